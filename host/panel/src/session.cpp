#include "trammel/panel/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "request.hpp"
#include "trammel/panel/texts.hpp"

namespace trammel::panel {
namespace {

using grbl::State;

constexpr std::uint8_t kHold = '!';
constexpr std::uint8_t kResume = '~';
constexpr std::uint8_t kReset = 0x18;
constexpr std::uint8_t kCancelJog = 0x85;
constexpr int kHoming = 22;              // number of Grbl's setting
constexpr unsigned kLinesChecked = 500;  // per call of serve()
constexpr std::size_t kNotesKept = 50;
constexpr auto kHomedFresh = std::chrono::milliseconds(500);
constexpr double kMinute = 60;
// mm or degrees, largest distance of a jog if the axis has no soft limit.
constexpr double kFarthest = 10'000;
// Coordinates in a line have four decimals.
constexpr double kGrid = 1e4;

bool begins_with(const std::string& text, const char* what) { return text.rfind(what, 0) == 0; }

}  // namespace

PanelSession::PanelSession(grbl::MachineSide& machine, grbl::Settings& settings, Now now)
    : machine_(machine),
      now_(std::move(now)),
      begun_(now_()),
      homed_(machine.homed()),
      homed_at_(begun_),
      controller_(machine, settings, [this](const std::string& text) { hear(text); }) {
  // Home has its own button; a machine that has not been homed is locked until it is homed or unlocked by Recover.
  if (machine.can_home() && !settings.flag(kHoming)) settings.set(kHoming, 1);
}

std::int64_t PanelSession::milliseconds() const {
  return std::chrono::duration_cast<std::chrono::milliseconds>(now_() - begun_).count();
}

void PanelSession::note(const std::string& text, bool error) {
  notes_.push_back({++noted_, error, text});
  if (notes_.size() > kNotesKept) notes_.pop_front();
}

void PanelSession::arrived() {
  end_jog();
  if (program_.phase() == Program::Phase::kLoading) program_.unload();
  page_ = true;
}

void PanelSession::left() {
  page_ = false;
  end_jog();
  if (program_.phase() == Program::Phase::kLoading) program_.unload();
  program_.end_check("The page has gone");
  if (!program_.running() || !hold_when_gone_ || controller_.state() == State::kHold) return;
  note("The page has gone: the program is held.");
  realtime(kHold);
}

void PanelSession::receive(std::string_view message) {
  const std::optional<Request> request = Request::parse(message);
  if (!request) return note("A message of the page was not understood.", true);
  take(*request);
}

void PanelSession::take(const Request& request) {
  const std::string& what = request.what;
  if (what == "held") {
    if (jog_ && jog_->id == request.id && !came_late(request, kDeadMan)) jog_->held = now_();
  } else if (what == "release") {
    if (jog_ && jog_->id == request.id && jog_->step == 0) end_jog();
  } else if (what == "hold") {
    realtime(kHold);
  } else if (what == "stop") {
    stop();
  } else if (what == "feed" || what == "rapid") {
    override_by(request);
  } else if (what == "when_gone") {
    hold_when_gone_ = request.hold;
  } else if (what == "load" || what == "part" || what == "loaded") {
    if (!take_load(request)) note("The program was not taken: it is too long, or the machine moves.", true);
  } else if (came_late(request, what == "jog" ? kDeadMan : kLate)) {
    if (what == "jog") last_jog_ = request.id;
    note(fmt::format("Refused, the connection is slow: {} came too late.", what), true);
  } else if (what == "jog") {
    take_jog(request);
  } else if (what == "resume") {
    realtime(kResume);
  } else if (what == "start") {
    take_start();
  } else if (what == "zero") {
    take_zero(request);
  } else if (what == "home" || what == "unlock") {
    commands_.emplace_back(what == "home" ? "$H" : "$X");
  } else {
    note(fmt::format("A message of the page was not understood: {}", what), true);
  }
}

bool PanelSession::came_late(const Request& request, std::chrono::milliseconds longest) const {
  return milliseconds() - request.clock > longest.count();
}

// Whether the machine is at rest and may move; otherwise a note gives the reason.
bool PanelSession::is_ready(const std::string& what) {
  if (controller_.state() == State::kAlarm) {
    note(fmt::format("{}: refused in an alarm. Recover or home first.", what), true);
    return false;
  }
  if (program_.running() || program_.checking() || controller_.state() != State::kIdle || !controller_.idle()) {
    note(fmt::format("{}: refused, the machine must stand and no program may run.", what), true);
    return false;
  }
  return true;
}

bool PanelSession::take_load(const Request& request) {
  if (request.what == "load") {
    const bool stands = controller_.state() == State::kIdle || controller_.state() == State::kAlarm;
    if (program_.running() || program_.checking() || !stands) return false;
    program_.begin_loading(request.text);
    line_ = 0;
    return true;
  }
  if (request.what == "part") {
    if (program_.phase() != Program::Phase::kLoading || program_.append(request.text)) return true;
    program_.unload();
    return false;
  }
  if (program_.phase() != Program::Phase::kLoading) return true;  // the reason was given before
  if (const auto reason = program_.finish_loading()) note(*reason, true);
  return true;
}

void PanelSession::take_start() {
  if (!is_ready("Start") || !program_.check()) return;
  line_ = 0;
  check_.emplace(controller_.interpreter());
}

// Checks the lines as the controller would, so that no motion starts for a program that the controller would refuse in
// the middle.
void PanelSession::check_program() {
  if (!program_.checking()) return;
  for (unsigned n = 0; n < kLinesChecked; ++n) {
    const std::optional<Program::Line> line = program_.next();
    grbl::Block block;
    const grbl::Status status = line ? check_->read(line->text, block) : grbl::Status::kOk;
    if (status != grbl::Status::kOk) {
      program_.end_check(fmt::format("Line {}: {}", line->number, error_text(static_cast<int>(status))));
      return note(fmt::format("{}: not started. {}.", program_.name(), program_.stop_reason()), true);
    }
    if (line && !block.end) continue;
    program_.start();
    return note(fmt::format("{}: started.", program_.name()));
  }
}

void PanelSession::take_zero(const Request& request) {
  if (request.axis >= machine_.machine().axes.size() || !is_ready("Work zero")) return;
  send(Sent::kCommand, fmt::format("G10L20P0{}0", machine_.machine().axes[request.axis].letter));
}

void PanelSession::override_by(const Request& request) {
  const bool feed = request.what == "feed";
  switch (request.change) {
    case 0:
      return realtime(feed ? 0x90 : 0x95);
    case 10:
      return realtime(0x91);
    case -10:
      return realtime(0x92);
    case 1:
      return realtime(0x93);
    case -1:
      return realtime(0x94);
    case 50:
      return realtime(0x96);
    case 25:
      return realtime(0x97);
    default:
      return;
  }
}

void PanelSession::realtime(std::uint8_t byte) {
  const char c = static_cast<char>(byte);
  controller_.receive(std::string_view(&c, 1));
}

void PanelSession::stop() {
  jog_.reset();
  commands_.clear();
  end_program("Stopped by the operator");
  realtime(kReset);
}

void PanelSession::take_jog(const Request& request) {
  last_jog_ = std::max(last_jog_, request.id);
  if (jog_) return;
  const bool jogs = controller_.state() == State::kJog;  // the previous jog is still ramping down
  if (request.axis >= machine_.machine().axes.size() || (!jogs && !is_ready("Jog"))) return;
  Jog jog;
  jog.id = request.id;
  jog.axis = request.axis;
  jog.way = request.way < 0 ? -1 : 1;
  jog.step = std::clamp(request.step, 0.0, kFarthest);
  jog.share = std::clamp(request.percent, 1.0, 100.0) / 100;
  jog.held = now_();
  jog_ = jog;
  serve_jog();
}

// The line "$J=...", or empty if the axis is at its soft limit.
std::string PanelSession::jog_line(const Jog& jog) const {
  const machine::MachineAxis& axis = machine_.machine().axes[jog.axis];
  const double at = machine_.look().at[jog.axis];
  const double limit = jog.way > 0 ? std::floor(axis.max * kGrid) / kGrid : std::ceil(axis.min * kGrid) / kGrid;
  const double left = (limit - at) * jog.way;  // infinite without a limit
  const double wanted = jog.step > 0 ? jog.step : kFarthest;
  const double feed = std::max(axis.max_velocity * kMinute * jog.share, 0.1);
  if (left < 1 / axis.steps_per_mm) return {};
  if (left > wanted) return fmt::format("$J=G91G21{}{:.4f}F{:.1f}", axis.letter, jog.way * wanted, feed);
  return fmt::format("$J=G53G21{}{:.4f}F{:.1f}", axis.letter, limit, feed);
}

void PanelSession::serve_jog() {
  if (!jog_) return;
  if (now_() - jog_->held >= kDeadMan) {
    note("The jog has ended: the page was silent for 300 ms.", true);
    return end_jog();
  }
  const bool stands = controller_.state() == State::kIdle && controller_.idle();
  if (controller_.state() == State::kAlarm || (jog_->sent && stands)) {
    jog_.reset();
  } else if (!jog_->sent && stands) {
    const std::string line = jog_line(*jog_);
    if (line.empty()) {
      note(fmt::format("{} is at its soft limit.", machine_.machine().axes[jog_->axis].letter));
      jog_.reset();
      return;
    }
    jog_->sent = true;
    send(Sent::kJog, line);
  }
}

void PanelSession::end_jog() {
  if (!jog_) return;
  const bool sent = jog_->sent;
  jog_.reset();
  if (sent) realtime(kCancelJog);
}

void PanelSession::send(Sent kind, const std::string& line) {
  sent_.push_back(kind);
  controller_.receive(line + "\n");
  controller_.serve();
}

// Sends one line at a time, so that no line after a refused one has been sent.
void PanelSession::feed_program() {
  while (program_.running() && sent_.empty() &&
         (controller_.state() == State::kIdle || controller_.state() == State::kRun)) {
    const std::optional<Program::Line> line = program_.next();
    if (!line) {
      if (!controller_.idle()) return;
      program_.done();
      return note(fmt::format("{}: done.", program_.name()));
    }
    send(Sent::kProgram, line->text);
  }
}

void PanelSession::serve() {
  serve_jog();
  controller_.serve();
  check_program();
  feed_program();
  if (controller_.idle()) return;
  const int line = controller_.report_now().line;
  if (line > 0) line_ = static_cast<std::size_t>(line);
}

void PanelSession::work() {
  // Only here, because a homing that is started within `meanwhile` could not serve the page.
  if (!commands_.empty() && sent_.empty() && controller_.idle()) {
    const std::string command = commands_.front();
    commands_.pop_front();
    send(Sent::kCommand, command);
    homed_at_ -= kHomedFresh;
  }
  if (controller_.idle() && now_() - homed_at_ >= kHomedFresh) {
    homed_ = machine_.homed();
    homed_at_ = now_();
  }
  serve();
  controller_.work();
}

void PanelSession::hear(const std::string& text) {
  heard_ += text;
  for (std::size_t end = heard_.find('\n'); end != std::string::npos; end = heard_.find('\n')) {
    std::string line = heard_.substr(0, end);
    heard_.erase(0, end + 1);
    while (!line.empty() && line.back() == '\r') line.pop_back();
    hear_line(line);
  }
}

void PanelSession::hear_line(const std::string& line) {
  if (line == "ok" || begins_with(line, "error:")) {
    hear_answer(line);
  } else if (begins_with(line, "ALARM:")) {
    alarm_ = {std::atoi(line.c_str() + 6), ""};
    sent_.clear();
    jog_.reset();
    note(alarm_text(alarm_.number), true);
    end_program(alarm_text(alarm_.number));
  } else if (begins_with(line, "[MSG:") && line.back() == ']') {
    hear_message(line.substr(5, line.size() - 6));
  } else if (begins_with(line, "Grbl ")) {
    reset_heard();
  }
}

void PanelSession::hear_answer(const std::string& line) {
  if (sent_.empty()) return;
  const Sent kind = sent_.front();
  sent_.pop_front();
  if (line == "ok") return;
  const std::string reason = error_text(std::atoi(line.c_str() + 6));
  if (kind != Sent::kProgram) return note(fmt::format("Refused: {}", reason), true);
  program_.stop(fmt::format("Line {}: {}", program_.sent(), reason));
  note(fmt::format("{}: {}. The lines before it are finished.", program_.name(), program_.stop_reason()), true);
}

void PanelSession::hear_message(const std::string& text) {
  if (text == "'$H'|'$X' to unlock") return;
  if (text == "Pgm End") return program_.skip_rest();
  if (begins_with(text, "Caution")) {
    alarm_ = {};
    return note("Recovered. Check that the machine stands where the page says.");
  }
  const bool alarm = controller_.state() == State::kAlarm;
  if (alarm) alarm_.reason = text;
  note(text, true);
  if (!alarm && program_.running()) {
    sent_.clear();
    program_.stop(text);
  }
}

// Called at once, so that no further line is sent.
void PanelSession::end_program(const std::string& reason) {
  if (program_.running()) note(fmt::format("{}: stopped at line {}.", program_.name(), line_));
  program_.end_check(reason);
  program_.stop(reason);
}

// A reset has ended all commands in progress.
void PanelSession::reset_heard() {
  sent_.clear();
  if (controller_.state() != State::kAlarm) alarm_ = {};
  end_program("Stopped by a reset");
}

}  // namespace trammel::panel
