#include "motion_record.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trammel::app {

std::string MotionRecord::text() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return text_;
}

void MotionRecord::opened(std::uint64_t clock, const std::array<std::int64_t, card_map::kMaxAxes>& positions) {
  add(fmt::format("open,{},{}\n", clock, fmt::join(positions.begin(), positions.begin() + joints_, ",")));
}

void MotionRecord::line(const trammel_period& period, std::int64_t duration) {
  add(fmt::format("line,{},{},{},{}\n", period.number, period.time, duration,
                  fmt::join(period.target, period.target + joints_, ",")));
}

void MotionRecord::closed(std::uint64_t clock) { add(fmt::format("close,{}\n", clock)); }

void MotionRecord::path_step(const driver::PathStep& step) {
  add(fmt::format("step,{},{},{},{}\n", step.cycle, step.command, step.axis, step.direction));
}

void MotionRecord::outputs_changed(const driver::OutputChange& change) {
  add(fmt::format("output,{},{}\n", change.cycle, change.levels));
}

void MotionRecord::add(const std::string& line) {
  const std::lock_guard<std::mutex> lock(mutex_);
  text_ += line;
}

}  // namespace trammel::app
