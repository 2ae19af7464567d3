// The values that a card reports: identification and state.
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <vector>

#include "module.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/one_shot.hpp"

namespace trammel::python {
namespace {

void bind_identification(nb::module_& m) {
  nb::class_<card_map::Descriptor>(m, "Unit", "A unit that the card is built of, from its table of units.")
      .def_prop_ro(
          "name", [](const card_map::Descriptor& of) { return driver::unit_name(of); }, "Name of the kind of unit.")
      .def_ro("tag", &card_map::Descriptor::tag, "Kind of the unit, as the register map numbers it.")
      .def_ro("major", &card_map::Descriptor::major, "Major version of the unit's registers.")
      .def_ro("minor", &card_map::Descriptor::minor, "Minor version of the unit's registers.")
      .def_ro("instances", &card_map::Descriptor::instances, "How many of the unit the card has.")
      .def_ro("features", &card_map::Descriptor::features, "Optional parts that it was built with: a mask.")
      .def_prop_ro(
          "address", [](const card_map::Descriptor& of) { return 4 * of.base; }, "Byte address of the first instance.")
      .def_ro("words", &card_map::Descriptor::words, "Words that one instance uses.")
      .def_ro("stride", &card_map::Descriptor::stride,
              "Words from one instance to the next; 0: all share the same registers.");
  nb::class_<driver::Identification>(m, "Identification", "Who the card is and what it was built of.")
      .def_ro("map_major", &driver::Identification::map_major, "Major version of the register map.")
      .def_ro("map_minor", &driver::Identification::map_minor, "Minor version of the register map.")
      .def_ro("commands_version", &driver::Identification::commands_version, "Version of the command set.")
      .def_ro("axes", &driver::Identification::axes, "Number of axes, 1 to 8.")
      .def_ro("clock_hz", &driver::Identification::clock_hz, "Clock of the card, Hz.")
      .def_ro("engines", &driver::Identification::engines, "Engines that it was built with: a mask.")
      .def_prop_ro(
          "units",
          [](const driver::Identification& of) {
            return std::vector<card_map::Descriptor>(of.units.begin(), of.units.end());
          },
          "What the card is built of: a list of Unit.")
      .def_ro("geometry_depth", &driver::Identification::geometry_depth, "Size of the geometry queue, halfwords.")
      .def_ro("feed_depth", &driver::Identification::feed_depth, "Size of the feed queue, halfwords.");
}

void bind_state(nb::module_& m) {
  nb::class_<driver::Status>(m, "Status", "The card's STATUS register.")
      .def_ro("busy", &driver::Status::busy, "Something is under way or queued.")
      .def_ro("direct", &driver::Status::direct, "A one-shot line (direct move) is under way.")
      .def_ro("path_active", &driver::Status::path_active, "A path or a direct move is under way.")
      .def_ro("feed_active", &driver::Status::feed_active, "A feed piece is under way.")
      .def_ro("held", &driver::Status::held, "The time base's ratio is 0.")
      .def_ro("ended", &driver::Status::ended, "END was executed, and nothing has begun since.")
      .def_ro("faulted", &driver::Status::faulted, "A fault is latched.")
      .def_ro("refused", &driver::Status::refused, "A refusal is latched.")
      .def_ro("snapshot", &driver::Status::snapshot, "A snapshot is under way.")
      .def_ro("incomplete", &driver::Status::incomplete, "The stream has written part of a command.")
      .def_ro("stopping", &driver::Status::stopping,
              "The card is stopping: it is on a ramp, or completes the last pulses.")
      .def_ro("geometry_low", &driver::Status::geometry_low,
              "Fewer halfwords are in the geometry queue than its watermark.")
      .def_ro("feed_low", &driver::Status::feed_low, "Fewer halfwords are in the feed queue than its watermark.")
      .def_ro("probed", &driver::Status::probed, "A probe has tripped; clear_probe() clears it.")
      .def_ro("probe_missed", &driver::Status::probe_missed, "Probing paths ended without an edge.")
      .def_ro("waiting", &driver::Status::waiting, "The card waits for an input.")
      .def_ro("underrun", &driver::Status::underrun,
              "The under-run hold is active, or a piece that begins from rest waits for commands.")
      .def_ro("stale", &driver::Status::stale, "Position streaming continues without a new period.")
      .def_ro("button_hold", &driver::Status::button_hold, "The feed hold input holds the card until cycle start.")
      .def_ro("enabled", &driver::Status::enabled, "The drives are enabled.")
      .def_ro("enable_waits", &driver::Status::enable_waits, "Motion waits for the enable of the drives.")
      .def_ro("settled", &driver::Status::settled,
              "For 31 clocks, at a ratio of 0 or stopped by a fault: every tick taken has made its steps, every step "
              "its pulse.");
  nb::class_<driver::Snapshot>(m, "Snapshot", "State of the card in one clock.")
      .def_ro("time", &driver::Snapshot::time, "Clocks since reset.")
      .def_ro("status", &driver::Snapshot::status, "STATUS of that clock.")
      .def_ro("faults", &driver::Snapshot::faults, "Latched faults: a mask for describe_faults().")
      .def_ro("rate", &driver::Snapshot::rate, "Feed rate, 2^-32 ticks per enabled clock.")
      .def_ro("ratio", &driver::Snapshot::ratio, "Ratio of the time base, 2^-16.")
      .def_ro("geometry_begun", &driver::Snapshot::geometry_begun,
              "Commands begun from the geometry queue; the count wraps at 2^32.")
      .def_ro("feed_begun", &driver::Snapshot::feed_begun,
              "Commands begun from the feed queue; the count wraps at 2^32.")
      .def_ro("position", &driver::Snapshot::position, "Pulses, by axis; the counts wrap at 2^32.");
  nb::class_<driver::Rest>(m, "Rest",
                           "The state in which the last stop left the card, latched before anything was dropped.")
      .def_ro("time", &driver::Rest::time, "Clocks from the reset to the stop; 0: no stop since the reset.")
      .def_ro("status", &driver::Rest::status, "STATUS of that clock.")
      .def_ro("faults", &driver::Rest::faults, "Faults latched at that time: a mask for describe_faults().")
      .def_ro("geometry_begun", &driver::Rest::geometry_begun,
              "Commands begun from the geometry queue; the count wraps at 2^32.")
      .def_ro("feed_begun", &driver::Rest::feed_begun, "Commands begun from the feed queue; the count wraps at 2^32.")
      .def_ro("ticks_left", &driver::Rest::ticks_left,
              "Ticks that the last command has not taken yet (of a one-shot line: clocks). 0 if no path was under way, "
              "or if the position is not exact.")
      .def_ro("position", &driver::Rest::position, "Pulses, by axis; the counts wrap at 2^32.")
      .def_prop_ro("exact", &driver::Rest::exact,
                   "Whether the position includes all ticks taken. It does not after an abort in motion.");
}

}  // namespace

void bind_card_values(nb::module_& m) {
  bind_identification(m);
  bind_state(m);
  nb::class_<driver::OneShotPlan>(m, "LinePlan", "A planned one-shot line.")
      .def_prop_ro("parts", &driver::OneShotPlan::size, "Number of commands.")
      .def_prop_ro("clocks", &driver::OneShotPlan::clocks, "Duration, clocks of the card.")
      .def_prop_ro("slowed", &driver::OneShotPlan::slowed, "Whether a limit made it slower than requested.");
  nb::enum_<driver::StepMode>(m, "StepMode", "Signals at an axis's two pins.")
      .value("STEP_DIRECTION", driver::StepMode::kStepDirection, "A STEP and a DIR pin.")
      .value("UP_DOWN", driver::StepMode::kUpDown, "A pin for pulses up, one for pulses down.")
      .value("QUADRATURE", driver::StepMode::kQuadrature, "Two phases, a quarter of a period apart.");
  nb::enum_<driver::PieceClass>(m, "PieceClass", "Class of a piece of feed: each has a ratio (override) of its own.")
      .value("FEED", driver::PieceClass::kFeed, "Motion at the programmed feed.")
      .value("RAPID", driver::PieceClass::kRapid, "Rapid motion.")
      .value("FIXED", driver::PieceClass::kFixed, "Probing and threading.");
}

}  // namespace trammel::python
