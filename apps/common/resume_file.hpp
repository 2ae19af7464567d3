// The data that `trammel run` needs to continue an interrupted program: a file per card, written before the run moves
// anything. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/run/interrupted.hpp"

namespace trammel::app {

// The inputs of a plan. Two runs with equal keys have equal plans, except with another build of the planner;
// ResumeRecord::plan detects that.
struct ResumeKey {
  std::string program;                         // name of the program, for messages; it may differ between two runs
  std::string program_hash;                    // hash of the program's lines
  std::string machine_hash;                    // hash of the machine file and of --set
  std::map<std::string, std::string> options;  // options that change the plan, with their values
  unsigned planner = 0;                        // planner::kPlanVersion
};

struct ResumeRecord {
  enum class State { kRunning, kStopped, kDone };

  ResumeKey key;
  std::string plan;                 // run::Plan::identity; empty if the run cannot be continued
  State state = State::kRunning;    // kRunning: the card has the place
  std::vector<std::int64_t> start;  // start of the program's first line, pulses by axis of the card
  std::vector<std::int32_t> zero;   // MACHINE_ZERO by axis of the card
  std::uint64_t time = 0;           // card time in clocks before the run's first access
  run::RunBegin begin;
  run::RunSettings::Place place;  // for kStopped
};

class ResumeFile {
 public:
  // `card`: URL of the card without a token. `file`: from --resume-file; if not given, a file named after the card in
  // the folder trammel of $XDG_STATE_HOME, by default ~/.local/state. Opens nothing.
  ResumeFile(const std::string& card, const std::optional<std::string>& file);

  const std::string& path() const { return path_; }
  // None if there is no file. Throws UsageError for a file of another kind.
  std::optional<ResumeRecord> read() const;
  // Writes atomically: a reader finds the old content or the new one. Throws UsageError if the file cannot be written,
  // or if its name belongs to a file of another kind. If the user did not name the file and it never existed, a failure
  // is only a note.
  void write(const ResumeRecord& record) const;

 private:
  std::string path_;  // empty: the folder is unknown
  bool named_;        // named by the user
};

// FNV-1a, 16 hexadecimal digits.
class TextHash {
 public:
  void add(const std::string& text);
  std::string text() const;

 private:
  std::uint64_t hash_ = 14'695'981'039'346'656'037U;
};

// Describes the difference between the interrupted run and this one: "the program has other lines"; empty if they
// agree.
std::string difference(const ResumeKey& before, const ResumeKey& now);

// The place at which the card left the record's run, from its area REST. Throws UsageError if the card stopped at once
// in a motion, was reset, or if its machine zero was set anew. The card is at rest.
run::RunSettings::Place place_of_stop(driver::Card& card, const ResumeRecord& record);
// Throws UsageError if machine zero of the card was set anew since the run.
void check_zeros(driver::Card& card, const ResumeRecord& record);

// Call before another program moves the card: saves the card's record of an interrupted run in the file. Returns false,
// with a note, if the run cannot be continued. Never throws: a card that does not answer keeps its record.
bool keep_place_of_stop(driver::Card& card, const ResumeFile& file) noexcept;

}  // namespace trammel::app
