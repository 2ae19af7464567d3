// Whether each word of a line has one that uses it. Internal to the reader.
#pragma once

#include <optional>

#include "problem.hpp"
#include "word_set.hpp"

namespace trammel::gcode {

// Whether the line's axis words belong to something else than a motion: G10, G28, G30, G43.1, G92.
bool uses_axes_otherwise(const WordSet& words);

// `modal`: the motion that holds where the line has no motion word. Words that no other would use are refused, as are
// those that lack one, and words that two would use.
bool check_uses(const WordSet& words, std::optional<int> modal, Problem& problem);

}  // namespace trammel::gcode
