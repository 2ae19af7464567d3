// The files that a subcommand writes: complete or absent. A regular file is written under a temporary name in the same
// folder. commit() renames all files together when each of them is complete. Until then the old files stay, and a
// failure or a signal leaves no trace. Existing non-regular files (devices, FIFOs, the /dev/fd/N of a process
// substitution) are written directly. A symbolic link is followed. "-" is standard output. Not thread-safe.
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

  // Throws std::runtime_error if the destination does not accept all of the text.
  void write(std::string_view text) override;
  // For writers that need a name: a temporary file, which commit() moves or copies. Not together with write().
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
  std::string name_;  // the name as given
  bool by_name_;
  Kind kind_ = Kind::kRegular;
  std::filesystem::path target_;  // the file after following links
  std::string identity_;          // equal for two names of one file; empty if several writers are harmless
  std::unique_ptr<TemporaryFile> staged_;
  std::FILE* stream_ = nullptr;
  bool existed_ = false;  // the target existed and was replaced; the staged name now holds its old content
  bool named_ = false;    // take_name() was executed
};

class Outputs {
 public:
  // Adds an option and its file; returns nullptr if no file is given. by_name: see Output::path_to_write().
  Output* add(const std::string& option, const std::optional<std::string>& file, bool by_name = false);
  // Forbids this file as an output. `what`: such as "the program", for the message; "-" is standard input.
  void keep(const std::string& what, const std::string& file);
  // Throws UsageError if a file is used twice, or is one of the files to keep; add() has already refused files that
  // cannot be written. Opens and creates nothing.
  void check() const;
  // Opens the files; call after check().
  void open();
  // Completes all outputs, or none. Prints `summary` for people on standard output, or on standard error if an option
  // writes to standard output; this happens when only a rename can still fail. Throws std::runtime_error.
  void commit(const std::string& summary = {});
  // Replaces commit() after a failed run: completes only this output; the others leave no trace.
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
