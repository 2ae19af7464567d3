// Records the surroundings of the card during a run, for the run's page: the levels at the card's inputs, and the
// distance by which the pulses of each axis are ahead of its carriage. Written as streams of the page (PageStream), in
// memory that does not grow with the run; docs/developer/report.md has their layout. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "trammel/report/page_stream.hpp"
#include "trammel/run/text_sink.hpp"

namespace trammel::report {

class Surroundings {
 public:
  // The bit of `levels` for the emergency stop's pin; the lower bits are the inputs.
  static constexpr unsigned kEmergencyStop = 32;
  // Largest number of differences kept per axis and second of card time.
  static constexpr std::uint32_t kBlocks = 200;

  // `least`: pulses, by axis, > 0: a difference is kept only if it has changed by at least this since the last kept
  // one. `levels`: at clock 0. The sink must outlive this object, and must already contain the page's head.
  Surroundings(run::TextSink& sink, std::uint32_t clock_hz, const std::vector<double>& least, std::uint64_t levels);

  // `cycle` ascends in the calls of inputs() and of apart(). `levels` from this clock on, bit n: input n.
  void inputs(std::uint64_t cycle, std::uint64_t levels);
  // `pulses`: commanded position minus the carriage's. The largest value in each block of time is kept.
  void apart(std::uint64_t cycle, std::size_t axis, double pulses);
  // Call before the page is finished.
  void finish();

 private:
  struct Apart {
    std::unique_ptr<PageStream> stream;
    double least;
    std::uint64_t block = 0;
    std::uint64_t cycle = 0;  // clock of the largest difference
    double largest = 0;       // largest difference in the block
    double last = 0;          // the last difference
    std::uint64_t last_cycle = 0;
    std::uint64_t kept_cycle = 0;
    std::int64_t kept = 0;  // pulses
  };
  static void keep(Apart& axis, std::uint64_t cycle, double pulses);

  std::uint64_t clocks_;  // clocks per block
  PageStream inputs_;
  std::uint64_t levels_;
  std::uint64_t cycle_ = 0;
  std::vector<Apart> apart_;
};

}  // namespace trammel::report
