// The files that a subcommand writes: complete or absent. A regular file is written beside itself, and all of them take
// their names together in commit(), when each is whole; until then what was there stays, and a failure or a signal
// leaves no trace. What exists and is no regular file (a device, a FIFO, the /dev/fd/N of a process substitution) is
// written as it comes. A symbolic link is followed. "-" is standard output. Not thread-safe.
#pragma once

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "temporary_files.hpp"
#include "trammel/run/text_sink.hpp"

namespace trammel::app {

class Output final : public run::TextSink {
 public:
  ~Output() override;
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  // Throws std::runtime_error when the destination does not take it all.
  void write(std::string_view text) override;
  // For who writes by name: a temporary file of commit()'s to move or copy. Not together with write().
  std::string path_to_write() const { return staged_->path().string(); }

 private:
  friend class Outputs;
  enum class Kind { kStandardOutput, kRegular, kOther };
  Output(std::string option, std::string name, bool by_name);
  void open();
  void finish();
  void copy_staged();
  void take_name();
  void give_name_back() noexcept;
  [[noreturn]] void fail() const;

  std::string option_;
  std::string name_;  // as it was given
  bool by_name_;
  Kind kind_ = Kind::kRegular;
  std::filesystem::path target_;  // links followed
  std::string identity_;          // equal for two names of one file; empty where several writers do no harm
  std::unique_ptr<TemporaryFile> staged_;
  std::FILE* stream_ = nullptr;
  bool existed_ = false;  // the target did when it was replaced; its content then lies at the staged name
  bool named_ = false;    // take_name() was done
};

class Outputs {
 public:
  // An option and its file; nullptr where none was given. by_name: see Output::path_to_write().
  Output* add(const std::string& option, const std::optional<std::string>& file, bool by_name = false);
  // No output may be this file: `what` is "the program" or the like; "-" is standard input.
  void keep(const std::string& what, const std::string& file);
  // Refuses the same file twice and the files to keep with UsageError; add() has refused what cannot be written.
  // Nothing is opened or made.
  void check() const;
  // After check().
  void open();
  // All outputs whole, or none; `summary`, for people, goes to standard output, or to standard error where an option
  // has taken that, once nothing but a name can fail. Throws std::runtime_error.
  void commit(const std::string& summary = {});
  // In place of it, of a run that failed: this one alone; the others leave no trace.
  void commit_alone(Output& output);

 private:
  struct Kept {
    std::string what;
    std::string identity;
  };
  std::vector<std::unique_ptr<Output>> outputs_;
  std::vector<Kept> kept_;
  bool standard_output_taken_ = false;
};

}  // namespace trammel::app
