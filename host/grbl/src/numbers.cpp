#include "trammel/grbl/numbers.hpp"

namespace trammel::grbl {

Status status_of(gcode::ErrorCode code) {
  using gcode::ErrorCode;
  switch (code) {
    case ErrorCode::kMalformedNumber:
    case ErrorCode::kNumberOutOfRange:
    case ErrorCode::kExponent:
      return Status::kBadNumber;
    case ErrorCode::kUnexpectedCharacter:
      return Status::kExpectedLetter;
    case ErrorCode::kModalGroupTwice:
      return Status::kModalGroup;
    case ErrorCode::kLetterTwice:
      return Status::kRepeatedWord;
    case ErrorCode::kNegative:
      return Status::kNegativeValue;
    case ErrorCode::kMissingWord:
      return Status::kMissingWord;
    case ErrorCode::kUnusedWord:
    case ErrorCode::kArcOutsidePlane:
      return Status::kUnusedWords;
    case ErrorCode::kMachineCoordinates:
      return Status::kMachineCoordinates;
    case ErrorCode::kNoFeed:
    case ErrorCode::kFeedTooSmall:
    case ErrorCode::kInverseTime:
      return Status::kNoFeed;
    case ErrorCode::kArcRadiusTooSmall:
      return Status::kArcRadius;
    case ErrorCode::kArcNoCentre:
      return Status::kNoOffsetsInPlane;
    case ErrorCode::kArcRadiusZero:
    case ErrorCode::kArcRadiusFullCircle:
    case ErrorCode::kArcOffCircle:
    case ErrorCode::kArcTooLarge:
    case ErrorCode::kProbeWay:
    case ErrorCode::kPositionRange:
      return Status::kInvalidTarget;
    case ErrorCode::kSoftLimit:
      return Status::kTravelExceeded;
    default:
      return Status::kUnsupported;
  }
}

}  // namespace trammel::grbl
