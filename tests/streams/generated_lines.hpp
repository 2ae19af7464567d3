// Generates a program of any length line by line, without storing it: lines, rapids, arcs, full circles and dwells,
// with end points in a cube of 160 mm. The same count and seed give the same program.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "trammel/gcode/line_source.hpp"

namespace trammel::streams {

class GeneratedLines final : public gcode::LineSource {
 public:
  explicit GeneratedLines(std::uint64_t count, std::uint64_t seed = 1)
      : name_("generated:" + std::to_string(count)), left_(count), state_(seed) {}

  bool next(std::string_view& line) override {
    if (left_ == 0) return false;
    --left_;
    length_ = 0;
    if (first_)
      write("G21 G90 G17 G94 F3000");
    else
      write_line();
    first_ = false;
    line = {text_, length_};
    return true;
  }
  const std::string& name() const override { return name_; }

 private:
  // xorshift64*: the same on every host.
  std::uint64_t random(std::uint64_t below) {
    state_ ^= state_ >> 12;
    state_ ^= state_ << 25;
    state_ ^= state_ >> 27;
    return ((state_ * 2685821657736338717U) >> 33) % below;
  }

  template <typename... Values>
  void write(const char* format, Values... values) {
    length_ += static_cast<std::size_t>(std::snprintf(text_ + length_, sizeof text_ - length_, format, values...));
  }

  // A coordinate from -80.000 to 80.000 in steps of 0.001.
  void word(char letter) {
    const auto thousandths = static_cast<unsigned>(random(80'001));
    write(" %c%s%u.%03u", letter, random(2) == 0 ? "-" : "", thousandths / 1000, thousandths % 1000);
  }

  void write_line() {
    const std::uint64_t kind = random(100);
    if (kind < 8) {
      write("G0");
    } else if (kind < 20) {
      write(kind < 14 ? "G2" : "G3");  // R exceeds half of the largest distance (113 mm)
      word('X');
      word('Y');
      write(" R%u.5", 115 + static_cast<unsigned>(random(400)));
      return;
    } else if (kind < 25) {
      // Two statements, because the compiler chooses the order in which it evaluates arguments.
      write("G2 I%u.25", 1 + static_cast<unsigned>(random(20)));
      write(" J%u.125", 1 + static_cast<unsigned>(random(20)));
      return;
    } else if (kind < 26) {
      write("G4 P0.%03u", static_cast<unsigned>(random(1000)));
      return;
    } else {
      write("G1");
      if (kind < 40) write(" F%u", 60 + static_cast<unsigned>(random(6000)));
    }
    word('X');
    word('Y');
    if (kind % 4 == 0) word('Z');
  }

  std::string name_;
  std::uint64_t left_;
  std::uint64_t state_;
  bool first_ = true;
  char text_[96] = {};
  std::size_t length_ = 0;
};

}  // namespace trammel::streams
