// The machine behind a card of `trammel serve --world`.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>

#include <optional>
#include <string>

#include "card.hpp"
#include "trammel/transport/served_world.hpp"
#include "waiting.hpp"

namespace trammel::python {
namespace {

using transport::ServedWorld;

constexpr std::int64_t kLongestNs = 10'000'000'000;

nb::object ask(ServedWorld& world, const std::string& request, std::int64_t longest_ns) {
  const auto longest = std::chrono::duration_cast<std::chrono::milliseconds>(nanoseconds(longest_ns));
  const std::string state = without_lock([&] { return world.request(request, longest); });
  return nb::module_::import_("json").attr("loads")(state);
}

nb::object switch_button(ServedWorld& world, const std::string& how, const std::string& name,
                         const std::optional<std::string>& when, std::int64_t longest_ns) {
  return ask(world, how + " " + name + (when ? " when " + *when : ""), longest_ns);
}

}  // namespace

void bind_world(nb::module_& m) {
  nb::class_<ServedWorld>(
      m, "ServedWorld",
      "The machine behind a card of `trammel serve --world`, beside the program that moves the card: what it is like, "
      "and its buttons. Its methods give the state, as `trammel world --json` has it. One thread at a time.")
      .def("__init__", waiting([](ServedWorld* place, const std::string& url) {
             new (place) ServedWorld(transport::parse_card_url(url));
           }),
           "url"_a,
           "Connects to a server's URL. Without a token in it nothing can be pressed. LinkError where no server with a "
           "world is there.")
      .def(
          "state", [](ServedWorld& world) { return ask(world, "state", kLongestNs); },
          "Carriages (mm and pulses), switches, buttons, levels of the pins, and the path that was stepped.")
      .def(
          "press",
          [](ServedWorld& world, const std::string& button, const std::optional<std::string>& when,
             std::int64_t longest_ns) { return switch_button(world, "press", button, when, longest_ns); },
          "button"_a, nb::kw_only(), "when"_a = nb::none(), "longest_ns"_a = kLongestNs,
          "Presses a button, and gives the state 20 ms of the card's time later. when: 'X > 40' (a carriage has come "
          "there, mm) or 'steps > 2000'. LinkError where no answer has come for longest_ns of real time.")
      .def(
          "release",
          [](ServedWorld& world, const std::string& button, const std::optional<std::string>& when,
             std::int64_t longest_ns) { return switch_button(world, "release", button, when, longest_ns); },
          "button"_a, nb::kw_only(), "when"_a = nb::none(), "longest_ns"_a = kLongestNs, "As press().")
      .def(
          "count", [](ServedWorld& world) { return ask(world, "count", kLongestNs); },
          "Counts the path's steps and their identity anew from here.");
}

}  // namespace trammel::python
