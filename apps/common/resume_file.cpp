#include "resume_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "errors.hpp"
#include "temporary_files.hpp"
#include "terminal.hpp"

namespace trammel::app {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using State = ResumeRecord::State;

constexpr const char* kKind = "trammel resume";
constexpr int kFormat = 1;
constexpr const char* kStates[] = {"running", "stopped", "done"};
constexpr const char* kZeroSet =
    "machine zero was set anew since the interrupted run, so the position where it stopped is not known any more";

// By the XDG Base Directory Specification a relative path is ignored.
fs::path state_folder() {
  const char* const state = std::getenv("XDG_STATE_HOME");
  const char* const home = std::getenv("HOME");
  if (state != nullptr && fs::path(state).is_absolute()) return fs::path(state) / "trammel";
  if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".local" / "state" / "trammel";
  return {};
}

// The card's URL, with underscores in place of all characters except letters, digits, dots and hyphens.
std::string file_name(const std::string& card) {
  std::string name = "resume-" + card + ".json";
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') c = '_';
  }
  return name;
}

Json json_of(const run::RunSettings::Place& place) {
  return {{"command", place.path.command}, {"ticks_left", place.path.ticks_left}, {"position", place.position}};
}

Json json_of(const ResumeRecord& record) {
  Json json;
  json["kind"] = kKind;
  json["format"] = kFormat;
  json["state"] = kStates[static_cast<std::size_t>(record.state)];
  json["program"] = record.key.program;
  json["program_hash"] = record.key.program_hash;
  json["machine_hash"] = record.key.machine_hash;
  json["planner"] = record.key.planner;
  json["plan"] = record.plan;
  json["options"] = record.key.options;
  json["start"] = record.start;
  json["machine_zero"] = record.zero;
  json["time"] = record.time;
  json["first_command"] = record.begin.first;
  json["begins_silent"] = record.begin.silent;
  json["begin"] = json_of(record.begin.place);
  if (record.state == State::kStopped) json["place"] = json_of(record.place);
  return json;
}

run::RunSettings::Place place_of(const Json& json) {
  run::RunSettings::Place place;
  place.path.command = json.at("command");
  place.path.ticks_left = json.at("ticks_left");
  place.position = json.at("position").get<planner::Pulses>();
  return place;
}

ResumeRecord record_of(const Json& json) {
  ResumeRecord record;
  const std::string state = json.at("state");
  const auto* const found = std::find(std::begin(kStates), std::end(kStates), state);
  if (found == std::end(kStates)) throw std::invalid_argument("state " + state);
  record.state = static_cast<State>(found - std::begin(kStates));
  record.key.program = json.at("program");
  record.key.program_hash = json.at("program_hash");
  record.key.machine_hash = json.at("machine_hash");
  record.key.planner = json.at("planner");
  record.key.options = json.at("options").get<std::map<std::string, std::string>>();
  record.plan = json.at("plan");
  record.start = json.at("start").get<std::vector<std::int64_t>>();
  record.zero = json.at("machine_zero").get<std::vector<std::int32_t>>();
  record.time = json.at("time");
  record.begin.first = json.at("first_command");
  record.begin.silent = json.at("begins_silent");
  record.begin.place = place_of(json.at("begin"));
  if (record.state == State::kStopped) record.place = place_of(json.at("place"));
  return record;
}

// An option that only one of the keys has counts as different.
std::string differing_option(const ResumeKey& before, const ResumeKey& now) {
  const auto value = [](const ResumeKey& key, const std::string& name) {
    const auto found = key.options.find(name);
    return found == key.options.end() ? std::string("nothing") : "'" + found->second + "'";
  };
  for (const ResumeKey* key : {&before, &now}) {
    for (const auto& [name, text] : key->options) {
      if (value(before, name) != value(now, name)) {
        return fmt::format("{} was {}, and is {} now", name, value(before, name), value(now, name));
      }
    }
  }
  return {};
}

// The place of a card that was not stopped since: it has executed all commands.
driver::Rest rest_without_stop(driver::Card& card, const ResumeRecord& record) {
  const driver::Snapshot now = card.read_snapshot();
  if (now.time <= record.time) throw UsageError("the card was reset since the interrupted run");
  if (now.status.busy) throw UsageError("the card is moving");
  driver::Rest rest;
  rest.time = now.time;
  rest.status = now.status;
  rest.status.settled = true;
  rest.geometry_begun = now.geometry_begun;
  rest.feed_begun = now.feed_begun;
  rest.position = now.position;
  return rest;
}

}  // namespace

