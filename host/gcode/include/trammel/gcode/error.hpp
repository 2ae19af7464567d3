// An error of a program, as a value: the code between the lines and the card's commands does not throw for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace trammel::gcode {

// One a kind of error. The numbers stay as they are, so that a server can give them to its clients.
enum class ErrorCode : std::uint16_t {
  // Lines and words
  kCannotRead = 1,
  kLineTooLong = 2,
  kUnexpectedCharacter = 3,
  kCommentNotClosed = 4,
  kCommentInComment = 5,
  kMalformedNumber = 6,
  kNumberOutOfRange = 7,
  kExponent = 8,
  kTextBesidePercent = 9,
  kUnsupportedWord = 10,
  kNoSuchLine = 11,  // to begin from
  kExpression = 12,
  kParameter = 13,  // no such number or name, or one that cannot be set
  kOWord = 14,
  kBesideLeftOut = 15,  // a G or M word on a line that is left out
  // Words of one line against each other
  kModalGroupTwice = 20,
  kLetterTwice = 21,
  kNegative = 22,
  kNotWhole = 23,
  kLineNumberNotFirst = 24,
  kNoSuchAxis = 25,
  kTwoUsesOfAxisWords = 26,  // G28 or G92 beside a motion, motors off for single axes
  kUnusedWord = 27,          // P without G4, I without G2 or G3
  kMissingWord = 28,         // G4 without P, G92 without an axis
  kNoMotionMode = 29,
  kMachineCoordinates = 30,  // G53 where it means nothing
  kDependsOnProbe = 31,      // what has to be known before the program begins
  kNoSuchTool = 32,
  kCoordinateSystem = 33,  // P of G10
  kInverseTime = 34,       // G93 where only a feed makes sense
  kCycleLevels = 35,       // R below the bottom, Q of 0
  kTooManyMotions = 36,    // of one line
  kNoProbe = 37,           // in the machine file
  kProbeWay = 38,          // of length 0
  kProbeMissed = 39,       // while it runs: G38.2 and G38.4
  // Feed
  kNoFeed = 40,
  kFeedTooSmall = 41,
  // Arcs
  kArcRadiusZero = 50,
  kArcRadiusTooSmall = 51,
  kArcRadiusFullCircle = 52,
  kArcRadiusAndCentre = 53,
  kArcNoCentre = 54,
  kArcOffCircle = 55,
  kArcOutsidePlane = 56,  // a centre word that the plane has not
  kArcPlaneAxis = 57,     // the machine lacks an axis of the plane
  kArcTurns = 59,         // P of an arc
  // Against machine and card: found where motions become pulses
  kSoftLimit = 70,
  kPositionRange = 71,
  kDwellTooLong = 72,
  kArcTooLarge = 73,
  kNoJerk = 74,    // of an axis that moves, where S-curves were asked for
  kNoOutput = 75,  // that the machine file names for a word
};

struct Error {
  ErrorCode code{};
  std::string file;
  std::size_t line = 0;  // from 1; 0: the program as a whole
  std::string message;   // one line
};

// "file:line: message", one line (machine::one_line()).
std::string describe(const Error& error);

// Text of a program for a message, as machine::one_line() has it.
inline constexpr std::size_t kLongestQuote = 80;
std::string quote(std::string_view text);

}  // namespace trammel::gcode
