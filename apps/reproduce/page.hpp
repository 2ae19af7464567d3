// The pages that `trammel reproduce` writes: text, items with their verdicts, tables, pictures with the CSV behind
// them. Nothing in them changes from run to run. Errors: std::runtime_error when a file cannot be written. Not
// thread-safe.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace trammel::app::reproduce {

enum class Verdict {
  kPass,       // as the paper has it
  kCorrected,  // the paper is wrong here; what is right was found
  kAdded,      // the paper is silent here; what it leaves open was found
  kOpen,       // a claim of the paper that is not put to a test here
  kFail,       // not what was expected
};

struct Item {
  std::string what;
  std::string paper;  // what the paper prints or says
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

// In lines of at most 120 columns, but for words longer than that; `text` is one paragraph.
std::string wrapped(const std::string& text);

class Page {
 public:
  // The page `file`, with pictures and CSV files in folders beside it.
  Page(std::string file, std::string title);

  void heading(const std::string& text);
  void text(const std::string& paragraph);
  // A table: the first row is its head.
  void table(const std::vector<std::vector<std::string>>& rows);
  void picture(const std::string& name, const std::string& caption, const std::string& svg, const Csv& csv);
  // A CSV without a picture of its own.
  void data(const std::string& name, const std::string& caption, const Csv& csv);

  // The paper's own result, found again when `holds`.
  void pass(const std::string& what, const std::string& paper, const std::string& found, bool holds);
  // A place where the paper is wrong; `found` is right when `holds`.
  void corrected(const std::string& what, const std::string& paper, const std::string& found, bool holds);

  // What the paper does not say; `found` is right when `holds`.
  void added(const std::string& what, const std::string& paper, const std::string& found, bool holds);

  // A claim that is not tested here, and why.
  void open(const std::string& what, const std::string& paper, const std::string& reason);

  // The page, its pictures and its data, by their names beside each other.
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
