/* SPDX-License-Identifier: GPL-2.0-only
 *
 * HAL component `trammel`. In each servo period it sends one target per joint to the process that owns the card
 * (`trammel linuxcnc`), and reads the card's state from it. docs/user/linuxcnc.md describes the pins.
 *
 *     loadrt trammel name=NAME joints=3
 *     addf trammel.read servo-thread      (first)
 *     addf trammel.write servo-thread     (last)
 */
#include "rtapi.h"
#include "rtapi_app.h"
#include "trammel_state.h"

MODULE_AUTHOR("The Trammel authors");
MODULE_DESCRIPTION("A Trammel stepper-motion card, by the process that owns it");
MODULE_LICENSE("GPL");

static char* name = NULL;
RTAPI_MP_STRING(name, "of the shared memory, as `trammel linuxcnc --name` has it; default: $TRAMMEL_LINUXCNC, else 0");
static int joints = 3;
RTAPI_MP_INT(joints, "number of joints, 1 to 8");

static int component = -1;
static struct card card;

static void read_joint(int n, int echo) {
  const struct trammel_status* status = status_of(&card);
  const struct joint_pins* pins = &card.pins->joint[n];
  const struct joint* joint = &card.joints[n];
  *pins->counts = (int32_t)(uint32_t)(uint64_t)status->position[n];
  *pins->homed = status->homed >> n & 1;
  if (joint->scale == 0) return;
  *pins->position_fb =
      echo && *pins->enable ? *pins->position_cmd : (double)(status->position[n] - joint->offset) / joint->scale;
  *pins->velocity_fb = status->speed[n] / joint->scale;
  *pins->stop_position = (double)(status->stop_position[n] - joint->offset) / joint->scale;
}

/* The index edge becomes HAL's zero. In this one period the feedback is the position of the command, counted from
   there: LinuxCNC then sets its command to the feedback, and a feedback that lags would command a jump. */
static void read_index(int n) {
  const struct trammel_status* status = status_of(&card);
  struct joint_pins* pins = &card.pins->joint[n];
  struct joint* joint = &card.joints[n];
  double place;
  if (!(status->index_latched >> n & 1)) joint->index_reported = 0;
  if (!*pins->index_enable || !(status->index_latched >> n & 1) || joint->index_reported) return;
  place = card.mode == FOLLOWING ? joint->follower.place : (double)status->position[n];
  joint->offset = status->index_position[n];
  joint->index_reported = 1;
  *pins->index_enable = 0;
  if (joint->scale != 0) *pins->position_fb = (place - (double)joint->offset) / joint->scale;
}

/* Takes over the scale in force. The parameter shows it if it is 0, or still shows the machine file's value. */
static void read_scale(int n) {
  struct joint_pins* pins = &card.pins->joint[n];
  struct joint* joint = &card.joints[n];
  const double in_force = status_of(&card)->pulses_per_unit[n];
  if (in_force == 0) return;
  if (pins->position_scale == 0 || pins->position_scale == joint->shown) {
    pins->position_scale = joint->shown = in_force;
  }
  joint->scale = in_force;
}

/* The card sets the watchdog's bit. If the user has cleared a bit that was set, the fault is to be cleared. */
static void read_watchdog(void) {
  static int was_set;
  const int bitten = (status_of(&card)->fault & FAULT_WATCHDOG) != 0;
  if (was_set && !*card.pins->watchdog) card.clear_pending = 1;
  was_set = bitten;
  *card.pins->watchdog = bitten;
}

static void read_card(void) {
  const struct trammel_status* status = status_of(&card);
  struct card_pins* pins = card.pins;
  int n;
  for (n = 0; n < CARD_INPUTS; ++n) {
    *pins->input[n] = status->inputs >> n & 1;
    *pins->input_not[n] = !*pins->input[n];
  }
  *pins->held = (status->flags & TRAMMEL_STATUS_HELD) != 0;
  *pins->at_rest = (status->flags & TRAMMEL_STATUS_AT_REST) != 0;
  *pins->probe = (status->flags & TRAMMEL_STATUS_PROBE) != 0;
  *pins->stop_cause = status->cause;
  *pins->underrun = status->missing;
  *pins->late = status->late;
  *pins->dropped = status->dropped;
  *pins->refused = status->refused;
  *pins->ahead = status->ahead;
  *pins->fault = !*pins->link_ok || card_failed(&card) || card.mode == LOST;
}

