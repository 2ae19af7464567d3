// Tests of the stop judge: each of its claims is seen to fail, on a correct card whose pins, answers or inputs are
// falsified.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stop_window.hpp"

namespace trammel::test {
namespace {

using testing::HasSubstr;

// A falsification: its kind and its start. `since` counts clocks from the first access to the register `trigger`.
struct Lie {
  std::uint32_t trigger = 0;  // 0: from the beginning
  std::function<StepPins(const StepPins& pins, const StepPins& before, std::uint64_t since)> pins;
  std::function<void(WatchedCard::Inputs&, std::uint64_t since)> inputs;
  // Bits that are wrong in each answer to a read of `address`, and in simultaneous answers.
  std::uint32_t address = 0;
  std::uint32_t bits = 0;
};

class FalseCard : public RtlAlone {
 public:
  explicit FalseCard(const Lie& lie) : RtlAlone(watched_straps(), kWatchedAxes), lie_(lie) {}

  Bus bus() const override {
    Bus bus = RtlAlone::bus();
    if (bus.rvalid && read_ == lie_.address && lie_.bits != 0 && told_) bus.rdata ^= lie_.bits;
    return bus;
  }
  StepPins pins() const override { return shown_; }

 protected:
  void clock(const Inputs& in) override {
    if (in.arvalid) read_ = in.araddr;
    const bool access = (in.arvalid && in.araddr == lie_.trigger) || (in.awvalid && in.awaddr == lie_.trigger);
    told_ = told_ || access || lie_.trigger == 0;
    since_ += told_ ? 1 : 0;
    Inputs given = in;
    if (lie_.inputs && told_) lie_.inputs(given, since_);
    RtlAlone::clock(given);
    const StepPins real = RtlAlone::pins();
    shown_ = lie_.pins && told_ ? lie_.pins(real, before_, since_) : real;
    before_ = real;
  }

