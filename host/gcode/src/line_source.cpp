#include "trammel/gcode/line_source.hpp"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace trammel::gcode {
namespace {

// Index of the first `c` in [from, to); `to` if there is none.
std::size_t find(const char* buffer, std::size_t from, std::size_t to, char c) {
  const void* found = to > from ? std::memchr(buffer + from, c, to - from) : nullptr;
  return found != nullptr ? static_cast<std::size_t>(static_cast<const char*>(found) - buffer) : to;
}

void wait_for_bytes(int descriptor, const std::function<void()>& meanwhile) {
  constexpr int kMilliseconds = 20;
  pollfd file{descriptor, POLLIN, 0};
  int ready = 0;
  do {
    meanwhile();
    ready = ::poll(&file, 1, kMilliseconds);
  } while (ready == 0 || (ready < 0 && errno == EINTR));
}

}  // namespace

ChunkedLines::ChunkedLines(std::string name, std::size_t chunk)
    : name_(std::move(name)), chunk_(chunk), buffer_(new char[kLongestLine + 1 + chunk]) {}

// Reads more bytes behind those not given yet; false if there are no more.
bool ChunkedLines::refill() {
  if (at_end_) {
    return false;
  }
  std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t count = read(buffer_.get() + end_, chunk_);
  line_feed_ = find(buffer_.get(), end_, end_ + count, '\n');
  end_ += count;
  at_end_ = count == 0;
  return !at_end_;
}

bool ChunkedLines::next(std::string_view& line) {
  if (after_return_) {
    if (begin_ == end_ && !refill()) {
      return false;
    }
    if (buffer_[begin_] == '\n') {
      ++begin_;
      line_feed_ = find(buffer_.get(), begin_, end_, '\n');
    }
    after_return_ = false;
  }
  std::size_t searched = begin_;
  while (true) {
    const std::size_t end = find(buffer_.get(), searched, line_feed_, '\r');
    const std::size_t size = end - begin_;
    if (end == end_ && size <= kLongestLine) {
      // refill() moves the part already searched to the front.
      if (refill()) {
        searched = size;
        continue;
      }
      if (size == 0) {
        return false;
      }
    }
    line = std::string_view(buffer_.get() + begin_, size);
    after_return_ = end < line_feed_;
    begin_ = std::min(end + 1, end_);
    if (!after_return_) {
      line_feed_ = find(buffer_.get(), begin_, end_, '\n');
    }
    return true;
  }
}

FileLines::FileLines(const std::string& path)
    : ChunkedLines(path), descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)), owned_(true) {
  if (descriptor_ < 0) {
    failure_ = std::strerror(errno);
  }
}

FileLines::FileLines(int descriptor, std::string name)
    : ChunkedLines(std::move(name)), descriptor_(descriptor), owned_(false) {}

FileLines::~FileLines() {
  if (owned_ && descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

std::size_t FileLines::read(char* to, std::size_t most) {
  if (failure_) {
    return 0;
  }
  if (meanwhile_) wait_for_bytes(descriptor_, meanwhile_);
  ssize_t count = 0;
  do {
    count = ::read(descriptor_, to, most);
  } while (count < 0 && errno == EINTR);
  if (count < 0) {
    failure_ = std::strerror(errno);
    return 0;
  }
  return static_cast<std::size_t>(count);
}

TextLines::TextLines(std::string_view text, std::string name, std::size_t chunk)
    : ChunkedLines(std::move(name), chunk), rest_(text) {}

std::size_t TextLines::read(char* to, std::size_t most) {
  const std::size_t count = std::min(most, rest_.size());
  std::copy_n(rest_.data(), count, to);
  rest_.remove_prefix(count);
  return count;
}

}  // namespace trammel::gcode
