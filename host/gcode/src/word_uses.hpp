// Checks that each word of a line belongs to another word that uses it. Internal to the reader.
#pragma once

#include <optional>

#include "problem.hpp"
#include "word_set.hpp"

namespace trammel::gcode {

// Whether the line's axis words are used by something other than a motion: G10, G28, G30, G43.1, G92.
bool uses_axes_otherwise(const WordSet& words);

// Refuses words that no other word uses, words that lack one they need, and words that two others would use. `modal`:
// the motion mode if the line has no motion word.
bool check_uses(const WordSet& words, std::optional<int> modal, Problem& problem);

}  // namespace trammel::gcode
