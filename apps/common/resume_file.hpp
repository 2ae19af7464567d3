// What `trammel run` must know to go on with a program that was interrupted: a file beside the card, written before the
// run moves anything. Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "trammel/driver/card.hpp"
#include "trammel/run/interrupted.hpp"

namespace trammel::app {

// What a plan follows from. Two runs with equal keys have equal plans, but for another build of the planner: of that
// `plan` tells.
struct ResumeKey {
  std::string program;                         // its name, for messages: two runs may differ in it
  std::string program_hash;                    // of its lines
  std::string machine_hash;                    // of the machine file and of --set
  std::map<std::string, std::string> options;  // that change the plan, with their values
  unsigned planner = 0;                        // planner::kPlanVersion
};

struct ResumeRecord {
  enum class State { kRunning, kStopped, kDone };

  ResumeKey key;
  std::string plan;                 // run::Plan::identity; empty where the run cannot be gone on with
  State state = State::kRunning;    // kRunning: the card knows the place
  std::vector<std::int64_t> start;  // where the program's first line begins, pulses by axis of the card
  std::vector<std::int32_t> zero;   // MACHINE_ZERO by axis of the card
  std::uint64_t time = 0;           // clocks of the card before the run's first access
  run::RunBegin begin;
  run::RunSettings::Place place;  // kStopped
};

class ResumeFile {
 public:
  // `card`: its URL without a token. `file`: of --resume-file; without it a file in the folder trammel of
  // $XDG_STATE_HOME, by default ~/.local/state, named after the card. Opens nothing.
  ResumeFile(const std::string& card, const std::optional<std::string>& file);

  const std::string& path() const { return path_; }
  // None where there is no file. Throws UsageError for a file that is none of these.
  std::optional<ResumeRecord> read() const;
  // In one go: whoever reads it finds the old content or the new one. Throws UsageError where it cannot be written, and
  // where another file has its name. A file that the user did not name and that was never there is a note only.
  void write(const ResumeRecord& record) const;

 private:
  std::string path_;  // empty: no folder is known
  bool named_;        // by the user
};

// FNV-1a, 16 hexadecimal digits.
class TextHash {
 public:
  void add(const std::string& text);
  std::string text() const;

 private:
  std::uint64_t hash_ = 14'695'981'039'346'656'037U;
};

// Names what differs between the interrupted run and this one, and how: "the program has other lines"; empty where they
// agree.
std::string difference(const ResumeKey& before, const ResumeKey& now);

// Where the card has left the record's run, from its area REST. Throws UsageError where it stopped at once in a motion,
// where it was reset, and where machine zero was set anew. The card stands.
run::RunSettings::Place place_of_stop(driver::Card& card, const ResumeRecord& record);
// Throws UsageError where machine zero of the card was set anew since the run.
void check_zeros(driver::Card& card, const ResumeRecord& record);

// Before somebody else moves the card: what it knows of an interrupted run's place goes to the file. False, with a
// note, where the run cannot be gone on with. Never throws: a card that does not answer keeps its place.
bool keep_place_of_stop(driver::Card& card, const ResumeFile& file) noexcept;

}  // namespace trammel::app
