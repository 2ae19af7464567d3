// Destination of a run's text output: a file, a pipe, a string.
#pragma once

#include <string_view>

namespace trammel::run {

class TextSink {
 public:
  virtual ~TextSink() = default;
  // Throws if the destination does not accept all of the text.
  virtual void write(std::string_view text) = 0;
};

}  // namespace trammel::run
