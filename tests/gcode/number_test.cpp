// Numbers of words: the reader returns the double that is nearest to the text, as strtod does.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "trammel/gcode/reader.hpp"

namespace trammel::gcode {
namespace {

// The reader's value of X<text>, with all its bits; the message if the reader refuses it.
std::string number_of(const std::string& text) {
  const machine::Machine machine = machine::default_machine();
  const std::string program = "G0 X" + text;
  TextLines lines(program, "p");
  Reader reader(lines, machine);
  Motion motion;
  return reader.next(motion) ? fmt::format("{:a}", motion.target[0]) : describe(*reader.error());
}

// The reader adds the word to an offset of 0, so that -0 becomes 0.
std::string nearest(const std::string& text) { return fmt::format("{:a}", 0.0 + std::strtod(text.c_str(), nullptr)); }

TEST(Number, HardCases) {
  for (const char* text : {
           "0",
           "-0",
           "+.5",
           "5.",
           "-0.1",
           "123456.789",
           "1000000000000",
           "0.000001",
           "900719925474.0991",  // 2^53 - 1 without the point
           "900719925474.0992",
           "900719925474.0993",  // 2^53 + 1, the first integer that is no double
           "0.1000000000000000055511151231257827",
           "0.1000000000000000124900090270330611",                     // 0.1 plus half an ulp
           "1.00000000000000011102230246251565404236316680908203125",  // a tie, rounded to even
           "1.00000000000000011102230246251565404236316680908203126",  // just above the tie
           "0.00000000000000000000000000000000000000000000000000000000000000000000000000000000000000000000001",
           "000000000000000000000000000000000000000000000000000000012.5",
           "0.30000000000000004",
           "123456789.12345678901234",
       }) {
    EXPECT_EQ(number_of(text), nearest(text)) << text;
  }
  // Nearer to 0 than to the least double.
  EXPECT_EQ(number_of("0." + std::string(400, '0') + "1"), nearest("0"));
  EXPECT_EQ(number_of("0." + std::string(322, '0') + "3"), nearest("3e-323"));
}

// Numbers of every length that a word may have, so that each path of the conversion and its limits are reached:
// integers above 2^53 have at least 16 digits, above 2^64 at least 20.
TEST(Number, IsTheNearestDouble) {
  constexpr std::size_t kEach = 8000;
  std::mt19937 random(9);
  std::vector<std::string> numbers;
  for (std::size_t digits = 1; digits <= 26; ++digits) {
    for (std::size_t i = 0; i < kEach; ++i) {
      std::string text(digits, '0');
      for (char& c : text) {
        c = static_cast<char>('0' + random() % 10);
      }
      text.insert(std::min<std::size_t>(random() % (digits + 1), 12), ".");
      numbers.push_back((random() % 2 == 0 ? "-" : "") + text);
    }
  }
  std::string program = "G0";
  for (const std::string& number : numbers) {
    program += "X" + number + "\n";
  }
  const machine::Machine machine = machine::default_machine();
  TextLines lines(program, "p");
  Reader reader(lines, machine);
  Motion motion;
  for (const std::string& number : numbers) {
    ASSERT_TRUE(reader.next(motion)) << describe(*reader.error());
    ASSERT_EQ(motion.target[0], std::strtod(number.c_str(), nullptr)) << number;
  }
}

}  // namespace
}  // namespace trammel::gcode
