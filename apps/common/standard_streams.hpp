// Standard input, output and error, each of which may be closed or full. Not thread-safe.
#pragma once

#include <string_view>

namespace trammel::app {

// Call once, before any file is opened. Takes the place of each of the three streams that is closed, so that no other
// file gets its descriptor: reading and writing there fails, also by a name such as /dev/stdin.
void hold_standard_descriptors();

// Whether standard input was closed before hold_standard_descriptors().
bool standard_input_is_closed();

// Throws std::runtime_error when standard output does not take the text. It may be buffered: see
// finish_standard_streams().
void to_standard_output(std::string_view text);

// Never fails: a lost text is found by finish_standard_streams().
void to_standard_error(std::string_view text) noexcept;

// Flushes standard output. Throws std::runtime_error when one of the two has not taken all that was printed.
void finish_standard_streams();

}  // namespace trammel::app
