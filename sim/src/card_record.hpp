// The card's observable state after one rising edge, as memory to compare: the only list of the signals that the
// lockstep compares. RTL and golden model each fill a record; equal cards have equal bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "rtl_buses.hpp"
#include "trammel/card_map.hpp"
#include "trammel/model/card_model.hpp"
#include "trammel/sim/lockstep.hpp"

// SIGNAL(name, the RTL's value, the golden model's value, condition under which the signal is valid). `rtl` is the
// Verilated card, `seen` its observe_o, `out` and `bus` are the model's outputs. A condition may name signals further
// up in the list. If it is false, both records contain 0. All signals are compared in every cycle.
#define TRAMMEL_CARD_SIGNALS(SIGNAL)                                      \
  SIGNAL(tick, seen.tick(), out.tick, true)                               \
  SIGNAL(path_tick, seen.path_tick(), out.path_tick, true)                \
  SIGNAL(path_swap, seen.path_swap(), out.path_swap, true)                \
  SIGNAL(feed_swap, seen.feed_swap(), out.feed_swap, true)                \
  SIGNAL(path_step, seen.path_step(), out.path_step, true)                \
  SIGNAL(path_dir, seen.path_dir(), out.path_dir, true)                   \
  SIGNAL(step_o, rtl.step_o, out.step, true)                              \
  SIGNAL(dir_o, rtl.dir_o, out.dir, true)                                 \
  SIGNAL(output_o, rtl.output_o, out.output, true)                        \
  SIGNAL(irq_o, rtl.irq_o, out.irq, true)                                 \
  SIGNAL(status, seen.status(), out.status, true)                         \
  SIGNAL(fault, seen.fault(), out.fault, true)                            \
  SIGNAL(geometry_begun, seen.geometry_begun(), out.geometry_begun, true) \
  SIGNAL(feed_begun, seen.feed_begun(), out.feed_begun, true)             \
  SIGNAL(geometry_room, seen.geometry_room(), out.geometry_room, true)    \
  SIGNAL(feed_room, seen.feed_room(), out.feed_room, true)                \
  SIGNAL(ratio, seen.ratio(), out.ratio, true)                            \
  SIGNAL(rate, seen.rate(), out.rate, true)                               \
  SIGNAL(awready_o, rtl.awready_o, bus.awready, true)                     \
  SIGNAL(wready_o, rtl.wready_o, bus.wready, true)                        \
  SIGNAL(bvalid_o, rtl.bvalid_o, bus.bvalid, true)                        \
  SIGNAL(bresp_o, rtl.bresp_o, bus.bresp, bvalid_o)                       \
  SIGNAL(arready_o, rtl.arready_o, bus.arready, true)                     \
  SIGNAL(rvalid_o, rtl.rvalid_o, bus.rvalid, true)                        \
  SIGNAL(rdata_o, rtl.rdata_o, bus.rdata, rvalid_o)                       \
  SIGNAL(rresp_o, rtl.rresp_o, bus.rresp, rvalid_o)

// AXIS_SIGNAL(name, the RTL's value for axis n, the golden model's value), 32 bits each
#define TRAMMEL_CARD_AXIS_SIGNALS(AXIS_SIGNAL) AXIS_SIGNAL(position, seen.position(n), model.position(n))

namespace trammel::sim {

// The fields of observe_o.
template <unsigned kAxes, class Wide>
class Observed {
 public:
  explicit Observed(const Wide& bits) : bits_(bits) {}

  std::uint32_t tick() const { return field(bus::observe::kTick); }
  std::uint32_t path_tick() const { return field(bus::observe::kPathTick); }
  std::uint32_t path_swap() const { return field(bus::observe::kPathSwap); }
  std::uint32_t feed_swap() const { return field(bus::observe::kFeedSwap); }
  std::uint32_t path_step() const { return of_axes(bus::axis_observe::kStep); }
  std::uint32_t path_dir() const { return of_axes(bus::axis_observe::kDir); }
  std::uint32_t position(unsigned axis) const { return field(of_axis(axis, bus::axis_observe::kPosition)); }
  std::uint32_t ratio() const { return field(bus::observe::kRatio); }
  std::uint32_t rate() const { return field(bus::observe::kRate); }
  std::uint32_t feed_begun() const { return field(bus::observe::kFeedBegun); }
  std::uint32_t geometry_begun() const { return field(bus::observe::kGeometryBegun); }
  std::uint32_t fault() const { return field(bus::observe::kFault); }
  std::uint32_t status() const { return field(bus::observe::kStatus); }
  std::uint32_t feed_room() const { return field(bus::observe::kFeedRoom); }
  std::uint32_t geometry_room() const { return field(bus::observe::kGeometryRoom); }

