// Reports of the controller.
#include <fmt/format.h>

#include "trammel/grbl/controller.hpp"

namespace trammel::grbl {
namespace {

constexpr double kInch = 25.4;

std::string name_of(State state, bool held, bool executing) {
  switch (state) {
    case State::kIdle:
      return "Idle";
    case State::kRun:
      return held ? "Hold:0" : "Run";  // a hold by the machine's feed hold button
    case State::kHold:
      return executing && !held ? "Hold:1" : "Hold:0";
    case State::kJog:
      return "Jog";
    case State::kAlarm:
      return "Alarm";
    case State::kHome:
      return "Home";
    case State::kCheck:
      return "Check";
    case State::kSleep:
      return "Sleep";
    case State::kDoor:
      return executing && !held ? "Door:2" : "Door:0";
  }
  return {};
}

}  // namespace

std::string Controller::coordinates_text(const gcode::Coordinates& at) const {
  const bool inches = settings_.flag(13);
  std::string text;
  for (const char letter : interpreter_.letters()) {
    const auto axis = shape_.axis(letter);
    double value = axis ? at[*axis] : 0;
    if (inches && letter >= 'X') value /= kInch;
    const std::string number = fmt::format("{:.{}f}", value, inches ? 4 : 3);
    const bool zero = number.find_first_not_of("-0.") == std::string::npos;
    text += (text.empty() ? "" : ",") + (zero && number[0] == '-' ? number.substr(1) : number);
  }
  return text;
}

Report Controller::report_now() {
  const Live live = machine_.look();
  const Modal& modal = interpreter_.modal();
  const gcode::Coordinates offset = interpreter_.work_offset();
  gcode::Coordinates work = live.at;
  for (std::size_t n = 0; n < work.size(); ++n) work[n] -= offset[n];
  Report report;
  report.state = name_of(state_, live.held, executing_);
  report.busy = state_ != State::kIdle && state_ != State::kAlarm && state_ != State::kCheck && state_ != State::kSleep;
  report.position = coordinates_text(live.at);
  report.work_position = coordinates_text(work);
  report.offset = coordinates_text(offset);
  report.blocks_free = static_cast<unsigned>(kPlannerBlocks - std::min(kPlannerBlocks, queue_.size()));
  report.bytes_free = input_.room();
  if (executing_ && live.line > 0 && live.line <= numbers_.size()) report.line = numbers_[live.line - 1];
  report.feed = settings_.flag(13) ? live.speed / kInch : live.speed;
  report.speed = modal.spindle == 5 ? 0 : modal.speed;
  if (live.probe) report.pins += 'P';
  for (const char letter : std::string("XYZ")) {
    const auto axis = shape_.axis(letter);
    if (axis && (live.limits >> *axis & 1U) != 0) report.pins += letter;
  }
  report.feed_override = static_cast<int>(feed_override_);
  report.rapid_override = static_cast<int>(rapid_override_);
  report.spindle_override = spindle_override_;
  if (modal.spindle == 3) report.accessories += 'S';
  if (modal.spindle == 4) report.accessories += 'C';
  if (modal.flood) report.accessories += 'F';
  if (modal.mist) report.accessories += 'M';
  return report;
}

void Controller::report() { say(status_.text(report_now(), static_cast<unsigned>(settings_.value(10)))); }

std::string Controller::probe_text() const {
  return fmt::format("[PRB:{}:{}]", coordinates_text(probed_.at), probed_.tripped ? 1 : 0);
}

std::string Controller::offsets_text() const {
  std::string text;
  for (const int kind : {54, 55, 56, 57, 58, 59, 28, 30, 92}) {
    text += fmt::format("[G{}:{}]\r\n", kind, coordinates_text(interpreter_.offset(kind)));
  }
  const bool inches = settings_.flag(13);
  const double length = interpreter_.modal().tool_length / (inches ? kInch : 1);
  text += fmt::format("[TLO:{:.{}f}]\r\n", length, inches ? 4 : 3);
  return text + probe_text();
}

}  // namespace trammel::grbl
