/* SPDX-License-Identifier: GPL-2.0-only
 *
 * The planner module's state of the path, and its work in each servo period. The public state is in LinuxCNC's
 * TP_STRUCT. The data of a segment that the owner does not need stays here until the segment starts.
 */
#ifndef TRAMMEL_PLANNER_PATH_H
#define TRAMMEL_PLANNER_PATH_H

#include "trammel_planner_ring.h"

enum {
  KEPT = 4096,          /* segments; more than fit in the ring and the owner's queue */
  MOST_QUEUED = 1500,   /* limit of segments that have not started; above it LinuxCNC has to wait */
  RING_RESERVE = 64,    /* slots for operations other than segments */
  SILENT_PERIODS = 2000 /* silent periods after which the owner counts as gone or stopped */
};
enum { WAIT_NOT = 0, WAIT_AT_SPEED = 1, WAIT_PROBE = 2 };

struct segment {
  int id, type;
  unsigned char enables;
  double speed;
  struct state_tag_t tag;
  syncdio_t io;
  EmcPose end;
};

static struct ring ring;
static struct segment segments[KEPT];            /* by segment number */
static unsigned char waits[TRAMMEL_OPERATIONS];  /* by slot: condition for its publication */
static uint64_t posted, begun;                   /* numbers of segments posted and of segments started */
static uint64_t in_force_at, pose_in_force_at;   /* operations_done from which abort, clear or pose is in force */
static uint64_t probes, refusals, session, beat; /* values seen last */
static unsigned silent = SILENT_PERIODS + 1;     /* periods without a new beat */
static int clear_pending, pose_pending, reverse_told;
static uint32_t outputs_pending, levels_pending; /* outputs and levels of M64 and M65 */
static uint32_t switched;                        /* levels of LinuxCNC's outputs, as far as this module knows */
static EmcPose pose_to_set;

static emcmot_status_t* status;
static emcmot_config_t* config;
static void (*write_digital)(int, char);
static void (*write_analog)(int, double);

static void pose_to(double* to, const EmcPose* pose) {
  const double all[TRAMMEL_POSE] = {pose->tran.x, pose->tran.y, pose->tran.z, pose->a, pose->b,
                                    pose->c,      pose->u,      pose->v,      pose->w};
  memcpy(to, all, sizeof all);
}

static void pose_from(EmcPose* pose, const double* from) {
  pose->tran.x = from[0];
  pose->tran.y = from[1];
  pose->tran.z = from[2];
  pose->a = from[3];
  pose->b = from[4];
  pose->c = from[5];
  pose->u = from[6];
  pose->v = from[7];
  pose->w = from[8];
}

static void drop_outputs(TP_STRUCT* tp) { memset(&tp->syncdio, 0, sizeof tp->syncdio); }

/* Sets the state in which nothing is queued and nothing moves. */
static void rest(TP_STRUCT* tp) {
  begun = posted;
  tp->goalPos = tp->currentPos;
  tp->done = 1;
  tp->depth = tp->activeDepth = 0;
  tp->aborting = tp->pausing = 0;
  tp->execId = 0;
  tp->motionType = 0;
  status->current_vel = status->requested_vel = status->distance_to_go = 0;
  ZERO_EMC_POSE(status->dtg);
  status->enables_queued = status->enables_new;
  status->spindleSync = 0;
}

static void forget_unpublished(void) {
  while (ring.written != ring.head) {
    const struct trammel_operation* last = &ring.region->operations[--ring.written % TRAMMEL_OPERATIONS];
    if (last->segment != 0) posted = last->segment - 1;
  }
}

/* Sends the pending requests. motmod may make requests outside of coordinated mode, when no period runs here. The last
   request counts. */
