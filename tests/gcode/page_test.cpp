// The user's page lists exactly the words that the reader understands.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "trammel/gcode/reader.hpp"

namespace trammel::gcode {
namespace {

// Words in the first column of the page's tables: | `G0`, `G1` | ... The refused words have their own section.
std::set<std::string> words_of_page(bool refused) {
  std::ifstream page(TRAMMEL_GCODE_PAGE);
  EXPECT_TRUE(page);
  std::set<std::string> words;
  bool in_refused = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("## ", 0) == 0) in_refused = line == "## Refused words";
    if (in_refused != refused) continue;
    if (line.rfind("| `", 0) != 0) continue;
    const std::string cell = line.substr(2, line.find(" |", 2) - 2);
    for (std::size_t at = cell.find('`'); at != std::string::npos; at = cell.find('`', at)) {
      const std::size_t end = cell.find('`', at + 1);
      std::string word = cell.substr(at + 1, end - at - 1);
      EXPECT_TRUE(words.insert(word).second) << word << " stands twice";
      at = end + 1;
    }
  }
  return words;
}

TEST(GcodePage, ListsWhatTheReaderUnderstands) {
  const std::vector<std::string> known = known_words();
  const std::set<std::string> reader(known.begin(), known.end());
  EXPECT_EQ(reader.size(), known.size()) << "a word twice";
  EXPECT_GT(reader.size(), 80U);
  const std::set<std::string> page = words_of_page(false);
  for (const std::string& word : reader) EXPECT_TRUE(page.count(word)) << word << " is not on docs/user/g-code.md";
  for (const std::string& word : page) EXPECT_TRUE(reader.count(word)) << word << " is on the page alone";
}

TEST(GcodePage, ListsTheWordsThatAreRefusedWithAReason) {
  const std::vector<std::string> refused = refused_words();
  EXPECT_EQ(words_of_page(true), std::set<std::string>(refused.begin(), refused.end()));
}

}  // namespace
}  // namespace trammel::gcode
