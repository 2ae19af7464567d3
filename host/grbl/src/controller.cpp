#include "trammel/grbl/controller.hpp"

#include <fmt/format.h>

#include "section_lines.hpp"

namespace trammel::grbl {

Controller::Controller(MachineSide& machine, Settings& settings, Write write)
    : machine_(machine),
      settings_(settings),
      write_(std::move(write)),
      shape_(machine.machine()),
      input_([this](std::uint8_t byte) { realtime(byte); }),
      interpreter_(shape_, machine.limits()) {
  interpreter_.set_parameters(settings.parameters());
  interpreter_.stand(machine_.look().at);
}

void Controller::begin() {
  say("\r\nGrbl 1.1h ['$' for help]");
  status_.offsets_changed();
  const bool lock = settings_.flag(22) && machine_.can_home() && !machine_.homed();
  if (state_ == State::kAlarm || lock) {
    state_ = State::kAlarm;
    say("[MSG:'$H'|'$X' to unlock]");
    return;
  }
  state_ = State::kIdle;
  run_startup();
}

void Controller::answer(Status status) {
  say(status == Status::kOk ? std::string("ok") : fmt::format("error:{}", static_cast<int>(status)));
}

void Controller::serve() {
  while (!waiting_ && !reset_ && pending_alarm_ == Alarm::kNone && queue_.size() < kPlannerBlocks) {
    if (state_ == State::kHold || state_ == State::kDoor || state_ == State::kSleep || state_ == State::kHome) return;
    const std::optional<std::string> line = input_.take();
    if (!line) return;
    last_line_ = std::chrono::steady_clock::now();
    const std::string text = cleaned(*line);
    if (!take(text)) waiting_ = text;
  }
}

bool Controller::take(const std::string& line) {
  if (line.size() > kLongestLine) {
    answer(Status::kLineTooLong);
  } else if (line.empty()) {
    answer(Status::kOk);
  } else if (line.rfind("$J=", 0) == 0) {
    // While jogs are under way another one joins them.
    if (executing_ && state_ != State::kJog && state_ != State::kRun) return false;
    take_jog(line.substr(3));
  } else if (line[0] == '$') {
    const bool quick = line == "$G" || line == "$";
    if (!quick && state_ != State::kRun && state_ != State::kJog && executing_) return false;
    system(line);
  } else if (state_ == State::kAlarm || state_ == State::kJog) {
    answer(Status::kLocked);
  } else {
    Block block;
    const Status status = parse_block(line, interpreter_.modal(), interpreter_.letters(), block);
    if (status == Status::kOk && block.waits() && (executing_ || !queue_.empty())) return false;
    take_code(line);
  }
  return true;
}

void Controller::take_code(const std::string& line) {
  Accepted accepted;
  accepted.before = preamble(interpreter_.modal());
  accepted.parameters = interpreter_.parameters();
  accepted.place = interpreter_.place();
  const Status status = interpreter_.read(line, block_);
  if (status == Status::kTravelExceeded && state_ != State::kCheck) return raise(Alarm::kSoftLimit);
  if (status != Status::kOk) return answer(status);
  if (block_.offsets) {
    status_.offsets_changed();
    settings_.set_parameters(interpreter_.parameters());
  }
  if (block_.outputs || block_.end) status_.overrides_changed();
  if (state_ == State::kCheck) return answer(Status::kOk);
  accepted.text = block_.text;
  accepted.number = block_.line_number;
  accepted.moves = block_.moves;
  if (block_.waits()) {
    to_execute_ = accepted;
    return;
  }
  const bool needed = block_.moves || block_.outputs || executing_ || !queue_.empty();
  if (needed && !accepted.text.empty()) queue_.push_back(accepted);
  if (block_.moves && state_ == State::kIdle) state_ = State::kRun;
  answer(Status::kOk);
}

void Controller::take_jog(const std::string& line) {
  if (state_ != State::kIdle && state_ != State::kJog) return answer(state_ == State::kAlarm ? Status::kLocked : Status::kNotIdle);
  Accepted accepted;
  accepted.before = preamble(interpreter_.modal());
  accepted.parameters = interpreter_.parameters();
  accepted.place = interpreter_.place();
  const Status status = interpreter_.read_jog(line, block_);
  if (status != Status::kOk) return answer(status);
  accepted.text = block_.text;
  accepted.moves = true;
  queue_.push_back(accepted);
  state_ = State::kJog;
  answer(Status::kOk);
}

void Controller::work() {
  serve();
  if (reset_) return finish_reset();
  if (pending_alarm_ != Alarm::kNone) return raise(pending_alarm_);
  const bool held = state_ == State::kHold || state_ == State::kDoor || state_ == State::kSleep;
  if (!held && to_execute_) return execute_waiting();
  if (!held && !queue_.empty()) return run_section();
  if (!held && waiting_) {
    const std::string line = *waiting_;
    waiting_.reset();
    if (!take(line)) waiting_ = line;
    return;
  }
  if (state_ != State::kAlarm) {
    if (const Alarm alarm = machine_.fault(); alarm != Alarm::kNone) return raise(alarm);
  }
  machine_.wait();
}

void Controller::run_section() {
  const Accepted first = queue_.front();
  numbers_.clear();
  SectionLines lines(*this, first.before);
  executing_ = true;
  const End end = machine_.run(lines, first.place, first.parameters);
  executing_ = false;
  ended(end);
}

void Controller::ended(const End& end) {
  const bool cancelled = stopping_jog_;
  if (end.stopped || end.alarm != Alarm::kNone || cancelled) {
    queue_.clear();
    to_execute_.reset();
    waiting_.reset();
  }
  stopping_jog_ = false;
  if (!end.message.empty()) say(fmt::format("[MSG:{}]", end.message));
  if (queue_.empty()) interpreter_.stand(end.stopped || cancelled || end.alarm != Alarm::kNone ? machine_.look().at
                                                                                              : interpreter_.place());
  if (end.alarm != Alarm::kNone) return raise(end.alarm);
  if (reset_ || pending_alarm_ != Alarm::kNone) return;
  const bool held = state_ == State::kHold || state_ == State::kDoor || state_ == State::kSleep;
  if (held) before_hold_ = State::kIdle;
  if (!held && queue_.empty()) state_ = State::kIdle;
}

// Lines that Grbl answers when they are done: probes, dwells, M0, M2 and M30.
void Controller::execute_waiting() {
  const Accepted line = *to_execute_;
  to_execute_.reset();
  const Block block = block_;
  if (block.probe) return probe(line);
  if (!line.text.empty() && !block.pause) {
    gcode::TextLines lines(line.before, "grbl");
    state_ = State::kRun;
    executing_ = true;
    const std::string text = line.before + line.text;
    gcode::TextLines whole(text, "grbl");
    const End end = machine_.run(whole, line.place, line.parameters);
    executing_ = false;
    ended(end);
    if (end.stopped || end.alarm != Alarm::kNone) return;
  }
  if (block.pause) request_hold(State::kHold);
  if (block.end) say("[MSG:Pgm End]");
  answer(Status::kOk);
}

void Controller::probe(const Accepted& line) {
  interpreter_.stand(machine_.look().at);
  if (machine_.look().probe != block_.probe_away) return raise(Alarm::kProbeInitial);
  const bool must_trip = block_.probe_must_trip;
  state_ = State::kRun;
  executing_ = true;
  const std::string text = line.before + line.text;
  gcode::TextLines whole(text, "grbl");
  const End end = machine_.run(whole, line.place, line.parameters);
  executing_ = false;
  if (end.probe) probed_ = *end.probe;
  ended(end);
  if (end.stopped || end.alarm != Alarm::kNone) return;
  interpreter_.stand(machine_.look().at);
  say(probe_text());
  if (!probed_.tripped && must_trip) return raise(Alarm::kProbeMissed);
  answer(Status::kOk);
}

void Controller::raise(Alarm alarm) {
  pending_alarm_ = alarm;
  if (executing_) {
    machine_.stop();
    return;
  }
  pending_alarm_ = Alarm::kNone;
  queue_.clear();
  to_execute_.reset();
  waiting_.reset();
  input_.clear();
  interpreter_.stand(machine_.look().at);
  state_ = State::kAlarm;
  say(fmt::format("ALARM:{}", static_cast<int>(alarm)));
  say("[MSG:'$H'|'$X' to unlock]");
}

void Controller::finish_reset() {
  reset_ = false;
  queue_.clear();
  to_execute_.reset();
  waiting_.reset();
  machine_.hold(false);
  interpreter_.reset();
  interpreter_.stand(machine_.look().at);
  feed_override_ = machine_.override_feed(100);
  machine_.override_rapids(rapid_override_ = 100);
  spindle_override_ = 100;
  if (state_ != State::kAlarm) state_ = State::kIdle;
  begin();
}

}  // namespace trammel::grbl
