#include "trammel/panel/program.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "trammel/grbl/input_buffer.hpp"

namespace trammel::panel {
namespace {

constexpr std::size_t kLargestNumber = 9'999'999;  // largest N word, as in Grbl

// Whether the controller would take the byte for a real-time command, at any position in a line.
bool is_command(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return byte >= 0x80 || byte == '?' || byte == '!' || byte == '~' || byte == 0x18;
}

std::optional<std::string> refusal(std::string_view line) {
  const std::string text = grbl::cleaned(line);
  if (std::any_of(text.begin(), text.end(), is_command)) return "has a character that G-code does not have";
  if (!text.empty() && text[0] == '$') return "begins with $: this is a command to a controller, not G-code";
  if (text.size() > grbl::kLongestLine) {
    return fmt::format("is longer than {} characters without blanks and comments", grbl::kLongestLine);
  }
  return std::nullopt;
}

std::string numbered(const std::string& text, std::size_t number) {
  std::size_t words = 0;
  if (text[0] == 'N') words = std::min(text.find_first_not_of("0123456789", 1), text.size());
  std::string line = fmt::format("N{}{}", number, text.substr(words));
  return line.size() <= grbl::kLongestLine && number <= kLargestNumber ? line : text;
}

}  // namespace

void Program::begin_loading(const std::string& name) {
  *this = [this] {
    Program empty;
    empty.version_ = version_ + 1;
    return empty;
  }();
  name_ = name;
  phase_ = Phase::kLoading;
}

bool Program::append(std::string_view part) {
  if (phase_ != Phase::kLoading || text_.size() + part.size() > kMost) return false;
  text_.append(part);
  return true;
}

void Program::unload() {
  begin_loading("");
  phase_ = Phase::kNone;
}

std::string_view Program::take() {
  const std::size_t end = std::min(text_.find('\n', at_), text_.size());
  const std::string_view line = std::string_view(text_).substr(at_, end - at_);
  at_ = end + 1;
  ++read_;
  return line;
}

std::optional<std::string> Program::finish_loading() {
  if (phase_ != Phase::kLoading) return "no program was sent";
  bool any = false;
  while (!sent_all()) {
    const std::string_view line = take();
    if (const auto reason = refusal(line)) {
      const std::string text = fmt::format("{}: line {} {}", name_, read_, *reason);
      unload();
      return text;
    }
    any = any || !grbl::cleaned(line).empty();
  }
  if (!any) {
    const std::string text = fmt::format("{}: the program is empty", name_);
    unload();
    return text;
  }
  lines_ = read_;
  phase_ = Phase::kReady;
  return std::nullopt;
}

bool Program::check() {
  if (phase_ != Phase::kReady && phase_ != Phase::kDone && phase_ != Phase::kStopped) return false;
  rewind();
  reason_.clear();
  phase_ = Phase::kChecking;
  return true;
}

void Program::start() {
  rewind();
  phase_ = Phase::kRunning;
}

void Program::end_check(const std::string& reason) {
  if (!checking()) return;
  phase_ = Phase::kStopped;
  reason_ = reason;
}

std::optional<Program::Line> Program::next() {
  while (!sent_all()) {
    const std::string text = grbl::cleaned(take());
    if (text.empty()) continue;
    sent_ = read_;
    return Line{read_, numbered(text, read_)};
  }
  return std::nullopt;
}

void Program::stop(const std::string& reason) {
  if (!running()) return;
  phase_ = Phase::kStopped;
  reason_ = reason;
}

}  // namespace trammel::panel
