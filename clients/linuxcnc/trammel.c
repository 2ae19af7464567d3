/* SPDX-License-Identifier: GPL-2.0-only
 *
 * HAL component `trammel`: LinuxCNC's joints on a Trammel card, which `trammel linuxcnc` owns.
 *
 *     loadrt trammel joints=3 name=0
 *     addf trammel.0.read servo-thread     before LinuxCNC's motion controller
 *     addf trammel.0.write servo-thread    behind it
 *
 * Neither function waits for the other process, allocates memory or calls the kernel for anything but a wake-up. */
#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "rtapi.h"
#include "rtapi_app.h"
#include "trammel_link.h"
#include "trammel_pins.h"

MODULE_AUTHOR("The Trammel authors");
MODULE_DESCRIPTION("LinuxCNC's joints on a Trammel card");
MODULE_LICENSE("GPL");

static char* name = "0";
RTAPI_MP_STRING(name, "of the card's owner: trammel linuxcnc --name");
static int joints = 3;
RTAPI_MP_INT(joints, "joints, 1 to 8");

#define PULSE 16777216.0             /* 2^24 */
#define FARTHEST 36028797018963968.0 /* 2^55 */
#define DEFAULT_LINK_PERIODS 100
#define LEVEL_LIMIT 100

static int component;
static struct card* card;
static struct link peer;

static uint64_t number;  /* of the next period */
static uint64_t session; /* of the owner that is followed; 0: none */
static unsigned silent;  /* periods since its last beat */
static int blocked;      /* until the machine is disabled: the link was lost while it was enabled */
static int was_enabled;
static uint32_t dice = 1; /* for test-drop */

static double scale_of(int n) {
  const double own = card->joints[n].position_scale;
  return own != 0 ? own : peer.status.pulses_per_unit[n];
}

static int is_enabled(void) {
  int n;
  for (n = 0; n < joints; ++n) {
    if (*card->joints[n].enable) return 1;
  }
  return 0;
}

static void note_longest(hal_u32_t* longest, long long began) {
  const long long took = rtapi_get_time() - began;
  if (took > *longest) *longest = (hal_u32_t)took;
}

/* Whether the owner lives, and is the one that is followed. */
static void watch_owner(int is_new) {
  const struct trammel_status* status = &peer.status;
  const int enabled = is_enabled();
  silent = is_new ? 0 : silent + 1;
  *card->link_ok = status->session != 0 && silent <= card->link_periods && (status->flags & TRAMMEL_STATUS_LINK) != 0;
  if (enabled && was_enabled && !*card->link_ok) blocked = 1;
  if (status->session != session) {
    if (session != 0 && was_enabled) {
      *card->session_lost = 1;
    } else if (!*card->session_lost) {
      session = status->session;
    }
  }
  if (!enabled) {
    blocked = 0;
    *card->session_lost = 0;
    session = status->session;
  }
}

static void read_joint(int n, int fresh) {
  struct joint* joint = &card->joints[n];
  const struct trammel_status* status = &peer.status;
  const double scale = scale_of(n);
  if (!fresh) return;
  *joint->homed = (status->homed >> n & 1u) != 0;
  *joint->valid = (status->valid >> n & 1u) != 0;
  if (*joint->index_enable && joint->index_sent != 0 && status->last_period >= joint->index_sent &&
      (status->index_latched >> n & 1u) != 0) {
    joint->offset = status->index_position[n];
    joint->index_sent = 0;
    *joint->index_enable = 0;
  }
  *joint->counts = (hal_s32_t)(uint32_t)(uint64_t)(status->position[n] - joint->offset);
  if (scale == 0) return;
  *joint->position_fb = (double)(status->position[n] - joint->offset) / scale;
  *joint->velocity_fb = status->speed[n] / scale;
  *joint->stop_position = (double)(status->stop_position[n] - joint->offset) / scale;
  *joint->probe_position = (double)(status->capture_position[n] - joint->offset) / scale;
}

static void read_card(int fresh) {
  const struct trammel_status* status = &peer.status;
  int n;
  *card->fault = (status->flags & TRAMMEL_STATUS_FAULT) != 0 || *card->session_lost || blocked;
  *card->ready = *card->link_ok && !*card->fault;
  if (!fresh) return;
  *card->probe = (status->flags & TRAMMEL_STATUS_PROBE) != 0;
  *card->held = (status->flags & TRAMMEL_STATUS_HELD) != 0;
  *card->at_rest = (status->flags & TRAMMEL_STATUS_AT_REST) != 0;
  if (status->missing > *card->underrun && (status->flags & TRAMMEL_STATUS_FAULT) != 0) *card->has_bit = 1;
  *card->underrun = status->missing;
  *card->late = status->late;
  *card->dropped = status->dropped;
  *card->refused = status->refused;
  *card->ahead = status->ahead;
  *card->stop_cause = status->cause;
  *card->probe_count = (hal_u32_t)status->captures;
  for (n = 0; n < TRAMMEL_INPUT_PINS; ++n) {
    *card->input[n] = (status->inputs >> n & 1u) != 0;
    *card->input_not[n] = !*card->input[n];
  }
}

