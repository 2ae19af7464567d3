// The pages that `trammel reproduce` writes: text, items with their verdicts, tables, and pictures with their CSV data.
// Their content is the same in every run. Throws std::runtime_error if a file cannot be written. Not thread-safe.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace trammel::app::reproduce {

enum class Verdict {
  kPass,       // the paper's result was reproduced
  kCorrected,  // the paper is wrong here; the correct result was found
  kAdded,      // the paper does not cover this; a result was found
  kOpen,       // a claim of the paper that is not tested here
  kFail,       // the result differs from the expected one
};

struct Item {
  std::string what;
  std::string paper;  // what the paper prints or claims
  std::string found;
  Verdict verdict;
};

const char* name_of(Verdict verdict);

// Lines of comma-separated values with a header.
class Csv {
 public:
  explicit Csv(const std::string& header) : text_(header + "\n") {}
  template <class... Values>
  void row(fmt::format_string<Values...> format, Values&&... values) {
    text_ += fmt::format(format, std::forward<Values>(values)...) + "\n";
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// Wraps one paragraph at 120 columns; longer words stay whole.
std::string wrapped(const std::string& text);

class Page {
 public:
  // The page `file`; its pictures and CSV files are in folders next to it.
  Page(std::string file, std::string title);

  void heading(const std::string& text);
  void text(const std::string& paragraph);
  // A table: the first row is its head.
  void table(const std::vector<std::vector<std::string>>& rows);
  void picture(const std::string& name, const std::string& caption, const std::string& svg, const Csv& csv);
  // A CSV without a picture of its own.
  void data(const std::string& name, const std::string& caption, const Csv& csv);

  // Adds a result of the paper, reproduced if `holds`.
  void pass(const std::string& what, const std::string& paper, const std::string& found, bool holds);
  // Adds an error of the paper; `found` is correct if `holds`.
  void corrected(const std::string& what, const std::string& paper, const std::string& found, bool holds);

  // Adds a result that the paper lacks; `found` is correct if `holds`.
  void added(const std::string& what, const std::string& paper, const std::string& found, bool holds);

  // Adds a claim that is not tested here, with the reason.
  void open(const std::string& what, const std::string& paper, const std::string& reason);

  // Content by file name: the page, its pictures and its data.
  std::map<std::string, std::string> files() const;

  const std::vector<Item>& items() const { return items_; }
  std::size_t count(Verdict verdict) const;
  const std::string& file() const { return file_; }
  const std::string& title() const { return title_; }

 private:
  void add(Item item);

  std::string file_;
  std::string title_;
  std::string body_;
  std::vector<Item> items_;
  std::map<std::string, std::string> beside_;  // pictures and data
};

}  // namespace trammel::app::reproduce
