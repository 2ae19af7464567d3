#include "trammel/report/page_stream.hpp"

#include <zlib.h>

#include <cstring>
#include <stdexcept>

namespace trammel::report {
namespace {

constexpr std::size_t kPending = 16 * 1024;
constexpr std::size_t kElement = 192 * 1024;  // bytes, a multiple of 3: only the last element of a stream is padded

}  // namespace

struct PageStream::Deflate {
  z_stream z{};
  // Level 6: the best level takes four times as long for 1 % of the size.
  Deflate() {
    if (deflateInit(&z, 6) != Z_OK) throw std::runtime_error("zlib cannot begin a stream");
  }
  ~Deflate() { deflateEnd(&z); }
  Deflate(const Deflate&) = delete;
  Deflate& operator=(const Deflate&) = delete;
};

PageStream::PageStream(run::TextSink& sink, std::string name)
    : sink_(sink), name_(std::move(name)), deflate_(std::make_unique<Deflate>()) {}

PageStream::~PageStream() = default;

void PageStream::append(const void* data, std::size_t size) {
  const auto* from = static_cast<const unsigned char*>(data);
  pending_.insert(pending_.end(), from, from + size);
  if (pending_.size() >= kPending) drain(Z_NO_FLUSH);
}

void PageStream::bytes(std::string_view text) {
  while (!text.empty()) {
    const std::string_view part = text.substr(0, kPending);
    append(part.data(), part.size());
    text.remove_prefix(part.size());
  }
}

void PageStream::varint(std::uint64_t value) {
  unsigned char bytes[10];
  std::size_t size = 0;
  for (; value >= 0x80; value >>= 7) bytes[size++] = static_cast<unsigned char>(value | 0x80);
  bytes[size++] = static_cast<unsigned char>(value);
  append(bytes, size);
}

void PageStream::little_endian(std::uint64_t bits, std::size_t size) {
  unsigned char bytes[sizeof bits];
  for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<unsigned char>(bits >> (8 * i));
  append(bytes, size);
}

void PageStream::number(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  little_endian(bits, sizeof bits);
}

void PageStream::number(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  little_endian(bits, sizeof bits);
}

void PageStream::drain(int flush) {
  z_stream& z = deflate_->z;
  z.next_in = pending_.data();
  z.avail_in = static_cast<uInt>(pending_.size());
  unsigned char out[kPending];
  do {
    z.next_out = out;
    z.avail_out = sizeof out;
    deflate(&z, flush);
    deflated_.insert(deflated_.end(), out, out + (sizeof out - z.avail_out));
  } while (z.avail_out == 0);
  pending_.clear();
  if (deflated_.size() >= kElement) write_element();
}

void PageStream::write_element() {
  const std::size_t size = deflated_.size() < kElement ? deflated_.size() : deflated_.size() / 3 * 3;
  sink_.write("<script type=\"text/plain\" data-stream=\"" + name_ + "\">");
  sink_.write(base64(deflated_.data(), size));
  sink_.write("</script>\n");
  deflated_.erase(deflated_.begin(), deflated_.begin() + static_cast<std::ptrdiff_t>(size));
}

void PageStream::finish() {
  drain(Z_FINISH);
  while (!deflated_.empty()) write_element();
}

std::string base64(const unsigned char* data, std::size_t size) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::uint32_t left = static_cast<std::uint32_t>(size - i);
    const std::uint32_t bits = static_cast<std::uint32_t>(data[i]) << 16 |
                               (left > 1 ? static_cast<std::uint32_t>(data[i + 1]) << 8 : 0) |
                               (left > 2 ? data[i + 2] : 0U);
    text += kDigits[bits >> 18];
    text += kDigits[bits >> 12 & 63];
    text += left > 1 ? kDigits[bits >> 6 & 63] : '=';
    text += left > 2 ? kDigits[bits & 63] : '=';
  }
  return text;
}

}  // namespace trammel::report
