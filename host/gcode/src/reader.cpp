#include "trammel/gcode/reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "characters.hpp"
#include "codes.hpp"
#include "interpreter.hpp"
#include "left_out.hpp"
#include "other_words.hpp"

namespace trammel::gcode {
namespace {

std::string_view without_blanks_before(std::string_view line) {
  while (!line.empty() && (line.front() == ' ' || line.front() == '\t')) {
    line.remove_prefix(1);
  }
  return line;
}

}  // namespace

class Reader::Impl {
 public:
  Impl(LineSource& lines, const machine::Machine& machine, const Coordinates& start, const ReaderOptions& options)
      : lines_(lines),
        axes_(machine),
        interpreter_(machine, start),
        parameters_(interpreter_),
        options_(options),
        left_out_(options.left_out) {
    interpreter_.begin_spindle(options.spindle, options.spindle_speed);
    for (const auto& [number, value] : options.parameters) {
      parameters_.preset(number, value);
      interpreter_.preset(number, value);
    }
  }

  bool next(Motion& motion) {
    while (given_ == motions_.size()) {
      if (ended_ || error_ || awaits_probe_) {
        return false;
      }
      motions_.clear();
      given_ = 0;
      if (!read_line() || (ended_ && ended_at_ < first_line_ && !fail_before_first_line())) {
        motions_.clear();
        return false;
      }
    }
    motion = motions_[given_++];
    awaits_probe_ = motion.kind == MotionKind::kProbe;
    motion.feed *= options_.feed_scale;
    if (motion.kind != MotionKind::kDwell) motion.seconds /= options_.feed_scale;
    return true;
  }

  void must_reach(std::size_t line) { first_line_ = line; }

  bool awaits_probe() const { return awaits_probe_; }
  void probed(const Coordinates& edge, const Coordinates& rest, bool tripped) {
    interpreter_.probed(edge, rest, tripped);
    awaits_probe_ = false;
  }
  void assume_probed() {
    interpreter_.assume_probed();
    awaits_probe_ = false;
  }
  std::size_t lines_on_probes() const { return interpreter_.lines_on_probes(); }
  std::map<int, double> parameters() const {
    std::map<int, double> numbers;
    parameters_.collect(numbers);
    interpreter_.collect(numbers);
    return numbers;
  }

  const std::optional<Error>& error() const { return error_; }
  const std::map<std::string, std::size_t>& accepted() {
    if (left_out_.for_printers() && dwells_by_p_ != 0) accepted_["G4 P"] = dwells_by_p_;
    return accepted_;
  }
  const std::string& file() const { return lines_.name(); }

 private:
  // Reads the next line and makes its motions. False at an error.
  bool read_line() {
    std::string_view line;
    if (!next_line(line)) {
      end();
      return !error_;
    }
    if (!options_.block_delete && !line.empty() && line.front() == '/') {
      line = without_blanks_before(line.substr(1));
    }
    if (line.empty() || line.front() == '/') {
      return !error_;
    }
    if (line.front() == '%') {
      return percent(line);
    }
    std::string_view left_out;
    if (left_out_.find(line, left_out, problem_)) {
      in_program_ = has_words_ = true;
      ++accepted_[std::string(left_out)];
      return !left_out_.failed() || fail();
    }
    if (!has_words_ && is_program_number(line)) {
      in_program_ = true;
      return !error_;
    }
    if (!words_.read(line, axes_, parameters_, problem_)) {
      name_command(line);
      return fail();
    }
    has_words_ = has_words_ || !words_.empty();
    in_program_ = in_program_ || has_words_;
    if (feeds_extruder()) left_out_.set_for_printers();
    if (words_.accepted_begin() != words_.accepted_end()) {
      count_accepted();
    }
    if (!words_.is_plain()) {
      count_modes();
    }
    const Interpreter::Outcome outcome = interpreter_.execute(words_, number_, motions_, problem_);
    ended_ = outcome == Interpreter::Outcome::kEnded;
    ended_at_ = number_;
    return outcome != Interpreter::Outcome::kFailed || fail();
  }

  void end() {
    ended_ = true;
    ended_at_ = number_;
    interpreter_.end(number_, motions_);
  }

  // Gets the next line, without blanks before it. A line that is too long sets the error and is given as empty. False
  // at the end, and when the source failed, which sets the error.
  bool next_line(std::string_view& line) {
    if (!lines_.next(line)) {
      if (const auto failure = lines_.failure()) {
        fail(ErrorCode::kCannotRead, "cannot read the program: " + *failure);
      }
      return false;
    }
    ++number_;
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (number_ == 1 && line.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
      line.remove_prefix(kByteOrderMark.size());
    }
    if (line.size() > kLongestLine) {
      fail(ErrorCode::kLineTooLong, fmt::format("a line of more than {} bytes", kLongestLine));
      line = {};
    }
    line = without_blanks_before(line);
    return true;
  }

  // The first '%' opens the program; the next one, or one after words, ends it. The lines after the end are read, so
  // that no motion is left out silently.
  bool percent(std::string_view line) {
    if (!only_comments(line.substr(1))) {
      return fail();
    }
    if (!in_program_) {
      in_program_ = true;
      return true;
    }
    end();
    while (next_line(line)) {
      if (error_) {
        return false;
      }
      const bool deleted = !line.empty() && line.front() == '/';
      const bool mark = !line.empty() && line.front() == '%';
      if (!deleted && !only_comments(line.substr(mark ? 1 : 0))) {
        return fail();
      }
    }
    return !error_;
  }

