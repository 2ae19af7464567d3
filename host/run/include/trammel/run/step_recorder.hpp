// Receives the steps of a run: writes the step lists, counts, and feeds the deviation meter and the picture. Not
// thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "trammel/driver/steps.hpp"
#include "trammel/kinematics/kinematics.hpp"
#include "trammel/run/deviation_meter.hpp"
#include "trammel/run/observer.hpp"
#include "trammel/run/path_points.hpp"
#include "trammel/run/path_speed.hpp"
#include "trammel/run/text_sink.hpp"

namespace trammel::run {

class CsvWriter;

// Receives the steps in order; as an observer of the run it also receives the commands to which they belong.
class StepRecorder final : public driver::StepSink, public Observer {
 public:
  struct Options {
    TextSink* steps = nullptr;       // list of the steps at the pins: cycle,axis,direction
    TextSink* path_steps = nullptr;  // list of the steps of the path: command,tick,axis,direction
    bool plot = false;
    double clock_hz = 0;
  };
  // `kinematics`: relates the steps of the joints to the coordinates of the picture.
  StepRecorder(const Options& options, kinematics::Kinematics kinematics);
  ~StepRecorder() override;

  void sending(const planner::PlannedBlock& planned) override {
    if (planner::moves(planned.block)) deviation_.sending(planned.block);
  }
  void command(std::uint64_t number, const driver::Command& command) override { deviation_.command(number, command); }
  void pin_step(const driver::PinStep& step) override;
  void path_step(const driver::PathStep& step) override;
  // Call after the last step: writes the rest of the lists.
  void finish();
  // Throws std::runtime_error unless the steps at the pins equal `counted`, the card's counters: pulses by axis.
  void check(const std::vector<std::int64_t>& counted) const;

  DeviationMeter& deviation() { return deviation_; }
  const std::vector<std::uint64_t>& steps() const { return steps_; }       // at the pins, by axis
  const std::vector<std::int64_t>& position() const { return position_; }  // sum of the pins' steps
  std::vector<PathPoint> executed() const { return executed_.points(); }
  bool thinned() const { return executed_.thinned(); }
  const std::vector<Point>& detail() const { return detail_; }
  std::vector<PathSpeed::Sample> speed() const { return speed_.samples(); }

  // From path `command` on, up to kDetailPoints positions are kept one by one for the magnified picture.
  void detail_of(std::uint64_t command) { detail_command_ = command; }
  static constexpr std::size_t kDetailPoints = 120;

 private:
  Point millimetres() const;
  void point_of_path();

  Options options_;
  kinematics::Kinematics kinematics_;
  std::array<double, card_map::kMaxAxes> step_length_{};  // mm per pulse, by joint
  std::unique_ptr<CsvWriter> step_list_;
  std::unique_ptr<CsvWriter> path_step_list_;
  DeviationMeter deviation_;
  std::vector<std::uint64_t> steps_;
  std::vector<std::int64_t> position_;  // position at the pins
  kinematics::Pulses path_position_{};  // position before the shapers
  PathPoints executed_{20000};
  PathSpeed speed_;
  std::vector<Point> detail_;
  std::optional<std::uint64_t> detail_command_;
  std::optional<driver::PathStep> last_;  // previous path step
};

}  // namespace trammel::run
