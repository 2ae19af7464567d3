#include "page.hpp"

#include <unistd.h>

#include <algorithm>
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

}  // namespace

Page::Page(std::string file, std::string title) : file_(std::move(file)), title_(std::move(title)) {}

void Page::heading(const std::string& text) { body_ += "\n## " + text + "\n"; }

void Page::text(const std::string& paragraph) { body_ += "\n" + paragraph + "\n"; }

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
  body_ += fmt::format("\n![{}](pictures/{}.svg)\n\n{} ([data](data/{}.csv))\n", caption, name, caption, name);
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
  body_ +=
      fmt::format("\n**{}** {}. Paper: {}. Found: {}.\n", name_of(item.verdict), item.what, item.paper, item.found);
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
