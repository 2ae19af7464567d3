// The machine's place that a card keeps.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "card.hpp"
#include "trammel/driver/card_place.hpp"
#include "waiting.hpp"

namespace trammel::python {
namespace {

struct PythonPlace {
  driver::CardPlace place;
  bool first;
  std::size_t axes;  // number of the card's axes

  template <class Values>
  auto of_axes(const Values& values) const {
    const auto end = values.begin() + static_cast<std::ptrdiff_t>(axes);
    return std::vector<typename Values::value_type>(values.begin(), end);
  }
  std::vector<bool> of_axes(std::uint8_t mask) const { return bits_of(mask, axes); }
};

PythonPlace place_of(const PythonCard& of, const driver::CardPlace& place, bool first) {
  return {place, first, of.card.identification().axes};
}

std::uint8_t all_axes(const PythonCard& of) {
  return static_cast<std::uint8_t>((1U << of.card.identification().axes) - 1);
}

void bind_value(nb::module_& m) {
  nb::class_<PythonPlace>(m, "Place", "The machine's place, as a card keeps it; lists are by axis of the card.")
      .def_prop_ro(
          "was_set", [](const PythonPlace& of) { return of.place.was_set(); },
          "Whether anybody has set a place since the card's reset; else pulses are zeros.")
      .def_ro("first", &PythonPlace::first, "Whether begin_at_place() has set machine zero here, since nobody had.")
      .def_prop_ro(
          "pulses", [](const PythonPlace& of) { return of.of_axes(of.place.pulses()); },
          "Where the axes stand, pulses from machine zero.")
      .def_prop_ro(
          "machine_zero", [](const PythonPlace& of) { return of.of_axes(of.place.zero); },
          "Positions of the axes at machine zero, pulses; the counts wrap at 2^32.")
      .def_prop_ro(
          "valid", [](const PythonPlace& of) { return of.of_axes(of.place.bits.valid); },
          "Whether each axis stands where pulses says.")
      .def_prop_ro(
          "homed", [](const PythonPlace& of) { return of.of_axes(of.place.bits.homed); },
          "Whether machine zero of each axis was found at a reference.")
      .def_prop_ro(
          "keeps", [](const PythonPlace& of) { return of.of_axes(of.place.keeps); },
          "Whether each axis keeps its place through a stop at once.")
      .def_prop_ro(
          "scales", [](const PythonPlace& of) { return of.place.scales; },
          "Hash of the scales that coordinates count in; 0: nobody has set a place, 1: pulses.");
}

}  // namespace

void bind_place(nb::module_& m, nb::class_<PythonCard>& card) {
  bind_value(m);
  card.def("read_place", waiting([](PythonCard& of) { return place_of(of, driver::read_card_place(of.card), false); }),
           "The machine's place: it outlives this program, and a reset of the card clears it.")
      .def(
          "begin_at_place", waiting([](PythonCard& of, const std::optional<Axes>& axes, bool trust) {
            const std::uint8_t mask = axes ? mask_of(of, *axes) : all_axes(of);
            const driver::PlaceBegin begin = driver::begin_at_place(of.card, mask, trust);
            return place_of(of, begin.place, begin.first);
          }),
          "axes"_a = nb::none(), nb::kw_only(), "trust"_a = false,
          "Before the axes move (their numbers; all of the card's): sets machine zero where the card stands, if nobody "
          "has set a place since its reset. Raises StateError where the card is busy, and for an axis whose place was "
          "lost; with trust such an axis is valid again, since you know that it has lost no step.")
      .def("set_place", waiting([](PythonCard& of, const Axes& axes, bool valid, bool homed) {
             of.card.set_place(mask_of(of, axes), valid, homed);
           }),
           "axes"_a, "valid"_a = true, "homed"_a = false,
           "Says whether the place of axes that stand is valid, and whether they were homed. Before machine zero is "
           "changed: valid=False.")
      .def("set_machine_zero",
           waiting([](PythonCard& of, unsigned axis, std::int32_t pulses) { of.card.set_machine_zero(axis, pulses); }),
           "axis"_a, "pulses"_a, "Sets the position that an axis has at machine zero.")
      .def("set_scales", waiting([](PythonCard& of, std::uint32_t hash) { of.card.set_scales(hash); }), "hash"_a,
           "Names the scales that coordinates count in. The trammel command refuses others than its machine file's, "
           "but takes over 1: pulses.")
      .def("set_keeps_place",
           waiting([](PythonCard& of, const Axes& axes) { of.card.set_keeps_place(mask_of(of, axes)); }), "axes"_a,
           "All axes that keep their place through a stop at once, since their mechanism cannot lose steps by it.");
}

}  // namespace trammel::python
