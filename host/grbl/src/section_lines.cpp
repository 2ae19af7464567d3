#include "section_lines.hpp"

namespace trammel::grbl {
namespace {

using namespace std::chrono_literals;

constexpr auto kBetweenLines = 25ms;  // a sender that reacts to ok sends the next line sooner
constexpr auto kFirstMotion = 250ms;  // for a slower sender, the first line is executed after this time
constexpr double kReserve = 0.06;     // s of motion left in the card when planning of the rest must begin

}  // namespace

bool SectionLines::next(std::string_view& line) {
  if (text_.empty() && !refill()) return false;
  const std::size_t end = text_.find('\n');
  given_ = text_.substr(0, end);
  text_.erase(0, end == std::string::npos ? end : end + 1);
  controller_.numbers_.push_back(number_);
  line = given_;
  return true;
}

bool SectionLines::refill() {
  for (;;) {
    controller_.serve();
    if (controller_.reset_ || controller_.pending_alarm_ != Alarm::kNone || controller_.cancelling_jog_) return false;
    if (!controller_.queue_.empty()) break;
    if (!may_wait()) return false;
    controller_.machine_.wait();
  }
  text_ = controller_.queue_.front().block.text;
  number_ = controller_.queue_.front().block.line_number;
  controller_.switched_ = controller_.switched_ || controller_.queue_.front().block.outputs;
  controller_.queue_.pop_front();
  return true;
}

bool SectionLines::may_wait() const {
  if (controller_.waiting_ || controller_.alone_) return false;
  const auto now = Clock::now();
  const Live live = controller_.machine_.look();
  if (live.any_sent) return live.seconds_left > kReserve && now - controller_.last_line_ < kFirstMotion;
  return now - controller_.last_line_ < kBetweenLines && now - begun_ < kFirstMotion;
}

}  // namespace trammel::grbl
