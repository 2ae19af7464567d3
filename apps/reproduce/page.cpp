#include "page.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <utility>

namespace trammel::app::reproduce {

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "PASS";
    case Verdict::kCorrected:
      return "CORRECTED";
    case Verdict::kFail:
      break;
  }
  return "FAIL";
}

void write_file(const std::filesystem::path& file, const std::string& content) {
  std::error_code error;
  std::filesystem::create_directories(file.parent_path(), error);
  std::ofstream out(file, std::ios::binary);
  out << content;
  out.close();
  if (!out) throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
}

Page::Page(std::filesystem::path folder, std::string file, std::string title)
    : folder_(std::move(folder)), file_(std::move(file)), title_(std::move(title)) {}

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

void Page::file_beside(const std::string& path, const std::string& content) const {
  write_file(folder_ / path, content);
}

void Page::picture(const std::string& name, const std::string& caption, const std::string& svg, const Csv& csv) {
  file_beside("pictures/" + name + ".svg", svg);
  file_beside("data/" + name + ".csv", csv.text());
  body_ += fmt::format("\n![{}](pictures/{}.svg)\n\n{} ([data](data/{}.csv))\n", caption, name, caption, name);
}

void Page::data(const std::string& name, const std::string& caption, const Csv& csv) {
  file_beside("data/" + name + ".csv", csv.text());
  body_ += fmt::format("\n{}: [data](data/{}.csv)\n", caption, name);
}

void Page::add(Item item) {
  fmt::print("{:<10} {}: {}\n", name_of(item.verdict), item.what, item.found);
  if (item.verdict != Verdict::kPass) fmt::print("{:<10} the paper: {}\n", "", item.paper);
  std::fflush(stdout);
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

std::size_t Page::count(Verdict verdict) const {
  const auto matches = [&](const Item& item) { return item.verdict == verdict; };
  return static_cast<std::size_t>(std::count_if(items_.begin(), items_.end(), matches));
}

void Page::write() const {
  std::string content = "# " + title_ + "\n\nWritten by `trammel reproduce`; [both papers](README.md).\n";
  write_file(folder_ / file_, content + body_);
}

}  // namespace trammel::app::reproduce
