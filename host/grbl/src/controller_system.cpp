// Lines that begin with '$'.
#include <fmt/format.h>

#include <cstdlib>

#include "trammel/gcode/parameter_numbers.hpp"
#include "trammel/grbl/controller.hpp"
#include "words.hpp"

namespace trammel::grbl {
namespace {

// Text that begins as one of Grbl's commands but is not one is error 3; other text is error 2.
bool begins_command(char c) { return c == '#' || c == 'I' || c == 'R' || c == 'S'; }

}  // namespace

void Controller::system(const std::string& line) {
  const Status status = system_status(line);
  if (!reset_) answer(status);
}

Status Controller::system_status(const std::string& line) {
  const bool still = !executing_ && queue_.empty();
  const bool waits = still && (state_ == State::kIdle || state_ == State::kAlarm);
  switch (line.size() == 1 ? '\0' : line[1]) {
    case '\0':
      say("[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ~ ! ? ctrl-x]");
      return Status::kOk;
    case '$':
    case 'G':
    case 'C':
    case 'X':
      return line.size() == 2 ? short_status(line[1]) : Status::kInvalidStatement;
    case 'J':
      return state_ == State::kIdle || state_ == State::kJog ? Status::kInvalidStatement : Status::kNotIdle;
    default:
      return waits ? still_status(line) : Status::kNotIdle;
  }
}

Status Controller::short_status(char what) {
  if (what == 'C') return toggle_check();
  if (what == 'X') return unlock();
  if (what == 'G') {
    say(parser_state(interpreter_.modal(), settings_.flag(13)));
    return Status::kOk;
  }
  if (state_ == State::kRun) return Status::kNotIdle;
  for (const std::string& setting : settings_.lines()) say(setting);
  return Status::kOk;
}

// Commands that need a machine at rest.
Status Controller::still_status(const std::string& line) {
  if (line == "$#") {
    say(offsets_text());
    return Status::kOk;
  }
  if (line == "$I") {
    say(fmt::format("[VER:1.1h.20190825:{}]", settings_.build_text()));
    say(fmt::format("[OPT:VNMH,{},{}]", kPlannerBlocks, kReceiveBuffer));
    return Status::kOk;
  }
  if (line == "$SLP") {
    say("[MSG:Sleeping]");
    state_ = State::kSleep;
    return Status::kOk;
  }
  if (line.rfind("$H", 0) == 0) return home(line);
  if (line.rfind("$N", 0) == 0) return startup_line(line);
  if (line.rfind("$RST=", 0) == 0 && line.size() == 6) return restore(line[5]);
  if (line.rfind("$I=", 0) == 0) {
    settings_.set_build_text(line.substr(3));
    return Status::kOk;
  }
  return set_line(line);
}

Status Controller::set_line(const std::string& line) {
  std::size_t at = 1;
  std::string number;
  std::string value;
  if (!read_number(line, at, number)) {
    return begins_command(line[1]) ? Status::kInvalidStatement : Status::kBadNumber;
  }
  if (at >= line.size() || line[at] != '=') return Status::kInvalidStatement;
  if (!read_number(line, ++at, value)) return Status::kBadNumber;
  if (at != line.size() || number.find_first_not_of("0123456789") != std::string::npos || number.size() > 3) {
    return Status::kInvalidStatement;
  }
  const int key = std::atoi(number.c_str());
  const Status status = settings_.set(key, std::strtod(value.c_str(), nullptr));
  if (status == Status::kOk && Settings::changes_machine(key)) apply_settings();
  return status;
}

void Controller::apply_settings() {
  machine_.set_machine(settings_.machine());
  shape_ = machine_.machine();
  interpreter_.stand(machine_.look().at);
}

Status Controller::startup_line(const std::string& line) {
  if (line == "$N") {
    for (std::size_t n = 0; n < Settings::kStartupLines; ++n) say(fmt::format("$N{}={}", n, settings_.startup(n)));
    return Status::kOk;
  }
  if (state_ != State::kIdle) return Status::kNotIdle;
  if (line[2] < '0' || line[2] > '9') return Status::kBadNumber;
  if (line.size() < 4 || line[3] != '=' || line[2] > '1') return Status::kInvalidStatement;
  const std::string text = line.substr(4);
  Block block;
  if (const Status status = parse_block(text, interpreter_.modal(), interpreter_.letters(), block);
      status != Status::kOk) {
    return status;
  }
  settings_.set_startup(line[2] == '0' ? 0 : 1, text);
  return Status::kOk;
}

// Shows each line as Grbl does: ">G21:ok".
void Controller::run_startup() {
  for (std::size_t n = 0; n < Settings::kStartupLines; ++n) {
    const std::string line = settings_.startup(n);
    if (line.empty()) continue;
    write_(">" + line + ":");
    take_code(line);
    while (alone_ && !queue_.empty()) run_section();
    if (alone_) execute();
    if (held() || state_ == State::kAlarm) return;
  }
}

Status Controller::restore(char what) {
  if (what != '$' && what != '#' && what != '*') return Status::kInvalidStatement;
  if (what != '#') settings_.restore();
  if (what != '$') {
    std::map<int, double> zeros = interpreter_.parameters();
    for (auto& [number, value] : zeros) value = number == gcode::parameter::kSystem ? value : 0;
    interpreter_.set_parameters(zeros);
    settings_.set_parameters(zeros);
    status_.offsets_changed();
  }
  if (what == '*') {
    for (std::size_t n = 0; n < Settings::kStartupLines; ++n) settings_.set_startup(n, "");
    settings_.set_build_text("");
  }
  apply_settings();
  say("[MSG:Restoring defaults]");
  answer(Status::kOk);
  reset_ = true;  // Grbl resets here
  return Status::kOk;
}

Status Controller::toggle_check() {
  if (state_ == State::kCheck) {
    // Grbl ends the check mode with a reset.
    say("[MSG:Disabled]");
    answer(Status::kOk);
    reset_ = true;
    return Status::kOk;
  }
  if (state_ != State::kIdle) return Status::kNotIdle;
  say("[MSG:Enabled]");
  state_ = State::kCheck;
  return Status::kOk;
}

Status Controller::unlock() {
  if (state_ != State::kAlarm) return Status::kOk;
  if (const End stays = machine_.unlock(); stays.alarm != Alarm::kNone) {
    if (!stays.message.empty()) say(fmt::format("[MSG:{}]", stays.message));
    return Status::kLocked;
  }
  shape_ = machine_.machine();
  interpreter_.stand(machine_.look().at);
  switch_off();
  say("[MSG:Caution: Unlocked]");
  state_ = State::kIdle;  // as in Grbl, the startup lines are not executed: they may move the machine
  return Status::kOk;
}

Status Controller::home(const std::string& line) {
  if (!settings_.flag(22) || !machine_.can_home()) return Status::kHomingDisabled;
  std::vector<std::size_t> axes;
  for (const char letter : line.substr(2)) {
    const auto axis = shape_.axis(letter);
    if (!axis || !shape_.axes[*axis].homing) return Status::kInvalidStatement;
    axes.push_back(*axis);
  }
  // Homing is permitted with an unknown position, because it determines the position.
  if (state_ == State::kAlarm) machine_.unlock();
  state_ = State::kHome;
  executing_ = true;
  End end = machine_.home(axes);
  executing_ = false;
  if (end.stopped) end.alarm = Alarm::kHomingReset;
  shape_ = machine_.machine();
  interpreter_.stand(machine_.look().at);
  ended(end);
  if (end.alarm == Alarm::kNone && axes.empty()) run_startup();
  return Status::kOk;
}

}  // namespace trammel::grbl
