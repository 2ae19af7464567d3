#include "trammel/grbl/input_buffer.hpp"

#include <algorithm>
#include <cctype>

namespace trammel::grbl {
namespace {

constexpr std::uint8_t kUtf8Lead = 0xC2;
constexpr std::uint8_t kReset = 0x18;

bool is_realtime(std::uint8_t byte) {
  return byte >= 0x80 || byte == '?' || byte == '!' || byte == '~' || byte == kReset;
}

}  // namespace

void InputBuffer::put(std::string_view bytes) {
  for (const char c : bytes) {
    const auto byte = static_cast<std::uint8_t>(c);
    if (byte == kUtf8Lead) continue;
    if (is_realtime(byte)) {
      realtime_(byte);
    } else {
      keep(c);
    }
  }
}

// CR, LF and CR LF end a line, even if CR and LF arrive separately.
void InputBuffer::keep(char c) {
  const bool second = c == '\n' && after_return_;
  after_return_ = c == '\r';
  if (!second && waiting_.size() < kMost) waiting_ += c == '\r' ? '\n' : c;
}

std::optional<std::string> InputBuffer::take() {
  const std::size_t end = waiting_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string line = waiting_.substr(0, end);
  waiting_.erase(0, end + 1);
  return line;
}

void InputBuffer::clear() { waiting_.clear(); }

std::size_t InputBuffer::room() const { return kReceiveBuffer - std::min(kReceiveBuffer, waiting_.size()); }

std::string cleaned(std::string_view line) {
  std::string text;
  bool comment = false;
  for (const char c : line) {
    if (c == ';' && !comment) break;
    if (c == '(') comment = true;
    if (!comment && static_cast<unsigned char>(c) > ' ' && c != '/' && text.size() <= kLongestLine) {
      text += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    if (c == ')') comment = false;
  }
  return !text.empty() && text.front() == '%' ? std::string() : text;
}

}  // namespace trammel::grbl
