#include "text.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <numeric>

#include "trammel/machine/machine.hpp"

namespace trammel::machine {
namespace {

// Number of changed, missing and surplus letters between two words (Levenshtein).
std::size_t changes(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0U : 1U);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

// The position after the string that begins at `at`. A single-line string ends with its line, even if it is not closed.
std::size_t skip_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string_view three = quote == '"' ? "\"\"\"" : "'''";
  const bool long_string = text.substr(at, 3) == three;
  at += long_string ? 3 : 1;
  while (at < text.size()) {
    if (quote == '"' && text[at] == '\\') {
      at += 2;
    } else if (long_string && text.substr(at, 3) == three) {
      return at + 3;
    } else if (!long_string && text[at] == '\n') {
      return at;
    } else if (!long_string && text[at] == quote) {
      return at + 1;
    } else {
      ++at;
    }
  }
  return text.size();
}

constexpr std::size_t kLongestMessage = 1000;

// A file descriptor, closed at the end of the scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

bool is_open(char c) { return c == '[' || c == '{'; }
bool is_close(char c) { return c == ']' || c == '}'; }

}  // namespace

std::string nearest(std::string_view wrong, const std::vector<std::string>& names) {
  // A longer text is not a misspelt name, and the comparison time is the product of the two lengths.
  constexpr std::size_t kMostLetters = 64;
  if (wrong.size() > kMostLetters) {
    return {};
  }
  std::string best;
  std::size_t least = kMostLetters;
  for (const std::string& name : names) {
    const std::size_t count = changes(wrong, name);
    if (count < least && count <= std::max(wrong.size(), name.size()) / 2) {
      least = count;
      best = name;
    }
  }
  return best;
}

std::size_t too_deep_line(std::string_view toml, std::size_t most) {
  std::size_t depth = 0;
  std::size_t dots = 0;  // dots of the current key
  std::size_t at = 0;
  while (at < toml.size()) {
    const char c = toml[at];
    if (c == '"' || c == '\'') {
      at = skip_string(toml, at);
      continue;
    }
    if (c == '#') {
      at = std::min(toml.find('\n', at), toml.size());
      continue;
    }
    if (is_open(c)) {
      ++depth;
    } else if (is_close(c)) {
      depth -= depth > 0 ? 1 : 0;
    }
    const bool key_ends = is_open(c) || is_close(c) || c == '=' || c == ',' || c == '\n';
    dots = key_ends ? 0 : dots + (c == '.' ? 1 : 0);
    if (depth > most || dots > most) {
      return 1 +
             static_cast<std::size_t>(std::count(toml.begin(), toml.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    }
    ++at;
  }
  return 0;
}

void refuse(const std::string& message) { throw MachineError(one_line(message, kLongestMessage)); }

std::string text_of_file(const std::string& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    refuse(fmt::format("{}: cannot read the machine file: {}", path, std::strerror(errno)));
  }
  // Checked before the file is opened, because opening some devices has side effects.
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) {
    refuse(fmt::format("{}: is {}, not a machine file", path, S_ISDIR(status.st_mode) ? "a directory" : "a device"));
  }
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  std::string text;
  std::array<char, 4096> part{};
  ssize_t count = file.number() < 0 ? -1 : 1;
  while (count > 0 && text.size() <= kLongestMachineText) {
    count = ::read(file.number(), part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  }
  if (count < 0) {
    refuse(fmt::format("{}: cannot read the machine file: {}", path, std::strerror(errno)));
  }
  return text;
}

}  // namespace trammel::machine
