// A program sent by the page: its text arrives in parts, and its lines are given out one at a time, each with its
// number as an N word. Not thread-safe.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace trammel::panel {

class Program {
 public:
  enum class Phase { kNone, kLoading, kReady, kChecking, kRunning, kDone, kStopped };

  // The largest program, bytes.
  static constexpr std::size_t kMost = std::size_t{32} << 20U;

  struct Line {
    std::size_t number = 0;  // from 1
    std::string text;        // in the form for the controller
  };

  void begin_loading(const std::string& name);
  // Returns false if no program is being loaded, or if it has more than kMost bytes.
  bool append(std::string_view part);
  // Checks each line; returns the reason if the program is refused.
  std::optional<std::string> finish_loading();
  void unload();

  // Starts at the first line: next() then gives the lines for the check and, after start(), for the run. Returns false
  // if there is no program.
  bool check();
  void start();
  // Ends the check with an error, before any motion.
  void end_check(const std::string& reason);
  // The next line that is not empty; none after the last one.
  std::optional<Line> next();
  // Call after M2 or M30: the later lines are not sent.
  void skip_rest() { at_ = text_.size(); }
  void done() { phase_ = Phase::kDone; }
  void stop(const std::string& reason);

  Phase phase() const { return phase_; }
  bool checking() const { return phase_ == Phase::kChecking; }
  bool running() const { return phase_ == Phase::kRunning; }
  bool sent_all() const { return at_ >= text_.size(); }
  const std::string& name() const { return name_; }
  const std::string& text() const { return text_; }
  // Increments with each loaded program.
  unsigned version() const { return version_; }
  std::size_t lines() const { return lines_; }
  std::size_t sent() const { return sent_; }  // number of the last line that was sent
  const std::string& stop_reason() const { return reason_; }

 private:
  std::string_view take();
  void rewind() { at_ = read_ = sent_ = 0; }

  Phase phase_ = Phase::kNone;
  std::string name_;
  std::string text_;
  std::string reason_;
  unsigned version_ = 0;
  std::size_t lines_ = 0;
  std::size_t at_ = 0;    // byte offset of the next line
  std::size_t read_ = 0;  // number of the last line that was read
  std::size_t sent_ = 0;
};

}  // namespace trammel::panel
