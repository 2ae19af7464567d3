// A cube root from + - * / alone: the mathematics library's differs between hosts. Internal to the planner; pure.
#pragma once

#include <cstdint>
#include <cstring>

namespace trammel::planner {

// x a normal number above 0; off by 2^-51 of it at most.
inline double cube_root(double x) {
  // A third of the exponent is within 6 % of it; Newton's steps square the error.
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  bits = bits / 3 + (std::uint64_t{0x2A9F} << 48);
  double root = 0;
  std::memcpy(&root, &bits, sizeof root);
  for (int i = 0; i < 5; ++i) root -= (root - x / (root * root)) / 3;
  return root;
}

}  // namespace trammel::planner
