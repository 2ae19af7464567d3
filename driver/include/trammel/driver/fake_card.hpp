// A card without hardware, at the level of its registers: what a program can see over the bus, so that programs on
// the driver can be tested. Access kinds, masks, limits and addresses are those of the card map; refused accesses are
// latched in REFUSAL and throw BusError, as on the card.
//
// Simplified, and no substitute for the golden model: a feed tick comes at every enabled clock whatever rate the piece
// names, positions change when a path ends, no step takes time after its path has ended, and a slew is immediate.
// Kept: which commands the card accepts, what takes room for how long, barriers, and that feed ticks and path
// ticks must match.
//
// Thread-safety: none.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <vector>

#include "trammel/card_map.hpp"
#include "trammel/driver/bus.hpp"
#include "trammel/driver/commands.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::driver {

// What the fake says of itself; the defaults are a card that the driver accepts.
struct FakeCardOptions {
  unsigned axes = 4;
  std::uint32_t clock_hz = 1'000'000;      // Hz
  std::uint32_t engines = 0x33;            // ENGINES: lines, accumulator, jerk, direct mode
  std::uint32_t geometry_depth = 4096;     // halfwords, up to 32768
  std::uint32_t feed_depth = 2560;         // halfwords, up to 32768
  std::uint64_t clocks_per_access = 8;     // of every bus access
  std::uint64_t clocks_per_snapshot = 40;  // from the strobe until STATUS.snapshot clears
  // For malformed cards: value of a constant register by its address, instead of the proper one.
  std::map<std::uint32_t, std::uint32_t> constants;
};

class FakeCard final : public Bus {
 public:
  explicit FakeCard(FakeCardOptions options = {});

  std::uint32_t read(std::uint32_t address) override;
  void write(std::uint32_t address, std::uint32_t value) override;
  void write_block(std::uint32_t address, const std::uint32_t* words, std::size_t count,
                   Addressing addressing) override;
  void wait(std::uint64_t card_clocks) override { run(card_clocks); }

  // The card refuses the command with this number (mod 256) for the given reason when its last word comes.
  void refuse_command(std::uint8_t number, card_map::Reason reason);
  // A fault: latches bits of FAULT and, if it is the first, the STOP area, and drops all that the card had.
  void raise_fault(std::uint32_t bits);

  // Commands that the card has accepted since the fake was made, in order.
  const std::vector<DecodedCommand>& accepted() const { return accepted_; }
  // Pulses, not wrapped.
  std::int64_t position(unsigned axis) const { return position_.at(axis); }
  // Clocks since reset.
  std::uint64_t time() const { return time_; }
  // Bus accesses so far; a block counts once.
  std::uint64_t accesses() const { return accesses_; }

 private:
  struct Queued {
    Command command;
    std::uint32_t halfwords = 0;
  };
  struct Queue {
    std::deque<Queued> commands;
    std::uint32_t used = 0;   // halfwords
    std::uint64_t left = 0;   // ticks that the command under way still takes or gives; 0: none is
    std::uint32_t begun = 0;  // commands since the last cut
    Command command;
  };

  void latch_refusal(card_map::Reason reason, std::uint32_t address, std::uint8_t command_number = 0);
  [[noreturn]] void refuse(card_map::Reason reason, std::uint32_t address, Direction direction);
  const card_map::Register& require_register(std::uint32_t address, Direction direction);
  void write_word(std::uint32_t address, std::uint32_t value);
  std::uint32_t constant(const card_map::Register& entry) const;
  std::uint32_t live(std::uint32_t address) const;
  std::uint32_t status() const;
  void take_snapshot(card_map::Area area);
  void control(std::uint32_t value);
  void cut();

  void stream_word(std::uint32_t word);
  void check_header();
  void accept_command();
  [[noreturn]] void refuse_partial(card_map::Reason reason);

  void start_direct(std::uint32_t mask);
  bool direct_is_valid(std::uint32_t mask) const;
  void end_direct();
  std::uint32_t setting(std::uint32_t address) const { return settings_.at(address); }
  std::uint64_t setting64(std::uint32_t low, std::uint32_t high) const;
  bool busy() const;
  std::uint32_t ratio() const;  // of the time base, 2^-16; 0 in a hold

  void run(std::uint64_t clocks);
  std::uint64_t run_some(std::uint64_t clocks);
  std::uint64_t run_ticks(std::uint64_t clocks, std::uint64_t wanted, std::uint64_t& ticks);
  void load(Queue& queue);
  bool pass_barrier();
  void end_path();

  FakeCardOptions options_;
  std::map<std::uint32_t, std::uint32_t> settings_;
  std::map<std::uint32_t, std::uint32_t> snapshot_;
  std::map<std::uint32_t, std::uint32_t> snapshot_before_;  // what is read until the new one is there
  std::uint64_t snapshot_until_ = 0;
  std::uint32_t fault_ = 0;
  std::uint32_t refusal_ = 0;
  bool ended_ = false;

  std::vector<std::uint32_t> partial_;
  bool stream_open_ = true;
  std::uint8_t next_number_ = 0;
  std::map<std::uint8_t, card_map::Reason> injected_;
  std::vector<DecodedCommand> accepted_;

  Queue geometry_;
  Queue feed_;
  std::uint64_t dwell_left_ = 0;
  std::uint64_t direct_left_ = 0;
  std::array<std::int64_t, card_map::kMaxAxes> direct_steps_{};  // of the one-shot line under way
  std::uint64_t ratio_phase_ = 0;                                // 2^-16 clocks
  std::uint64_t time_ = 0;
  std::uint64_t accesses_ = 0;
  std::array<std::int64_t, card_map::kMaxAxes> position_{};
};

}  // namespace trammel::driver
