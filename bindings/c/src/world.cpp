// The simulated machine behind a card.
#include <algorithm>

#include "handle.hpp"
#include "trammel_machine.h"

struct trammel_world {
  std::unique_ptr<trammel::bindings::SimulatedMachine> machine;
};

namespace trammel::c {

static_assert(TRAMMEL_MAX_CONTACTS == world::kMostInputs + 1);

namespace {

trammel_world_axis c_axis(const bindings::WorldAxis& axis) {
  return {axis.letter, axis.carriage_mm, axis.commanded_mm, axis.carriage, axis.commanded, axis.lost, axis.powered};
}

trammel_world_contact c_contact(const bindings::WorldContact& contact) {
  trammel_world_contact out{};
  out.name[contact.name.copy(out.name, sizeof(out.name) - 1)] = '\0';
  out.input = contact.input ? static_cast<std::int32_t>(*contact.input) : -1;
  out.is_button = contact.is_button;
  out.pressed = contact.pressed;
  return out;
}

trammel_world_state c_state(const bindings::WorldState& state) {
  if (state.axes.size() > TRAMMEL_MAX_AXES || state.contacts.size() > TRAMMEL_MAX_CONTACTS) {
    throw driver::LinkError("the machine has more axes or contacts than any");
  }
  trammel_world_state out{};
  out.time_s = state.time_s;
  out.axis_count = static_cast<std::uint32_t>(state.axes.size());
  out.contact_count = static_cast<std::uint32_t>(state.contacts.size());
  std::transform(state.axes.begin(), state.axes.end(), out.axes, c_axis);
  std::transform(state.contacts.begin(), state.contacts.end(), out.contacts, c_contact);
  out.inputs = state.inputs;
  out.emergency_stop = state.emergency_stop;
  return out;
}

using Press = std::string (bindings::SimulatedMachine::*)(const std::string&, const std::string&,
                                                          std::chrono::nanoseconds);

trammel_result press(trammel_world* world, Press which, const char* button, const char* when, std::int64_t longest_ns,
                     trammel_world_state* state) {
  return guarded([=] {
    bindings::SimulatedMachine& machine = *required(world, "world").machine;
    const std::string name = &required(button, "button");
    if (longest_ns < 1) throw driver::ArgumentError("longest_ns is 1 or more");
    const auto now = (machine.*which)(name, when == nullptr ? "" : when, std::chrono::nanoseconds(longest_ns));
    if (state != nullptr) *state = c_state(bindings::parse_world_state(now));
  });
}

}  // namespace
}  // namespace trammel::c

using namespace trammel::c;
namespace driver = trammel::driver;
namespace bindings = trammel::bindings;

trammel_result trammel_world_of_card(trammel_card* card, trammel_world** world) {
  return guarded([=] {
    required(world, "world") = nullptr;
    const auto& behind = required(card, "card").world;
    if (!behind)
      throw driver::StateError("no machine is simulated behind this card: trammel_open_in_world() makes one");
    *world = new trammel_world{bindings::machine_of(behind)};
  });
}

trammel_result trammel_open_world(const char* url, trammel_world** world) {
  return guarded([=] {
    required(world, "world") = nullptr;
    *world = new trammel_world{bindings::open_served_machine(&required(url, "url"))};
  });
}

void trammel_close_world(trammel_world* world) { delete world; }

trammel_result trammel_read_world(trammel_world* world, trammel_world_state* state) {
  return guarded([=] {
    bindings::SimulatedMachine& machine = *required(world, "world").machine;
    required(state, "state") = c_state(bindings::parse_world_state(machine.read()));
  });
}

trammel_result trammel_press(trammel_world* world, const char* button, const char* when, int64_t longest_ns,
                             trammel_world_state* state) {
  return press(world, &bindings::SimulatedMachine::press, button, when, longest_ns, state);
}

trammel_result trammel_release(trammel_world* world, const char* button, const char* when, int64_t longest_ns,
                               trammel_world_state* state) {
  return press(world, &bindings::SimulatedMachine::release, button, when, longest_ns, state);
}
