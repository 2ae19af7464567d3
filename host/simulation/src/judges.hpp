// The instruments that measure a run by its steps, other than the step recorder. Not thread-safe.
#pragma once

#include "trammel/run/feed_meter.hpp"
#include "trammel/run/output_recorder.hpp"
#include "trammel/run/path_identity.hpp"
#include "trammel/run/step_fork.hpp"
#include "trammel/run/step_recorder.hpp"
#include "trammel/simulation/simulated_run.hpp"

namespace trammel::simulation {

struct Judges {
  // `recorder` and `output_list` must outlive them; `output_list` may be null. `fork` must get all steps.
  Judges(run::StepRecorder& recorder, run::TextSink* output_list, double clock_hz)
      : feed(clock_hz), outputs(output_list) {
    fork.add(recorder);
    fork.add(path);
    fork.add(shapers);
    fork.add(feed);
    fork.add(outputs);
  }
  // Call after the last step.
  void tell(RunResult& result) {
    shapers.finish();
    outputs.finish();
    result.path_steps = path.count();
    result.path_identity = path.text();
    if (shapers.range()) result.shaper_delay = *shapers.range();
    result.commanded_feed = feed.commanded();
    result.achieved_feed = feed.achieved();
  }

  run::StepFork fork;
  run::PathIdentity path;
  run::ShaperDelay shapers;
  run::FeedMeter feed;
  run::OutputRecorder outputs;
};

}  // namespace trammel::simulation