 private:
  Lie lie_;
  std::uint32_t read_ = 0;
  bool told_ = false;
  std::uint64_t since_ = 0;
  StepPins before_;
  StepPins shown_;
};

template <class List>
const auto& named(const List& list, const std::string& name) {
  for (const auto& entry : list) {
    if (entry.name == name) return entry;
  }
  throw std::logic_error("no " + name);
}

// The claim that fails; empty: none.
std::string broken_claim(const char* cause, Reaction reaction, const char* state, const Lie& lie, unsigned clock = 3) {
  try {
    Tally tally;
    Window window(std::make_unique<FalseCard>(lie), named(causes(), cause), reaction, named(states(), state));
    window.judge(clock, tally);
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

struct Falsified {
  const char* cause;
  Reaction reaction;
  const char* state;
  Lie lie;
  const char* claim;
  unsigned clock = 3;
};

Lie wrong(std::uint32_t address, std::uint32_t bits = 1) {
  Lie lie;
  lie.address = address;
  lie.bits = bits;
  return lie;
}
// From the first access to `trigger` on. For FAULT: the judge reads it when it waits for a stop.
Lie wrong_later(std::uint32_t address, std::uint32_t bits, std::uint32_t trigger) {
  Lie lie = wrong(address, bits);
  lie.trigger = trigger;
  return lie;
}
Lie at_pins(std::uint32_t trigger, std::function<StepPins(const StepPins&, const StepPins&, std::uint64_t)> pins) {
  Lie lie;
  lie.trigger = trigger;
  lie.pins = std::move(pins);
  return lie;
}
Lie at_inputs(std::uint32_t trigger, std::function<void(WatchedCard::Inputs&, std::uint64_t)> inputs) {
  Lie lie;
  lie.trigger = trigger;
  lie.inputs = std::move(inputs);
  return lie;
}
// A pulse of axis 0 that the card does not count, a number of clocks after an access.
Lie pulse_after(std::uint32_t trigger, std::uint64_t clocks) {
  return at_pins(trigger, [clocks](StepPins pins, const StepPins&, std::uint64_t since) {
    if (since >= clocks && since < clocks + 4) pins.first |= 1;
    return pins;
  });
}
// Clears bits of the data written to an address.
Lie never_written(std::uint32_t address, std::uint32_t bits) {
  return at_inputs(0, [=](WatchedCard::Inputs& in, std::uint64_t) {
    if (in.awaddr == address) in.wdata &= ~bits;
  });
}
Lie always_written(std::uint32_t address, std::uint32_t bits) {
  return at_inputs(0, [=](WatchedCard::Inputs& in, std::uint64_t) {
    if (in.awaddr == address) in.wdata |= bits;
  });
}
Lie slew(std::uint32_t value) {
  return at_inputs(0, [=](WatchedCard::Inputs& in, std::uint64_t) {
    if (in.awaddr == reg::kSlew) in.wdata = value;
  });
}
constexpr auto kRamp = Reaction::kRamp;
constexpr auto kAtOnce = Reaction::kAtOnce;

Lie no_input(Input input) {
  return at_inputs(0, [=](WatchedCard::Inputs& in, std::uint64_t) { in.pins &= ~(1U << input); });
}
// From the judge's first read of STATUS on.
Lie pressed(Input input) {
  return at_inputs(reg::kStatus, [=](WatchedCard::Inputs& in, std::uint64_t) { in.pins |= 1U << input; });
}
constexpr const char* kDrive = "drive fault";

// Pulses, including pulses after rest.
std::vector<Falsified> falsified_pulses() {
  const Lie short_pulses = at_pins(0, [](StepPins pins, const StepPins& before, std::uint64_t) {
    pins.first &= before.first | 8;  // each pulse of axes 0 to 2 begins one clock late
    return pins;
  });
  // One pulse of axis 0 is lost.
  const Lie lost = at_pins(reg::kStream, [](StepPins pins, const StepPins&, std::uint64_t since) {
    if (since > 455 && since < 471) pins.first &= ~1U;
    return pins;
  });
  const Lie crowded = at_pins(reg::kStream, [](StepPins pins, const StepPins&, std::uint64_t since) {
    if (since % 64 < 2) pins.first |= 1;
    return pins;
  });
  const Lie turned = at_pins(reg::kStream, [](StepPins pins, const StepPins&, std::uint64_t) {
    pins.second ^= pins.first & 1;
    return pins;
  });
  return {
      {kDrive, kRamp, "line", short_pulses, "a pulse of"},
      {kDrive, kRamp, "line", lost, "STOP_POSITION"},
      {kDrive, kRamp, "line", crowded, "a pulse"},
      {"probe", Reaction::kOff, "line", turned, "the direction changes beside a pulse"},
      {"probe", Reaction::kOff, "line", lost, "the program's end"},
      {kDrive, kRamp, "line", pulse_after(reg::kRestFault, 1), "after REST"},
      {kDrive, kRamp, "line", pulse_after(reg::kGeometryDepth, 60), "POSITION after the stop"},
      {kDrive, kRamp, "line", pulse_after(reg::kFeedRoom, 200), "when faults are cleared"},
      {"limit plus", kRamp, "line", pulse_after(reg::kFeedRoom, 1000), "when a hold is taken back"},
      {kDrive, kAtOnce, "hold", pulse_after(reg::kFeedRoom, 1750), "the next program's end"},
  };
}

// FAULT, STOP and REST.
std::vector<Falsified> falsified_areas() {
  return {
      {kDrive, kRamp, "line", wrong(reg::kFault, field::kFaultLimit), "FAULT is"},
      {kDrive, kRamp, "line", wrong(reg::kFault, field::kFaultDriveFault), "FAULT is"},
      {kDrive, kRamp, "line", wrong(reg::kStopFault, field::kFaultLimit), "STOP_FAULT"},
      {kDrive, kRamp, "line", wrong(reg::kStopTimeLo, 0x40), "latched"},
      {kDrive, kRamp, "line", wrong(reg::stop_position(1)), "STOP_POSITION"},
      {kDrive, kRamp, "line", wrong(reg::kStopGeometryBegun), "STOP_GEOMETRY_BEGUN"},
      {kDrive, kRamp, "line", wrong(reg::kStopFeedBegun), "STOP_FEED_BEGUN"},
      {kDrive, kRamp, "line", wrong(reg::kRestFault), "REST_FAULT"},
      {kDrive, kRamp, "line", wrong(reg::kRestStatus, field::kStatusSettled), "settled"},
      {kDrive, kRamp, "line", wrong(reg::kRestTimeLo, 0x400), "REST"},
      {kDrive, kRamp, "line", wrong(reg::rest_position(2)), "REST_POSITION"},
      {kDrive, kRamp, "line", wrong(reg::kRestTicksLeftLo), "ticks of command"},
      {kDrive, kAtOnce, "arc", wrong(reg::kRestTicksLeftLo), "ticks of command"},
      {kDrive, kRamp, "arc in eight directions", wrong(reg::kRestTicksLeftLo), "ticks of command"},
      {kDrive, kRamp, "conic", wrong(reg::kRestTicksLeftLo), "ticks of command"},
      {kDrive, kRamp, "helix", wrong(reg::kRestTicksLeftLo, 4), "ticks of command"},
      {kDrive, kRamp, "direct mode", wrong(reg::kRestTicksLeftLo, 0x10), "REST's clocks"},
      {kDrive, kRamp, "streaming", wrong(reg::kStaleTicks), "ticks of command"},
      {kDrive, kRamp, "line", wrong(reg::kRestTicksLeftHi), "ticks are left"},
      {kDrive, kRamp, "corner", wrong(reg::kRestGeometryBegun, 3), "ticks are left of"},
  };
}

// The state after a stop, and clearing.
std::vector<Falsified> falsified_end() {
  return {
      {kDrive, kRamp, "line", wrong_later(reg::kStatus, field::kStatusBusy, reg::kRestFault), "STATUS"},
      {kDrive, kRamp, "line", wrong_later(reg::kGeometryBegun, 1, reg::kRestFault), "commands begun"},
      {kDrive, kRamp, "line", wrong(reg::kGeometryRoom), "GEOMETRY_ROOM"},
      {kDrive, kRamp, "line", wrong(reg::kFeedRoom), "FEED_ROOM"},
      {kDrive, kRamp, "line", wrong(reg::snap_position(3)), "POSITION after the stop"},
      {kDrive, kRamp, "line", wrong(reg::kSnapTimeLo, 0x20), "snapshot's time"},
      {kDrive, kRamp, "line", wrong_later(reg::kFault, field::kFaultDriveFault, reg::kGeometryDepth), "cleared,"},
      {"limit plus", kRamp, "line", never_written(reg::kFault, field::kFaultLimit),
       "FAULT while the cause lasts, cleared,"},
      {kDrive, kRamp, "line", wrong_later(reg::kStatus, field::kStatusBusy, reg::kSnapTimeLo),
       "STATUS.busy after clearing"},
      {kDrive, kRamp, "line", wrong_later(reg::kStatus, field::kStatusEnded, reg::kSnapTimeLo), "program does not end"},
      {"probe", Reaction::kOff, "line", wrong(reg::kStatus), "the program's end"},
      {kDrive, kRamp, "line",
       at_inputs(reg::kFeedRoom,
                 [](auto& in, std::uint64_t since) {
                   if (since < 150 && in.awaddr == reg::kStream) in.awaddr = reg::kIrqEnable;
                 }),
       "a word is taken while a fault stands"},
  };
}

// Outputs have these levels from the first access to a register on.
Lie outputs(std::uint32_t trigger, std::uint32_t on, std::uint32_t off = 0) {
  return at_pins(trigger, [=](StepPins pins, const StepPins&, std::uint64_t) {
    pins.outputs = (pins.outputs | on) & ~off;
    return pins;
  });
}

// Outputs at their pins, and the machine's place.
std::vector<Falsified> falsified_outputs() {
  constexpr const char* kTool = "tool setter";
  return {
      {kTool, kRamp, "line", outputs(0, kOutputSafeAtCause), "safe at the cause stays on"},
      {kTool, kRamp, "line", outputs(0, kOutputSafeAtRest), "safe at rest stays on"},
      {kTool, kRamp, "line", outputs(reg::kStatus, 0, kOutputSafeAtRest), "safe at rest changes in clock"},
      {kTool, kRamp, "line", outputs(reg::kStatus, 0, kOutputSafeAtCause), "safe at the cause changes in clock"},
      {kTool, kRamp, "line", outputs(reg::kRestStatus, kOutputSafeAtCause), "is on again"},
      {kTool, kRamp, "line", outputs(reg::kRestStatus, 0, kOutputKept), "without a safe level"},
      {"abort", Reaction::kNone, "line", outputs(0, kOutputSafeAtCause), "safe at the cause stays on"},
      {"feed hold button", Reaction::kNone, "line", outputs(reg::kStatus, 0, kOutputKept), "without a stop"},
      {"probe", Reaction::kOff, "line", outputs(reg::kStatus, 0, kOutputKept), "without a stop"},
      {kTool, kRamp, "line", wrong(reg::kPlace), "and valid ones"},
      {kTool, kRamp, "line", wrong(reg::kPlace, 0x101), "lost axes that keep it"},
      {kTool, kAtOnce, "line", wrong(reg::kPlace, 0x101), "still has axes that lose it"},
      {kDrive, kRamp, "line", wrong(reg::kPlace, 0x404), "still has axes that lose it"},
      {"feed hold button", Reaction::kNone, "line", wrong(reg::kPlace), "PLACE in a hold"},
      {"probe", Reaction::kOff, "line", wrong(reg::kPlace), "PLACE at the program's end"},
  };
}

// Reactions; causes with no effect or too much, and second causes.
std::vector<Falsified> falsified_reactions() {
  return {
      {kDrive, kRamp, "line", never_written(reg::kStopReaction, ~0U), "the ramp ends"},
      {kDrive, kAtOnce, "line", always_written(reg::kStopReaction, field::kStopReactionDriveFault),
       "after a stop at once"},
      {kDrive, kRamp, "line", slew(1U << 18), "clocks of a ramp"},
      {kDrive, kRamp, "line", no_input(kDriveInput), "does not stop the card"},
      {"limit plus", kRamp, "line", no_input(kLimitPlusInput), "a step into the limit does not stop"},
      {"limit plus", Reaction::kShortRamp, "line",
       at_inputs(0,
                 [](auto& in, std::uint64_t) {
                   if (in.awaddr == reg::overtravel(0)) in.wdata = 40;
                 }),
       "steps into the limit"},
      {"probe", Reaction::kOff, "line", pressed(kDriveInput), "FAULT is"},
      {"limit plus", kAtOnce, "between commands", pressed(kDriveInput), "FAULT is"},
      {kDrive, kRamp, "line", pressed(kToolSetterInput), "FAULT is"},
      {"tool setter", kRamp, "line", wrong(reg::kStopFault, field::kFaultDriveFault | field::kFaultToolSetter),
       "STOP_FAULT", 2},
  };
}

// The button, an abort, a reset.
std::vector<Falsified> falsified_others() {
  const Lie started = at_inputs(reg::kSnapTimeLo, [](WatchedCard::Inputs& in, std::uint64_t since) {
    if (since > 200) in.pins |= 1U << kCycleStartInput;
  });
  return {
      {"feed hold button", Reaction::kNone, "line", no_input(kFeedHoldInput), "button_hold"},
      {"feed hold button", Reaction::kNone, "line", started, "before cycle start"},
      {"feed hold button", Reaction::kNone, "hold", pulse_after(reg::kSnapTimeLo, 40), "when the button is free"},
      {"abort", Reaction::kNone, "line", never_written(reg::kControl, field::kControlAbort),
       "STATUS.busy after an abort"},
      {"abort", Reaction::kNone, "hold", wrong(reg::kRestStatus, field::kStatusSettled), "settled"},
      {"abort", Reaction::kNone, "line", pulse_after(reg::kControl, 300), "after an abort"},
      {"abort", Reaction::kNone, "line", wrong(reg::rest_position(0)), "REST_POSITION of an abort"},
      {"feed hold button", Reaction::kNone, "line", slew(0xFFFFFFF), "the hold has no ramp"},
      {"feed hold button", Reaction::kNone, "line", slew(1U << 18), "a pin moves in a hold"},
      {"feed hold button", Reaction::kNone, "line", wrong(reg::kFault), "FAULT in a hold"},
      {"feed hold button", Reaction::kNone, "line", wrong(reg::kStatus, field::kStatusHeld), "STATUS.held"},
      {"abort", Reaction::kNone, "line", wrong(reg::kFault), "FAULT after an abort"},
      {"abort", Reaction::kNone, "line", wrong(reg::kRestFault), "REST_FAULT after an abort"},
      {"abort", Reaction::kNone, "line", wrong(reg::kRestTimeLo, 0x40), "REST_TIME of an abort"},
      {"abort", Reaction::kNone, "line", wrong(reg::kRestTicksLeftHi), "TICKS_LEFT of an unsettled"},
      {"abort", Reaction::kNone, "line", wrong(reg::kRestGeometryBegun), "REST_GEOMETRY_BEGUN of an abort"},
      {kDrive, kRamp, "reset", pulse_after(reg::kStream, 900), "after a reset"},
      {kDrive, kRamp, "reset", wrong(reg::kFault), "FAULT after a reset"},
      {kDrive, kRamp, "reset", wrong(reg::kStatus), "STATUS after a reset"},
      {kDrive, kRamp, "reset", wrong(reg::snap_position(0)), "POSITION after a reset"},
  };
}

TEST(StopJudge, ComplainsOfNothingThatIsRight) { EXPECT_EQ(broken_claim("drive fault", kRamp, "line", Lie{}), ""); }

TEST(StopJudge, EachClaimIsSeenToFail) {
  std::vector<Falsified> all;
  for (const auto& some : {falsified_pulses(), falsified_areas(), falsified_end(), falsified_outputs(),
                           falsified_reactions(), falsified_others()})
    all.insert(all.end(), some.begin(), some.end());
  EXPECT_GT(all.size(), 80U);
  for (const Falsified& f : all) {
    const std::string claim = broken_claim(f.cause, f.reaction, f.state, f.lie, f.clock);
    EXPECT_NE(claim, "") << f.cause << ", " << f.state << ": " << f.claim;
    EXPECT_THAT(claim, HasSubstr(f.claim)) << f.cause << ", " << f.state;
  }
}

}  // namespace
}  // namespace trammel::test
