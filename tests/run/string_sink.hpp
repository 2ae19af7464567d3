// Text of a run in a string, for tests.
#pragma once

#include <string>

#include "trammel/run/text_sink.hpp"

namespace trammel::run {

class StringSink final : public TextSink {
 public:
  void write(std::string_view more) override { text += more; }
  std::string text;
};

}  // namespace trammel::run
