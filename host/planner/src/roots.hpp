// A cube root from + - * / alone, because that of the mathematics library differs between hosts. Internal to the
// planner; pure.
#pragma once

#include <cstdint>
#include <cstring>

namespace trammel::planner {

// x: a normal number above 0. Error at most 2^-51 of the result.
inline double cube_root(double x) {
  // A third of the exponent gives the root within 6 %; each of Newton's steps squares the error.
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  bits = bits / 3 + (std::uint64_t{0x2A9F} << 48);
  double root = 0;
  std::memcpy(&root, &bits, sizeof root);
  for (int i = 0; i < 5; ++i) root -= (root - x / (root * root)) / 3;
  return root;
}

}  // namespace trammel::planner
