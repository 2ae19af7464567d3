// An error of a program, as a value: no code between the program's lines and the card's commands throws for it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace trammel::gcode {

// One per kind of error. The numbers never change, so that a server can give them to its clients.
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
  kNoSuchLine = 11,  // the program ends before the line to begin from
  kExpression = 12,
  kParameter = 13,  // no such number or name, or one that cannot be set
  kOWord = 14,
  kBesideLeftOut = 15,  // another G or M word on a line that is left out
  // Words of one line that contradict each other
  kModalGroupTwice = 20,
  kLetterTwice = 21,
  kNegative = 22,
  kNotWhole = 23,
  kLineNumberNotFirst = 24,
  kNoSuchAxis = 25,
  kTwoUsesOfAxisWords = 26,  // G28 or G92 with a motion, motors off for single axes
  kUnusedWord = 27,          // P without G4, I without G2 or G3
  kMissingWord = 28,         // G4 without P, G92 without an axis
  kNoMotionMode = 29,
  kMachineCoordinates = 30,  // G53 with relative distances or a motion other than G0 and G1
  kDependsOnProbe = 31,      // a value that a probe decides, but must be known before
  kNoSuchTool = 32,
  kCoordinateSystem = 33,  // P of G10
  kInverseTime = 34,       // G93 with a motion that needs a feed
  kCycleLevels = 35,       // of a drilling cycle: R below the bottom, Q of 0
  kTooManyMotions = 36,    // one line makes too many motions
  kNoProbe = 37,           // the machine file has no probe, or the card cannot probe
  kProbeWay = 38,          // a probe motion of length 0
  kProbeMissed = 39,       // G38.2 or G38.4 ended without a change of the input
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
  kArcOutsidePlane = 56,  // a centre word of an axis outside the plane
  kArcPlaneAxis = 57,     // the machine lacks an axis of the plane
  kArcTurns = 59,         // P of an arc: not a whole number of turns in the range
  // Program against machine and card; found when motions become pulses
  kSoftLimit = 70,
  kPositionRange = 71,
  kDwellTooLong = 72,
  kArcTooLarge = 73,
  kNoJerk = 74,    // of a moving axis, when S-curves are demanded
  kNoOutput = 75,  // the machine file names no output for a word, or the card cannot switch it
};

struct Error {
  ErrorCode code{};
  std::string file;
  std::size_t line = 0;  // from 1; 0: the program as a whole
  std::string message;   // one line
};

// "file:line: message", one line (machine::one_line()).
std::string describe(const Error& error);

// Text of a program for a message, shortened and made printable by machine::one_line().
inline constexpr std::size_t kLongestQuote = 80;
std::string quote(std::string_view text);

}  // namespace trammel::gcode
