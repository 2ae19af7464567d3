#include "trammel/grbl/interpreter.hpp"

#include "trammel/gcode/parameter_numbers.hpp"
#include "trammel/gcode/reader.hpp"
#include "trammel/planner/block_builder.hpp"

namespace trammel::grbl {
namespace {

namespace parameter = gcode::parameter;

constexpr std::string_view kLetters = "XYZABC";

int first_of(int kind) {
  if (kind == 28) return parameter::kHome;
  if (kind == 30) return parameter::kSecondHome;
  if (kind == 92) return parameter::kShift;
  return parameter::kFirstSystem + (kind - 54) * parameter::kBetweenSystems;
}

// Grbl's part of the reader's parameters. All have a value, so the machine file supplies none.
std::map<int, double> whole(const std::map<int, double>& some) {
  std::map<int, double> all;
  const auto take = [&](int number) {
    const auto found = some.find(number);
    all[number] = found == some.end() ? 0 : found->second;
  };
  for (const int kind : {28, 30, 92, 54, 55, 56, 57, 58, 59}) {
    for (int n = 0; n < static_cast<int>(kLetters.size()); ++n) take(first_of(kind) + n);
  }
  take(parameter::kShifted);
  take(parameter::kSystem);
  return all;
}

}  // namespace

void Interpreter::reset() {
  modal_ = {};
  if (parameters_.empty()) {
    const std::string text = "\n";
    gcode::Coordinates place{};
    std::map<int, double> first;
    follow(text, modal_, place, first);
    parameters_ = whole(first);
  }
  parameters_[parameter::kSystem] = 1;
  parameters_[parameter::kShifted] = 0;
  for (int n = 0; n < static_cast<int>(kLetters.size()); ++n) parameters_[parameter::kShift + n] = 0;
}

void Interpreter::set_parameters(const std::map<int, double>& parameters) {
  for (const auto& [number, value] : parameters) {
    if (parameters_.count(number) != 0) parameters_[number] = value;
  }
}

std::string Interpreter::letters() const {
  std::string letters = "XYZ";
  for (const char letter : kLetters.substr(3)) {
    if (machine_.axis(letter)) letters += letter;
  }
  return letters;
}

gcode::Coordinates Interpreter::offset(int kind) const {
  gcode::Coordinates at{};
  for (std::size_t n = 0; n < kLetters.size(); ++n) {
    const auto axis = machine_.axis(kLetters[n]);
    if (axis) at[*axis] = parameters_.at(first_of(kind) + static_cast<int>(n));
  }
  return at;
}

gcode::Coordinates Interpreter::work_offset() const {
  gcode::Coordinates at = offset(modal_.system);
  const gcode::Coordinates shift = offset(92);
  for (std::size_t n = 0; n < at.size(); ++n) at[n] += parameters_.at(parameter::kShifted) != 0 ? shift[n] : 0;
  if (const auto z = machine_.axis('Z')) at[*z] += modal_.tool_length;
  return at;
}

// Reads the line with the project's reader and returns the new position and offsets.
Status Interpreter::follow(const std::string& text, const Modal& modal, gcode::Coordinates& place,
                           std::map<int, double>& parameters) const {
  const std::string whole_text = preamble(modal) + text;
  gcode::TextLines lines(whole_text, "line");
  gcode::ReaderOptions options;
  options.parameters = parameters_;
  gcode::Reader reader(lines, machine_, place_, options);
  gcode::Motion motion;
  while (reader.next(motion)) place = motion.target;
  if (reader.awaits_probe()) {
    reader.assume_probed();
    while (reader.next(motion)) {
    }
  }
  if (reader.error()) return status_of(reader.error()->code);
  parameters = reader.parameters();
  return Status::kOk;
}

Status Interpreter::check_limits(const std::string& text) const {
  const std::string whole_text = preamble(modal_) + text;
  gcode::TextLines lines(whole_text, "line");
  gcode::ReaderOptions options;
  options.parameters = parameters_;
  gcode::Reader reader(lines, machine_, place_, options);
  planner::BlockBuilder blocks(reader, machine_, card_, place_);
  planner::Block block;
  while (blocks.next(block)) {
  }
  if (blocks.at_probe()) {
    blocks.begin_probe();
    while (blocks.next(block)) {
    }
  }
  return blocks.error() ? status_of(blocks.error()->code) : Status::kOk;
}

Status Interpreter::read(std::string_view line, Block& block) {
  if (const Status status = parse_block(line, modal_, letters(), block); status != Status::kOk) return status;
  gcode::Coordinates place = place_;
  std::map<int, double> parameters;
  if (const Status status = follow(block.text, modal_, place, parameters); status != Status::kOk) return status;
  if (block.moves) {
    if (const Status status = check_limits(block.text); status != Status::kOk) return status;
  }
  place_ = place;
  parameters_ = whole(parameters);
  modal_ = block.after;
  parameters_[parameter::kSystem] = modal_.system - 53;
  return Status::kOk;
}

Status Interpreter::read_jog(std::string_view line, Block& block) {
  if (const Status status = parse_jog(line, modal_, letters(), block); status != Status::kOk) return status;
  gcode::Coordinates place = place_;
  std::map<int, double> parameters;
  if (const Status status = follow(block.text, modal_, place, parameters); status != Status::kOk) return status;
  if (const Status status = check_limits(block.text); status != Status::kOk) return status;
  place_ = place;
  return Status::kOk;
}

}  // namespace trammel::grbl
