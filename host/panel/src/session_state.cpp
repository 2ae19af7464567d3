// The session's messages: JSON in and out.
#include <cmath>
#include <nlohmann/json.hpp>

#include "request.hpp"
#include "trammel/panel/session.hpp"
#include "trammel/panel/texts.hpp"

namespace trammel::panel {
namespace {

using nlohmann::json;

bool is_rotary(char letter) { return letter >= 'A' && letter <= 'C'; }

// Rounded to 0.1 um: the page shows three decimals.
double rounded(double value) { return std::round(value * 1e4) / 1e4; }

json finite(double value) { return std::isfinite(value) ? json(value) : json(); }

const char* name_of(Program::Phase phase) {
  switch (phase) {
    case Program::Phase::kNone:
      return "none";
    case Program::Phase::kLoading:
      return "loading";
    case Program::Phase::kReady:
      return "ready";
    case Program::Phase::kChecking:
      return "checking";
    case Program::Phase::kRunning:
      return "running";
    case Program::Phase::kDone:
      return "done";
    case Program::Phase::kStopped:
      return "stopped";
  }
  return "";
}

}  // namespace

std::optional<PanelSession::Request> PanelSession::Request::parse(std::string_view message) {
  const json read = json::parse(message, nullptr, false);
  if (!read.is_object()) return std::nullopt;
  Request request;
  try {
    request.what = read.at("do").get<std::string>();
    request.clock = read.value("clock", std::int64_t{0});
    request.id = read.value("id", std::uint64_t{0});
    request.axis = read.value("axis", std::size_t{0});
    request.way = read.value("way", 0);
    request.step = read.value("step", 0.0);
    request.percent = read.value("percent", 0.0);
    request.change = read.value("change", 0);
    request.hold = read.value("hold", true);
    request.text = read.value("text", std::string());
  } catch (const json::exception&) {
    return std::nullopt;
  }
  return request;
}

std::string PanelSession::hello() const {
  const machine::Machine& machine = machine_.machine();
  json axes = json::array();
  for (const machine::MachineAxis& axis : machine.axes) {
    const bool rotary = is_rotary(axis.letter);
    axes.push_back({{"letter", std::string(1, axis.letter)},
                    {"unit", rotary ? "\u00b0" : "mm"},
                    {"max_velocity_per_min", axis.max_velocity * 60},
                    {"speed_unit", rotary ? "\u00b0/min" : "mm/min"},
                    {"homes", axis.homing.has_value()}});
  }
  return json{{"hello", {{"axes", axes}, {"can_home", machine_.can_home()}, {"hold_when_gone", hold_when_gone_}}}}.dump(
      -1, ' ', false, json::error_handler_t::replace);
}

std::string PanelSession::state(std::uint64_t& told) {
  const grbl::Report report = controller_.report_now();
  const grbl::Live live = machine_.look();
  const machine::Machine& machine = machine_.machine();
  const gcode::Coordinates offset = controller_.interpreter().work_offset();
  json axes = json::array();
  for (std::size_t n = 0; n < machine.axes.size(); ++n) {
    axes.push_back({{"machine", rounded(live.at[n])},
                    {"work", rounded(live.at[n] - offset[n])},
                    {"min", finite(machine.axes[n].min)},
                    {"max", finite(machine.axes[n].max)},
                    {"at_switch", (live.limits >> n & 1U) != 0}});
  }
  json state{{"clock", milliseconds()},
             {"state", report.state},
             {"axes", axes},
             {"homed", homed_},
             {"speed_mm_per_min", std::round(live.speed)},
             {"probe", live.probe},
             {"feed_override_percent", report.feed_override},
             {"rapid_override_percent", report.rapid_override},
             {"jog", jog_ ? jog_->id : 0},
             {"jog_taken", last_jog_},
             {"hold_when_gone", hold_when_gone_},
             {"alarm", nullptr},
             {"program",
              {{"phase", name_of(program_.phase())},
               {"name", program_.name()},
               {"version", program_.version()},
               {"lines", program_.lines()},
               {"line", line_},
               {"stop_reason", program_.stop_reason()}}}};
  if (controller_.state() == grbl::State::kAlarm) {
    const bool locked = alarm_.number == 0 && !alarm_.reason.empty();
    state["alarm"] = {
        {"number", alarm_.number}, {"text", locked ? "Locked" : alarm_text(alarm_.number)}, {"reason", alarm_.reason}};
  }
  json notes = json::array();
  for (const Note& note : notes_) {
    if (note.number > told) notes.push_back({{"error", note.error}, {"text", note.text}});
  }
  told = noted_;
  if (!notes.empty()) state["notes"] = notes;
  return json{{"state", state}}.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace trammel::panel
