// Captures of inputs' edges, soft limits in the card, drives and the emergency stop.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <vector>

#include "card.hpp"
#include "trammel/driver/captures.hpp"
#include "trammel/driver/drives.hpp"
#include "trammel/driver/roles.hpp"
#include "waiting.hpp"

namespace trammel::python {
namespace {

using SoftRanges = std::vector<std::optional<driver::SoftRange>>;

// CaptureStates plus the number of the card's units, which is the length of the Python list.
struct PythonCaptures {
  driver::CaptureStates states;
  unsigned present;
};

// Masks of faults are ints in Python; this enumeration holds their bits.
enum class Fault : std::uint32_t {};
constexpr Fault fault(std::uint32_t bits) { return static_cast<Fault>(bits); }

void bind_faults(nb::module_& m) {
  namespace field = card_map::field;
  nb::enum_<Fault>(m, "Fault", "Bits of masks of faults; bits 0 to 7 are step faults of the axes 0 to 7.",
                   nb::is_flag(), nb::is_arithmetic())
      .value("STEPS", fault(field::kFaultStep), "A step of any axis had to wait too long, or too many steps waited.")
      .value("TICK_MISMATCH", fault(field::kFaultTickMismatch),
             "The ticks of feed and geometry did not match at a barrier.")
      .value("PATH_INCOMPLETE", fault(field::kFaultPathIncomplete), "A path did not end at its end point.")
      .value("MISSING_PERIOD", fault(field::kFaultMissingPeriod), "Position streaming got no new period in time.")
      .value("LIMIT", fault(field::kFaultLimit), "A step into a limit switch.")
      .value("EMERGENCY_STOP", fault(field::kFaultEmergencyStop), "It stays as long as the button is pressed.")
      .value("DRIVE_FAULT", fault(field::kFaultDriveFault), "It stays as long as the drive reports it.")
      .value("WATCHDOG", fault(field::kFaultWatchdog), "The program was silent for too long.")
      .value("LINK_LOSS", fault(field::kFaultLinkLoss), "None of the program's accesses came.")
      .value("SOFT_LIMIT", fault(field::kFaultSoftLimit), "A step beyond a soft limit.")
      .value("PROBE", fault(field::kFaultProbe), "The probe became active outside probing.")
      .value("TOOL_SETTER", fault(field::kFaultToolSetter), "The tool setter's switch became active in a move.");
}

void bind_values(nb::module_& m) {
  using driver::CaptureState;
  nb::class_<CaptureState>(m, "CaptureState", "State of a capture unit.")
      .def_ro("pending", &CaptureState::pending, "An edge has come and is not yet confirmed, withdrawn or written.")
      .def_ro("valid", &CaptureState::valid, "A capture is ready to be read.")
      .def_ro("overrun", &CaptureState::overrun,
              "A confirmed edge was lost, because an earlier capture had not been read.")
      .def_ro("active", &CaptureState::active, "The level after the captured edge.");
  nb::class_<PythonCaptures>(m, "CaptureStates", "State of the card's capture units.")
      .def_prop_ro(
          "units",
          [](const PythonCaptures& of) {
            const auto& units = of.states.units;
            return std::vector<CaptureState>(units.begin(), units.begin() + of.present);
          },
          "A CaptureState for each unit.")
      .def_prop_ro(
          "snapshots", [](const PythonCaptures& of) { return of.states.snapshots; },
          "Snapshots taken for captures, including withdrawn ones; the count wraps at 2^16.");
  nb::class_<driver::Capture>(m, "Capture", "An edge of an input, at the time when it was at the pin.")
      .def_ro("at", &driver::Capture::at, "Snapshot of the edge: its time and the positions.")
      .def_ro("active", &driver::Capture::active, "The level after the edge.")
      .def_ro("overrun", &driver::Capture::overrun, "Later edges were lost.");
  nb::class_<driver::CaptureQueue>(m, "CaptureQueue", "State of the card's queue of captures.")
      .def_ro("captures", &driver::CaptureQueue::captures, "In it, 0 to 16.")
      .def_ro("lost", &driver::CaptureQueue::lost, "Since reset, because it was full; the count wraps at 2^16.");
  nb::class_<driver::QueuedCapture>(m, "QueuedCapture", "An edge of an input, from the queue.")
      .def_ro("at", &driver::QueuedCapture::at, "Snapshot of the edge: its time and the positions.")
      .def_ro("unit", &driver::QueuedCapture::unit, "The unit that took it.")
      .def_ro("active", &driver::QueuedCapture::active, "The level after the edge.");
  nb::class_<driver::SoftRange>(m, "SoftRange", "Positions that an axis may go to, pulses as the card counts them.")
      .def(nb::init<std::int32_t, std::int32_t>(), "minus"_a, "plus"_a, "From minus to plus, both included.")
      .def_ro("minus", &driver::SoftRange::minus, "The lowest position.")
      .def_ro("plus", &driver::SoftRange::plus, "The highest position.");
}

void bind_captures(nb::class_<PythonCard>& card) {
  card.def_prop_ro(
          "captures_present", [](const PythonCard& of) { return of.card.captures_present(); },
          "How many capture units the card has, 0 to 4.")
      .def("select_capture",
           waiting([](PythonCard& of, unsigned unit, unsigned input, bool to_active, bool to_inactive, bool continuous,
                      bool queue) {
             of.card.select_capture(unit, {input, to_active, to_inactive, continuous, queue});
           }),
           "unit"_a, "input"_a, nb::kw_only(), "to_active"_a = true, "to_inactive"_a = false, "continuous"_a = false,
           "queue"_a = false,
           "The unit watches an input for edges to its active level, to its inactive level, or both, however long its "
           "filter is, and drops what it had. continuous: it goes on after each capture; else it takes one. queue: "
           "captures go into the card's queue at once.")
      .def("stop_capture", waiting([](PythonCard& of, unsigned unit) { of.card.stop_capture(unit); }), "unit"_a,
           "The unit watches for nothing.")
      .def("read_captures", waiting([](PythonCard& of) {
             return PythonCaptures{of.card.read_captures(), of.card.captures_present()};
           }),
           "State of the card's capture units.")
      .def("take_capture", waiting([](PythonCard& of, unsigned unit) { return of.card.take_capture(unit); }), "unit"_a,
           "The capture that stands, which is cleared with it; None where there is none.")
      .def("wait_for_capture", waiting([](PythonCard& of, unsigned unit, std::int64_t ns) {
             return of.card.wait_for_capture(unit, nanoseconds(ns));
           }),
           "unit"_a, "timeout_ns"_a,
           "The same, as soon as there is one. Raises TimeoutError after timeout_ns of card time.")
      .def("clear_captures", waiting([](PythonCard& of, unsigned units) { of.card.clear_captures(units); }), "units"_a,
           "Overruns begin anew, of the units of the mask, with what stands with them.");
  card.def_prop_ro(
          "has_capture_queue", [](const PythonCard& of) { return of.card.has_capture_queue(); },
          "Whether the card has a queue of captures.")
      .def("read_capture_queue", waiting([](PythonCard& of) { return of.card.read_capture_queue(); }),
           "How many captures are in the queue, and how many were lost since it was full.")
      .def("take_queued_captures", waiting([](PythonCard& of) { return of.card.take_queued_captures(); }),
           "The captures of the queue, the oldest first, which leave it.");
}

void bind_soft_limits(nb::class_<PythonCard>& card) {
  card.def_prop_ro(
          "has_soft_limits", [](const PythonCard& of) { return of.card.has_soft_limits(); },
          "Whether the card compares positions with soft limits itself.")
      .def("set_soft_limits",
           waiting([](PythonCard& of, const SoftRanges& ranges) { of.card.set_soft_limits(ranges); }), "ranges"_a,
           "A SoftRange or None by axis; the axes behind the last one have none then, and an empty list switches all "
           "off. While the axes stand. A pulse further out stops the card, by default on a ramp; pulses back are free.")
      .def("read_soft_limits", waiting([](PythonCard& of) { return of.card.read_soft_limits(); }),
           "As the card has them: a SoftRange or None for each axis.")
      .def("set_soft_limit_ramps", waiting([](PythonCard& of, bool ramp) { of.card.set_soft_limit_ramps(ramp); }),
           "ramp"_a, "Whether soft limits stop the axes on a ramp, as after a reset; else at once.");
}

void bind_drives(nb::class_<PythonCard>& card) {
  card.def("set_output_safe_cause", waiting([](PythonCard& of, std::uint16_t levels, std::uint16_t change) {
             of.card.set_output_safe_cause(levels, change);
           }),
           "levels"_a, "change"_a,
           "Levels that the outputs in change take in the clock of a fault, and at an abort: masks. They go before "
           "those of set_output_safe(), and stay until the fault is cleared.")
      .def("set_output_roles",
           waiting([](PythonCard& of, std::uint16_t enable, std::uint16_t brake, std::uint16_t charge_pump,
                      std::uint16_t healthy) {
             of.card.set_output_roles({enable, brake, charge_pump, healthy});
           }),
           nb::kw_only(), "enable"_a = 0, "brake"_a = 0, "charge_pump"_a = 0, "healthy"_a = 0,
           "Outputs that follow the drives or the card: masks. Active while the drives are enabled, while the brake is "
           "released, as a square wave while the card is healthy, while it is healthy. An output has one role.")
      .def("set_enable_sequence",
           waiting([](PythonCard& of, const Axes& axes, bool manual, std::int64_t release, std::int64_t before,
                      std::int64_t after, std::int64_t set, std::int64_t idle, std::uint32_t causes) {
             of.card.set_enable_sequence({mask_of(of, axes), manual, nanoseconds(release), nanoseconds(before),
                                          nanoseconds(after), nanoseconds(set), nanoseconds(idle), causes});
           }),
           "axes"_a, nb::kw_only(), "manual"_a = false, "brake_release_ns"_a = 0, "before_first_step_ns"_a = 0,
           "after_last_step_ns"_a = 0, "brake_set_ns"_a = 0, "idle_ns"_a = 0, "disable_causes"_a = 0,
           "The sequence of enable and brake for the drives of these axes; none: motion waits for nothing. Motion "
           "enables the drives, with manual it waits for enable(). brake_release_ns: from the enable; "
           "before_first_step_ns: from there; after_last_step_ns: until the brake is set; brake_set_ns: from there to "
           "the disable; idle_ns: without motion, until they are disabled (0: never). disable_causes: a mask of Fault "
           "that disables them at rest; the emergency stop does at once.")
      .def("enable", waiting([](PythonCard& of, bool on) { of.card.enable(on); }), "on"_a = true,
           "The drives are enabled now, and stay so until enable(False). Status: enabled, enable_waits.")
      .def("set_health", waiting([](PythonCard& of, std::uint32_t causes, bool needs_watchdog, std::int64_t half) {
             of.card.set_health({causes, needs_watchdog, nanoseconds(half)});
           }),
           nb::kw_only(), "causes"_a = 0, "needs_watchdog"_a = false, "pump_half_period_ns"_a = 0,
           "When the card is healthy: with none of the faults in causes (a mask of Fault), and with needs_watchdog "
           "while the watchdog runs. pump_half_period_ns: of the charge pump's wave, 0: none.");
}

void bind_emergency_stop(nb::class_<PythonCard>& card) {
  card.def_prop_ro(
          "has_emergency_stop", [](const PythonCard& of) { return of.card.has_emergency_stop(); },
          "Whether the card has a pin for an emergency stop. It is not a safety function.")
      .def("read_emergency_stop", waiting([](PythonCard& of) { return of.card.read_emergency_stop(); }),
           "Whether one stands: the button was pressed, however briefly. clear_faults() clears it once the button is "
           "released; until then it stands.")
      .def("set_emergency_stop_ramps",
           waiting([](PythonCard& of, bool ramp) { of.card.set_emergency_stop_ramps(ramp); }), "ramp"_a,
           "Whether it stops the axes on a ramp; else at once, as after a reset.")
      .def(
          "set_emergency_stop", [](PythonCard& of, bool pressed) { of.engine().set_emergency_stop(pressed); },
          "pressed"_a, "Simulated cards: as by the emergency stop's button.");
}

}  // namespace

void bind_guards(nb::module_& m, nb::class_<PythonCard>& card) {
  bind_faults(m);
  bind_values(m);
  bind_captures(card);
  bind_soft_limits(card);
  bind_drives(card);
  bind_emergency_stop(card);
}

}  // namespace trammel::python
