// The Verilated card on a bus of its own, beside its golden model. The inputs and outputs of every clock go to a
// file, for the replay on the synthesised netlist.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "Vrecorded.h"
#include "card_record.hpp"
#include "trammel/model/card_model.hpp"
#include "trammel/sim/lockstep.hpp"

namespace trammel::netlist {

// The file: the first line names the ports in order, `name<width` for an input and `name>width` for an output. Then
// follows one line per clock with their values in hexadecimal; outputs are those after the clock's edge.
class Recorder {
 public:
  static constexpr unsigned kAxes = 4;
  static constexpr unsigned kPins = 4;  // inputs, and as many outputs

  // Counts of clocks or edges; the recording must have seen all of them to be worth a replay.
  struct Seen {
    std::uint64_t clocks = 0;
    std::uint64_t steps = 0;       // rising edges of STEP pins
    std::uint64_t path_ticks = 0;  // path ticks of the accumulator
    std::uint64_t direct = 0;      // clocks in a direct move
    std::uint64_t held = 0;        // clocks with a path while the ratio is 0
    std::uint64_t interrupts = 0;  // rising edges
    std::uint64_t refused = 0;     // answers with an error
    std::uint64_t faulted = 0;     // clocks with a fault
  };

  // `idle_level`: the strap, {second pins, first pins}. `seed` is only for the report if RTL and model differ. Throws
  // std::runtime_error if the file cannot be written.
  Recorder(const std::string& path, std::uint32_t idle_level, std::uint32_t seed);
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  // `strobes`: the bytes of the word that are written. Both return the answer; a refused read returns 0.
  bool write(std::uint32_t address, std::uint32_t data, std::uint8_t strobes = model::Axi4LitePort::kAllStrobes);
  std::uint32_t read(std::uint32_t address);
  void wait(std::uint64_t clocks);
  void reset(int clocks);

  const Seen& seen() const { return seen_; }

 private:
  void clock();
  void judge();
  void count(const sim::CardRecord& rtl);
  void write_line();
  template <class Port>
  void for_each_port(Port&& port);

  std::FILE* file_;
  std::string line_;
  lockstep::Simulated<Vrecorded> dut_{lockstep::kZeros};
  model::CardModel model_;
  model::CardModel::Inputs in_;
  std::uint32_t seed_;
  Seen seen_;
  std::uint32_t last_step_ = 0;
  bool last_irq_ = false;
};

}  // namespace trammel::netlist
