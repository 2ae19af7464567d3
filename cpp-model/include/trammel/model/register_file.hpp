// Golden model of the register file: the register map as a plain table of values, with the latencies of
// docs/developer/architecture.md. Cycle-exact at every port. One instance for each card; not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "trammel/card_map.hpp"

namespace trammel::model {

class RegisterFile {
 public:
  static constexpr std::size_t kMaxAxes = card_map::kMaxAxes;

  struct Config {
    std::uint32_t axes = 4;               // 1 .. 8
    std::uint32_t geometry_depth = 4096;  // halfwords
    std::uint32_t feed_depth = 2560;      // halfwords
    std::uint32_t clock_hz = 100'000'000;
  };

  struct Inputs {
    // the access; `request` for one clock, the next at the earliest in the clock behind `ack`
    bool request = false;
    bool write = false;
    bool partial = false;
    std::uint32_t address = 0;  // byte address, 12 bits
    std::uint32_t data = 0;
    // the card's state
    bool busy = false;
    bool direct = false;
    bool path_active = false;
    bool feed_active = false;
    bool ended = false;
    bool incomplete = false;
    std::uint32_t geometry_room = 0;  // halfwords, 16 bits
    std::uint32_t feed_room = 0;
    std::uint8_t running_geometry = 0;
    std::uint8_t running_feed = 0;
    std::uint32_t rate = 0;   // 2^-32 feed ticks an enabled clock
    std::uint32_t ratio = 0;  // 2^-16, 17 bits
    std::array<std::uint32_t, kMaxAxes> position{};
    std::uint32_t fault = 0;  // levels, 10 bits
    // the stream's door
    bool door_ready = true;
    bool door_refuse = false;
    std::uint8_t door_reason = 0;
    std::uint8_t door_number = 0;
    // the direct loader
    bool start_done = false;
    bool start_error = false;
    std::uint8_t start_reason = 0;
    std::uint8_t loader_address = 0;  // words
  };

  struct Outputs {
    bool ack = false;
    bool error = false;
    std::uint32_t data = 0;
    std::uint32_t clear_fault = 0;
    std::uint32_t fault = 0;
    bool irq = false;
    bool stream_write = false;
    std::uint32_t stream_word = 0;
    bool abort = false;
    bool flush = false;
    bool start = false;
    std::uint8_t start_mask = 0;
    bool loader_valid = false;  // no port: whether `loader_data` answers the loader; unspecified otherwise
    std::uint32_t loader_data = 0;
    bool hold = false;
    std::uint32_t ratio = 0;
    std::uint32_t slew = 0;
    std::uint32_t hold_limit = 0;
    std::array<std::uint16_t, kMaxAxes> step_length{};
    std::array<std::uint16_t, kMaxAxes> step_space{};
    std::array<std::uint16_t, kMaxAxes> dir_setup{};
    std::array<std::uint16_t, kMaxAxes> dir_hold{};
    std::array<std::uint8_t, kMaxAxes> mode{};
  };

  explicit RegisterFile(const Config& config);

  // Back to the state in reset.
  void reset();

  // One rising edge with reset low.
  void clock(const Inputs& in);

  const Outputs& outputs() const { return out_; }

  // True when clocks with these same inputs change nothing but the time; then advance(n) equals n times clock(in).
  bool quiet(const Inputs& in) const;
  void advance(std::uint64_t clocks) { time_ += clocks; }

  // Clocks since reset.
  std::uint64_t time() const { return time_; }

 private:
  enum class Stage { Idle, Decode, Wait, Act, Respond, Send, Sent, Judge, Load };

  void clear_pulses();
  std::uint32_t status(const Inputs& in) const;
  bool interrupt(const Inputs& in) const;
  std::uint32_t live(const Inputs& in) const;
  card_map::Reason judge(bool direct) const;
  void step_access(const Inputs& in);
  void begin(const Inputs& in);
  void act(const Inputs& in);
  void effect();
  void take_snapshot(const Inputs& in);
  void finish(bool error, std::uint32_t data = 0);
  void settle_refusal(const Inputs& in, std::uint32_t access_address);
  void step_loader(const Inputs& in);
  void show_settings();
  std::uint32_t& stored(std::uint32_t address) { return stored_[address / 4]; }
  std::uint32_t stored(std::uint32_t address) const { return stored_[address / 4]; }

  Config config_;
  Outputs out_;
  std::uint64_t time_ = 0;

  // The access in work.
  Stage stage_ = Stage::Idle;
  bool write_ = false;
  bool partial_ = false;
  std::uint32_t address_ = 0;
  std::uint32_t word_ = 0;  // last word written
  card_map::Slot slot_{nullptr, 0};
  card_map::Reason reason_ = card_map::Reason::None;
  std::uint32_t answer_ = 0;
  bool word_refused_ = false;     // by the door
  std::uint8_t own_refusal_ = 0;  // reason of a refusal in this clock that is not the door's
  bool clear_refusal_ = false;
  bool write_pending_ = false;  // a write was answered and takes effect in this clock
  bool snapshot_pending_ = false;

  std::array<std::uint32_t, 256> stored_{};  // whatever reads back: constants, settings, the last snapshot
  std::uint32_t walk_ = 0;                   // clocks for which the walker still has the RAM
  std::uint32_t refusal_ = 0;                // as the register reads; a reason is never 0
  std::array<std::uint32_t, 2> clearing_{};  // bits on their way from clear_fault to FAULT

  struct LoaderRead {
    bool valid = false;
    std::uint32_t data = 0;
  };
  bool loading_ = false;
  LoaderRead loader_read_;
};

}  // namespace trammel::model
