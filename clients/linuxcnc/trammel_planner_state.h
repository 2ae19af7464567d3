/* SPDX-License-Identifier: GPL-2.0-only
 *
 * The functions of LinuxCNC's planner interface that store or return a value, and the names of all 30. Without
 * EXPORT_SYMBOL the names stay local to the module, and motmod does not load.
 */
#ifndef TRAMMEL_PLANNER_STATE_H
#define TRAMMEL_PLANNER_STATE_H

void tpMotFunctions(void (*digital)(int, char), void (*analog)(int, double), void (*unlock)(int, int),
                    int (*is_unlocked)(int), double (*speed_limit)(int), double (*acceleration_limit)(int)) {
  (void)unlock, (void)is_unlocked, (void)speed_limit, (void)acceleration_limit;
  write_digital = digital;
  write_analog = analog;
}

void tpMotData(emcmot_status_t* motion_status, emcmot_config_t* motion_config) {
  status = motion_status;
  config = motion_config;
}

int tpSetCycleTime(TP_STRUCT* tp, double seconds) {
  tp->cycleTime = seconds;
  return TP_ERR_OK;
}

int tpSetVmax(TP_STRUCT* tp, double speed, double most_speed) {
  tp->vMax = speed;
  tp->ini_maxvel = most_speed;
  return TP_ERR_OK;
}

int tpSetVlimit(TP_STRUCT* tp, double limit) {
  tp->vLimit = limit;
  return TP_ERR_OK;
}

int tpSetAmax(TP_STRUCT* tp, double acceleration) {
  tp->aMax = acceleration;
  return TP_ERR_OK;
}

int tpSetId(TP_STRUCT* tp, int id) {
  tp->nextId = id;
  return TP_ERR_OK;
}

int tpPause(TP_STRUCT* tp) {
  tp->pausing = 1;
  return TP_ERR_OK;
}

int tpResume(TP_STRUCT* tp) {
  tp->pausing = 0;
  return TP_ERR_OK;
}

int tpSetDout(TP_STRUCT* const tp, int index, unsigned char start, unsigned char end) {
  (void)end;
  if (index < 0 || index >= EMCMOT_MAX_DIO) return TP_ERR_FAIL;
  tp->syncdio.anychanged = 1;
  tp->syncdio.dio_mask |= (iomask_t)1 << index;
  tp->syncdio.dios[index] = start > 0 ? 1 : -1;
  return TP_ERR_OK;
}

int tpSetAout(TP_STRUCT* const tp, unsigned char index, double start, double end) {
  (void)end;
  if (index >= EMCMOT_MAX_AIO) return TP_ERR_FAIL;
  tp->syncdio.anychanged = 1;
  tp->syncdio.aio_mask |= (iomask_t)1 << index;
  tp->syncdio.aios[index] = start;
  return TP_ERR_OK;
}

int tpSetTermCond(TP_STRUCT* tp, int condition, double tolerance) {
  tp->termCond = condition;
  tp->tolerance = tolerance;
  return TP_ERR_OK;
}

int tpGetPos(TP_STRUCT const* const tp, EmcPose* const pose) {
  *pose = tp->currentPos;
  return TP_ERR_OK;
}

int tpGetExecId(TP_STRUCT* tp) { return tp->execId; }
struct state_tag_t tpGetExecTag(TP_STRUCT* const tp) {
  return tp->execTag;
}
int tpIsDone(TP_STRUCT* const tp) { return tp->done; }
int tpQueueDepth(TP_STRUCT* const tp) { return tp->depth; }
int tpActiveDepth(TP_STRUCT* const tp) { return tp->activeDepth; }
int tpGetMotionType(TP_STRUCT* const tp) { return tp->motionType; }

/* Whether LinuxCNC must wait before it adds motions. motmod calls this at the end of each servo period, in every mode.
 */
int tcqFull(TC_QUEUE_STRUCT const* const queue) {
  struct __comp_state* __comp_inst = __comp_first_inst;
  (void)queue;
  ring_read_status(&ring);
  watch_owner(planner);
  watch_outputs();
  link_ok = owner_answers();
  return posted - begun > MOST_QUEUED || ring_free(&ring) < RING_RESERVE;
}

EXPORT_SYMBOL(tcqFull);
EXPORT_SYMBOL(tpAbort);
EXPORT_SYMBOL(tpActiveDepth);
EXPORT_SYMBOL(tpAddCircle);
EXPORT_SYMBOL(tpAddLine);
EXPORT_SYMBOL(tpAddRigidTap);
EXPORT_SYMBOL(tpClear);
EXPORT_SYMBOL(tpCreate);
EXPORT_SYMBOL(tpGetExecId);
EXPORT_SYMBOL(tpGetExecTag);
EXPORT_SYMBOL(tpGetMotionType);
EXPORT_SYMBOL(tpGetPos);
EXPORT_SYMBOL(tpIsDone);
EXPORT_SYMBOL(tpMotData);
EXPORT_SYMBOL(tpMotFunctions);
EXPORT_SYMBOL(tpPause);
EXPORT_SYMBOL(tpQueueDepth);
EXPORT_SYMBOL(tpResume);
EXPORT_SYMBOL(tpRunCycle);
EXPORT_SYMBOL(tpSetAmax);
EXPORT_SYMBOL(tpSetAout);
EXPORT_SYMBOL(tpSetCycleTime);
EXPORT_SYMBOL(tpSetDout);
EXPORT_SYMBOL(tpSetId);
EXPORT_SYMBOL(tpSetPos);
EXPORT_SYMBOL(tpSetRunDir);
EXPORT_SYMBOL(tpSetSpindleSync);
EXPORT_SYMBOL(tpSetTermCond);
EXPORT_SYMBOL(tpSetVlimit);
EXPORT_SYMBOL(tpSetVmax);

#endif
