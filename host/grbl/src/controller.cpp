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
  const End trouble = machine_.trouble();
  if (state_ == State::kAlarm || state_ == State::kSleep || lock || trouble.alarm != Alarm::kNone) {
    state_ = State::kAlarm;
    if (!trouble.message.empty()) say(fmt::format("[MSG:{}]", trouble.message));
    say("[MSG:'$H'|'$X' to unlock]");
    return;
  }
  state_ = State::kIdle;
  run_startup();
}

void Controller::answer(Status status) {
  if (const std::string trouble = settings_.take_trouble(); !trouble.empty()) say(fmt::format("[MSG:{}]", trouble));
  say(status == Status::kOk ? std::string("ok") : fmt::format("error:{}", static_cast<int>(status)));
}

void Controller::serve() {
  while (!waiting_ && !alone_ && !executing_alone_ && !reset_ && !cancelling_jog_ && pending_alarm_ == Alarm::kNone &&
         queue_.size() < kPlannerBlocks) {
    if (held() || state_ == State::kHome) return;
    const std::optional<std::string> line = input_.take();
    if (!line) return;
    last_line_ = std::chrono::steady_clock::now();
    const std::string text = cleaned(*line);
    if (!take(text)) waiting_ = text;
  }
}

bool Controller::take(const std::string& line, bool at_rest) {
  const bool busy = executing_ || !queue_.empty();
  if (line.size() > kLongestLine) {
    answer(Status::kLineTooLong);
  } else if (line.empty()) {
    answer(Status::kOk);
  } else if (line.rfind("$J=", 0) == 0) {
    // A queue with output changes only is no reason to refuse a jog: the jog waits.
    if (busy && state_ == State::kIdle) return false;
    take_jog(line.substr(3));
  } else if (line[0] == '$') {
    // Commands that use the machine are executed from work(): within `meanwhile` the bus makes no further calls of it,
    // so nothing would be served during such a command.
    const bool moves = state_ == State::kRun || state_ == State::kJog;
    if (line != "$G" && line != "$" && !moves && (busy || !at_rest)) return false;
    system(line);
  } else if (state_ == State::kAlarm || state_ == State::kJog) {
    answer(Status::kLocked);
  } else {
    Block block;
    const Status status = parse_block(line, interpreter_.modal(), interpreter_.letters(), block);
    if (status == Status::kOk && block.waits() && busy) return false;
    take_code(line);
  }
  return true;
}

// The state before the next line.
Controller::Accepted Controller::accepted() const {
  const Modal& modal = interpreter_.modal();
  return {preamble(modal), {}, {interpreter_.place(), interpreter_.parameters(), modal.spindle, modal.speed}};
}

void Controller::take_code(const std::string& line) {
  Accepted next = accepted();
  Block& block = next.block;
  const Status status = interpreter_.read(line, block);
  if (status == Status::kTravelExceeded && state_ != State::kCheck) return raise(Alarm::kSoftLimit);
  if (status != Status::kOk) return answer(status);
  if (block.offsets) {
    status_.offsets_changed();
    settings_.set_parameters(interpreter_.parameters());
  }
  if (block.outputs || block.end) status_.overrides_changed();
  if (state_ == State::kCheck) {
    if (block.end) say("[MSG:Pgm End]");
    return answer(Status::kOk);
  }
  if (block.waits()) {
    alone_ = next;
    return;
  }
  const bool needed = block.moves || block.outputs || executing_ || !queue_.empty();
  if (block.moves && state_ == State::kIdle) state_ = State::kRun;
  if (needed && !block.text.empty()) queue_.push_back(std::move(next));
  answer(Status::kOk);
}

void Controller::take_jog(const std::string& line) {
  if (state_ != State::kIdle && state_ != State::kJog) return answer(Status::kNotIdle);
  Accepted next = accepted();
  const Status status = interpreter_.read_jog(line, next.block);
  if (status != Status::kOk) return answer(status);
  queue_.push_back(std::move(next));
  state_ = State::kJog;
  answer(Status::kOk);
}

void Controller::work() {
  serve();
  if (reset_) return finish_reset();
  if (pending_alarm_ != Alarm::kNone) return raise(pending_alarm_);
  if (cancelling_jog_) return finish_jog();
  if (!held()) {
    if (!queue_.empty()) return run_section();
    if (alone_) return execute();
    if (waiting_) {
      const std::string line = std::move(*waiting_);
      waiting_.reset();
      take(line, true);
      return;
    }
  }
  if (state_ != State::kAlarm) {
    if (const End trouble = machine_.trouble(); trouble.alarm != Alarm::kNone) {
      return raise(trouble.alarm, trouble.message);
    }
  }
  machine_.wait();
}

void Controller::run_section() {
  const Accepted first = queue_.front();
  if (state_ == State::kIdle && first.block.moves) state_ = State::kRun;
  numbers_.clear();
  SectionLines lines(*this, first.preamble);
  executing_ = true;
  const End end = machine_.run(lines, first.before);
  executing_ = false;
  ended(end);
}

void Controller::drop_lines() {
  queue_.clear();
  alone_.reset();
  waiting_.reset();
  answer_at_resume_ = false;
}

