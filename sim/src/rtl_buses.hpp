// Fields of the RTL's bundles, for those who drive and read the ports of Verilated blocks.
// Written by scripts/rtl/buses from the packages of rtl/buses; edit those.
#pragma once

#include "bus_field.hpp"

namespace trammel::bus {

namespace arrival {
inline constexpr Field kHalfword{0, 16};
inline constexpr Field kFeedWrite{16, 1};
inline constexpr Field kFeedCommit{17, 1};
inline constexpr Field kGeometryWrite{18, 1};
inline constexpr Field kGeometryCommit{19, 1};
inline constexpr Field kDrop{20, 1};
inline constexpr Field kFull{21, 1};
inline constexpr unsigned kWidth = 22;
}  // namespace arrival

namespace axis_drive {
inline constexpr Field kChordWord{0, 16};
inline constexpr Field kChordLoad{16, 8};
inline constexpr Field kChordSwap{24, 8};
inline constexpr Field kStep{32, 8};
inline constexpr Field kDir{40, 8};
inline constexpr Field kTick{48, 1};
inline constexpr Field kSwap{49, 1};
inline constexpr unsigned kWidth = 50;
}  // namespace axis_drive

namespace axis_observe {
inline constexpr Field kStep{0, 1};
inline constexpr Field kDir{1, 1};
inline constexpr Field kPosition{2, 32};
inline constexpr Field kCounts{34, 1};
inline constexpr Field kCountsBack{35, 1};
inline constexpr unsigned kWidth = 36;
}  // namespace axis_observe

namespace capture_answer {
inline constexpr Field kCaptured{0, 4};
inline constexpr Field kQueued{4, 4};
inline constexpr Field kFull{8, 1};
inline constexpr unsigned kWidth = 9;
}  // namespace capture_answer

namespace capture {
inline constexpr Field kAsk{0, 4};
inline constexpr Field kPassed{4, 4};
inline constexpr Field kEdge{8, 4};
inline constexpr Field kState{12, 32};
inline constexpr unsigned kWidth = 44;
}  // namespace capture

namespace card_constants {
inline constexpr Field kFirst{0, 512};
inline constexpr unsigned kWidth = 512;
}  // namespace card_constants

namespace commands {
inline constexpr Field kTakeOutput{0, 1};
inline constexpr Field kTakeMark{1, 1};
inline constexpr Field kOver{2, 1};
inline constexpr Field kRuns{3, 1};
inline constexpr Field kProbeWaits{4, 1};
inline constexpr Field kProbeEnds{5, 1};
inline constexpr Field kTakePwm{6, 1};
inline constexpr unsigned kWidth = 7;
}  // namespace commands

namespace engines {
inline constexpr Field kReady{0, 1};
inline constexpr Field kPayloadReady{1, 1};
inline constexpr Field kShadowsFree{2, 1};
inline constexpr Field kDone{3, 1};
inline constexpr Field kMissedEnd{4, 1};
inline constexpr Field kLive{5, 1};
inline constexpr Field kBusy{6, 1};
inline constexpr Field kQuiet{7, 1};
inline constexpr unsigned kWidth = 8;
}  // namespace engines

namespace feed_load {
inline constexpr Field kWord{0, 16};
inline constexpr Field kTarget{16, 3};
inline constexpr Field kValid{19, 1};
inline constexpr unsigned kWidth = 20;
}  // namespace feed_load

namespace feed {
inline constexpr Field kAtBarrier{0, 1};
inline constexpr Field kRuns{1, 1};
inline constexpr Field kAtRest{2, 1};
inline constexpr Field kStopping{3, 1};
inline constexpr Field kSilent{4, 1};
inline constexpr Field kClosing{5, 1};
inline constexpr Field kCaused{6, 1};
inline constexpr Field kLatched{7, 1};
inline constexpr Field kEnabled{8, 1};
inline constexpr Field kReleased{9, 1};
inline constexpr Field kHealthy{10, 1};
inline constexpr Field kPump{11, 1};
inline constexpr Field kGives{12, 1};
inline constexpr Field kRatio{13, 17};
inline constexpr Field kRate{30, 32};
inline constexpr unsigned kWidth = 62;
}  // namespace feed

namespace geometry_state {
inline constexpr Field kGeometryBegun{0, 32};
inline constexpr Field kStaleTicks{32, 32};
inline constexpr Field kPathSwap{64, 1};
inline constexpr Field kStale{65, 1};
inline constexpr Field kWaiting{66, 1};
inline constexpr Field kPathActive{67, 1};
inline constexpr Field kEnded{68, 1};
inline constexpr Field kDirect{69, 1};
inline constexpr unsigned kWidth = 70;
}  // namespace geometry_state

namespace input_levels {
inline constexpr Field kLevels{0, 32};
inline constexpr Field kRaw{32, 32};
inline constexpr Field kQuiet{64, 32};
inline constexpr unsigned kWidth = 96;
}  // namespace input_levels

namespace input_roles {
inline constexpr Field kLimitMinus{0, 8};
inline constexpr Field kLimitPlus{8, 8};
inline constexpr Field kDriveFault{16, 8};
inline constexpr Field kFeedHold{24, 1};
inline constexpr Field kCycleStart{25, 1};
inline constexpr Field kToolSetter{26, 1};
inline constexpr Field kProbe{27, 1};
inline constexpr unsigned kWidth = 28;
}  // namespace input_roles

namespace load_bus {
inline constexpr Field kWord{0, 16};
inline constexpr Field kTarget{16, 4};
inline constexpr Field kUnit{20, 5};
inline constexpr Field kValid{25, 1};
inline constexpr unsigned kWidth = 26;
}  // namespace load_bus

namespace move {
inline constexpr Field kEngine{0, 5};
inline constexpr Field kAxes{5, 8};
inline constexpr Field kSwap{13, 1};
inline constexpr Field kDirect{14, 1};
inline constexpr Field kTaking{15, 1};
inline constexpr unsigned kWidth = 16;
}  // namespace move

namespace observe {
inline constexpr Field kTick{0, 1};
inline constexpr Field kPathTick{1, 1};
inline constexpr Field kPathSwap{2, 1};
inline constexpr Field kFeedSwap{3, 1};
inline constexpr Field kRatio{4, 17};
inline constexpr Field kRate{21, 32};
inline constexpr Field kFeedBegun{53, 32};
inline constexpr Field kGeometryBegun{85, 32};
inline constexpr Field kFault{117, 32};
inline constexpr Field kStatus{149, 32};
inline constexpr Field kFeedRoom{181, 16};
inline constexpr Field kGeometryRoom{197, 16};
inline constexpr unsigned kWidth = 213;
}  // namespace observe

namespace path {
inline constexpr Field kTaking{0, 1};
inline constexpr Field kDirect{1, 1};
inline constexpr Field kStreaming{2, 1};
inline constexpr Field kBarrierBegins{3, 1};
inline constexpr Field kBarrierCounts{4, 1};
inline constexpr Field kBarrierDone{5, 1};
inline constexpr Field kDrop{6, 1};
inline constexpr Field kHalt{7, 1};
inline constexpr Field kHold{8, 1};
inline constexpr Field kMismatch{9, 1};
inline constexpr Field kIncomplete{10, 1};
inline constexpr Field kMissing{11, 1};
inline constexpr Field kProbing{12, 1};
inline constexpr Field kUnfinished{13, 1};
inline constexpr Field kLeft{14, 40};
inline constexpr unsigned kWidth = 54;
}  // namespace path

namespace pins_state {
inline constexpr Field kInputs{0, 32};
inline constexpr Field kOutputs{32, 16};
inline constexpr Field kMarks{48, 32};
inline constexpr Field kProbed{80, 1};
inline constexpr Field kProbeMissed{81, 1};
inline constexpr unsigned kWidth = 82;
}  // namespace pins_state

namespace probe {
inline constexpr Field kMet{0, 1};
inline constexpr Field kTaken{1, 1};
inline constexpr Field kStays{2, 1};
inline constexpr Field kHold{3, 1};
inline constexpr Field kBusy{4, 1};
inline constexpr unsigned kWidth = 5;
}  // namespace probe

namespace pwm_order {
inline constexpr Field kDuty{0, 16};
inline constexpr Field kGain{16, 16};
inline constexpr Field kShift{32, 5};
inline constexpr Field kFollows{37, 1};
inline constexpr unsigned kWidth = 38;
}  // namespace pwm_order

namespace queue_state {
inline constexpr Field kFeedRoom{0, 16};
inline constexpr Field kGeometryRoom{16, 16};
inline constexpr Field kFeedLow{32, 1};
inline constexpr Field kGeometryLow{33, 1};
inline constexpr unsigned kWidth = 34;
}  // namespace queue_state

namespace refusal {
inline constexpr Field kReason{0, 8};
inline constexpr Field kNumber{8, 8};
inline constexpr Field kRefuse{16, 1};
inline constexpr Field kClear{17, 1};
inline constexpr unsigned kWidth = 18;
}  // namespace refusal

namespace register_access {
inline constexpr Field kData{0, 32};
inline constexpr Field kAddress{32, 12};
inline constexpr Field kPartial{44, 1};
inline constexpr Field kWrite{45, 1};
inline constexpr Field kOfSession{46, 1};
inline constexpr Field kNewSession{47, 1};
inline constexpr Field kPort{48, 2};
inline constexpr Field kRequest{50, 1};
inline constexpr unsigned kWidth = 51;
}  // namespace register_access

namespace register_answer {
inline constexpr Field kData{0, 32};
inline constexpr Field kError{32, 1};
inline constexpr Field kAck{33, 1};
inline constexpr unsigned kWidth = 34;
}  // namespace register_answer

namespace setting_bus {
inline constexpr Field kData{0, 32};
inline constexpr Field kWord{32, 10};
inline constexpr Field kSet{42, 1};
inline constexpr unsigned kWidth = 43;
}  // namespace setting_bus

namespace snapshot {
inline constexpr Field kWord{0, 32};
inline constexpr Field kStrobe{32, 1};
inline constexpr Field kShift{33, 1};
inline constexpr Field kRest{34, 1};
inline constexpr unsigned kWidth = 35;
}  // namespace snapshot

namespace start_answer {
inline constexpr Field kReason{0, 8};
inline constexpr Field kError{8, 1};
inline constexpr Field kDone{9, 1};
inline constexpr Field kAddress{10, 10};
inline constexpr unsigned kWidth = 20;
}  // namespace start_answer

namespace start {
inline constexpr Field kData{0, 32};
inline constexpr Field kMask{32, 8};
inline constexpr Field kStart{40, 1};
inline constexpr unsigned kWidth = 41;
}  // namespace start

namespace stop_causes {
inline constexpr Field kLimit{0, 1};
inline constexpr Field kBeyond{1, 1};
inline constexpr Field kDriveFault{2, 1};
inline constexpr Field kProbe{3, 1};
inline constexpr Field kToolSetter{4, 1};
inline constexpr unsigned kWidth = 5;
}  // namespace stop_causes

namespace stream_answer {
inline constexpr Field kReason{0, 8};
inline constexpr Field kNumber{8, 8};
inline constexpr Field kRefuse{16, 1};
inline constexpr Field kReady{17, 1};
inline constexpr Field kPartial{18, 1};
inline constexpr unsigned kWidth = 19;
}  // namespace stream_answer

namespace time_state {
inline constexpr Field kFault{0, 32};
inline constexpr Field kFeedBegun{32, 32};
inline constexpr Field kUnderruns{64, 32};
inline constexpr Field kRate{96, 32};
inline constexpr Field kRatio{128, 17};
inline constexpr Field kTick{145, 1};
inline constexpr Field kFeedSwap{146, 1};
inline constexpr Field kUnderrun{147, 1};
inline constexpr Field kHeld{148, 1};
inline constexpr Field kFeedActive{149, 1};
inline constexpr Field kStopping{150, 1};
inline constexpr Field kLimitState{151, 28};
inline constexpr Field kButtonHold{179, 1};
inline constexpr Field kPlace{180, 16};
inline constexpr Field kSettled{196, 1};
inline constexpr Field kEnabled{197, 1};
inline constexpr Field kEnableWaits{198, 1};
inline constexpr unsigned kWidth = 199;
}  // namespace time_state

namespace wishbone_answer {
inline constexpr Field kDat{0, 32};
inline constexpr Field kStall{32, 1};
inline constexpr Field kErr{33, 1};
inline constexpr Field kAck{34, 1};
inline constexpr unsigned kWidth = 35;
}  // namespace wishbone_answer

namespace wishbone_request {
inline constexpr Field kDat{0, 32};
inline constexpr Field kAdr{32, 12};
inline constexpr Field kSel{44, 4};
inline constexpr Field kWe{48, 1};
inline constexpr Field kStb{49, 1};
inline constexpr Field kCyc{50, 1};
inline constexpr unsigned kWidth = 51;
}  // namespace wishbone_request

}  // namespace trammel::bus
