// What stands around the card while a run goes on, for its page: the levels at the card's inputs, and how far the
// pulses of each axis are ahead of the carriage that they move. Streams of the page (PageStream), in memory that does
// not grow with the run; docs/developer/report.md has their layout. Not thread-safe.
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
  // Bit of levels that is the emergency stop's pin; those below are the inputs.
  static constexpr unsigned kEmergencyStop = 32;
  // Of each second of the card as many differences of an axis are kept at most.
  static constexpr std::uint32_t kBlocks = 200;

  // `least`: pulses, by axis, > 0: a difference that has changed by less since the one kept last is not kept. `levels`:
  // at clock 0. The sink must outlive it, and have the page's head.
  Surroundings(run::TextSink& sink, std::uint32_t clock_hz, const std::vector<double>& least, std::uint64_t levels);

  // Clocks ascend, of both. `levels` from this clock on, bit n: input n.
  void inputs(std::uint64_t cycle, std::uint64_t levels);
  // Pulses, commanded less the carriage's place. Of a block of time the largest counts.
  void apart(std::uint64_t cycle, std::size_t axis, double pulses);
  // Before the page is finished.
  void finish();

 private:
  struct Apart {
    std::unique_ptr<PageStream> stream;
    double least;
    std::uint64_t block = 0;
    std::uint64_t cycle = 0;  // of the largest
    double largest = 0;       // of the block
    double last = 0;          // the difference that came last
    std::uint64_t last_cycle = 0;
    std::uint64_t kept_cycle = 0;
    std::int64_t kept = 0;  // pulses
  };
  static void keep(Apart& axis, std::uint64_t cycle, double pulses);

  std::uint64_t clocks_;  // of a block
  PageStream inputs_;
  std::uint64_t levels_;
  std::uint64_t cycle_ = 0;
  std::vector<Apart> apart_;
};

}  // namespace trammel::report
