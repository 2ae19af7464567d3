#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "trammel/bindings/simulated_machine.hpp"
#include "trammel/driver/errors.hpp"

namespace trammel::bindings {
namespace {

using Json = nlohmann::json;

WorldAxis axis_of(const Json& json) {
  WorldAxis axis;
  const auto letter = json.at("axis").get<std::string>();
  axis.letter = letter.empty() ? '?' : letter[0];
  axis.carriage_mm = json.at("carriage_mm").get<double>();
  axis.commanded_mm = json.at("commanded_mm").get<double>();
  axis.carriage = json.at("carriage").get<std::int64_t>();
  axis.commanded = json.at("commanded").get<std::int64_t>();
  axis.lost = json.at("lost").get<std::int64_t>();
  axis.powered = json.at("powered").get<bool>();
  return axis;
}

WorldContact contact_of(const Json& json, bool is_button) {
  WorldContact contact;
  contact.name = json.at("name").get<std::string>();
  if (json.at("input").is_number()) contact.input = json.at("input").get<unsigned>();
  contact.is_button = is_button;
  contact.pressed = json.at("pressed").get<bool>();
  return contact;
}

}  // namespace

WorldState parse_world_state(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    WorldState state;
    state.time_s = json.at("time_s").get<double>();
    for (const Json& axis : json.at("axes")) state.axes.push_back(axis_of(axis));
    for (const Json& one : json.at("switches")) state.contacts.push_back(contact_of(one, false));
    for (const Json& one : json.at("buttons")) state.contacts.push_back(contact_of(one, true));
    state.inputs = json.at("inputs").get<std::uint32_t>();
    state.emergency_stop = json.at("emergency_stop").get<bool>();
    return state;
  } catch (const Json::exception& error) {
    throw driver::LinkError(fmt::format("the state of the machine cannot be read: {}", error.what()));
  }
}

}  // namespace trammel::bindings
