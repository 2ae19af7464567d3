component trammel_planner "LinuxCNC's trajectory planner on a Trammel card: [TRAJ]TPMOD = trammel_planner";
description """
Hands lines and arcs to the process that owns the card (`trammel linuxcnc`), which plans them and keeps them in the
card's queue; follows the card's position. docs/user/linuxcnc-planner.md tells how to use it and what it refuses.""";
pin out bit link_ok "The process that owns the card answers.";
pin out u32 longest_call "Longest time that one call of the module took, ns.";
pin out u32 longest_cycle "Longest time that one servo period took in the module, ns.";
pin out u32 stale_copies "Periods in which the owner's status could not be copied.";
pin out u32 queued "Motions that LinuxCNC has handed over and the card has not begun.";
license "GPL-2.0-only";
author "The Trammel authors";
option tpmod;
option extra_setup;
;;
#include "posemath.h"
#include "rtapi_math.h"
#include "motion.h"
#include "tp.h"
#include "tc.h"
#include "tcq.h"
#include "motion_types.h"
#include "emcpose.h"

#include "trammel_planner_path.h"

static long long longest;  /* ns, of one call */
static TP_STRUCT* planner; /* motmod makes one */

/* Every call that fills the ring or runs a period is timed. */
static void time_call(long long began) {
  const long long took = rtapi_get_time() - began;
  if (took > longest) longest = took;
}

static int refused(const char* what) {
  rtapi_print_msg(RTAPI_MSG_ERR, "trammel_planner: %s: not supported; use LinuxCNC's own planner for it\n", what);
  return TP_ERR_FAIL;
}

/* What LinuxCNC would have to do behind the planner's back. */
static int check_machine(const TP_STRUCT* tp, int locking_joint) {
  int joint;
  if (tp->aborting) return TP_ERR_FAIL;
  if (tp->synchronized) return refused("a spindle-synchronous motion (G33, G33.1, G95)");
  if (config->kinType != KINEMATICS_IDENTITY) return refused("kinematics other than trivkins");
  if (status->external_offsets_applied) return refused("external offsets");
  if (locking_joint >= 0) return refused("a locking rotary axis");
  for (joint = 0; joint < config->numJoints; ++joint) {
    if (status->joint_status[joint].backlash != 0) return refused("backlash compensation");
  }
  return TP_ERR_OK;
}

struct motion {
  EmcPose end;
  int type;
  double speed, most_speed, acceleration;
  unsigned char enables;
  char at_speed;
  struct state_tag_t tag;
};

/* The card switches those that the machine file names in their place on the path. */
static void set_outputs(struct trammel_operation* operation, const syncdio_t* io) {
  int n;
  if (!io->anychanged) return;
  for (n = 0; n < TRAMMEL_OUTPUTS; ++n) {
    if (!(io->dio_mask >> n & 1)) continue;
    operation->outputs |= UINT32_C(1) << n;
    if (io->dios[n] > 0) operation->levels |= UINT32_C(1) << n;
  }
}

/* Fills a slot, which the next period publishes. NULL: the ring is full. */
static struct trammel_operation* add(TP_STRUCT* tp, uint32_t kind, const struct motion* motion) {
  struct trammel_operation* operation;
  struct segment* segment;
  flush_pending();
  operation = ring_slot(&ring, kind);
  if (operation == NULL) {
    refused("more motions than the memory shared with `trammel linuxcnc` holds");
    return NULL;
  }
  segment = &segments[++posted % KEPT];
  segment->id = tp->nextId;
  segment->type = motion->type;
  segment->enables = motion->enables;
  segment->speed = motion->speed;
  segment->tag = motion->tag;
  segment->io = tp->syncdio;
  segment->end = motion->end;
  operation->id = tp->nextId;
  operation->segment = posted;
  operation->motion = motion->type;
  operation->blending = tp->termCond == TC_TERM_COND_STOP    ? TRAMMEL_EXACT_STOP
                        : tp->termCond == TC_TERM_COND_EXACT ? TRAMMEL_EXACT_PATH
                                                             : TRAMMEL_BLEND;
  operation->tolerance = operation->blending == TRAMMEL_BLEND ? tp->tolerance : 0;
  operation->scale_by_feed = (motion->enables & FS_ENABLED) != 0;
  operation->speed = motion->speed;
  operation->most_speed = motion->most_speed;
  operation->most_acceleration = motion->acceleration;
  pose_to(operation->end, &motion->end);
  set_outputs(operation, &tp->syncdio);
  waits[ring.written % TRAMMEL_OPERATIONS] = motion->type == EMC_MOTION_TYPE_PROBING ? WAIT_PROBE
                                             : motion->at_speed                      ? WAIT_AT_SPEED
                                                                                     : WAIT_NOT;
  ring_fill(&ring);
  drop_outputs(tp);
  tp->goalPos = motion->end;
  tp->done = 0;
  ++tp->depth;
  return operation;
}

static int same_pose(const EmcPose* a, const EmcPose* b) {
  double all_a[TRAMMEL_POSE], all_b[TRAMMEL_POSE];
  int n;
  pose_to(all_a, a);
  pose_to(all_b, b);
  for (n = 0; n < TRAMMEL_POSE; ++n) {
    if (fabs(all_a[n] - all_b[n]) >= TP_POS_EPSILON) return 0;
  }
  return 1;
}

