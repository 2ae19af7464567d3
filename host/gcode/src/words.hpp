// Words of one line of G-code. Internal to the reader.
#pragma once

#include <string_view>

#include "parameters.hpp"
#include "problem.hpp"

namespace trammel::gcode {

struct Word {
  char letter;            // upper case
  double value;           // finite
  std::string_view text;  // as written, for messages
  bool later = false;     // the value depends on a probe that has not run yet
  bool bare = false;      // a letter without a number: its value is 0
};

// Gives the words of a line one by one, without comments. Numbers are decimal, without exponent, and become the nearest
// double whatever the locale and the host. Assignments go to the parameters, which must outlive the scanner; they take
// effect at Parameters::take_effect().
class WordScanner {
 public:
  WordScanner(std::string_view line, Parameters& parameters) : line_(line), parameters_(parameters) {}

  // False at the end of the line, and after a problem: then failed() is true.
  bool next(Word& word, Problem& problem);
  bool failed() const { return failed_; }

 private:
  inline bool parse(Word& word, Problem& problem);
  // Few lines need these: the attribute keeps their code apart from the rest.
  [[gnu::cold]] bool skip_comment(Problem& problem);
  [[gnu::cold]] bool expression(std::size_t from, Word& word, Problem& problem);
  [[gnu::cold]] bool assignment(Problem& problem);
  [[gnu::cold]] bool o_word(Problem& problem) const;
  [[gnu::cold]] bool unexpected(Problem& problem) const;
  [[gnu::cold]] bool convert(std::size_t from, std::size_t end, double& value) const;
  [[gnu::cold]] bool is_bare(std::size_t letter) const;
  [[gnu::cold]] bool malformed(std::size_t from, Problem& problem) const;
  [[gnu::cold]] bool exponent(std::size_t from, Problem& problem) const;
  [[gnu::cold]] bool out_of_range(std::size_t from, Problem& problem) const;
  [[gnu::cold]] static bool may_follow(char c);

  std::string_view line_;
  Parameters& parameters_;
  std::size_t at_ = 0;
  bool failed_ = false;
};

// The code of a G or M word in tenths (G91.1 is 911); -1 if the value cannot be a code.
int code_of(double value);

}  // namespace trammel::gcode
