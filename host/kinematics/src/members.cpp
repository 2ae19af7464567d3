#include "members.hpp"

#include <algorithm>
#include <stdexcept>

namespace trammel::kinematics {
namespace {

using machine::Machine;
using machine::MachineAxis;

Joint joint_of(const MachineAxis& axis, std::size_t index) {
  Joint joint;
  joint.steps_per_mm = axis.steps_per_mm;
  joint.terms[0] = {static_cast<std::uint8_t>(index), 1};
  joint.term_count = 1;
  joint.settings = static_cast<std::uint8_t>(index);
  joint.inverted = axis.inverted;
  return joint;
}

Layout::Inverse same(std::size_t joint) { return {{{{static_cast<std::uint8_t>(joint), 1}, {}}}, 1}; }

// One joint per axis, with the axis's number.
Layout cartesian(const Machine& machine) {
  Layout layout;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    layout.joints.push_back(joint_of(machine.axes[i], i));
    layout.inverse.push_back(same(i));
  }
  return layout;
}

// A = X + Y, B = X - Y; so X = (A + B) / 2, Y = (A - B) / 2.
Layout corexy(const Machine& machine) {
  Layout layout = cartesian(machine);
  const auto x = static_cast<std::uint8_t>(*machine.axis('X'));
  const auto y = static_cast<std::uint8_t>(*machine.axis('Y'));
  layout.joints[x].terms = {{{x, 1}, {y, 1}}};
  layout.joints[y].terms = {{{x, 1}, {y, -1}}};
  layout.inverse[x] = {{{{x, 0.5}, {y, 0.5}}}, 2};
  layout.inverse[y] = {{{{x, 0.5}, {y, -0.5}}}, 2};
  for (const std::uint8_t joint : {x, y}) {
    layout.joints[joint].term_count = 2;
    layout.joints[joint].limits = machine.kinematics.motor;
  }
  return layout;
}

struct Member {
  std::string_view name;
  Layout (*layout)(const Machine& machine);
};

// One member per name in machine::kKinematics.
constexpr std::array<Member, machine::kKinematics.size()> kMembers{{{"cartesian", cartesian}, {"corexy", corexy}}};

}  // namespace

Layout layout_in_pulses(std::size_t axes) {
  MachineAxis axis;
  axis.steps_per_mm = 1;
  Machine machine;
  machine.axes.assign(axes, axis);
  return cartesian(machine);
}

Layout layout_of(const Machine& machine) {
  const auto* const member = std::find_if(kMembers.begin(), kMembers.end(),
                                          [&](const Member& m) { return m.name == machine.kinematics.name; });
  if (member == kMembers.end()) throw std::invalid_argument("no kinematics " + machine.kinematics.name);
  Layout layout = member->layout(machine);
  // Second motors come in the order of their axes. No belt couples these axes (machine_checks.cpp).
  for (const std::size_t axis : machine.second_motors()) {
    Joint second = layout.joints[axis];
    second.inverted = machine.axes[axis].second_inverted;
    layout.joints.push_back(second);
  }
  return layout;
}

}  // namespace trammel::kinematics
