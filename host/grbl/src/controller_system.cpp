// Lines that begin with '$'.
#include <fmt/format.h>

#include <cstdlib>

#include "trammel/grbl/controller.hpp"

namespace trammel::grbl {

void Controller::system(const std::string& line) {
  const Status status = system_status(line);
  const bool homing_failed = line.rfind("$H", 0) == 0 && status == Status::kOk && state_ == State::kAlarm;
  if (!homing_failed && !reset_) answer(status);
}

Status Controller::system_status(const std::string& line) {
  if (line == "$") {
    say("[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ~ ! ? ctrl-x]");
    return Status::kOk;
  }
  if (line == "$G") {
    say(parser_state(interpreter_.modal(), settings_.flag(13)));
    return Status::kOk;
  }
  const bool still = !executing_ && queue_.empty();
  if (!still || (state_ != State::kIdle && state_ != State::kAlarm && state_ != State::kCheck)) return Status::kNotIdle;
  return still_status(line);
}

// Of a machine that stands.
Status Controller::still_status(const std::string& line) {
  if (line == "$C") return toggle_check();
  if (state_ == State::kCheck) return Status::kNotIdle;
  if (line == "$X") return unlock();
  if (line == "$$") {
    for (const std::string& setting : settings_.lines()) say(setting);
    return Status::kOk;
  }
  if (line == "$#") {
    say(offsets_text());
    return Status::kOk;
  }
  if (line == "$I") {
    say(fmt::format("[VER:1.1h.20190825:{}]", settings_.build_text()));
    say(fmt::format("[OPT:VMNH,{},{}]", kPlannerBlocks, kReceiveBuffer));
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
  const std::size_t equal = line.find('=');
  if (equal == std::string::npos || equal == 1) return Status::kInvalidStatement;
  const std::string number = line.substr(1, equal - 1);
  const std::string value = line.substr(equal + 1);
  char* end = nullptr;
  const double setting = std::strtod(value.c_str(), &end);
  if (number.find_first_not_of("0123456789") != std::string::npos || number.size() > 3)
    return Status::kInvalidStatement;
  if (value.empty() || *end != '\0') return Status::kBadNumber;
  const int key = std::atoi(number.c_str());
  const Status status = settings_.set(key, setting);
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
  if (line.size() < 4 || line[3] != '=' || (line[2] != '0' && line[2] != '1')) return Status::kInvalidStatement;
  const std::string text = line.substr(4);
  Block block;
  if (const Status status = parse_block(text, interpreter_.modal(), interpreter_.letters(), block);
      status != Status::kOk) {
    return status;
  }
  settings_.set_startup(line[2] == '0' ? 0 : 1, text);
  return Status::kOk;
}

// ">G21:ok", as Grbl shows them.
void Controller::run_startup() {
  for (std::size_t n = 0; n < Settings::kStartupLines; ++n) {
    const std::string line = settings_.startup(n);
    if (line.empty()) continue;
    write_(">" + line + ":");
    take_code(line);
  }
}

Status Controller::restore(char what) {
  if (what != '$' && what != '#' && what != '*') return Status::kInvalidStatement;
  if (what != '#') settings_.restore();
  if (what != '$') {
    std::map<int, double> zeros = interpreter_.parameters();
    for (auto& [number, value] : zeros) value = number == 5220 ? value : 0;
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
  say("[MSG:Caution: Unlocked]");
  state_ = State::kIdle;
  run_startup();
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
  // A place that is not known is what homing is for.
  if (state_ == State::kAlarm) machine_.unlock();
  state_ = State::kHome;
  executing_ = true;
  End end = machine_.home(axes);
  executing_ = false;
  if (end.stopped) end.alarm = Alarm::kHomingReset;
  shape_ = machine_.machine();
  interpreter_.stand(machine_.look().at);
  ended(end);
  if (end.alarm == Alarm::kNone) run_startup();
  return Status::kOk;
}

}  // namespace trammel::grbl
