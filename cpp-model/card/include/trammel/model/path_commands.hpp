// Golden model of what commands do at their place on the path beside motion: OUTPUT and MARK.
//
// They take effect kToStep clocks after the end of the path that ran as they were decoded shows, that is with the step
// of its last tick; where none runs, as long after they are taken. What is taken while others are on their way goes
// with them (outputs) or follows (marks). Not thread-safe; no errors are reported.
#pragma once

#include <cstdint>

#include "trammel/model/buses.hpp"
#include "trammel/model/io_pins.hpp"

namespace trammel::model {

class PathCommands {
 public:
  struct Config {
    unsigned inputs = 4;            // 1 .. 16
    unsigned outputs = 4;           // 1 .. 16
    std::uint16_t output_idle = 0;  // strap: levels in reset
  };
  struct Inputs {
    bool cut = false;
    bool halt = false;    // what waits is dropped, but the outputs stay
    bool output = false;  // an OUTPUT is taken; its last halfword is on the load bus
    bool mark = false;    // a MARK is taken
    bool over = false;    // event: a path has ended
    bool runs = false;    // a path is under way
    std::uint16_t pins = 0;
    LoadWord load;
    Setting setting;
  };

  // From the clock in which a path's end shows, or a command could take effect, to the one in which it has.
  static constexpr unsigned kToStep = 7;

  explicit PathCommands(const Config& config) : inputs_(config.inputs), outputs_(config.outputs, config.output_idle) {}

  // One rising edge.
  void clock(const Inputs& in) {
    const bool due = left_ == 1 && !in.cut && !in.halt;
    outputs_.clock(in.cut, due ? set_ : std::uint16_t{0}, due ? clear_ : std::uint16_t{0}, in.setting);
    mark_ = due && mark_goes_;
    if (mark_) marks_ = marks_taken_;
    if (due) set_ = clear_ = 0;
    const bool goes = left_ == 0 && (output_waits_ || mark_waits_) && (in.over || !in.runs);
    if (left_ != 0) --left_;
    if (goes) {
      left_ = kToStep - 1;
      mark_goes_ = mark_waits_;
      output_waits_ = mark_waits_ = false;
    }
    take(in);
    inputs_.clock(in.pins, in.setting);
    if (in.cut || in.halt) drop();
  }

  std::uint16_t levels() const { return inputs_.level(); }
  std::uint16_t outputs() const { return outputs_.level(); }
  std::uint32_t marks() const { return marks_; }
  bool mark() const { return mark_; }  // event: a snapshot is wanted

  // Clocks with these levels and without events change nothing, as long as no path ends.
  bool quiet(std::uint16_t pins, bool runs) const {
    const bool waits = output_waits_ || mark_waits_;
    return inputs_.quiet(pins) && left_ == 0 && !merges_ && !mark_ && (!waits || runs);
  }

 private:
  // An OUTPUT's masks are whole a clock after it is taken; the later one wins.
  void take(const Inputs& in) {
    if (merges_) {
      const auto set = static_cast<std::uint16_t>(masks_);
      const auto clear = static_cast<std::uint16_t>(masks_ >> 16);
      set_ = static_cast<std::uint16_t>((set_ & ~clear) | set);
      clear_ = static_cast<std::uint16_t>((clear_ & ~set) | clear);
    }
    merges_ = in.output;
    output_waits_ = output_waits_ || in.output;
    mark_waits_ = mark_waits_ || in.mark;
    marks_taken_ += in.mark ? 1 : 0;
    if (in.load.to(load_target::kCommand)) shift_in<32>(masks_, in.load.word);
  }

  void drop() {
    left_ = 0;
    set_ = clear_ = 0;
    merges_ = output_waits_ = mark_waits_ = false;
    marks_taken_ = marks_;
  }

  InputPins inputs_;
  OutputPins outputs_;
  std::uint64_t masks_ = 0;  // clear, set
  std::uint16_t set_ = 0;
  std::uint16_t clear_ = 0;
  bool merges_ = false;
  bool output_waits_ = false;
  bool mark_waits_ = false;
  bool mark_goes_ = false;
  bool mark_ = false;
  unsigned left_ = 0;  // clocks until what goes has taken effect
  std::uint32_t marks_taken_ = 0;
  std::uint32_t marks_ = 0;
};

}  // namespace trammel::model
