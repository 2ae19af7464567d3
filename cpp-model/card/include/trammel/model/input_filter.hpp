// Golden model of the digital filter of the inputs, rtl/io/input_filter.sv. A scan of 64 clocks looks at input n in
// its clock 2 n + 2. An input passes when its level has differed from the output in every clock of as many whole
// scans as its filter length. The length in use is the one that was set two clocks before the look. With captures the
// filter also tells whether an input is quiet: it has equalled the output for that number of whole scans. Not
// thread-safe; no errors are reported.
#pragma once

#include <array>
#include <cstdint>

namespace trammel::model {

class InputFilter {
 public:
  static constexpr unsigned kInputs = 32;  // at most
  static constexpr unsigned kScanClocks = 64;

  struct Inputs {
    std::uint32_t levels = 0;      // bit n: input n, behind synchroniser and polarity
    bool set = false;              // never within kScanClocks clocks after a reset
    unsigned set_input = 0;        // 0 to 31
    std::uint16_t set_length = 0;  // scans
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    unsigned clock = 0;  // clock of the scan, 0 to 63
    bool clearing = true;
    std::uint32_t levels = 0;    // levels of the outputs
    std::uint32_t quiet = 0;     // inputs that are quiet
    std::uint32_t differed = 0;  // inputs that have differed from their outputs since their last look
    std::uint32_t agreed = 0;    // inputs that have equalled their outputs since their last look
    std::array<std::uint16_t, kInputs> lengths{};
    std::array<std::uint16_t, kInputs> counts{};
    std::array<std::uint16_t, 2> length_read{};  // length at the RAM's output, and in the register behind it
  };

  explicit InputFilter(bool tells_quiet = false) : tells_quiet_(tells_quiet) {}

  // One rising edge.
  void clock(const Inputs& in) {
    const std::uint32_t differs = in.levels ^ state_.levels;
    const unsigned next = state_.clock / 2;
    state_.differed &= differs;
    state_.agreed &= ~differs;
    state_.quiet &= ~differs;
    if (state_.clock % 2 == 0) {
      const unsigned input = (next + kInputs - 1) % kInputs;
      look(input, std::uint32_t{1} << input, differs);
      if (state_.clearing) state_.lengths[input] = 0;
    }
    state_.length_read = {state_.lengths[next], state_.length_read[0]};
    if (in.set && !state_.clearing) state_.lengths[in.set_input] = in.set_length;
    if (state_.clock == kScanClocks - 1) state_.clearing = false;
    state_.clock = (state_.clock + 1) % kScanClocks;
  }

  std::uint32_t levels() const { return state_.levels; }
  std::uint32_t quiet() const { return state_.quiet; }
  bool tells_quiet() const { return tells_quiet_; }
  const State& state() const { return state_; }
  State& state() { return state_; }

 private:
  // `bit`: the mask of the input.
  void look(unsigned input, std::uint32_t bit, std::uint32_t differs) {
    const bool steady = ((state_.differed | state_.agreed) & bit) != 0;
    std::uint16_t& count = state_.counts[input];
    if (!steady)
      count = 0;
    else if ((state_.quiet & bit) == 0)
      ++count;
    const bool lasts = count >= (state_.clearing ? 0U : unsigned{state_.length_read[1]});
    const bool passes = lasts && (differs & bit) != 0;
    if (passes) state_.levels ^= bit;
    const bool agrees = passes || (differs & bit) == 0;
    state_.differed = agrees ? state_.differed & ~bit : state_.differed | bit;
    if (!tells_quiet_ || !agrees) return;
    state_.agreed |= bit;
    if (passes || (lasts && steady)) state_.quiet |= bit;
  }

  bool tells_quiet_;
  State state_;
};

}  // namespace trammel::model
