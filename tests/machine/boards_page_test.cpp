// Reads the parts of machine files that docs/user/boards.md suggests for each board.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <map>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {
namespace {

// The TOML blocks of the page, by the name of the board in the HTML comment above each block.
std::map<std::string, std::string> suggested_roles() {
  std::ifstream file(TRAMMEL_EXAMPLES_DIR "/../docs/user/boards.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  const std::string mark = ": written by scripts/boards -->";
  std::map<std::string, std::string> found;
  for (std::size_t at = page.find(mark); at != std::string::npos; at = page.find(mark, at + 1)) {
    const std::size_t name = page.rfind("<!-- ", at) + 5;
    const std::size_t begin = page.find("```toml\n", at) + 8;
    found[page.substr(name, at - name)] = page.substr(begin, page.find("```", begin) - begin);
  }
  return found;
}

// The default machine without E: each of X, Y and Z may home, so only a wrong role of the page can be refused.
Machine with_roles(const std::string& roles) {
  std::string text = default_machine_text();
  text.resize(text.find("[axis.e]"));
  return parse_machine(text + roles, "boards.md");
}

TEST(BoardsPage, SuggestsWhatAMachineFileTakes) {
  const std::map<std::string, std::string> boards = suggested_roles();
  ASSERT_EQ(boards.size(), 3U);
  const std::map<std::string, std::pair<unsigned, unsigned>> pins{
      {"hx8k", {8, 4}}, {"ulx3s", {16, 8}}, {"colorlight-5a-75b", {16, 8}}};
  for (const auto& [board, roles] : boards) {
    SCOPED_TRACE(board);
    const Machine machine = with_roles(roles);
    const auto [inputs, outputs] = pins.at(board);
    EXPECT_NE(machine.inputs.used(), 0U);
    EXPECT_EQ(machine.inputs.used() >> inputs, 0U);
    EXPECT_EQ(machine.outputs.all() >> outputs, 0U);
    EXPECT_NE(machine.outputs.enable, 0U);
    EXPECT_NE(machine.outputs.healthy, 0U);
    ASSERT_TRUE(machine.probe.input);
    EXPECT_LT(*machine.probe.input, inputs);
    EXPECT_EQ(machine.inputs.used() >> *machine.probe.input & 1U, 0U) << "the probe's input has another role";
  }
}

}  // namespace
}  // namespace trammel::machine
