// hostmot2's registers in front of a card: distributes accesses by address, and applies the watchdog to the motion.
//
// A bite of the watchdog ends all motion at once, as a fault of the card does by itself; the counters keep counting the
// pulses at the pins. Rates that are written while it is bitten are dropped. Clearing the status starts no motion; only
// a rate that is written afterwards does.
//
// Addresses: bytes. Times: clocks of the card. Errors: LinkError. Used by one thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/hm2/card_time.hpp"
#include "trammel/hm2/step_generators.hpp"
#include "trammel/hm2/watchdog.hpp"

namespace trammel::hm2 {

class Hostmot2 {
 public:
  using Note = std::function<void(const std::string&)>;

  // `card` and `time` must outlive this object. `note`: gets messages for the operator. Throws ArgumentError for a card
  // without the necessary engines.
  Hostmot2(driver::Card& card, CardTime& time, Note note);

  // Begins a datagram. All reads of a datagram are of one moment: between two calls the card is read at most once.
  void begin() { latched_ = false; }
  // `address`: a multiple of 4 below map::kBytes. Unused addresses read as 0, and writes to them have no effect.
  std::uint32_t read(std::uint32_t address);
  void write(std::uint32_t address, std::uint32_t value);

  // Advances the card's time to `clock`; the watchdog bites when it expires.
  void run_to(std::uint64_t clock);
  // The clock at which run_to() is needed next; UINT64_MAX: not before a write.
  std::uint64_t next_due() const { return std::min(steps_.next_due(), watchdog_.deadline()); }
  // Ends the motion as the watchdog does, for the reason `why`.
  void bite(const std::string& why);

  std::uint64_t now() const { return time_.now(); }
  bool moves() const { return steps_.moves(); }
  bool bitten() const { return watchdog_.bitten(); }
  std::uint64_t bites() const { return bites_; }
  const StepGenerators& steps() const { return steps_; }

 private:
  std::uint32_t read_accumulator(unsigned axis);
  std::uint32_t read_pins();
  void write_times(std::uint32_t address, unsigned axis, std::uint32_t value);
  void write_inverts(std::uint32_t value);
  void write_status(std::uint32_t value);

  driver::Card& card_;
  CardTime& time_;
  Note note_;
  StepGenerators steps_;
  Watchdog watchdog_;
  std::vector<std::uint32_t> words_;  // constants and written values
  std::array<StepTimes, card_map::kMaxAxes> times_{};
  unsigned inputs_;
  bool latched_ = false;
  std::uint64_t bites_ = 0;
};

}  // namespace trammel::hm2
