// Numbers of the parameters that keep a program's offsets, as in LinuxCNC. Each "place" is nine parameters from the
// given number on: the axes X Y Z A B C U V W, in mm or degrees.
#pragma once

namespace trammel::gcode::parameter {

inline constexpr int kHome = 5161;          // a place: the target of G28
inline constexpr int kSecondHome = 5181;    // a place: the target of G30
inline constexpr int kShifted = 5210;       // 1 while G92 is in force, else 0
inline constexpr int kShift = 5211;         // a place: the offset of G92
inline constexpr int kSystem = 5220;        // the coordinate system in force, 1: G54 .. 9: G59.3
inline constexpr int kFirstSystem = 5221;   // a place: the zero of G54
inline constexpr int kBetweenSystems = 20;  // from the first number of one system to that of the next

}  // namespace trammel::gcode::parameter
