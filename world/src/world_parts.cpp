// Construction of a World from its description.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

#include "trammel/world/world.hpp"

namespace trammel::world {

namespace {

constexpr unsigned kCardAxes = 8;

[[noreturn]] void refuse_part(const std::string& text) { throw std::invalid_argument(text); }

std::uint64_t clocks_at(std::uint64_t nanoseconds, std::uint32_t clock_hz) {
  constexpr std::uint64_t kSecond = 1'000'000'000;
  return nanoseconds / kSecond * clock_hz + nanoseconds % kSecond * clock_hz / kSecond;
}

// Adds the part's name to an exception of its constructor.
template <class Make>
auto named(const std::string& name, Make make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    refuse_part(fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace

std::string alarm_name(char letter) {
  return std::string(1, static_cast<char>(std::tolower(static_cast<unsigned char>(letter)))) + "_alarm";
}

World::World(const Description& description, std::uint32_t clock_hz)
    : clock_hz_(clock_hz), closed_level_(description.closed_level) {
  if (clock_hz == 0) refuse_part("a world's card has a clock of 1 Hz or more");
  step_clocks_ = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(Motor::kLongestStep * clock_hz));
  const double step = static_cast<double>(step_clocks_) / clock_hz;
  parts_ = static_cast<unsigned>(std::ceil(step / Motor::kLongestStep * (1 - 1e-9)));
  part_ = step / parts_;
  add_contacts(description);
  add_axes(description);
  add_events(description);
  show_pins();
}

void World::add_axes(const Description& description) {
  unsigned taken = 0;
  for (const AxisDescription& axis : description.axes) {
    const std::string name = fmt::format("axis {}", axis.letter);
    if (axis.card_axis >= kCardAxes) refuse_part(fmt::format("{}: a card has axes 0 to {}", name, kCardAxes - 1));
    if ((taken >> axis.card_axis & 1U) != 0) {
      refuse_part(fmt::format("{}: axis {} of the card moves another carriage", name, axis.card_axis));
    }
    taken |= 1U << axis.card_axis;
    const auto alarm = std::find_if(buttons_.begin(), buttons_.end(), [&](const Button& button) {
      return button.description.name == alarm_name(axis.letter);
    });
    if (axis.alarm_at && (alarm == buttons_.end() || !(*axis.alarm_at > 0))) {
      refuse_part(fmt::format("{}: a drive that watches its motor has a button {}, and a lag above 0 full steps", name,
                              alarm_name(axis.letter)));
    }
    watches_ = watches_ || axis.alarm_at;
    const std::size_t button = alarm == buttons_.end() ? kNone : static_cast<std::size_t>(alarm - buttons_.begin());
    axes_.push_back({axis, named(name, [&] { return Carriage(axis.carriage); }), button});
  }
}

void World::add_contacts(const Description& description) {
  std::uint64_t seed = description.seed;
  for (const SwitchDescription& one : description.switches) {
    const std::string name = fmt::format("switch {}", one.name);
    if (one.axis >= description.axes.size() || one.hysteresis < 0) {
      refuse_part(fmt::format("{}: it needs an axis of the world, and a way of 0 or more to its release", name));
    }
    wire(name, one.input);
    Switch made{one, named(name, [&] { return Contact(one.contact, clock_hz_, ++seed); })};
    if (made.pressed_at(0)) made.contact.begin_pressed();
    switches_.push_back(made);
  }
  for (const ButtonDescription& button : description.buttons) {
    const std::string name = fmt::format("button {}", button.name);
    const auto same = [&](const auto& other) { return other.description.name == button.name; };
    if (std::any_of(buttons_.begin(), buttons_.end(), same) || std::any_of(switches_.begin(), switches_.end(), same)) {
      refuse_part(name + ": another one has that name");
    }
    if (button.input) wire(name, *button.input);
    if (!button.input && has_emergency_stop_) refuse_part(name + ": the emergency stop's pin has another button");
    has_emergency_stop_ = has_emergency_stop_ || !button.input;
    if (!(button.power_delay >= 0)) refuse_part(name + ": power goes 0 s or more after the press");
    buttons_.push_back({button, named(name, [&] { return Contact(button.contact, clock_hz_, ++seed); })});
  }
}

void World::add_events(const Description& description) {
  for (const Event& event : description.events) {
    events_.push_back({clocks_at(event.nanoseconds, clock_hz_), find_button(event.button), event.press});
  }
  std::stable_sort(events_.begin(), events_.end(), [](const Due& a, const Due& b) { return a.clock < b.clock; });
}

void World::wire(const std::string& name, unsigned input) {
  if (input >= kMostInputs) refuse_part(fmt::format("{}: inputs are 0 to {}", name, kMostInputs - 1));
  const std::uint32_t pin = std::uint32_t{1} << input;
  if ((wired_ & pin) != 0) refuse_part(fmt::format("{}: something else is wired to input {}", name, input));
  wired_ |= pin;
}

std::size_t World::find_button(const std::string& name) const {
  std::vector<std::string> names;
  for (std::size_t n = 0; n < buttons_.size(); ++n) {
    if (buttons_[n].description.name == name) return n;
    names.push_back(buttons_[n].description.name);
  }
  if (names.empty()) refuse_part(fmt::format("{}: the world has no buttons", name));
  refuse_part(fmt::format("{}: no such button: {}", name, fmt::join(names, ", ")));
}

bool World::pressed(const std::string& button_or_switch) const {
  for (const Switch& one : switches_) {
    if (one.description.name == button_or_switch) return one.contact.pressed();
  }
  return buttons_[find_button(button_or_switch)].contact.pressed();
}

std::vector<std::string> World::pressed() const {
  std::vector<std::string> names;
  const auto add = [&](const auto& part) {
    if (part.contact.pressed()) names.push_back(part.description.name);
  };
  std::for_each(switches_.begin(), switches_.end(), add);
  std::for_each(buttons_.begin(), buttons_.end(), add);
  return names;
}

std::vector<World::ContactState> World::contacts() const {
  std::vector<ContactState> states;
  for (const Switch& one : switches_) {
    states.push_back({one.description.name, one.description.input, false, one.contact.pressed()});
  }
  for (const Button& button : buttons_) {
    states.push_back({button.description.name, button.description.input, true, button.contact.pressed()});
  }
  return states;
}

}  // namespace trammel::world
