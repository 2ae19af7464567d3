// A session on a SlowMachine, and the page that talks to it.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <string>

#include "slow_machine.hpp"
#include "trammel/grbl/settings.hpp"
#include "trammel/panel/session.hpp"

namespace trammel::panel {

using nlohmann::json;
using std::chrono::milliseconds;

class Bench {
 public:
  explicit Bench(bool homed = true) {
    machine.is_homed = homed;
    machine.set_meanwhile([this] { session.serve(); });
    session.begin();
    session.arrived();
  }

  json state() {
    std::uint64_t told = 0;
    return json::parse(session.state(told)).at("state");
  }
  std::string notes() {
    const json now = state();
    return now.contains("notes") ? now["notes"].dump() : "";
  }
  // Sends a message with the present clock, as the page does.
  void send(json message) {
    if (!message.contains("clock")) message["clock"] = state()["clock"];
    session.receive(message.dump());
  }
  void load(const std::string& text) {
    send({{"do", "load"}, {"text", "test.ngc"}});
    send({{"do", "part"}, {"text", text}});
    send({{"do", "loaded"}});
  }
  // A key goes down. held() reports that it is still down.
  void press(std::uint64_t id, double step = 0, int way = 1) {
    send({{"do", "jog"}, {"id", id}, {"axis", 0}, {"way", way}, {"step", step}, {"percent", 50}});
  }
  void held(std::uint64_t id) { send({{"do", "held"}, {"id", id}}); }

  // Works until the machine's clock has advanced by `time`. A motion may end later.
  void work(milliseconds time) {
    const TimePoint end = machine.now + time;
    while (machine.now < end) session.work();
  }
  void settle() {
    for (unsigned n = 0; n < 5; ++n) session.work();
  }
  // Calls `step` once, when the machine's clock has advanced by `time`.
  void after(milliseconds time, std::function<void()> step) {
    const TimePoint due = machine.now + time;
    machine.at_moments = [this, due, step = std::move(step)] {
      if (machine.now < due) return;
      machine.at_moments = nullptr;
      step();
    };
  }
  milliseconds clock() const { return std::chrono::duration_cast<milliseconds>(machine.now.time_since_epoch()); }

  SlowMachine machine;
  grbl::Settings settings{machine.machine(), ""};
  PanelSession session{machine, settings, [this] { return machine.now; }};
};

}  // namespace trammel::panel
