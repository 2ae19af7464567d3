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

// Bytes of a line without its end. Slicers write settings of several thousand bytes as one comment.
inline constexpr std::size_t kLongestLine = 65535;

class LineSource {
 public:
  virtual ~LineSource() = default;
  // Gets the next line without its end; `line` is valid until the next call. Returns false after the last line and when
  // the source fails. A line longer than kLongestLine may be cut, but not to kLongestLine or less: the reader refuses
  // it.
  virtual bool next(std::string_view& line) = 0;
  // The name of the source, for messages.
  virtual const std::string& name() const = 0;
  // The reason if next() returned false because of a failure; empty at the end of the program.
  virtual std::optional<std::string> failure() const { return std::nullopt; }
};

// Lines of a source that gives its bytes in chunks.
class ChunkedLines : public LineSource {
 public:
  bool next(std::string_view& line) final;
  const std::string& name() const final { return name_; }

 protected:
  // `chunk`: bytes per read(), at least 1.
  explicit ChunkedLines(std::string name, std::size_t chunk = 65536);
  // Reads up to `most` bytes into `to`. Returns 0 at the end and after a failure.
  virtual std::size_t read(char* to, std::size_t most) = 0;

 private:
  bool refill();

  std::string name_;
  std::size_t chunk_;
  std::unique_ptr<char[]> buffer_;
  std::size_t begin_ = 0;      // of the bytes that next() has not given
  std::size_t line_feed_ = 0;  // position of the first LF after begin_; end_ if there is none
  std::size_t end_ = 0;
  bool after_return_ = false;  // a CR ended the last line: an LF that follows belongs to it
  bool at_end_ = false;
};

// A file, a device or a pipe. If the file cannot be opened, failure() gives the reason.
class FileLines final : public ChunkedLines {
 public:
  explicit FileLines(const std::string& path);
  // Reads on from the present position of an open file and does not close it.
  FileLines(int descriptor, std::string name);
  ~FileLines() override;
  FileLines(const FileLines&) = delete;
  FileLines& operator=(const FileLines&) = delete;
  // `meanwhile` is called before each read, and every 20 ms while a pipe or a device has nothing to read. next() passes
  // on its exceptions.
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

// A text in memory, which must outlive the source.
class TextLines final : public ChunkedLines {
 public:
  TextLines(std::string_view text, std::string name, std::size_t chunk = 65536);

 protected:
  std::size_t read(char* to, std::size_t most) override;

 private:
  std::string_view rest_;
};

}  // namespace trammel::gcode
