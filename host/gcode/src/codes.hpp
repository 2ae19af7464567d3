// G codes by function, in tenths. Internal to the reader.
#pragma once

namespace trammel::gcode::code {

inline constexpr int kTraverse = 0;
inline constexpr int kLine = 10;
inline constexpr int kArcClockwise = 20;
inline constexpr int kArcCounterClockwise = 30;
inline constexpr int kDwell = 40;
inline constexpr int kSpline = 50;
inline constexpr int kQuadratic = 51;
inline constexpr int kSet = 100;
inline constexpr int kHome = 280;
inline constexpr int kStoreHome = 281;
inline constexpr int kSecondHome = 300;
inline constexpr int kStoreSecondHome = 301;
inline constexpr int kSkip = 310;              // G31: as G38.3, for one line
inline constexpr int kProbe = 382;             // towards the probe, a miss is an error
inline constexpr int kProbeQuietly = 383;      // towards the probe
inline constexpr int kProbeAway = 384;         // away from the probe, a miss is an error
inline constexpr int kProbeAwayQuietly = 385;  // away from the probe
inline constexpr int kToolLength = 430;
inline constexpr int kToolOffsets = 431;
inline constexpr int kLocalOrigin = 520;
inline constexpr int kMachineCoordinates = 530;
inline constexpr int kBlend = 640;
inline constexpr int kCancel = 800;
inline constexpr int kOrigin = 920;
inline constexpr int kOriginClear = 921;
inline constexpr int kOriginOff = 922;
inline constexpr int kOriginOn = 923;

}  // namespace trammel::gcode::code