  // Sets a problem if anything but blanks and comments is on the line of a '%' or after the last one.
  bool only_comments(std::string_view text) {
    WordScanner scanner(text, parameters_);
    Word word{};
    const bool any = scanner.next(word, problem_) || scanner.failed() || parameters_.any_assigned();
    parameters_.drop_assigned();
    return !any ||
           problem_.set(ErrorCode::kTextBesidePercent, fmt::format("'{}' beside or behind '%', where nothing is read",
                                                                   quote(without_blanks_before(text))));
  }

  // O1234 before all words.
  bool is_program_number(std::string_view line) {
    if (line.size() < 2 || upper(line.front()) != 'O' || !is_digit(line[1])) return false;
    return only_comments(line.substr(std::min(line.find_first_not_of("0123456789", 1), line.size())));
  }

  // Names the command of Klipper, if the line is one instead of G-code.
  void name_command(std::string_view line) {
    const std::string_view name = command_name(line);
    if (name.empty()) return;
    problem_.set(
        ErrorCode::kUnsupportedWord,
        fmt::format("'{}' is a command or macro of Klipper: let the slicer write the G-code that it stands for",
                    quote(name)));
  }

  bool feeds_extruder() const {
    const std::uint8_t extruder = axes_['E'];
    return (extruder != AxisLetters::kNone && words_.has_axis(extruder)) || words_.code(Group::kExtruder);
  }

  // Counts words that have an effect, but less than a user may expect.
  void count_modes() {
    if (words_.code(Group::kPathControl) && words_.letter('Q')) ++accepted_["G64 Q"];  // naive cam: no lines are joined
    const std::optional<int> action = words_.code(Group::kNonModal);
    if (action == code::kHome) ++accepted_["G28"];  // no switch is searched
    if (action == code::kDwell && words_.letter('P').value_or(0) > 0) ++dwells_by_p_;
  }

  void count_accepted() {
    for (const WordSet::Accepted* word = words_.accepted_begin(); word != words_.accepted_end(); ++word) {
      if (word->letter == 'S' && (words_.dwells_by_s() || interpreter_.sets_pulse_width())) continue;
      if (word->letter == 'M' && interpreter_.switches(word->number)) {
        continue;
      }
      std::string name(1, word->letter);
      if (word->number >= 0) {
        name += std::to_string(word->number);
      }
      ++accepted_[name];
    }
  }

  bool fail_before_first_line() {
    return fail(ErrorCode::kNoSuchLine,
                fmt::format("the program ends before line {}, where it is to begin", first_line_));
  }
  bool fail() {
    if (!problem_.unknown.empty()) name_unknown();
    return fail(problem_.code, problem_.message);
  }
  // Adds to the message how to run the program without the unknown word, and without those in later lines.
  void name_unknown() {
    const std::size_t here = number_;
    std::vector<std::string> names{problem_.unknown};
    std::string_view line;
    while (options_.name_all_unknown && next_line(line)) {
      std::string name = left_out_.unknown(line);
      if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
    }
    number_ = here;
    problem_.message += fmt::format("; --accept {} leaves out the lines that begin with {}", fmt::join(names, ","),
                                    names.size() == 1 ? "it" : "these words");
  }
  bool fail(ErrorCode code, const std::string& message) {
    error_ = Error{code, lines_.name(), number_, message};
    return false;
  }

  LineSource& lines_;
  AxisLetters axes_;
  Interpreter interpreter_;
  Parameters parameters_;
  ReaderOptions options_;
  LeftOut left_out_;
  std::size_t number_ = 0;  // number of the present line
  std::size_t first_line_ = 0;
  bool in_program_ = false;  // a word, a program number or a '%' has been read
  bool has_words_ = false;   // a word has been read
  std::size_t dwells_by_p_ = 0;
  bool ended_ = false;
  std::size_t ended_at_ = 0;  // the line that ended the program
  bool awaits_probe_ = false;
  WordSet words_;
  LineMotions motions_;
  std::size_t given_ = 0;  // number of motions_ that next() has returned
  Problem problem_;
  std::optional<Error> error_;
  std::map<std::string, std::size_t> accepted_;
};

Reader::Reader(LineSource& lines, const machine::Machine& machine, const Coordinates& start,
               const ReaderOptions& options)
    : impl_(std::make_unique<Impl>(lines, machine, start, options)) {}
Reader::~Reader() = default;
Reader::Reader(Reader&&) noexcept = default;
Reader& Reader::operator=(Reader&&) noexcept = default;

bool Reader::next(Motion& motion) { return impl_->next(motion); }
bool Reader::awaits_probe() const { return impl_->awaits_probe(); }
void Reader::probed(const Coordinates& edge, const Coordinates& rest, bool tripped) {
  impl_->probed(edge, rest, tripped);
}
void Reader::assume_probed() { impl_->assume_probed(); }
std::size_t Reader::lines_on_probes() const { return impl_->lines_on_probes(); }
std::map<int, double> Reader::parameters() const { return impl_->parameters(); }
void Reader::must_reach(std::size_t line) { impl_->must_reach(line); }
const std::optional<Error>& Reader::error() const { return impl_->error(); }
const std::map<std::string, std::size_t>& Reader::accepted() const { return impl_->accepted(); }
const std::string& Reader::file() const { return impl_->file(); }

}  // namespace trammel::gcode
