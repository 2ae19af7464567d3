// Standard input, output and error, each of which may be closed or full. Not thread-safe.
#pragma once

#include <string_view>

namespace trammel::app {

// Call once, before any file is opened. Occupies the descriptor of each closed stream, so that no other file gets it:
// reading and writing there fails, also by a name such as /dev/stdin.
void hold_standard_descriptors();

// Whether standard input was closed before hold_standard_descriptors().
bool standard_input_is_closed();

// Throws std::runtime_error if standard output does not accept the text. The text may be buffered: see
// finish_standard_streams().
void to_standard_output(std::string_view text);

// Never fails: finish_standard_streams() detects lost text.
void to_standard_error(std::string_view text) noexcept;

// Flushes standard output. Throws std::runtime_error if one of the two streams has not accepted all text.
void finish_standard_streams();

}  // namespace trammel::app
