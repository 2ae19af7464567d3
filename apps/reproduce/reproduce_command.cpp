#include "reproduce_command.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "chapters.hpp"
#include "common/errors.hpp"
#include "common/outputs.hpp"
#include "common/progress_bar.hpp"

namespace trammel::app {
namespace {

using reproduce::Page;
using reproduce::Progress;
using reproduce::Verdict;

struct ReproduceOptions {
  std::string out = "reproduce";
  bool progress = false;
};

struct Chapter {
  const char* name;
  std::size_t page;
  void (*make)(Page&, const Progress&);
  double share;  // fraction of the total time
};

constexpr std::array<Chapter, 10> kChapters{{{"STEER's tables", 0, reproduce::steer_tables, 0.01},
                                             {"STEER's circles", 0, reproduce::steer_circles, 0.25},
                                             {"STEER's program", 0, reproduce::steer_program, 0.005},
                                             {"STEER's text", 0, reproduce::steer_text, 0.005},
                                             {"one-shot lines", 1, reproduce::one_shot_lines, 0.015},
                                             {"one-shot text", 1, reproduce::one_shot_text, 0.005},
                                             {"one-shot waveforms", 1, reproduce::one_shot_waves, 0.01},
                                             {"motors", 1, reproduce::one_shot_motor, 0.1},
                                             {"one-shot bound", 1, reproduce::one_shot_bound, 0.4},
                                             {"lines on the card", 1, reproduce::one_shot_card, 0.2}}};

std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, "\\");
  return text;
}

std::string entry_page(const std::vector<Page>& pages) {
  std::string text =
      "# Both papers, reproduced\n\n" +
      reproduce::wrapped(
          "`trammel reproduce` computed the tables, figures and claims of the two papers behind this project and wrote "
          "these pages. PASS: the result equals the paper. CORRECTED: the paper is wrong; the correct result is given. "
          "ADDED: the paper does not say; the result is given. OPEN: not tested, with the reason. FAIL: none of these; "
          "the command then ends with status 1.") +
      "\n";
  for (const Page& page : pages) {
    text += fmt::format(
        "\n## [{}]({})\n\n{} PASS, {} CORRECTED, {} ADDED, {} OPEN, {} FAIL\n\n"
        "| item | verdict | paper | found |\n|---|---|---|---|\n",
        page.title(), page.file(), page.count(Verdict::kPass), page.count(Verdict::kCorrected),
        page.count(Verdict::kAdded), page.count(Verdict::kOpen), page.count(Verdict::kFail));
    for (const reproduce::Item& item : page.items()) {
      text += fmt::format("| {} | {} | {} | {} |\n", cell(item.what), name_of(item.verdict), cell(item.paper),
                          cell(item.found));
    }
  }
  return text;
}

// Files are written only after all computations, but an unusable folder is refused before them.
void check_folder(const std::string& name) {
  std::filesystem::path folder = std::filesystem::absolute(name);
  std::error_code error;
  while (!std::filesystem::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (!std::filesystem::is_directory(folder, error) || ::access(folder.c_str(), W_OK | X_OK) != 0) {
    throw UsageError(fmt::format("--out: {}: cannot be made a folder", name));
  }
}

void write_all(const std::filesystem::path& folder, const std::map<std::string, std::string>& files,
               const std::string& summary) {
  Outputs outputs;
  std::vector<Output*> places;
  for (const auto& [name, content] : files) {
    const std::filesystem::path file = folder / name;
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    places.push_back(outputs.add("--out", file.string()));
  }
  outputs.check();
  outputs.open();
  auto place = places.begin();
  for (const auto& [name, content] : files) (*place++)->write(content);
  outputs.commit(summary);
}

void reproduce_papers(const ReproduceOptions& options) {
  check_folder(options.out);
  std::vector<Page> pages;
  pages.emplace_back("goldberg-steer.md", "Goldberg & Goldberg: XY Interpolation Algorithms");
  pages.emplace_back("zeng-one-shot.md", "Zeng, Zhang & Huang: A New Linear Interpolation Algorithm");
  ProgressBar bar(options.progress);
  double done = 0;
  for (const Chapter& chapter : kChapters) {
    bar.show(done, chapter.name);
    chapter.make(pages[chapter.page], [&](double part) { bar.show(done + part * chapter.share, chapter.name); });
    done += chapter.share;
  }
  bar.show(1, "done");
  std::size_t failed = 0;
  std::size_t passed = 0;
  std::size_t corrected = 0;
  std::size_t added = 0;
  std::size_t open = 0;
  std::map<std::string, std::string> files{{"README.md", entry_page(pages)}};
  for (const Page& page : pages) {
    files.merge(page.files());
    passed += page.count(Verdict::kPass);
    corrected += page.count(Verdict::kCorrected);
    added += page.count(Verdict::kAdded);
    open += page.count(Verdict::kOpen);
    failed += page.count(Verdict::kFail);
  }
  write_all(
      options.out, files,
      fmt::format("{} items: {} PASS, {} CORRECTED, {} ADDED, {} OPEN, {} FAIL; pages in {}\n",
                  passed + corrected + added + open + failed, passed, corrected, added, open, failed, options.out));
  if (failed != 0) throw std::runtime_error(fmt::format("{} items of the papers were not reproduced", failed));
}

}  // namespace

void add_reproduce_command(CLI::App& app) {
  auto options = std::make_shared<ReproduceOptions>();
  CLI::App* command =
      app.add_subcommand("reproduce", "reproduce every table and figure of both papers, with a verdict on each");
  command->add_option("--out", options->out, "folder for the pages, pictures and data")
      ->capture_default_str()
      ->type_name("DIR");
  command->add_flag("--progress", options->progress, "show the progress even if standard error is not a terminal");
  command->callback([options] { reproduce_papers(*options); });
}

}  // namespace trammel::app
