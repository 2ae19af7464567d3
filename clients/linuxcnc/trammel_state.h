/* SPDX-License-Identifier: GPL-2.0-only
 *
 * State of the component `trammel`, and the rules for when it follows the command, so that nothing moves unexpectedly.
 */
#ifndef TRAMMEL_STATE_H
#define TRAMMEL_STATE_H

#include "rtapi.h"
#include "trammel_follow.h"
#include "trammel_link.h"
#include "trammel_pins.h"

enum {
  LINK_PERIODS = 250,       /* periods without a new beat before link-ok falls; parameter link-periods */
  FAULT_WATCHDOG = 1 << 14, /* bit of trammel_status.fault, as in the register map */
  LEVEL_UP = 2,             /* increment of packet-error-level, as in hostmot2 */
  LEVEL_MOST = 10
};
/* Without a limit of acceleration, largest distance from card to command at which following may start. */
static const double start_distance = 2; /* pulses */
/* The owner refuses a target faster than maxvel times this factor; the margin is for the rounding of targets limited to
   maxvel. */
#define SPEED_RESERVE 1.05

enum mode {
  OFF,       /* no joint is enabled */
  WAITING,   /* enabled; the card is not at rest yet */
  FOLLOWING, /* enabled; the card gets the targets */
  LOST       /* enabled, but link, owner or card failed; lasts until every joint is disabled */
};

struct joint {
  struct follower follower;
  int64_t offset;     /* pulses from machine zero to HAL's zero, the index edge */
  double scale;       /* scale in force, pulses per unit */
  double shown;       /* value that position-scale shows for the machine file's scale */
  int follows;        /* enabled in the last period */
  int index_reported; /* the index was reported; the owner's bit stays set until it sees the period's bit fall */
};

struct card {
  struct card_pins* pins;
  struct link link;
  struct joint joints[TRAMMEL_JOINTS];
  int joint_count;
  enum mode mode;
  long long began;                     /* ns, start of this period; 0: `read` does not run */
  long long read_before, fresh_before; /* ns: last run of `read`; last new beat */
  uint64_t beat, session;
  uint32_t silent;     /* periods without a new beat */
  uint32_t waited;     /* periods in WAITING */
  int told, was_clear; /* the stop was reported; the pin `clear` in the last period */
  int clear_pending, dropped;
};

static const struct trammel_status* status_of(const struct card* card) { return &card->link.ring.status; }

static int card_failed(const struct card* card) {
  const struct trammel_status* status = status_of(card);
  return (status->flags & TRAMMEL_STATUS_FAULT) || status->state == TRAMMEL_STOPPED;
}

static int on_path(const struct card* card) { return card->pins->planner_module && *card->pins->coord_mode; }

static int any_enabled(const struct card* card) {
  int n;
  for (n = 0; n < card->joint_count; ++n) {
    if (*card->pins->joint[n].enable) return 1;
  }
  return 0;
}

static void lose(struct card* card, const char* why) {
  if (card->mode == LOST) return;
  card->mode = LOST;
  rtapi_print_msg(RTAPI_MSG_ERR, "trammel: %s; targets are followed again after the machine was off\n", why);
}

/* The realtime printf does not support "%.*s". */
static void tell_stop(const struct trammel_status* status) {
  char text[sizeof status->text];
  memcpy(text, status->text, sizeof text);
  text[sizeof text - 1] = '\0';
  rtapi_print_msg(RTAPI_MSG_ERR, "trammel: stop cause %u: %s\n", status->cause, text);
}

/* Runs in each period, with the newest status. */
static void watch(struct card* card) {
  const struct trammel_status* status = status_of(card);
  const int enabled = card->mode == WAITING || card->mode == FOLLOWING;
  if (status->session != card->session) {
    if (card->session != 0 && enabled) {
      *card->pins->session_lost = 1;
      lose(card, "another process owns the card now");
    }
    card->session = status->session;
  }
  if (enabled && !*card->pins->link_ok) {
    lose(card, "`trammel linuxcnc` does not answer: it has ended, was stopped, or has lost the card");
  }
  if (enabled && card_failed(card)) lose(card, "the card has stopped");
  if (card_failed(card) && !card->told && *card->pins->link_ok) tell_stop(status);
  card->told = card_failed(card);
}

/* The command in pulses from machine zero; NAN if it is not finite. */
static double commanded_pulses(const struct card* card, int n) {
  const double command = *card->pins->joint[n].position_cmd * card->joints[n].scale + (double)card->joints[n].offset;
  return isfinite(command) ? command : NAN;
}

/* Starts following; 0: the command is too far away. */
static int begin_joint(struct card* card, int n, double place) {
  const double command = commanded_pulses(card, n);
  follow_begin(&card->joints[n].follower, place, isnan(command) ? place : command);
  if (card->pins->joint[n].maxaccel > 0 || on_path(card)) return 1;
  return fabs(card->joints[n].follower.command - place) <= start_distance;
}

static void begin(struct card* card) {
  int n, near = 1;
  for (n = 0; n < card->joint_count; ++n) {
    const double place = (double)status_of(card)->position[n];
    const int enabled = card->joints[n].follows = *card->pins->joint[n].enable;
    if (!enabled) follow_begin(&card->joints[n].follower, place, place);
    if (enabled && !begin_joint(card, n, place)) near = 0;
  }
  card->mode = FOLLOWING;
  if (!near) lose(card, "position-cmd is not where the card stands: begin from position-fb, or set maxaccel");
}

/* Whether the card is at rest, and its owner has seen that the machine was off. */
static int may_begin(const struct card* card) {
  const struct trammel_status* status = status_of(card);
  return (status->flags & TRAMMEL_STATUS_AT_REST) && status->state != TRAMMEL_STREAMING;
}

static void update_mode(struct card* card) {
  if (!any_enabled(card)) {
    card->mode = OFF;
    *card->pins->session_lost = 0;
    return;
  }
  if (card->mode == OFF) {
    card->mode = WAITING;
    card->waited = 0;
    if (!*card->pins->link_ok) lose(card, "start `trammel linuxcnc` before the machine is switched on");
    if (card_failed(card)) lose(card, "clear the card's stop before the machine is switched on");
  }
  if (card->mode != WAITING) return;
  if (may_begin(card)) {
    begin(card);
  } else if (++card->waited > card->pins->link_periods) {
    lose(card, "the card still moves: switch the machine on when it stands");
  }
}

#endif
