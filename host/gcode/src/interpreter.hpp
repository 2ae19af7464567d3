// Modal state of a G-code program, and the execution of blocks. Internal to the reader.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "block.hpp"
#include "trammel/gcode/reader.hpp"

namespace trammel::gcode {

class Interpreter {
 public:
  Interpreter(const machine::Machine& machine, Program& program);

  // Appends the block's motions. Throws WordError. False: the program ended with this block.
  bool execute(const Block& block, std::size_t line);
  void end(std::size_t line);

 private:
  enum class FeedMode { kPerMinute, kInverseTime };
  struct Plane {
    char first;
    char second;
    char first_offset;
    char second_offset;
    char unused_offset;
  };

  void set_feed(const Block& block);
  void set_modes(const Block& block);
  void dwell(const Block& block);
  void go_home(const Block& block);
  void set_origin(const Block& block);
  void move(const Block& block);
  void straight(const Block& block, bool rapid);
  void arc(const Block& block, bool clockwise);
  void check_leftovers(const Block& block) const;

  bool is_rotary(std::size_t axis) const;
  double to_mm(std::size_t axis, double value) const;
  double offset(std::size_t axis) const;
  Coordinates target_of(const Block& block) const;
  void append(Motion motion);
  void set_speed(const Block& block, Motion& motion) const;
  std::size_t plane_axis(char letter) const;
  void check_plane_words(const Block& block, const Plane& plane) const;

  const machine::Machine& machine_;
  Program& program_;
  std::size_t line_ = 0;
  Coordinates here_{};    // machine coordinates
  Coordinates origin_{};  // G92
  std::size_t coordinate_system_ = 0;
  std::optional<int> motion_;  // code in tenths; none under G80
  int plane_ = 170;
  bool inches_ = false;
  bool absolute_ = true;
  std::optional<bool> extruder_absolute_;  // none until M82 or M83
  bool centre_absolute_ = false;
  FeedMode feed_mode_ = FeedMode::kPerMinute;
  std::optional<double> feed_;  // as written, units or 1 a minute
  bool feed_in_inches_ = false;
};

}  // namespace trammel::gcode
