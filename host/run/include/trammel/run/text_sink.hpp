// Where the text of a run goes: a file, a pipe, a string.
#pragma once

#include <string_view>

namespace trammel::run {

class TextSink {
 public:
  virtual ~TextSink() = default;
  // Throws when the destination does not take all of it.
  virtual void write(std::string_view text) = 0;
};

}  // namespace trammel::run
