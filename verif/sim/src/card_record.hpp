// What the card shows behind one rising edge, as memory to be compared: the one list of the signals that the lockstep
// compares. RTL and golden model each fill a record; equal cards are equal bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "lockstep.hpp"
#include "trammel/model/card_model.hpp"

// SIGNAL(port, the golden model's value, when it means anything)
// `out` and `bus` are the model's outputs; a condition names ports that stand further up. Where it does not hold both
// records say 0. All signals are compared in every cycle.
#define TRAMMEL_CARD_SIGNALS(SIGNAL)               \
  SIGNAL(tick_o, out.tick, true)                   \
  SIGNAL(path_swap_o, out.path_swap, true)         \
  SIGNAL(feed_swap_o, out.feed_swap, true)         \
  SIGNAL(path_tick_o, out.path_tick, true)         \
  SIGNAL(path_step_o, out.path_step, true)         \
  SIGNAL(path_dir_o, out.path_dir, true)           \
  SIGNAL(step_o, out.step, true)                   \
  SIGNAL(dir_o, out.dir, true)                     \
  SIGNAL(status_o, out.status, true)               \
  SIGNAL(fault_o, out.fault, true)                 \
  SIGNAL(running_o, out.running, true)             \
  SIGNAL(geometry_room_o, out.geometry_room, true) \
  SIGNAL(feed_room_o, out.feed_room, true)         \
  SIGNAL(ratio_o, out.ratio, true)                 \
  SIGNAL(rate_o, out.rate, true)                   \
  SIGNAL(irq_o, out.irq, true)                     \
  SIGNAL(awready_o, bus.awready, true)             \
  SIGNAL(wready_o, bus.wready, true)               \
  SIGNAL(bvalid_o, bus.bvalid, true)               \
  SIGNAL(bresp_o, bus.bresp, bvalid_o)             \
  SIGNAL(arready_o, bus.arready, true)             \
  SIGNAL(rvalid_o, bus.rvalid, true)               \
  SIGNAL(rdata_o, bus.rdata, rvalid_o)             \
  SIGNAL(rresp_o, bus.rresp, rvalid_o)

// AXIS_SIGNAL(port of 32 bits an axis, the golden model's value for axis n)
#define TRAMMEL_CARD_AXIS_SIGNALS(AXIS_SIGNAL) AXIS_SIGNAL(position_o, model.position(n))

namespace trammel::sim {

struct CardRecord {
  static constexpr unsigned kMaxAxes = model::CardModel::kMaxAxes;

#define TRAMMEL_MEMBER(port, golden, when) std::uint32_t port = 0;
#define TRAMMEL_AXIS_MEMBER(port, golden) std::array<std::uint32_t, kMaxAxes> port{};  // 0 for absent axes
  TRAMMEL_CARD_SIGNALS(TRAMMEL_MEMBER)
  TRAMMEL_CARD_AXIS_SIGNALS(TRAMMEL_AXIS_MEMBER)
#undef TRAMMEL_AXIS_MEMBER
#undef TRAMMEL_MEMBER

  void show(const model::CardModel& model) {
    const auto& out = model.outputs();
    const auto& bus = model.bus();
#define TRAMMEL_SHOW(port, golden, when) port = (when) ? static_cast<std::uint32_t>(golden) : 0;
#define TRAMMEL_SHOW_AXIS(port, golden) port[n] = golden;
    TRAMMEL_CARD_SIGNALS(TRAMMEL_SHOW)
    for (unsigned n = 0; n < model.axes(); ++n) {
      TRAMMEL_CARD_AXIS_SIGNALS(TRAMMEL_SHOW_AXIS)
    }
#undef TRAMMEL_SHOW_AXIS
#undef TRAMMEL_SHOW
  }

  // `rtl`: a Verilated card.
  template <unsigned kAxes, class Rtl>
  void show_rtl(const Rtl& rtl) {
#define TRAMMEL_SHOW(port, golden, when)                 \
  static_assert(sizeof(rtl.port) <= sizeof(this->port)); \
  port = (when) ? rtl.port : 0;
#define TRAMMEL_SHOW_AXIS(port, golden) port[n] = axis_word(rtl.port, n);
    TRAMMEL_CARD_SIGNALS(TRAMMEL_SHOW)
    for (unsigned n = 0; n < kAxes; ++n) {
      TRAMMEL_CARD_AXIS_SIGNALS(TRAMMEL_SHOW_AXIS)
    }
#undef TRAMMEL_SHOW_AXIS
#undef TRAMMEL_SHOW
  }

 private:
  // Verilator's types for 1, for 2 and for more axes.
  static std::uint32_t axis_word(IData port, unsigned) { return port; }
  static std::uint32_t axis_word(QData port, unsigned n) { return static_cast<std::uint32_t>(port >> 32 * n); }
  template <std::size_t kWords>
  static std::uint32_t axis_word(const VlWide<kWords>& port, unsigned n) {
    return port[n];
  }
};

// No padding: equal cards are equal bytes.
static_assert(std::has_unique_object_representations_v<CardRecord>);

// A signal's place in a record.
struct CardSignal {
  const char* name;
  std::size_t offset;  // bytes
  std::size_t words;   // 1, or one for each of kMaxAxes
};
inline constexpr CardSignal kCardSignals[] = {
#define TRAMMEL_PLACE(port, golden, when) {#port, offsetof(CardRecord, port), 1},
#define TRAMMEL_AXIS_PLACE(port, golden) {#port, offsetof(CardRecord, port), CardRecord::kMaxAxes},
    TRAMMEL_CARD_SIGNALS(TRAMMEL_PLACE) TRAMMEL_CARD_AXIS_SIGNALS(TRAMMEL_AXIS_PLACE)
#undef TRAMMEL_AXIS_PLACE
#undef TRAMMEL_PLACE
};

// Signals of a record that hold something with `axes` axes, those of each axis counted for themselves.
constexpr unsigned signals_compared(unsigned axes) {
  unsigned signals = 0;
  for (const CardSignal& s : kCardSignals) signals += s.words == 1 ? 1 : axes;
  return signals;
}

// Every byte of a record has a name.
constexpr std::size_t named_words() {
  std::size_t words = 0;
  for (const CardSignal& s : kCardSignals) words += s.words;
  return words;
}
static_assert(named_words() * sizeof(std::uint32_t) == sizeof(CardRecord));

// All signals in which the two differ.
std::vector<lockstep::Difference> differences(const CardRecord& rtl, const CardRecord& model);

}  // namespace trammel::sim
