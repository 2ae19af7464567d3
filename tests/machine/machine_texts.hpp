// Texts of machine files, and the errors that they cause.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

inline std::string error_of(const std::string& text) {
  try {
    parse_machine(text, "m.toml");
  } catch (const MachineError& error) {
    return error.what();
  }
  return "no error";
}

inline std::string override_error(const std::string& text) {
  Machine machine = default_machine();
  try {
    apply_override(machine, text);
  } catch (const MachineError& error) {
    return error.what();
  }
  return "no error";
}

inline const std::string& defaults() { return default_machine_text(); }

}  // namespace trammel::machine
