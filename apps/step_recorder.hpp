// Takes the steps of a run: writes the step lists, counts, and feeds the deviation meter and the picture.
// Not thread-safe.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "deviation_meter.hpp"
#include "plot.hpp"
#include "trammel/sim/engine.hpp"

namespace trammel::app {

// A CSV file written through a large buffer; "-" is stdout.
class CsvFile {
 public:
  // Throws std::runtime_error when the file cannot be opened.
  CsvFile(const std::string& file, const char* header);
  ~CsvFile();
  CsvFile(const CsvFile&) = delete;
  CsvFile& operator=(const CsvFile&) = delete;

  template <class... Values>
  void row(fmt::format_string<Values...> format, Values... values) {
    fmt::format_to(std::back_inserter(buffer_), format, values...);
    if (buffer_.size() > kFlushAt) flush();
  }
  // Writes what is left; throws std::runtime_error when the disk did not take it all.
  void close();

 private:
  static constexpr std::size_t kFlushAt = 1U << 16U;
  void flush();
  std::string file_;
  std::FILE* out_;
  bool failed_ = false;
  fmt::memory_buffer buffer_;
};

class StepRecorder final : public sim::StepSink {
 public:
  struct Options {
    std::optional<std::string> steps;       // file of --steps
    std::optional<std::string> path_steps;  // file of --path-steps
    bool plot = false;
    double clock_hz = 0;
    std::vector<double> steps_per_mm;  // by axis
  };
  explicit StepRecorder(const Options& options);

  void pin_step(const sim::PinStep& step) override;
  void path_step(const sim::PathStep& step) override;
  void finish();

  DeviationMeter& deviation() { return deviation_; }
  const std::vector<std::uint64_t>& steps() const { return steps_; }       // at the pins, by axis
  const std::vector<std::int64_t>& position() const { return position_; }  // sum of the pins' steps
  std::vector<Point> executed() const { return executed_.points(); }
  bool thinned() const { return executed_.thinned(); }
  const std::vector<Point>& detail() const { return detail_; }
  std::vector<SpeedOverTime::Sample> speed() const { return speed_.samples(); }

  // From now on up to kDetailPoints positions are kept one by one for the magnified picture, for path `command`.
  void detail_of(std::uint64_t command) { detail_command_ = command; }
  static constexpr std::size_t kDetailPoints = 120;

 private:
  Point millimetres() const;
  void point_of_path();

  Options options_;
  std::unique_ptr<CsvFile> steps_file_;
  std::unique_ptr<CsvFile> path_steps_file_;
  DeviationMeter deviation_;
  std::vector<std::uint64_t> steps_;
  std::vector<std::int64_t> position_;       // at the pins
  std::vector<std::int64_t> path_position_;  // before the shapers
  ThinnedPath executed_{20000};
  SpeedOverTime speed_;
  std::vector<Point> detail_;
  std::optional<std::uint64_t> detail_command_;
  std::optional<sim::PathStep> last_;  // the path step before
};

}  // namespace trammel::app
