#include "jog_keys.hpp"

namespace trammel::app {
namespace {

JogKey move(std::size_t axis, int sign) { return {JogKey::Kind::kMove, axis, sign, 0}; }

struct Sequence {
  std::string_view bytes;
  JogKey key;
};

// Escape sequences of ECMA-48 and xterm: arrows in both cursor modes, page up, page down.
const Sequence kSequences[] = {{"\x1b[A", move(1, 1)},  {"\x1bOA", move(1, 1)},  {"\x1b[B", move(1, -1)},
                               {"\x1bOB", move(1, -1)}, {"\x1b[C", move(0, 1)},  {"\x1bOC", move(0, 1)},
                               {"\x1b[D", move(0, -1)}, {"\x1bOD", move(0, -1)}, {"\x1b[5~", move(2, 1)},
                               {"\x1b[6~", move(2, -1)}};

JogKey key_of(char byte) {
  if (byte >= '0' && byte <= '9') return {JogKey::Kind::kStep, 0, 0, static_cast<unsigned>(byte - '0')};
  switch (byte) {
    case '[':
      return move(3, -1);
    case ']':
      return move(3, 1);
    case '+':
      return {JogKey::Kind::kFaster};
    case '-':
      return {JogKey::Kind::kSlower};
    case ' ':
      return {JogKey::Kind::kStop};
    case 'q':
      return {JogKey::Kind::kEnd};
    default:
      return {};
  }
}

// Length of an escape sequence, to its final byte or to the end of the text.
std::size_t length_of(std::string_view bytes) {
  if (bytes.size() < 2) return bytes.size();
  if (bytes[1] == 'O') return bytes.size() < 3 ? bytes.size() : 3;
  if (bytes[1] != '[') return 1;
  std::size_t length = 2;
  while (length < bytes.size() && (bytes[length] < '@' || bytes[length] > '~')) ++length;
  return length < bytes.size() ? length + 1 : length;
}

}  // namespace

std::vector<JogKey> jog_keys(std::string_view bytes) {
  std::vector<JogKey> keys;
  while (!bytes.empty()) {
    std::size_t length = 1;
    JogKey key = key_of(bytes.front());
    if (bytes.front() == '\x1b') {
      length = length_of(bytes);
      for (const Sequence& sequence : kSequences) {
        if (bytes.substr(0, length) == sequence.bytes) key = sequence.key;
      }
    }
    keys.push_back(key);
    bytes.remove_prefix(length);
  }
  return keys;
}

}  // namespace trammel::app
