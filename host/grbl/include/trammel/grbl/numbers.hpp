// Grbl 1.1's error and alarm numbers (its doc/csv files), and the mapping of the project's errors to them.
#pragma once

#include "trammel/gcode/error.hpp"

namespace trammel::grbl {

enum class Status {
  kOk = 0,
  kExpectedLetter = 1,
  kBadNumber = 2,
  kInvalidStatement = 3,
  kNegativeValue = 4,
  kHomingDisabled = 5,
  kStepPulseTooShort = 6,
  kNotIdle = 8,
  kLocked = 9,
  kSoftLimitsNeedHoming = 10,
  kLineTooLong = 11,
  kTravelExceeded = 15,
  kInvalidJog = 16,
  kUnsupported = 20,
  kModalGroup = 21,
  kNoFeed = 22,
  kNotInteger = 23,
  kAxisCommandConflict = 24,
  kRepeatedWord = 25,
  kNoAxisWords = 26,
  kLineNumber = 27,
  kMissingWord = 28,
  kCoordinateSystem = 29,
  kMachineCoordinates = 30,
  kAxisWordsUnused = 31,
  kNoAxisWordsInPlane = 32,
  kInvalidTarget = 33,
  kArcRadius = 34,
  kNoOffsetsInPlane = 35,
  kUnusedWords = 36,
  kToolLengthAxis = 37,
  kValueTooLarge = 38,
};

enum class Alarm {
  kNone = 0,
  kHardLimit = 1,
  kSoftLimit = 2,
  kPositionLost = 3,
  kProbeInitial = 4,
  kProbeMissed = 5,
  kHomingReset = 6,
  kHomingNoSwitch = 9,
  kEmergencyStop = 10,
};

// Grbl's error number that is closest to an error of the project's reader.
Status status_of(gcode::ErrorCode code);

}  // namespace trammel::grbl
