// Cards: opening and closing, settings and state, functions of simulated cards.
#include "card.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "trammel/transport/card_url.hpp"
#include "trammel/transport/connection.hpp"
#include "waiting.hpp"

namespace trammel::python {
namespace {

std::unique_ptr<PythonCard> open_place(const transport::CardUrl& place) {
  const auto connection = std::make_shared<transport::Connection>(place);
  return std::make_unique<PythonCard>(std::shared_ptr<driver::Bus>(connection, &connection->bus()),
                                      connection->engine());
}

std::unique_ptr<PythonCard> open_card(const std::string& url) { return open_place(transport::parse_card_url(url)); }

std::unique_ptr<PythonCard> simulate(unsigned axes, std::uint32_t clock_hz) {
  transport::CardUrl place;
  place.axes = axes;
  place.clock_hz = clock_hz;
  return open_place(place);
}

void configure_axis(PythonCard& of, unsigned axis, std::int64_t length, std::int64_t space, std::int64_t setup,
                    std::int64_t hold, driver::StepMode mode, bool invert_first, bool invert_second) {
  of.card.configure_axis(axis, {nanoseconds(length), nanoseconds(space), nanoseconds(setup), nanoseconds(hold), mode,
                                invert_first, invert_second});
}

void bind_closing(nb::class_<PythonCard>& card) {
  card.def("close", waiting([](PythonCard& of) { of.close(); }),
           "Lets go of the link; a served card that could be moved then holds. Further accesses raise StateError.")
      .def(
          "__enter__", [](nb::handle self) { return nb::borrow(self); },
          "The card itself; close() is called at the end of the block.")
      .def(
          "__exit__", [](PythonCard& of, const nb::object&, const nb::object&, const nb::object&) { of.close(); },
          "type"_a.none(), "value"_a.none(), "traceback"_a.none(), "Calls close().");
}

void bind_state(nb::class_<PythonCard>& card) {
  card.def_prop_ro(
          "identification", [](const PythonCard& of) { return of.card.identification(); },
          "Who the card is, as read when it was opened.")
      .def("configure_axis", waiting(configure_axis), "axis"_a, nb::kw_only(), "step_length_ns"_a = 0,
           "step_space_ns"_a = 0, "direction_setup_ns"_a = 0, "direction_hold_ns"_a = 0,
           "mode"_a = driver::StepMode::kStepDirection, "invert_first"_a = false, "invert_second"_a = false,
           "Sets an axis's step times (rounded up to clocks), its mode and the polarity of its two pins.")
      .def("read_status", waiting([](PythonCard& of) { return of.card.read_status(); }), "Reads STATUS.")
      .def("read_snapshot", waiting([](PythonCard& of) { return of.card.read_snapshot(); }),
           "State of the card, all of one clock.")
      .def("read_stop_snapshot", waiting([](PythonCard& of) { return of.card.read_stop_snapshot(); }),
           "Snapshot of the clock in which the present or last fault stopped the card; zeros without one.")
      .def("wait_until_idle",
           waiting([](PythonCard& of, std::int64_t ns) { of.card.wait_until_idle(nanoseconds(ns)); }), "timeout_ns"_a,
           "Waits until nothing runs or is queued. Raises TimeoutError after timeout_ns.")
      .def("read_faults", waiting([](PythonCard& of) { return of.card.read_faults(); }), "Latched faults: a mask.")
      .def("read_fault_text", waiting([](PythonCard& of) { return of.card.read_fault_text(); }),
           "The latched faults as text, with the axes and sides of limits: 'LIMIT (axis 0 plus)'; 'none'.")
      .def("name_axes",
           waiting([](PythonCard& of, std::vector<std::string> names) { of.card.name_axes(std::move(names)); }),
           "names"_a, "The names of the axes, by number, in this object's texts about faults.")
      .def("clear_faults", waiting([](PythonCard& of) { of.card.clear_faults(); }),
           "Clears the latched faults; on the ramp of one it waits for the end first. Nothing moves by it. The fault "
           "of a drive that still reports it stays, and so does an emergency stop whose button is pressed.")
      .def("read_rest", waiting([](PythonCard& of) { return of.card.read_rest(); }),
           "Where the last stop has left the card. Raises StateError while it is on its way to one.")
      .def("wait_until_stopped",
           waiting([](PythonCard& of, std::int64_t ns) { of.card.wait_until_stopped(nanoseconds(ns)); }),
           "margin_ns"_a = 1'000'000'000,
           "Waits until a stop under way has ended. Raises TimeoutError margin_ns after the longest ramp.")
      .def("set_watchdog", waiting([](PythonCard& of, std::int64_t ns) { of.card.set_watchdog(nanoseconds(ns)); }),
           "time_ns"_a,
           "The card stops, with a fault, when this program is silent for time_ns (0: never). Calls that wait, and "
           "streams, keep it from stopping; set 0 when the motion is over.")
      .def("read_inputs", waiting([](PythonCard& of) { return of.card.read_inputs(); }),
           "Levels of the inputs after polarity and filters, bit n: input n.")
      .def("read_outputs", waiting([](PythonCard& of) { return of.card.read_outputs(); }),
           "Levels of the outputs, bit n: output n.")
      .def("read_marks", waiting([](PythonCard& of) { return of.card.read_marks(); }),
           "MARK commands passed since reset.")
      .def("read_mark_snapshot", waiting([](PythonCard& of) { return of.card.read_mark_snapshot(); }),
           "Snapshot at the last MARK.");
}

void bind_simulation(nb::class_<PythonCard>& card) {
  card.def("wait", waiting([](PythonCard& of, std::uint64_t clocks) {
             if (!of.engine().wait_or_interrupt(clocks)) throw driver::InterruptedError("wait: interrupted");
           }),
           "clocks"_a, "Simulated cards: lets clocks pass.")
      .def(
          "set_inputs", [](PythonCard& of, std::uint32_t levels) { of.engine().set_inputs(levels); }, "levels"_a,
          "Simulated cards: levels at the input pins, bit n: input n.")
      .def(
          "set_input",
          [](PythonCard& of, unsigned input, bool level) {
            check_input(of, input);
            of.engine().set_input(input, level);
          },
          "input"_a, "level"_a,
          "Simulated cards: the level of one input; the others stay. One that has got none is at its inactive level.")
      .def(
          "reset", [](PythonCard& of) { of.engine().reset(); }, "Simulated cards: as by the reset input.")
      .def("record_steps", &PythonCard::record, "on"_a = true,
           "Simulated cards: keeps every step from now on in pin_steps and path_steps.")
      .def_prop_ro(
          "pin_steps", [](const PythonCard& of) { return of.steps.pins; },
          "Leading edges at the STEP pins: (cycle, axis, direction).")
      .def_prop_ro(
          "path_steps", [](const PythonCard& of) { return of.steps.path; },
          "Steps of the path: (command, tick, axis, direction).");
}

}  // namespace

void bind_card(nb::module_& m) {
  auto card = nb::class_<PythonCard>(m, "Card", "A card; open() and simulate() make them.");
  bind_closing(card);
  bind_motion(card);
  bind_state(card);
  bind_inputs(m, card);
  bind_guards(m, card);
  bind_place(m, card);
  bind_pwm(m, card);
  bind_world(m, card);
  bind_machine_file(m, card);
  bind_simulation(card);
  m.def("open", waiting(open_card), "url"_a,
        "The card that a URL names: sim:, tcp://host:port, serial:/dev/..., spi:/dev/..., mmap:/dev/...");
  m.def("simulate", simulate, "axes"_a = 4, "clock_hz"_a = 1'000'000, "A simulated card: the golden model.");
  m.def("describe_faults", driver::describe_faults, "faults"_a, "limit_state"_a = nb::none(),
        "axes"_a = std::vector<std::string>(),
        "The names of the faults in a mask, as text; the axes of limits and drives where LIMIT_STATE is given. `axes`: "
        "names of the card's axes, by number; others are \"axis N\".");
}

}  // namespace trammel::python
