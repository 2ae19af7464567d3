/* SPDX-License-Identifier: GPL-2.0-only
 *
 * The target position of one joint in each period: LinuxCNC's command, limited in speed and acceleration. Pulses and
 * seconds. Arithmetic only, no types of HAL.
 */
#ifndef TRAMMEL_FOLLOW_H
#define TRAMMEL_FOLLOW_H

#include <math.h>
#include <stdint.h>

struct follower {
  double place;   /* target sent last, pulses from machine zero */
  double speed;   /* speed of the target, pulses/s */
  double command; /* command of the previous period */
};

static double clip(double value, double low, double high) { return value < low ? low : value > high ? high : value; }

static void follow_begin(struct follower* f, double place, double command) {
  f->place = place;
  f->speed = 0;
  f->command = command;
}

/* One period of `time` seconds. Without limits (0), or within them, the target equals the command. After the target was
   limited, the remaining distance closes at the limits, relative to the command's own speed. `most` is the largest
   difference of speeds that still closes it with whole periods of that deceleration. */
static void follow(struct follower* f, double command, double time, double max_speed, double max_acceleration) {
  const double commanded = (command - f->command) / time;
  const double left = f->command - f->place;
  const double wanted = commanded + left / time;
  double speed = wanted;
  if (max_acceleration > 0) {
    const double change = max_acceleration * time;
    const double most = sqrt(change * change / 4 + 2 * max_acceleration * fabs(left)) - change / 2;
    speed = commanded + clip(left / time, -most, most);
    speed = clip(speed, f->speed - change, f->speed + change);
  }
  if (max_speed > 0) speed = clip(speed, -max_speed, max_speed);
  f->place = speed == wanted ? command : f->place + speed * time;
  f->speed = speed;
  f->command = command;
}

/* One period of a joint that must stop: at the limit of acceleration, or at once without a limit. */
static void follow_brake(struct follower* f, double time, double max_acceleration) {
  const double change = max_acceleration * time;
  f->speed = max_acceleration > 0 ? f->speed - clip(f->speed, -change, change) : 0;
  f->place += f->speed * time;
  f->command = f->place;
}

/* The target in the unit of the shared memory, within its range. */
static int64_t follow_target(const struct follower* f) {
  const double most = 36028797018963968.0; /* 2^55 */
  return (int64_t)llrint(clip(f->place * 16777216.0, -most, most));
}

#endif