void Controller::finish_jog() {
  cancelling_jog_ = false;
  queue_.clear();
  interpreter_.stand(machine_.look().at);
  if (state_ == State::kJog) state_ = State::kIdle;
}

void Controller::ended(const End& end) {
  const bool cut = end.stopped || end.alarm != Alarm::kNone || !end.message.empty();
  if (cut) {
    if (!cancelling_jog_) drop_lines();
    interpreter_.stand(machine_.look().at);
    see_safe_outputs();
  }
  if (end.alarm != Alarm::kNone) return raise(end.alarm, end.message);
  if (!end.message.empty()) say(fmt::format("[MSG:{}]", end.message));
  if (reset_ || pending_alarm_ != Alarm::kNone || cancelling_jog_) return;
  if (held()) {
    before_hold_ = State::kIdle;
  } else if (queue_.empty()) {
    state_ = State::kIdle;
  }
}

// Switches outputs off as Grbl does at a reset and at an alarm. During a fault this is postponed until the fault is
// cleared; the card has set its safe levels meanwhile.
void Controller::switch_off() {
  interpreter_.end_spindle();
  interpreter_.end_coolant();
  status_.overrides_changed();
  if (!switched_ || executing_ || machine_.trouble().alarm != Alarm::kNone) return;
  switched_ = false;
  const std::string text = "M5 M9\n";
  gcode::TextLines lines(text, "grbl");
  executing_ = executing_alone_ = true;
  machine_.run(lines, {machine_.look().at, interpreter_.parameters(), 5, 0});
  executing_ = executing_alone_ = false;
}

// A stop sets the machine file's safe levels. Only a new line of the sender switches these outputs on again.
void Controller::see_safe_outputs() {
  const machine::MachineOutputs& outputs = machine_.machine().outputs;
  const std::uint16_t safe = outputs.safe();
  if ((outputs.spindle() & safe) != 0) interpreter_.end_spindle();
  if ((outputs.coolant() & safe) != 0) interpreter_.end_coolant();
  status_.overrides_changed();
}

// Executes lines that Grbl answers when they are done: probes, dwells, M0, M2 and M30.
void Controller::execute() {
  const Accepted line = std::move(*alone_);
  alone_.reset();
  if (line.block.probe && !probe(line)) return;
  if (!line.block.probe && !line.block.text.empty() && !run_alone(line)) return;
  if (line.block.pause) {
    request_hold(State::kHold);
    answer_at_resume_ = true;
    return;
  }
  if (line.block.end) {
    restore_overrides();
    say("[MSG:Pgm End]");
  }
  answer(Status::kOk);
}

// Returns whether the line was executed to its end.
bool Controller::run_alone(const Accepted& line) {
  const std::string text = line.preamble + line.block.text;
  gcode::TextLines lines(text, "grbl");
  state_ = State::kRun;
  numbers_.clear();
  switched_ = switched_ || line.block.outputs;
  executing_ = executing_alone_ = true;
  const End end = machine_.run(lines, line.before);
  executing_ = executing_alone_ = false;
  if (end.probe) probed_ = *end.probe;
  ended(end);
  return !end.stopped && end.alarm == Alarm::kNone && !reset_;
}

// Returns whether the line may continue. Even if the probe raises an alarm, the line gets its answer, as in Grbl.
bool Controller::probe(const Accepted& line) {
  if (machine_.probe_touches() != line.block.probe_away) {
    raise(Alarm::kProbeInitial);
    answer(Status::kOk);
    return false;
  }
  probed_ = {};
  if (!run_alone(line)) return false;
  interpreter_.stand(machine_.look().at);
  if (!probed_.tripped) probed_.at = interpreter_.place();
  const bool missed = !probed_.tripped && line.block.probe_must_trip;
  if (missed) raise(Alarm::kProbeMissed);
  say(probe_text());
  if (missed) answer(Status::kOk);
  return !missed;
}

void Controller::raise(Alarm alarm, const std::string& message) {
  if (executing_) {
    pending_alarm_ = alarm;
    return machine_.stop();
  }
  pending_alarm_ = Alarm::kNone;
  drop_lines();
  const bool by_probe = alarm == Alarm::kProbeInitial || alarm == Alarm::kProbeMissed;
  if (!by_probe) input_.clear();
  interpreter_.stand(machine_.look().at);
  state_ = State::kAlarm;
  say(fmt::format("ALARM:{}", static_cast<int>(alarm)));
  if (!message.empty()) say(fmt::format("[MSG:{}]", message));
  say("[MSG:'$H'|'$X' to unlock]");
  if (!by_probe) switch_off();
}

void Controller::finish_reset() {
  reset_ = false;
  cancelling_jog_ = false;
  drop_lines();
  if (pending_alarm_ != Alarm::kNone) raise(pending_alarm_);
  machine_.hold(false);
  switch_off();
  interpreter_.reset();
  interpreter_.stand(machine_.look().at);
  probed_ = {};
  restore_overrides();
  begin();
}

void Controller::restore_overrides() {
  feed_override_ = machine_.override_feed(100);
  machine_.override_rapids(rapid_override_ = 100);
  spindle_override_ = 100;
  status_.overrides_changed();
}

}  // namespace trammel::grbl