static void read_function(void* unused, long period) {
  const long long began = rtapi_get_time();
  const int is_new = link_read_status(&peer);
  int n;
  (void)unused;
  (void)period;
  watch_owner(is_new);
  /* Positions of another owner would be another machine's. */
  const int fresh = is_new && !*card->session_lost && session != 0;
  for (n = 0; n < joints; ++n) read_joint(n, fresh);
  read_card(fresh);
  /* In coordinated motion by the planner module the command is the echo of the card. */
  if (*card->path) {
    for (n = 0; n < joints; ++n) *card->joints[n].position_fb = *card->joints[n].position_cmd;
  }
  note_longest(card->longest_read, began);
}

static void write_settings(void) {
  static struct trammel_settings settings;
  int n;
  for (n = 0; n < joints; ++n) {
    const struct joint* joint = &card->joints[n];
    settings.pulses_per_unit[n] = joint->position_scale;
    settings.max_speed[n] = fabs(joint->maxvel * scale_of(n));
    settings.step_length[n] = joint->steplen;
    settings.step_space[n] = joint->stepspace;
    settings.dir_setup[n] = joint->dirsetup;
    settings.dir_hold[n] = joint->dirhold;
  }
  settings.lead_periods = card->lead_periods;
  settings.joints = (uint32_t)joints;
  link_set_settings(&peer, &settings);
}

/* A joint that is not enabled, and one with a command that is no number, stays. */
static int64_t target_of(struct joint* joint, int n) {
  const double pulses = *joint->position_cmd * scale_of(n) + (double)joint->offset;
  if (*joint->enable && fabs(pulses) * PULSE < FARTHEST) joint->target = (int64_t)floor(pulses * PULSE + 0.5);
  return joint->target;
}

static uint32_t flags_of(int enabled) {
  uint32_t flags = 0;
  int n;
  if (enabled && *card->link_ok && !blocked && !*card->session_lost) flags |= TRAMMEL_PERIOD_ENABLE;
  if (*card->hold) flags |= TRAMMEL_PERIOD_HOLD;
  if (*card->path) flags |= TRAMMEL_PERIOD_PATH;
  if (*card->clear) flags |= TRAMMEL_PERIOD_CLEAR;
  for (n = 0; n < joints; ++n) {
    struct joint* joint = &card->joints[n];
    if (!*joint->index_enable) {
      joint->index_sent = 0;
      continue;
    }
    if (joint->index_sent == 0) joint->index_sent = number;
    flags |= 1u << (TRAMMEL_PERIOD_INDEX_SHIFT + n);
  }
  return flags;
}

/* For tests: so many periods of a thousand are lost. */
static int is_dropped(void) {
  dice = dice * 1664525u + 1013904223u;
  return (dice >> 8) % 1000u < card->test_drop;
}

static void write_function(void* unused, long duration) {
  static struct trammel_period period;
  const long long began = rtapi_get_time();
  const int enabled = is_enabled();
  int lost;
  int n;
  (void)unused;
  if (!enabled) {
    /* The machine stands where the card says. */
    for (n = 0; n < joints; ++n) card->joints[n].target = peer.status.position[n] * (int64_t)PULSE;
    write_settings();
  }
  ++number;
  period.number = number;
  period.time = began;
  period.duration = (uint32_t)duration;
  period.flags = flags_of(enabled);
  for (n = 0; n < joints; ++n) period.target[n] = target_of(&card->joints[n], n);
  lost = is_dropped() || !link_send(&peer, &period);
  *card->packet_error = lost || !*card->link_ok;
  if (*card->packet_error) {
    ++*card->packet_errors;
    if (*card->packet_error_level < LEVEL_LIMIT) *card->packet_error_level += 2;
  } else if (*card->packet_error_level > 0) {
    --*card->packet_error_level;
  }
  was_enabled = enabled;
  note_longest(card->longest_write, began);
}

int rtapi_app_main(void) {
  const char* error;
  if (joints < 1 || joints > TRAMMEL_JOINTS) {
    rtapi_print_msg(RTAPI_MSG_ERR, "trammel: joints=%d is outside 1 .. %d\n", joints, TRAMMEL_JOINTS);
    return -EINVAL;
  }
  component = hal_init("trammel");
  if (component < 0) return component;
  card = hal_malloc(sizeof *card);
  if (card == NULL) {
    hal_exit(component);
    return -ENOMEM;
  }
  memset(card, 0, sizeof *card);
  error = link_attach(&peer, name);
  if (error != NULL) {
    rtapi_print_msg(RTAPI_MSG_ERR, "trammel: name=%s: %s\n", name, error);
    hal_exit(component);
    return -EIO;
  }
  card->link_periods = DEFAULT_LINK_PERIODS;
  if (export_card(card, component, joints) != 0 ||
      hal_export_funct("trammel.0.read", read_function, NULL, 1, 0, component) != 0 ||
      hal_export_funct("trammel.0.write", write_function, NULL, 1, 0, component) != 0) {
    link_detach(&peer);
    hal_exit(component);
    return -EINVAL;
  }
  hal_ready(component);
  return 0;
}

/* The machine is off from here on. */
void rtapi_app_exit(void) {
  static struct trammel_period last;
  hal_exit(component);
  last.number = ++number;
  (void)link_send(&peer, &last);
  link_detach(&peer);
}
