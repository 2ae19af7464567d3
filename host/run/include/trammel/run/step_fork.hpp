// Distributes steps to several sinks, because a simulated card supports only one. Not thread-safe.
#pragma once

#include <vector>

#include "trammel/driver/steps.hpp"

namespace trammel::run {

class StepFork final : public driver::StepSink {
 public:
  // `sink` must outlive the fork. The sinks get each step in the order in which they were added.
  void add(driver::StepSink& sink) { sinks_.push_back(&sink); }

  void pin_step(const driver::PinStep& step) override {
    for (driver::StepSink* sink : sinks_) sink->pin_step(step);
  }
  void path_step(const driver::PathStep& step) override {
    for (driver::StepSink* sink : sinks_) sink->path_step(step);
  }
  void outputs_changed(const driver::OutputChange& change) override {
    for (driver::StepSink* sink : sinks_) sink->outputs_changed(change);
  }

 private:
  std::vector<driver::StepSink*> sinks_;
};

}  // namespace trammel::run
