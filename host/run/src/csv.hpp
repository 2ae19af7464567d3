// Rows of whole numbers as CSV. Internal to the recorder.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>

#include "trammel/run/text_sink.hpp"

namespace trammel::run {

class CsvWriter {
 public:
  // `out` must outlive the writer. The header is written with the first rows.
  CsvWriter(TextSink& out, const char* header);
  void row(std::initializer_list<std::int64_t> values);
  // Writes the rest.
  void finish();

 private:
  TextSink& out_;
  std::string buffer_;
};

}  // namespace trammel::run
