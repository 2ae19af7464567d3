#include "step_hashes.hpp"

#include <algorithm>
#include <stdexcept>
#include <variant>

namespace trammel::test {
namespace {

bool is_barrier(const driver::Command& command) {
  return std::holds_alternative<driver::DwellCommand>(command) || std::holds_alternative<driver::EndCommand>(command);
}

std::uint64_t word(std::int64_t value) { return static_cast<std::uint64_t>(value); }

template <class Step>
void sort_by_axis(std::vector<Step>& steps) {
  std::sort(steps.begin(), steps.end(), [](const Step& a, const Step& b) { return a.axis < b.axis; });
}

}  // namespace

// The constants of FNV-1a. The shift brings the high bits down, because the product carries only upwards.
void Hash::add(std::uint64_t word) {
  value_ = (value_ ^ word) * 0x100000001B3U;
  value_ ^= value_ >> 29U;
}

void StepHasher::block(Path path) {
  arcs_ |= path != Path::kNoArc;
  chords_ = path == Path::kChords;
}

void StepHasher::command(const driver::Command& command) {
  commands_.push_back({sent_at_.size(), result_.barriers, chords_});
  if (is_barrier(command)) ++result_.barriers;
}

void StepHasher::sent(std::uint64_t cycle) { sent_at_.push_back(cycle); }

void StepHasher::path_step(const driver::PathStep& step) {
  const Sent& command = commands_.at(step.command);
  if (!tick_.empty() && (tick_.back().command != step.command || tick_.back().tick != step.tick)) {
    const bool next_command = tick_.back().command != step.command;
    end_tick();
    if (next_command) end_chord();
  }
  tick_.push_back(step);
  ++result_.path_steps;
  waiting_.at(step.axis).push_back({&command, step.direction});
}

void StepHasher::end_tick() {
  sort_by_axis(tick_);
  for (const driver::PathStep& step : tick_) {
    if (commands_[step.command].chord) {
      if (chord_ == Pulses{}) path_.add(step.command);
      ++chord_[step.axis][step.direction > 0 ? 0 : 1];
      continue;
    }
    path_.add(step.command);
    path_.add(step.tick);
    path_.add(step.axis);
    path_.add(word(step.direction));
  }
  tick_.clear();
}

void StepHasher::end_chord() {
  if (chord_ == Pulses{}) return;
  for (const auto& axis : chord_) {
    for (const std::uint64_t pulses : axis) path_.add(pulses);
  }
  chord_ = {};
}

void StepHasher::pin_step(const driver::PinStep& step) {
  auto& waiting = waiting_.at(step.axis);
  if (waiting.empty() || waiting.front().direction != step.direction) {
    throw std::logic_error("a step at a pin that no path has made");
  }
  const Sent command = *waiting.front().command;
  waiting.pop_front();
  if (sent_at_.empty()) throw std::logic_error("a step at a pin before the first commands are written");
  if (!cycle_.empty() && last_cycle_ != step.cycle) end_cycle();
  look_at_lead(command.block, step.cycle);
  const auto since = static_cast<std::int64_t>(step.cycle - sent_at_.front());
  const std::int64_t corrected = since - shift_.start - shift_.barrier * static_cast<std::int64_t>(command.barriers);
  if (result_.pin_steps == 0) result_.start = corrected;
  corrected_ = corrected;
  cycle_.push_back(step);
  last_cycle_ = step.cycle;
  ++result_.pin_steps;
}

void StepHasher::look_at_lead(std::size_t block, std::uint64_t cycle) {
  if (last_block_ && *last_block_ != block) {
    // A block that is still being written has no time yet, so it is not ahead.
    const std::uint64_t written = block < sent_at_.size() ? sent_at_[block] : cycle;
    const auto lead = static_cast<std::int64_t>(last_cycle_ - written);
    result_.lead = std::min(result_.lead.value_or(lead), lead);
  }
  last_block_ = block;
}

void StepHasher::end_cycle() {
  sort_by_axis(cycle_);
  for (const driver::PinStep& step : cycle_) {
    pins_.add(word(corrected_ - result_.start));
    pins_.add(step.axis);
    pins_.add(word(step.direction));
  }
  cycle_.clear();
}

StepHashes StepHasher::finish() {
  end_tick();
  end_chord();
  end_cycle();
  if (result_.path_steps != result_.pin_steps) throw std::logic_error("path steps that no pin has made");
  result_.path = path_.value();
  if (!arcs_) result_.pins = pins_.value();
  return result_;
}

}  // namespace trammel::test
