// Records commanded and executed motion for comparisons: the lines sent to the card, and every step of a simulated
// card. Thread-safe: the card's thread reports steps, another thread reports lines.
#pragma once

#include <mutex>
#include <string>

#include "trammel/driver/steps.hpp"
#include "trammel/linuxcnc/servo_stream.hpp"

namespace trammel::app {

class MotionRecord final : public linuxcnc::ServoRecord, public driver::StepSink {
 public:
  explicit MotionRecord(unsigned joints) : joints_(joints) {}

  // CSV, in the order of the reports:
  //   open,CLOCK,POSITION...            pulses from machine zero
  //   line,NUMBER,TIME,DURATION,TARGET...
  //                                     NUMBER of the period; TIME when LinuxCNC's thread began it, ns; DURATION, ns;
  //                                     TARGET, 2^-24 pulses from machine zero
  //   close,CLOCK
  //   output,CLOCK,LEVELS               levels of all outputs, bit n: output n
  //   step,CLOCK,COMMAND,AXIS,DIRECTION path step, before the shaper; COMMAND counts the stream's commands from 0
  std::string text() const;

  void opened(std::uint64_t clock, const std::array<std::int64_t, card_map::kMaxAxes>& positions) override;
  void line(const trammel_period& period, std::int64_t duration) override;
  void closed(std::uint64_t clock) override;
  void pin_step(const driver::PinStep& /*step*/) override {}
  void path_step(const driver::PathStep& step) override;
  void outputs_changed(const driver::OutputChange& change) override;

 private:
  void add(const std::string& line);

  unsigned joints_;
  mutable std::mutex mutex_;
  std::string text_;
};

}  // namespace trammel::app
