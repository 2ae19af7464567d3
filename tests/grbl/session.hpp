// A sender, a controller, and a simulated machine in memory.
#pragma once

#include <gmock/gmock.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "fake_machine.hpp"
#include "trammel/grbl/controller.hpp"

namespace trammel::grbl {

class Session {
 public:
  explicit Session(const machine::Machine& machine = router(), const std::string& file = "")
      : fake(machine),
        settings(machine, file),
        controller(fake, settings, [this](const std::string& text) { take(text); }) {
    fake.set_meanwhile([this] { controller.serve(); });
  }

  // Powers up and reads the banner.
  Session& begun() {
    controller.begin();
    settle();
    answers();
    return *this;
  }

  // Sends bytes and does not wait for an answer.
  void put(const std::string& bytes) { controller.receive(bytes); }
  // Works until nothing is left to do, or the machine is in a hold.
  void settle() {
    for (unsigned quiet = 0, n = 0; quiet < 3; ++n) {
      if (n > 20'000) throw std::logic_error("the controller does not settle");
      const unsigned before = fake.idle_waits;
      controller.work();
      quiet = fake.idle_waits == before ? 0 : quiet + 1;
    }
  }
  // Answers since the last call, without blank lines.
  std::vector<std::string> answers() { return std::exchange(answers_, {}); }
  // Sends a line and returns all its answers.
  std::vector<std::string> ask(const std::string& line) {
    put(line + "\n");
    settle();
    return answers();
  }
  // Sends a line and returns the last of its answers, normally "ok".
  std::string last(const std::string& line) {
    const std::vector<std::string> all = ask(line);
    return all.empty() ? "" : all.back();
  }
  // The fields of a status report, without '<' and '>'.
  std::vector<std::string> report() {
    const std::vector<std::string> kept = answers();
    put("?");
    const std::string text = answers().at(0);
    answers_ = kept;
    std::vector<std::string> fields{""};
    for (const char c : text.substr(1, text.size() - 2)) {
      if (c == '|') {
        fields.emplace_back();
      } else {
        fields.back() += c;
      }
    }
    return fields;
  }
  std::string state() { return report().front(); }
  // A field by its name, such as "MPos"; "" if the reports do not have it. Some fields are not in every report.
  std::string field(const std::string& name) {
    const bool seldom = name == "WCO" || name == "Ov" || name == "A";
    for (int n = 0; n < (seldom ? 31 : 1); ++n) {
      for (const std::string& text : report()) {
        if (text.rfind(name + ":", 0) == 0) return text.substr(name.size() + 1);
      }
    }
    return "";
  }
  // Steps for the next motions, one per tick.
  template <typename... Steps>
  void script(Steps... steps) {
    (fake.script.emplace_back(steps), ...);
  }

  FakeMachine fake;
  Settings settings;
  Controller controller;

 private:
  void take(const std::string& text) {
    partial_ += text;
    for (std::size_t end = partial_.find("\r\n"); end != std::string::npos; end = partial_.find("\r\n")) {
      if (end > 0) answers_.push_back(partial_.substr(0, end));
      partial_.erase(0, end + 2);
    }
  }

  std::vector<std::string> answers_;
  std::string partial_;
};

}  // namespace trammel::grbl