 private:
  static constexpr bus::Field of_axis(unsigned axis, const bus::Field& field) {
    return up(field, bus::observe::kWidth + bus::axis_observe::kWidth * axis);
  }
  // The value of a field of at most 32 bits.
  std::uint32_t field(const bus::Field& place) const { return static_cast<std::uint32_t>(get(bits_, place)); }
  // Collects a one-bit field of each axis.
  std::uint32_t of_axes(const bus::Field& place) const {
    std::uint32_t bits = 0;
    for (unsigned axis = 0; axis < kAxes; ++axis) bits |= field(of_axis(axis, place)) << axis;
    return bits;
  }

  const Wide& bits_;
};

struct CardRecord {
#define TRAMMEL_MEMBER(port, shown, golden, when) std::uint32_t port = 0;
#define TRAMMEL_AXIS_MEMBER(port, shown, golden) \
  std::array<std::uint32_t, card_map::kMaxAxes> port{};  // 0 for absent axes
  TRAMMEL_CARD_SIGNALS(TRAMMEL_MEMBER)
  TRAMMEL_CARD_AXIS_SIGNALS(TRAMMEL_AXIS_MEMBER)
#undef TRAMMEL_AXIS_MEMBER
#undef TRAMMEL_MEMBER

  void show(const model::CardModel& model) {
    const auto& out = model.outputs();
    const auto& bus = model.bus();
#define TRAMMEL_SHOW(port, shown, golden, when) port = (when) ? static_cast<std::uint32_t>(golden) : 0;
#define TRAMMEL_SHOW_AXIS(port, shown, golden) port[n] = golden;
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
    const Observed<kAxes, std::remove_reference_t<decltype(rtl.observe_o)>> seen(rtl.observe_o);
#define TRAMMEL_SHOW(port, shown, golden, when) port = (when) ? static_cast<std::uint32_t>(shown) : 0;
#define TRAMMEL_SHOW_AXIS(port, shown, golden) port[n] = shown;
    TRAMMEL_CARD_SIGNALS(TRAMMEL_SHOW)
    for (unsigned n = 0; n < kAxes; ++n) {
      TRAMMEL_CARD_AXIS_SIGNALS(TRAMMEL_SHOW_AXIS)
    }
#undef TRAMMEL_SHOW_AXIS
#undef TRAMMEL_SHOW
  }
};

// Without padding, equal cards have equal bytes.
static_assert(std::has_unique_object_representations_v<CardRecord>);

// The position of a signal in a record.
struct CardSignal {
  const char* name;
  std::size_t offset;  // bytes
  std::size_t words;   // 1, or card_map::kMaxAxes
};
inline constexpr CardSignal kCardSignals[] = {
#define TRAMMEL_PLACE(port, shown, golden, when) {#port, offsetof(CardRecord, port), 1},
#define TRAMMEL_AXIS_PLACE(port, shown, golden) {#port, offsetof(CardRecord, port), card_map::kMaxAxes},
    TRAMMEL_CARD_SIGNALS(TRAMMEL_PLACE) TRAMMEL_CARD_AXIS_SIGNALS(TRAMMEL_AXIS_PLACE)
#undef TRAMMEL_AXIS_PLACE
#undef TRAMMEL_PLACE
};

// Number of signals in a record with `axes` axes; a signal per axis counts once per axis.
constexpr unsigned signals_compared(unsigned axes) {
  unsigned signals = 0;
  for (const CardSignal& s : kCardSignals) signals += s.words == 1 ? 1 : axes;
  return signals;
}

// Checks that every byte of a record belongs to a signal.
constexpr std::size_t named_words() {
  std::size_t words = 0;
  for (const CardSignal& s : kCardSignals) words += s.words;
  return words;
}
static_assert(named_words() * sizeof(std::uint32_t) == sizeof(CardRecord));

// All signals in which the two differ.
std::vector<lockstep::Difference> differences(const CardRecord& rtl, const CardRecord& model);

}  // namespace trammel::sim
