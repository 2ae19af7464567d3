// The lines of one motion, as they arrive. The motion ends when no more lines arrive for a moment; the planner then
// plans a stop before the card could run out of commands. Internal to the controller.
#pragma once

#include <chrono>

#include "trammel/grbl/controller.hpp"

namespace trammel::grbl {

class SectionLines final : public gcode::LineSource {
 public:
  SectionLines(Controller& controller, std::string first) : controller_(controller), text_(std::move(first)) {}
  bool next(std::string_view& line) override;
  const std::string& name() const override { return name_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool refill();
  bool may_wait() const;

  Controller& controller_;
  std::string name_ = "grbl";
  std::string text_;
  std::string given_;
  int number_ = 0;
  Clock::time_point begun_ = Clock::now();
};

}  // namespace trammel::grbl