static void count_errors(int fresh) {
  struct card_pins* pins = card.pins;
  const int error = !fresh || card.dropped;
  *pins->packet_error = error;
  *pins->packet_error_level += error ? LEVEL_UP : *pins->packet_error_level > 0 ? -1 : 0;
  if (*pins->packet_error_level > LEVEL_MOST) *pins->packet_error_level = LEVEL_MOST;
  if (error && *pins->link_ok) ++*pins->packet_error_total;
}

/* Whether a new status came since the last period. A late thread runs many periods at once, so the link is lost only
   after both the number of periods and their time. */
static int read_status(long period) {
  const struct trammel_status* status = status_of(&card);
  const uint32_t most = card.pins->link_periods;
  int fresh = 0;
  if (link_has_owner(&card.link) && ring_read_status(&card.link.ring) == 0) fresh = status->beat != card.beat;
  if (fresh) {
    card.beat = status->beat;
    card.silent = 0;
    *card.pins->latency = card.mode == FOLLOWING ? link_latency(&card.link, (double)period * 1e-9) : 0;
  } else if (card.silent < UINT32_MAX) {
    ++card.silent;
  }
  *card.pins->link_ok = status->beat != 0 && (status->flags & TRAMMEL_STATUS_LINK) &&
                        (card.silent <= most || card.began - card.fresh_before <= (long long)most * period);
  return fresh;
}

static void keep_most(hal_u32_t* most, long long value) {
  if (value > *most) *most = value > UINT32_MAX ? UINT32_MAX : (hal_u32_t)value;
}

/* Measures, while the machine is on, the longest delays of LinuxCNC's thread and of the owner, to find which one stalls
   the motion. */
static void measure(long long now, int fresh) {
  if (card.mode == FOLLOWING) {
    keep_most(card.pins->longest_period, now - card.read_before);
    keep_most(card.pins->longest_silence, now - card.fresh_before);
  }
  card.read_before = now;
  if (fresh) card.fresh_before = now;
}

static void read_period(void* unused, long period) {
  int n, fresh, echo;
  (void)unused;
  card.began = rtapi_get_time();
  fresh = read_status(period);
  measure(card.began, fresh);
  watch(&card);
  echo = card.mode == FOLLOWING && on_path(&card);
  for (n = 0; n < card.joint_count; ++n) {
    read_scale(n);
    read_joint(n, echo);
    read_index(n);
  }
  read_watchdog();
  read_card();
  count_errors(fresh);
  keep_most(card.pins->longest_read, rtapi_get_time() - card.began);
}

static void write_settings(void) {
  struct trammel_settings settings = {0};
  int n;
  for (n = 0; n < card.joint_count; ++n) {
    const struct joint_pins* pins = &card.pins->joint[n];
    const double own = pins->position_scale == card.joints[n].shown ? 0 : pins->position_scale;
    settings.pulses_per_unit[n] = own;
    settings.max_speed[n] = SPEED_RESERVE * pins->maxvel * fabs(own != 0 ? own : card.joints[n].scale);
    settings.step_length[n] = pins->step_len;
    settings.step_space[n] = pins->step_space;
    settings.dir_setup[n] = pins->dir_setup;
    settings.dir_hold[n] = pins->dir_hold;
  }
  settings.lead_periods = card.pins->lead_periods;
  settings.joints = (uint32_t)card.joint_count;
  link_write_settings(&card.link, &settings);
}

static void move_joint(int n, double time, int path) {
  const struct joint_pins* pins = &card.pins->joint[n];
  struct joint* joint = &card.joints[n];
  const double acceleration = pins->maxaccel * fabs(joint->scale);
  const double command = commanded_pulses(&card, n);
  const int enabled = *pins->enable && !isnan(command);
  if (enabled && path) {
    follow_begin(&joint->follower, command, command);
  } else if (enabled && (joint->follows || begin_joint(&card, n, joint->follower.place))) {
    follow(&joint->follower, command, time, pins->maxvel * fabs(joint->scale), acceleration);
  } else if (enabled) {
    lose(&card, "position-cmd of a joint that was enabled by itself is not where the joint stands");
  } else {
    follow_brake(&joint->follower, time, acceleration);
  }
  joint->follows = enabled;
}