static void flush_pending(void) {
  struct trammel_operation* operation;
  if (clear_pending && (operation = ring_slot(&ring, TRAMMEL_CLEAR)) != NULL) {
    clear_pending = 0;
    waits[ring.written % TRAMMEL_OPERATIONS] = WAIT_NOT;
    ring_fill(&ring);
    in_force_at = ring.written;
  }
  if (pose_pending && (operation = ring_slot(&ring, TRAMMEL_SET_POSE)) != NULL) {
    pose_pending = 0;
    pose_to(operation->end, &pose_to_set);
    waits[ring.written % TRAMMEL_OPERATIONS] = WAIT_NOT;
    ring_fill(&ring);
    in_force_at = pose_in_force_at = ring.written;
  }
  if (outputs_pending != 0 && (operation = ring_slot(&ring, TRAMMEL_SWITCH)) != NULL) {
    operation->outputs = outputs_pending;
    operation->levels = levels_pending;
    outputs_pending = levels_pending = 0;
    waits[ring.written % TRAMMEL_OPERATIONS] = WAIT_NOT;
    ring_fill(&ring);
  }
}

/* M64 and M65 bypass the planner: motmod switches the pin. Every level that this module has not set itself came from
   there. */
static void watch_outputs(void) {
  int n;
  for (n = 0; n < TRAMMEL_OUTPUTS && n < config->numDIO; ++n) {
    const uint32_t bit = UINT32_C(1) << n;
    const uint32_t level = status->synch_do[n] != 0 ? bit : 0;
    if (level == (switched & bit)) continue;
    switched ^= bit;
    outputs_pending |= bit;
    levels_pending = (levels_pending & ~bit) | level;
  }
}

static int all_at_speed(void) {
  int spindle;
  for (spindle = 0; spindle < config->numSpindles; ++spindle) {
    if (!status->spindle_status[spindle].at_speed) return 0;
  }
  return 1;
}

/* motmod tells how to probe only after the call that adds the motion. */
static void publish(void) {
  int any = 0;
  for (; ring.head != ring.written; any = 1) {
    const unsigned char wait = waits[ring.head % TRAMMEL_OPERATIONS];
    if (wait == WAIT_AT_SPEED && !all_at_speed()) break;
    if (wait == WAIT_PROBE) ring_next(&ring)->probe_away = (status->probe_type & 2) != 0;
    ring_publish_one(&ring);
  }
  if (any) ring_wake(&ring);
}

static void begin_abort(TP_STRUCT* tp) {
  forget_unpublished();
  if (ring_slot(&ring, TRAMMEL_ABORT) != NULL) {
    waits[ring.written % TRAMMEL_OPERATIONS] = WAIT_NOT;
    ring_fill(&ring);
  }
  in_force_at = ring.written;
  publish();
  tp->aborting = 1;
}

/* A segment starts at the card: switches its outputs, and shows its data in LinuxCNC. */
static void begin_segment(TP_STRUCT* tp, const struct segment* segment) {
  int n;
  tp->execId = segment->id;
  tp->execTag = segment->tag;
  tp->motionType = segment->type;
  status->enables_queued = segment->enables;
  status->requested_vel = segment->speed;
  if (!segment->io.anychanged) return;
  for (n = 0; n < EMCMOT_MAX_DIO; ++n) {
    if (!(segment->io.dio_mask >> n & 1)) continue;
    write_digital(n, segment->io.dios[n] > 0);
    if (n < TRAMMEL_OUTPUTS) switched = (switched & ~(UINT32_C(1) << n)) | (uint32_t)(segment->io.dios[n] > 0) << n;
  }
  for (n = 0; n < EMCMOT_MAX_AIO; ++n) {
    if (segment->io.aio_mask >> n & 1) write_analog(n, segment->io.aios[n]);
  }
}

/* Writes feed and rapid override. The factors for both (feed hold, adaptive feed, a pause) are the rest of motmod's net
   scale. */
static void write_scales(const TP_STRUCT* tp) {
  const int overrides = (status->enables_queued & FS_ENABLED) != 0;
  const double feed = overrides ? status->feed_scale : 1;
  const double rapid = overrides ? status->rapid_scale : 1;
  const double now = tp->motionType == EMC_MOTION_TYPE_TRAVERSE ? rapid : feed;
  const double most = config->maxFeedScale > 0 ? config->maxFeedScale : 1;
  double both = now > 0 ? status->net_feed_scale / now : 1;
  double limit = most;
  if (tp->pausing) both = 0;
  if (status->requested_vel > 0 && tp->vLimit > 0) limit = fmin(limit, tp->vLimit / status->requested_vel);
  ring_write_scales(&ring, fmin(feed * both, limit), fmin(rapid * both, fmin(limit, 1)));
}

