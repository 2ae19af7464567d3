// A sink that stores the written text.
#pragma once

#include <string>
#include <string_view>

#include "trammel/run/text_sink.hpp"

namespace trammel::report {

class Text final : public run::TextSink {
 public:
  void write(std::string_view text) override { all += text; }
  std::string all;
};

}  // namespace trammel::report
