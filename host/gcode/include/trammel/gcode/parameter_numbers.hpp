// Numbers of the parameters that keep a program's offsets, as LinuxCNC has them. From each number of a place on, values
// follow for the axes X Y Z A B C U V W, in mm or degrees.
#pragma once

namespace trammel::gcode::parameter {

inline constexpr int kHome = 5161;          // a place: where G28 goes
inline constexpr int kSecondHome = 5181;    // a place: where G30 goes
inline constexpr int kShifted = 5210;       // 1 while G92 is in force, else 0
inline constexpr int kShift = 5211;         // a place: G92
inline constexpr int kSystem = 5220;        // the coordinate system in force, 1: G54 .. 9: G59.3
inline constexpr int kFirstSystem = 5221;   // a place: the zero of G54
inline constexpr int kBetweenSystems = 20;  // from one system's first number to the next one's

}  // namespace trammel::gcode::parameter