static void write_way(const EmcPose* end, const EmcPose* here) {
  double way[TRAMMEL_POSE], from[TRAMMEL_POSE];
  int n;
  pose_to(way, end);
  pose_to(from, here);
  for (n = 0; n < TRAMMEL_POSE; ++n) way[n] -= from[n];
  pose_from(&status->dtg, way);
}

static void follow(TP_STRUCT* tp) {
  const struct trammel_status* now = &ring.status;
  if (now->operations_done >= pose_in_force_at) pose_from(&tp->currentPos, now->pose);
  while (begun < now->segments_begun && begun < posted) begin_segment(tp, &segments[++begun % KEPT]);
  tp->depth = tp->done ? 0 : (int)(posted - begun) + 1;
  tp->activeDepth = tp->done ? 0 : 1;
  status->tcqlen = tp->depth;
  if (tp->done || begun == 0) return;
  status->current_vel = now->path_speed;
  status->distance_to_go = now->distance_to_go;
  write_way(&segments[begun % KEPT].end, &tp->currentPos);
}

/* Takes the card's captured position of the edge. motmod has taken a position of its own, or has not seen the probe's
   pin yet. */
static void take_probe(void) {
  if (ring.status.probes == probes) return;
  probes = ring.status.probes;
  if (!ring.status.probe_tripped) return;
  pose_from(&status->probedPos, ring.status.probe_pose);
  if (status->probing) status->probeTripped = 1;
  status->probing = 0;
}

/* Runs once per servo period, in every mode of motmod. */
static void watch_owner(TP_STRUCT* tp) {
  const int replaced = session != 0 && ring.status.session != session;
  if (replaced || session == 0) {
    session = ring.status.session;
    probes = ring.status.probes;
    refusals = ring.status.refusals;
    if (replaced) pose_in_force_at = UINT64_MAX; /* the new owner does not know our position: wait until one is set */
  }
  if (ring.status.beat != beat) {
    silent = 0;
  } else if (silent <= SILENT_PERIODS) {
    ++silent;
  }
  beat = ring.status.beat;
  if (tp->done || (!replaced && silent <= SILENT_PERIODS)) return;
  rtapi_print_msg(RTAPI_MSG_ERR, "trammel_planner: the process that owns the card %s: start `trammel linuxcnc`\n",
                  replaced ? "was replaced in a motion" : "does not answer");
  status->motionFlag |= EMCMOT_MOTION_ERROR_BIT;
  forget_unpublished();
  rest(tp);
}

static int owner_answers(void) { return session != 0 && silent <= SILENT_PERIODS; }

/* Handles a refused operation or a fault of the card. */
static void take_refusal(TP_STRUCT* tp) {
  if (ring.status.refusals == refusals) return;
  refusals = ring.status.refusals;
  rtapi_print_msg(RTAPI_MSG_ERR, "trammel_planner: %.127s\n", ring.status.text);
  status->motionFlag |= EMCMOT_MOTION_ERROR_BIT;
  if (!tp->done && !tp->aborting) begin_abort(tp);
}

static int run_period(TP_STRUCT* tp) {
  int at_rest;
  ring_read_status(&ring);
  if (!owner_answers()) return TP_ERR_WAITING;
  flush_pending();
  publish();
  follow(tp);
  take_probe();
  take_refusal(tp);
  write_scales(tp);
  at_rest = (ring.status.flags & TRAMMEL_STATUS_AT_REST) != 0 && ring.status.operations_done == ring.head &&
            ring.head == ring.written;
  if (tp->done || !at_rest || ring.status.operations_done < in_force_at) return TP_ERR_OK;
  if (!tp->aborting) {
    while (begun < posted) begin_segment(tp, &segments[++begun % KEPT]);
  }
  rest(tp);
  return TP_ERR_STOPPED;
}

#endif
