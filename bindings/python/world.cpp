// The simulated machine behind a card: one of this process, or that of `trammel serve --world`.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include <optional>
#include <string>

#include "card.hpp"
#include "trammel/bindings/simulated_machine.hpp"
#include "waiting.hpp"

namespace trammel::python {
namespace {

struct PythonWorld {
  std::unique_ptr<bindings::SimulatedMachine> machine;
};

using Switch = std::string (bindings::SimulatedMachine::*)(const std::string&, const std::string&, nanoseconds);
using When = std::optional<std::string>;

std::unique_ptr<PythonCard> simulate_in_world(const std::optional<std::string>& file, unsigned axes,
                                              std::uint32_t clock_hz) {
  const auto world = std::make_shared<bindings::CardInWorld>(file.value_or(""), axes, clock_hz);
  auto card = std::make_unique<PythonCard>(std::shared_ptr<driver::Bus>(world, &world->engine()), &world->engine());
  card->world = world;
  return card;
}

PythonWorld world_of(const PythonCard& of) {
  if (!of.world) throw driver::StateError("no machine is simulated behind this card: simulate_in_world() makes one");
  return {bindings::machine_of(of.world)};
}

nb::object dict_of(const std::string& state) { return nb::module_::import_("json").attr("loads")(state); }

nb::object switch_button(PythonWorld& of, Switch which, const std::string& button, const When& when,
                         std::int64_t longest_ns) {
  if (longest_ns < 1) throw driver::ArgumentError("longest_ns is 1 or more");
  return dict_of(
      without_lock([&] { return (of.machine.get()->*which)(button, when.value_or(""), nanoseconds(longest_ns)); }));
}

constexpr std::int64_t kLongest = 60'000'000'000;

}  // namespace

void bind_world(nb::module_& m, nb::class_<PythonCard>& card) {
  using bindings::SimulatedMachine;
  nb::class_<PythonWorld>(m, "World",
                          "The simulated machine behind a card: what it is like, and its buttons. Its methods give the "
                          "state, as `trammel world --json` has it. That of a card in this process is for the card's "
                          "thread.")
      .def(
          "state", [](PythonWorld& of) { return dict_of(without_lock([&] { return of.machine->read(); })); },
          "Carriages (mm and pulses), switches, buttons, levels of the pins; of a served card the path that was "
          "stepped.")
      .def(
          "count", [](PythonWorld& of) { return dict_of(without_lock([&] { return of.machine->count(); })); },
          "Counts the path's steps and their identity anew from here. StateError where the card is none of a server.")
      .def(
          "press",
          [](PythonWorld& of, const std::string& button, const When& when, std::int64_t longest_ns) {
            return switch_button(of, &SimulatedMachine::press, button, when, longest_ns);
          },
          "button"_a, nb::kw_only(), "when"_a = nb::none(), "longest_ns"_a = kLongest,
          "Presses a button, and gives the state 20 ms of the card's time later. when: 'X > 40' (mm of a carriage) or, "
          "at "
          "served cards, 'steps > 2000'. Nothing is pressed where that has not come within longest_ns: of the card's "
          "time in this process (TimeoutError), of real time at a server (LinkError).")
      .def(
          "release",
          [](PythonWorld& of, const std::string& button, const When& when, std::int64_t longest_ns) {
            return switch_button(of, &SimulatedMachine::release, button, when, longest_ns);
          },
          "button"_a, nb::kw_only(), "when"_a = nb::none(), "longest_ns"_a = kLongest, "As press().");
  card.def_prop_ro("world", world_of, "Cards of simulate_in_world(): the machine behind the pins.");
  m.def("open_world",
        waiting([](const std::string& url) -> PythonWorld { return {bindings::open_served_machine(url)}; }), "url"_a,
        "The machine behind a card of `trammel serve --world`, beside the program that moves the card. Without a token "
        "in "
        "the URL nothing can be pressed. LinkError where no server with a machine is there.");
  m.def("simulate_in_world", simulate_in_world, "world_file"_a = nb::none(), "axes"_a = 4, "clock_hz"_a = 1'000'000,
        "A simulated card with a machine behind its pins; None: the built-in one, which fits "
        "examples/first-machine.toml.");
}

}  // namespace trammel::python
