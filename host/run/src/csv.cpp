#include "csv.hpp"

#include <charconv>

namespace trammel::run {
namespace {

constexpr std::size_t kFlushAt = 1U << 16U;
constexpr std::size_t kLongestNumber = 24;

}  // namespace

CsvWriter::CsvWriter(TextSink& out, const char* header) : out_(out), buffer_(header) { buffer_ += '\n'; }

void CsvWriter::row(std::initializer_list<std::int64_t> values) {
  char separator = 0;
  for (const std::int64_t value : values) {
    if (separator != 0) buffer_ += separator;
    separator = ',';
    char digits[kLongestNumber];
    buffer_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
  }
  buffer_ += '\n';
  if (buffer_.size() > kFlushAt) finish();
}

void CsvWriter::finish() {
  out_.write(buffer_);
  buffer_.clear();
}

}  // namespace trammel::run
