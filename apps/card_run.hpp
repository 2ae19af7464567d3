// Runs a program on a card outside this process: no pin is seen here, so what is told is what the card says.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "program_run.hpp"
#include "trammel/driver/card.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/transport/connection.hpp"

namespace trammel::app {

struct CardRunResult {
  std::string card;  // its URL
  std::string axes;  // letters in the card's order
  run::Plan plan;
  run::Outcome outcome;
  std::vector<double> final_millimetres;
  bool joint_for_each_axis = true;  // no motor moves two axes
  std::uint32_t clock_hz = 0;
  double seconds = 0;  // of card time, from the first access to the end
  ProfileReport profile;
  driver::FrameBus::Counts link;  // zeros where it does not go by frames
  std::uint64_t reconnections = 0;
};

// The program begins where the card stands. `options`: those that need no pins. Errors as of run_program().
CardRunResult run_on_card(const run::ProgramLines& lines, const machine::Machine& machine, driver::Card& card,
                          transport::Connection& connection, const RunOptions& options);

std::string summary(const CardRunResult& result);
std::string json_text(const CardRunResult& result);

}  // namespace trammel::app
