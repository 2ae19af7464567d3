// Machine files, homing, positions in mm.
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <functional>
#include <optional>
#include <string>

#include "card.hpp"
#include "trammel/bindings/homing.hpp"
#include "waiting.hpp"

namespace trammel::python {
namespace {

struct PythonMachine {
  machine::Machine machine;

  std::string letters() const {
    std::string text;
    for (const auto& axis : machine.axes) text += axis.letter;
    return text;
  }
};

struct PythonHomedAxis {
  std::string letter;
  run::HomedAxis homed;
};

using Say = std::optional<nb::callable>;

std::vector<PythonHomedAxis> home_axes(PythonCard& of, const PythonMachine& machine, const std::string& axes,
                                       const Say& say) {
  std::function<void(const std::string&)> told;
  if (say) {
    told = [&say](const std::string& text) {
      const nb::gil_scoped_acquire locked;
      (*say)(text);
    };
  }
  std::vector<PythonHomedAxis> out;
  for (const run::HomedAxis& axis : bindings::home(of.card, machine.machine, axes, told)) {
    out.push_back({std::string(1, machine.machine.axes[axis.axis].letter), axis});
  }
  return out;
}

void bind_machine_values(nb::module_& m) {
  nb::class_<PythonMachine>(m, "Machine", "A machine file: scales, inputs, homing.")
      .def(
          "__init__",
          [](PythonMachine* self, const std::optional<std::string>& file) {
            new (self) PythonMachine{bindings::load_machine(file.value_or(""))};
          },
          "file"_a = nb::none(), "Reads a file; None: the built-in machine. Raises ArgumentError with file and line.")
      .def(
          "change", [](PythonMachine& of, const std::string& entry) { bindings::change_machine(of.machine, entry); },
          "entry"_a, "Changes an entry: 'homing.x.search_distance=20'.")
      .def_prop_ro("letters", &PythonMachine::letters, "Its axes, as 'XYZE'.")
      .def(
          "pulses_of",
          [](const PythonMachine& of, const std::vector<double>& way) { return bindings::pulses_of(of.machine, way); },
          "way"_a, "A way in mm (degrees), by axis of the machine, as pulses of the card's axes.");
  nb::class_<PythonHomedAxis>(m, "HomedAxis", "An axis that has found its switch.")
      .def_ro("letter", &PythonHomedAxis::letter, "The axis.")
      .def_prop_ro(
          "search_edge", [](const PythonHomedAxis& of) { return of.homed.search_edge; },
          "Where the switch's edge came in the search, mm in coordinates as they were before.")
      .def_prop_ro(
          "edge", [](const PythonHomedAxis& of) { return of.homed.edge; }, "The same of the edge that counts.")
      .def_prop_ro(
          "squared_by", [](const PythonHomedAxis& of) { return of.homed.squared_by; },
          "Way of a gantry's second motor to its place, mm.");
}

}  // namespace

void bind_machine_file(nb::module_& m, nb::class_<PythonCard>& card) {
  bind_machine_values(m);
  card.def("configure",
           waiting([](PythonCard& of, const PythonMachine& machine) { bindings::configure(of.card, machine.machine); }),
           "machine"_a, "Writes step times, slew, inputs and outputs of a machine file. The card must stand.")
      .def("home", waiting(home_axes), "machine"_a, "axes"_a = "", "say"_a = nb::none(),
           "Configures the card and homes axes ('XY'; '': all that have a [homing]): a HomedAxis each. say(text) is "
           "called for each thing that is done. Raises HomingError, with axis, input and distance, where a switch is "
           "not found; the card then stands, and of the axes those of lower sequence numbers count as homed.")
      .def(
          "read_coordinates", waiting([](PythonCard& of, const PythonMachine& machine) {
            return bindings::read_coordinates(of.card, machine.machine);
          }),
          "machine"_a,
          "Where the axes stand, mm (degrees) in machine coordinates, by axis of the machine; zeros where no place was "
          "set since the card's reset. Raises StateError for a place in other scales.");
}

}  // namespace trammel::python
