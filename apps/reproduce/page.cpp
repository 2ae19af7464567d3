#include "page.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "common/standard_streams.hpp"
#include "common/terminal.hpp"

namespace trammel::app::reproduce {

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "PASS";
    case Verdict::kCorrected:
      return "CORRECTED";
    case Verdict::kAdded:
      return "ADDED";
    case Verdict::kOpen:
      return "OPEN";
    case Verdict::kFail:
      break;
  }
  return "FAIL";
}

namespace {

Colour colour_of(Verdict verdict) {
  if (verdict == Verdict::kPass) return Colour::kGreen;
  return verdict == Verdict::kFail ? Colour::kRed : Colour::kYellow;
}

// A line that begins with a number, a dash or a plus sign could be a list in Markdown.
bool may_begin_line(const std::string& text, std::size_t at) {
  return std::isalpha(static_cast<unsigned char>(text[at])) != 0 || text[at] == '(' || text[at] == '`';
}

}  // namespace

std::string wrapped(const std::string& text) {
  constexpr std::size_t kColumns = 120;
  std::string result;
  std::size_t begin = 0;
  while (text.size() - begin > kColumns) {
    std::size_t at = begin + kColumns;
    while (at > begin && (text[at] != ' ' || !may_begin_line(text, at + 1))) --at;
    if (at == begin) break;
    result += text.substr(begin, at - begin) + "\n";
    begin = at + 1;
  }
  return result + text.substr(begin);
}

Page::Page(std::string file, std::string title) : file_(std::move(file)), title_(std::move(title)) {}

void Page::heading(const std::string& text) { body_ += "\n## " + text + "\n"; }

void Page::text(const std::string& paragraph) { body_ += "\n" + wrapped(paragraph) + "\n"; }

void Page::table(const std::vector<std::vector<std::string>>& rows) {
  body_ += "\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    body_ += "|";
    for (const std::string& cell : rows[i]) body_ += " " + cell + " |";
    body_ += "\n";
    if (i != 0) continue;
    body_ += "|";
    for (std::size_t column = 0; column < rows[i].size(); ++column) body_ += "---|";
    body_ += "\n";
  }
}

void Page::picture(const std::string& name, const std::string& caption, const std::string& svg, const Csv& csv) {
  beside_["pictures/" + name + ".svg"] = svg;
  beside_["data/" + name + ".csv"] = csv.text();
  body_ += fmt::format("\n![{}](pictures/{}.svg)\n\n{}\n", caption, name,
                       wrapped(fmt::format("{} ([data](data/{}.csv))", caption, name)));
}

void Page::data(const std::string& name, const std::string& caption, const Csv& csv) {
  beside_["data/" + name + ".csv"] = csv.text();
  body_ += fmt::format("\n{}: [data](data/{}.csv)\n", caption, name);
}

void Page::add(Item item) {
  const std::string verdict = fmt::format("{:<10}", name_of(item.verdict));
  to_standard_output(
      fmt::format("{} {}: {}\n", coloured(STDOUT_FILENO, colour_of(item.verdict), verdict), item.what, item.found));
  if (item.verdict != Verdict::kPass) to_standard_output(fmt::format("{:<10} the paper: {}\n", "", item.paper));
  finish_standard_streams();
  const char* found = item.verdict == Verdict::kOpen ? "Not tested" : "Found";
  body_ += fmt::format("\n{}\n", wrapped(fmt::format("**{}** {}. Paper: {}. {}: {}.", name_of(item.verdict), item.what,
                                                     item.paper, found, item.found)));
  items_.push_back(std::move(item));
}

void Page::pass(const std::string& what, const std::string& paper, const std::string& found, bool holds) {
  add({what, paper, found, holds ? Verdict::kPass : Verdict::kFail});
}

void Page::corrected(const std::string& what, const std::string& paper, const std::string& found, bool holds) {
  add({what, paper, found, holds ? Verdict::kCorrected : Verdict::kFail});
}

void Page::added(const std::string& what, const std::string& paper, const std::string& found, bool holds) {
  add({what, paper, found, holds ? Verdict::kAdded : Verdict::kFail});
}

void Page::open(const std::string& what, const std::string& paper, const std::string& reason) {
  add({what, paper, reason, Verdict::kOpen});
}

std::size_t Page::count(Verdict verdict) const {
  const auto matches = [&](const Item& item) { return item.verdict == verdict; };
  return static_cast<std::size_t>(std::count_if(items_.begin(), items_.end(), matches));
}

std::map<std::string, std::string> Page::files() const {
  std::map<std::string, std::string> result = beside_;
  result[file_] = "# " + title_ + "\n\nWritten by `trammel reproduce`; [both papers](README.md).\n" + body_;
  return result;
}

}  // namespace trammel::app::reproduce