ResumeFile::ResumeFile(const std::string& card, const std::optional<std::string>& file) : named_(file.has_value()) {
  const fs::path folder = state_folder();
  if (file) {
    path_ = *file;
  } else if (!folder.empty()) {
    path_ = (folder / file_name(card)).string();
  }
}

std::optional<ResumeRecord> ResumeFile::read() const {
  std::error_code code;
  if (path_.empty() || !fs::exists(path_, code)) return std::nullopt;
  std::ifstream in(path_);
  const Json json = Json::parse(in, nullptr, false);
  if (json.is_discarded() || !json.is_object() || json.value("kind", "") != kKind) {
    throw UsageError(fmt::format("{}: is not the file of an interrupted run", path_));
  }
  if (json.value("format", 0) != kFormat) {
    throw UsageError(
        fmt::format("{}: was written by another version of trammel (format {})", path_, json.value("format", 0)));
  }
  try {
    return record_of(json);
  } catch (const std::exception& error) {
    throw UsageError(fmt::format("{}: cannot be read as the file of an interrupted run: {}", path_, error.what()));
  }
}

void ResumeFile::write(const ResumeRecord& record) const {
  if (path_.empty()) return;
  bool there = false;
  try {
    there = read().has_value();  // a file of another kind with this name is not overwritten
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("{}; name another file with --resume-file", error.what()));
  }
  const fs::path target(path_);
  const fs::path folder = target.parent_path().empty() ? fs::path(".") : target.parent_path();
  std::error_code code;
  fs::create_directories(folder, code);
  try {
    const SignalsWait wait;
    const fs::path beside = folder / (target.filename().string() + fmt::format(".{}", ::getpid()));
    std::ofstream out(beside);
    out << json_of(record).dump(2) << '\n';
    out.close();
    if (!out) throw std::runtime_error("writing failed");
    fs::rename(beside, target);
  } catch (const std::exception& error) {
    const std::string text = fmt::format("{}: cannot write the file that --resume needs: {}", path_, error.what());
    if (named_ || there) throw UsageError(text);
    tell("note", text);
  }
}

void TextHash::add(const std::string& text) {
  for (const char c : text + '\n') hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 1'099'511'628'211U;
}

std::string TextHash::text() const { return fmt::format("{:016x}", hash_); }

std::string difference(const ResumeKey& before, const ResumeKey& now) {
  if (before.program_hash != now.program_hash) {
    return fmt::format("the lines of the program {} differ from those that {} had then", now.program, before.program);
  }
  if (before.machine_hash != now.machine_hash) return "the machine file or --set has changed since then";
  if (before.planner != now.planner) {
    return fmt::format("the planner has version {}, but had version {} then", now.planner, before.planner);
  }
  return differing_option(before, now);
}

void check_zeros(driver::Card& card, const ResumeRecord& record) {
  for (std::size_t n = 0; n < record.zero.size() && n < card.identification().axes; ++n) {
    if (card.read_machine_zero(static_cast<unsigned>(n)) != record.zero[n]) throw UsageError(kZeroSet);
  }
}

run::RunSettings::Place place_of_stop(driver::Card& card, const ResumeRecord& record) {
  check_zeros(card, record);
  card.wait_until_stopped();
  driver::Rest rest = card.read_rest();
  if (rest.time <= record.time) rest = rest_without_stop(card, record);
  std::array<std::int32_t, card_map::kMaxAxes> zero{};
  std::copy_n(record.zero.begin(), std::min(record.zero.size(), zero.size()), zero.begin());
  const std::optional<run::RunSettings::Place> place = run::place_of(record.begin, rest, zero);
  if (!place) {
    throw UsageError(
        "the card was stopped immediately while it moved, so the tick of the path at which it stands is not known");
  }
  return *place;
}

bool keep_place_of_stop(driver::Card& card, const ResumeFile& file) noexcept {
  try {
    std::optional<ResumeRecord> record = file.read();
    if (!record || record->state != State::kRunning || record->plan.empty()) return true;
    record->place = place_of_stop(card, *record);
    record->state = State::kStopped;
    file.write(*record);
    return true;
  } catch (const UsageError& error) {
    tell("note", fmt::format("the interrupted run cannot be resumed: {}", error.what()));
    return false;
  } catch (const std::exception&) {
    return true;
  }
}

}  // namespace trammel::app