/* While the machine is off, the target is the card's own position. */
static void move_joints(long period) {
  const int path = on_path(&card);
  int n;
  for (n = 0; n < card.joint_count; ++n) {
    if (card.mode == FOLLOWING) {
      move_joint(n, (double)period * 1e-9, path);
    } else {
      const double place = (double)status_of(&card)->position[n];
      follow_begin(&card.joints[n].follower, place, place);
    }
  }
}

static uint32_t flags(void) {
  uint32_t result = card.mode == FOLLOWING ? TRAMMEL_PERIOD_ENABLE : 0;
  int n;
  if (*card.pins->hold) result |= TRAMMEL_PERIOD_HOLD;
  if (on_path(&card)) result |= TRAMMEL_PERIOD_PATH;
  if (card.clear_pending) result |= TRAMMEL_PERIOD_CLEAR;
  for (n = 0; n < card.joint_count; ++n) {
    if (*card.pins->joint[n].index_enable) result |= 1u << (TRAMMEL_PERIOD_INDEX_SHIFT + (uint32_t)n);
  }
  return result;
}

static void send_period(long long began, long period) {
  struct trammel_period* slot = link_period(&card.link, began);
  const uint32_t drop = card.pins->test_drop_one_in;
  int n;
  card.dropped = slot == NULL || (drop != 0 && card.link.number % drop == 0);
  if (card.dropped) return;
  slot->duration = (uint32_t)period;
  slot->flags = flags();
  for (n = 0; n < card.joint_count; ++n) slot->target[n] = follow_target(&card.joints[n].follower);
  card.clear_pending = 0;
  link_publish(&card.link);
  ring_wake(&card.link.ring);
}

static void write_period(void* unused, long period) {
  const long long began = rtapi_get_time();
  (void)unused;
  if (*card.pins->clear && !card.was_clear) card.clear_pending = 1;
  card.was_clear = *card.pins->clear;
  update_mode(&card);
  move_joints(period);
  write_settings();
  send_period(card.began != 0 ? card.began : began, period);
  card.began = 0;
  keep_most(card.pins->longest_write, rtapi_get_time() - began);
}

static int refuse(int error) {
  rtapi_print_msg(RTAPI_MSG_ERR, "trammel: cannot share memory %s/%s%s: %s\n", TRAMMEL_REGION_FOLDER,
                  TRAMMEL_REGION_PREFIX, name, ring_text_of(error));
  return error;
}

static int export_all(void) {
  int n, bad = 0;
  card.pins = hal_malloc(sizeof *card.pins);
  if (card.pins == NULL) return -ENOMEM;
  memset(card.pins, 0, sizeof *card.pins);
  card.pins->link_periods = LINK_PERIODS;
  for (n = 0; n < joints; ++n) bad |= export_joint(&card.pins->joint[n], n, component);
  bad |= export_card(card.pins, component);
  bad |= hal_export_funct("trammel.read", read_period, NULL, 1, 0, component);
  bad |= hal_export_funct("trammel.write", write_period, NULL, 1, 0, component);
  return bad != 0 ? -EINVAL : 0;
}

int rtapi_app_main(void) {
  const char* environment = getenv("TRAMMEL_LINUXCNC");
  int error;
  if (name == NULL || name[0] == '\0') {
    name = (char*)(environment != NULL && environment[0] != '\0' ? environment : "0");
  }
  if (joints < 1 || joints > TRAMMEL_JOINTS) {
    rtapi_print_msg(RTAPI_MSG_ERR, "trammel: joints=%d: 1 to %d\n", joints, TRAMMEL_JOINTS);
    return -EINVAL;
  }
  memset(&card, 0, sizeof card);
  card.joint_count = joints;
  error = link_attach(&card.link, name);
  if (error != 0) return refuse(error);
  component = hal_init("trammel");
  error = component < 0 ? component : export_all();
  if (error == 0) return hal_ready(component);
  if (component >= 0) hal_exit(component);
  link_detach(&card.link);
  return error;
}

/* LinuxCNC has already stopped its threads. The last period switches the machine off. */
void rtapi_app_exit(void) {
  struct trammel_period* last = link_period(&card.link, rtapi_get_time());
  hal_exit(component);
  if (last != NULL) {
    link_publish(&card.link);
    ring_wake(&card.link.ring);
  }
  link_detach(&card.link);
}
