#include "trammel/frames/stuffing.hpp"

namespace trammel::frames {

namespace {

void append_stuffed(Bytes& stream, std::uint8_t byte) {
  if (byte != kEnd && byte != kEscape) return stream.push_back(byte);
  stream.push_back(kEscape);
  stream.push_back(byte == kEnd ? kEscapedEnd : kEscapedEscape);
}

}  // namespace

void append_frame(Bytes& stream, const Bytes& body) {
  for (const std::uint8_t byte : body) append_stuffed(stream, byte);
  const std::uint32_t crc = crc32(body.data(), body.size());
  for (unsigned i = 0; i < kCrcBytes; ++i) append_stuffed(stream, static_cast<std::uint8_t>(crc >> (8 * i)));
  stream.push_back(kEnd);
}

bool Deframer::take(std::uint8_t byte) {
  if (byte == kEnd) return end();
  if (escaped_) {
    escaped_ = false;
    if (byte == kEscapedEnd) {
      add(kEnd);
    } else if (byte == kEscapedEscape) {
      add(kEscape);
    } else {
      bad_ = true;
    }
  } else if (byte == kEscape) {
    escaped_ = true;
  } else {
    add(byte);
  }
  return false;
}

void Deframer::add(std::uint8_t byte) {
  if (bytes_.size() == most_ + kCrcBytes) bad_ = true;
  if (bad_) return;
  bytes_.push_back(byte);
  crc_.add(byte);
}

bool Deframer::end() {
  const bool begun = !bytes_.empty() || escaped_ || bad_;
  const bool good = !bad_ && !escaped_ && bytes_.size() > kCrcBytes && crc_.whole();
  if (good) {
    bytes_.resize(bytes_.size() - kCrcBytes);
    body_.swap(bytes_);
  } else if (begun) {
    ++dropped_;
  }
  clear();
  return good;
}

void Deframer::clear() {
  bytes_.clear();
  crc_ = Crc32();
  escaped_ = false;
  bad_ = false;
}

}  // namespace trammel::frames
