// The source of a program, line by line, in memory that does not grow with it. LF, CR LF and CR alone end a line. Not
// thread-safe.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace trammel::gcode {

// Bytes of a line without its end. Slicers write settings of some thousand bytes as one comment.
inline constexpr std::size_t kLongestLine = 65535;

class LineSource {
 public:
  virtual ~LineSource() = default;
  // The next line without its end, until the next call; false after the last line and when the source fails. Of a line
  // longer than kLongestLine it may give any part that is still longer: the reader refuses it.
  virtual bool next(std::string_view& line) = 0;
  // For messages.
  virtual const std::string& name() const = 0;
  // Why next() gave false, or nothing at the end of the program.
  virtual std::optional<std::string> failure() const { return std::nullopt; }
};

// Lines of bytes that come in pieces.
class ChunkedLines : public LineSource {
 public:
  bool next(std::string_view& line) final;
  const std::string& name() const final { return name_; }

 protected:
  // `chunk`: bytes asked for at a time, at least 1.
  explicit ChunkedLines(std::string name, std::size_t chunk = 65536);
  // Up to `most` bytes to `to`, 0 at the end and after a failure.
  virtual std::size_t read(char* to, std::size_t most) = 0;

 private:
  bool refill();

  std::string name_;
  std::size_t chunk_;
  std::unique_ptr<char[]> buffer_;
  std::size_t begin_ = 0;      // of what was not given yet
  std::size_t line_feed_ = 0;  // the first one behind begin_; end_ where there is none
  std::size_t end_ = 0;
  bool after_return_ = false;  // a CR ended the last line: an LF that follows belongs to it
  bool at_end_ = false;
};

// A file, a device or a pipe. A file that cannot be opened shows as a failure.
class FileLines final : public ChunkedLines {
 public:
  explicit FileLines(const std::string& path);
  // From where an open file stands; it is not closed.
  FileLines(int descriptor, std::string name);
  ~FileLines() override;
  FileLines(const FileLines&) = delete;
  FileLines& operator=(const FileLines&) = delete;
  // Called before each read, and every 20 ms while a pipe or a device has nothing to read. next() passes on what it
  // throws.
  void set_meanwhile(std::function<void()> meanwhile) { meanwhile_ = std::move(meanwhile); }
  std::optional<std::string> failure() const override { return failure_; }

 protected:
  std::size_t read(char* to, std::size_t most) override;

 private:
  int descriptor_;
  bool owned_;
  std::function<void()> meanwhile_;
  std::optional<std::string> failure_;
};

// A text that outlives the source.
class TextLines final : public ChunkedLines {
 public:
  TextLines(std::string_view text, std::string name, std::size_t chunk = 65536);

 protected:
  std::size_t read(char* to, std::size_t most) override;

 private:
  std::string_view rest_;
};

}  // namespace trammel::gcode