int tpAddLine(TP_STRUCT* const tp, EmcPose end, int type, double speed, double most_speed, double acceleration,
              unsigned char enables, char at_speed, int locking_joint, struct state_tag_t tag) {
  const long long began = rtapi_get_time();
  const struct motion motion = {end, type, speed, most_speed, acceleration, enables, at_speed, tag};
  int result = check_machine(tp, locking_joint);
  if (result != TP_ERR_OK) return result;
  if (same_pose(&tp->goalPos, &end)) return TP_ERR_ZERO_LENGTH;
  if (add(tp, TRAMMEL_LINE, &motion) == NULL) result = TP_ERR_FAIL;
  time_call(began);
  return result;
}

int tpAddCircle(TP_STRUCT* const tp, EmcPose end, PmCartesian centre, PmCartesian normal, int turns, int type,
                double speed, double most_speed, double acceleration, unsigned char enables, char at_speed,
                struct state_tag_t tag) {
  const long long began = rtapi_get_time();
  const struct motion motion = {end, type, speed, most_speed, acceleration, enables, at_speed, tag};
  struct trammel_operation* operation;
  if (check_machine(tp, -1) != TP_ERR_OK) return TP_ERR_FAIL;
  operation = add(tp, TRAMMEL_ARC, &motion);
  if (operation == NULL) return TP_ERR_FAIL;
  operation->turns = turns;
  operation->centre[0] = centre.x;
  operation->centre[1] = centre.y;
  operation->centre[2] = centre.z;
  operation->normal[0] = normal.x;
  operation->normal[1] = normal.y;
  operation->normal[2] = normal.z;
  time_call(began);
  return TP_ERR_OK;
}

int tpAddRigidTap(TP_STRUCT* const tp, EmcPose end, double speed, double most_speed, double acceleration,
                  unsigned char enables, double scale, struct state_tag_t tag) {
  (void)tp, (void)end, (void)speed, (void)most_speed, (void)acceleration, (void)enables, (void)scale, (void)tag;
  return refused("rigid tapping (G33.1)");
}

int tpRunCycle(TP_STRUCT* tp, long period) {
  struct __comp_state* __comp_inst = __comp_first_inst;
  const long long began = rtapi_get_time();
  const int result = run_period(tp);
  const long long took = rtapi_get_time() - began;
  (void)period;
  if (took > longest_cycle) longest_cycle = took;
  if (took > longest) longest = took;
  longest_call = longest;
  stale_copies = ring.stale;
  queued = posted - begun;
  return result;
}

int tpCreate(TP_STRUCT* const tp, int size, int id) {
  (void)id;
  if (ring.region == NULL) return TP_ERR_FAIL;
  memset(tp, 0, sizeof *tp);
  tp->queueSize = size;
  planner = tp;
  rest(tp);
  return TP_ERR_OK;
}

int tpClear(TP_STRUCT* const tp) {
  forget_unpublished();
  clear_pending = 1;
  rest(tp);
  drop_outputs(tp);
  tp->nextId = 0;
  tp->termCond = TC_TERM_COND_PARABOLIC;
  tp->tolerance = 0;
  tp->synchronized = 0;
  reverse_told = 0;
  status->motionFlag |= EMCMOT_MOTION_INPOS_BIT;
  return TP_ERR_OK;
}

int tpSetPos(TP_STRUCT* tp, EmcPose const* const pose) {
  tp->currentPos = tp->goalPos = *pose;
  pose_to_set = *pose;
  pose_pending = 1;
  return TP_ERR_OK;
}

int tpAbort(TP_STRUCT* tp) {
  if (!tp->aborting && !tp->done) begin_abort(tp);
  tp->synchronized = 0;
  drop_outputs(tp);
  return TP_ERR_OK;
}

/* motmod asks in each period for as long as the adaptive feed is negative: told once. */
int tpSetRunDir(TP_STRUCT* const tp, tc_direction_t direction) {
  (void)tp;
  if (direction == TC_DIR_FORWARD) {
    reverse_told = 0;
    return TP_ERR_OK;
  }
  if (!reverse_told) refused("a reverse run, or a negative adaptive feed");
  reverse_told = 1;
  return TP_ERR_FAIL;
}

int tpSetSpindleSync(TP_STRUCT* const tp, int spindle, double sync, int mode) {
  (void)spindle, (void)mode;
  tp->synchronized = sync != 0;
  return TP_ERR_OK;
}

#include "trammel_planner_state.h"

EXTRA_SETUP() {
  const char* name = getenv("TRAMMEL_LINUXCNC");
  const char* region_name = name != NULL && name[0] != '\0' ? name : "0";
  const int error = ring_attach(&ring, region_name);
  (void)__comp_inst, (void)prefix, (void)extra_arg;
  if (error != 0) {
    rtapi_print_msg(RTAPI_MSG_ERR, "trammel_planner: cannot share memory %s/%s%s: %s\n", TRAMMEL_REGION_FOLDER,
                    TRAMMEL_REGION_PREFIX, region_name, ring_text_of(error));
  }
  return error;
}
