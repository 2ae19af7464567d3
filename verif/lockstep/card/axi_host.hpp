// An AXI4-Lite master for the card under lockstep. It delays each valid and ready by its own number of clocks, and
// writes and reads side by side. It uses the answers of the golden model; a different answer of the RTL is a
// mismatch.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <stdexcept>

#include "lockstep_card.hpp"
#include "switches.hpp"

namespace trammel::test {

// `Card`: a LockstepCard, or a class with the same clocking and bus.
template <class Card>
class AxiHostOf {
 public:
  struct Write {
    std::uint32_t address = 0;
    std::uint32_t value = 0;
    std::uint8_t strobes = 0xF;
  };
  struct Answers {
    bool written = false;               // the write was accepted
    std::optional<std::uint32_t> read;  // the value read; nothing if the read was refused
  };

  AxiHostOf(Card& card, std::uint64_t seed) : card_(card), random_(seed) {}

  // Each valid and ready comes up to `clocks` late, at random; 0: at once, and ready before its valid.
  void set_delays(unsigned clocks) { max_delay_ = clocks; }

  bool write(std::uint32_t address, std::uint32_t value, std::uint8_t strobes = 0xF) {
    const Write access{address, value, strobes};
    return perform(&access, nullptr).written;
  }
  std::optional<std::uint32_t> read(std::uint32_t address) { return perform(nullptr, &address).read; }
  Answers write_beside_read(const Write& write, std::uint32_t address) { return perform(&write, &address); }

  // Levels at the card's inputs from now on.
  void set_pins(std::uint32_t pins) { pins_ = pins; }
  std::uint32_t pins() const { return pins_; }
  void press_emergency_stop(bool pressed) { emergency_stop_ = pressed; }
  // Switches that change the levels, including those of set_pins(), in clocks of their own. Not owned.
  void set_switches(Switches* switches) { switches_ = switches; }
  void wait(std::uint64_t clocks) { run({}, clocks); }
  void reset(std::uint64_t clocks) {
    model::CardModel::Inputs in;
    in.rst = true;
    run(in, clocks);
  }

  // Clocks since the start; resets of the card do not change the count.
  std::uint64_t clocks() const { return clocks_; }
  // The longest time from a handshake to its answer, clocks.
  std::uint64_t slowest_answer() const { return slowest_; }
  Card& card() { return card_; }
  std::uint64_t below(std::uint64_t count) { return random_() % count; }

 private:
  void run(model::CardModel::Inputs in, std::uint64_t clocks) {
    while (clocks != 0) {
      std::uint64_t some = clocks;
      in.pins = pins_;
      in.emergency_stop = emergency_stop_;
      if (switches_ != nullptr) {
        in.pins ^= switches_->levels(clocks_);
        some = std::min(some, switches_->next_change() - clocks_);
      }
      card_.run(in, some);
      clocks_ += some;
      clocks -= some;
    }
  }
  // One handshake: begins after `delay` clocks, ends when valid and ready are both high.
  struct Handshake {
    bool due = false;
    std::uint64_t delay = 0;

    bool up() const { return due && delay == 0; }
    void clock(bool met) {
      if (met) due = false;
      if (delay != 0) --delay;
    }
  };
  static constexpr std::uint64_t kMaxClocks = 5000;  // far above the card's bound of 700

  Handshake handshake(bool wanted) { return {wanted, wanted && max_delay_ != 0 ? below(max_delay_ + 1) : 0}; }

  Answers perform(const Write* write, const std::uint32_t* read) {
    Handshake aw = handshake(write != nullptr);
    Handshake w = handshake(write != nullptr);
    Handshake b = handshake(write != nullptr);
    Handshake ar = handshake(read != nullptr);
    Handshake r = handshake(read != nullptr);
    Answers answers;
    model::CardModel::Inputs in;
    if (write != nullptr) {
      in.awaddr = write->address;
      in.wdata = write->value;
      in.wstrb = write->strobes;
    }
    if (read != nullptr) in.araddr = *read;
    std::uint64_t asked = 0;
    for (std::uint64_t clocks = 0; b.due || r.due; ++clocks) {
      if (clocks == kMaxClocks) throw std::logic_error("the card does not answer");
      in.awvalid = aw.up();
      in.wvalid = w.up();
      in.bready = b.up();
      in.arvalid = ar.up();
      in.rready = r.up();
      const model::Axi4LitePort::Outputs bus = card_.bus();
      const bool asking = aw.due || w.due || ar.due;
      if (asking) asked = clocks;
      if (b.up() && bus.bvalid) answers.written = bus.bresp == model::Axi4LitePort::kOkay;
      if (r.up() && bus.rvalid && bus.rresp == model::Axi4LitePort::kOkay) answers.read = bus.rdata;
      if ((b.due && bus.bvalid) || (r.due && bus.rvalid)) slowest_ = std::max(slowest_, clocks - asked);
      run(in, 1);
      aw.clock(in.awvalid && bus.awready);
      w.clock(in.wvalid && bus.wready);
      b.clock(in.bready && bus.bvalid);
      ar.clock(in.arvalid && bus.arready);
      r.clock(in.rready && bus.rvalid);
    }
    return answers;
  }

  Card& card_;
  std::mt19937_64 random_;
  unsigned max_delay_ = 0;
  std::uint32_t pins_ = 0;
  bool emergency_stop_ = false;
  Switches* switches_ = nullptr;
  std::uint64_t slowest_ = 0;
  std::uint64_t clocks_ = 0;
};

using AxiHost = AxiHostOf<sim::LockstepCard>;

}  // namespace trammel::test
