/* SPDX-License-Identifier: 0BSD
 *
 * The memory that LinuxCNC's realtime modules share with the process that owns the card (`trammel linuxcnc`). Only
 * plain data: this header uses no type of LinuxCNC and none of the driver, so each side can have its own licence. It
 * compiles as C11 and as C++17.
 *
 * The region is the file /dev/shm/trammel-linuxcnc.NAME (mode 0600). The first process creates it; its length is
 * sizeof(struct trammel_region), and its bytes are initially zero. The owner holds an open-file-description lock
 * (fcntl F_OFD_SETLK) on byte TRAMMEL_LOCK_OWNER, and each realtime module holds one on its own byte. The kernel drops
 * the locks of a process that dies. Therefore a second owner is refused, and a dead one can be replaced.
 *
 * Rules. Every word has one writer. A ring has one writer and one reader: the writer fills the slot, then stores `head`
 * with release order; the reader loads `head` with acquire order and, when it has read the slot, stores `tail`. A full
 * ring drops nothing by itself: the writer detects it and reports it. A record (struct trammel_status,
 * struct trammel_settings) is guarded by a sequence number that is odd while it is written; a reader tries
 * TRAMMEL_TRIES times, keeps its last copy if it fails, and never waits. The only kernel call of the realtime side is
 * FUTEX_WAKE on `wake`, which never blocks.
 *
 * Units. Positions: pulses of a joint from machine zero, as counted by the card; targets in 2^-24 pulses. Times:
 * nanoseconds. Path positions, speeds and lengths: LinuxCNC's machine units (mm or inch, degrees) and seconds, as its
 * planner gives them. The owner converts them.
 */
#ifndef TRAMMEL_LINUXCNC_SHARED_REGION_H
#define TRAMMEL_LINUXCNC_SHARED_REGION_H

#include <stdint.h>

/* Puts each word that one side polls while the other one writes in its own cache line. */
#ifdef __cplusplus
#define TRAMMEL_APART alignas(64)
#else
#define TRAMMEL_APART _Alignas(64)
#endif

#define TRAMMEL_REGION_FOLDER "/dev/shm"
#define TRAMMEL_REGION_PREFIX "trammel-linuxcnc."
/* Incremented with every change of this layout. Each side writes it when it attaches, and does not use a region of
 * another version. */
#define TRAMMEL_REGION_VERSION 4u

enum { TRAMMEL_LOCK_OWNER = 0, TRAMMEL_LOCK_HAL = 1, TRAMMEL_LOCK_PLANNER = 2 };

enum {
  TRAMMEL_JOINTS = 8,        /* maximum of a card */
  TRAMMEL_POSE = 9,          /* X Y Z A B C U V W */
  TRAMMEL_PERIODS = 256,     /* slots: at 1 kHz the owner may sleep for 250 ms before a period is lost */
  TRAMMEL_OPERATIONS = 2048, /* slots: LinuxCNC's own planner queues 2,000 segments */
  TRAMMEL_OUTPUTS = 16,      /* digital outputs of LinuxCNC (P of M62 to M65) that the card may have */
  TRAMMEL_TRIES = 4
};

/* ---- from the HAL component: one entry per servo period ---- */

enum {
  TRAMMEL_PERIOD_ENABLE = 1u << 0, /* the machine is on: follow the targets */
  TRAMMEL_PERIOD_HOLD = 1u << 1,   /* hold on the path; targets take effect again when it is released */
  TRAMMEL_PERIOD_PATH = 1u << 2,   /* path operations command the card; the targets only repeat its position */
  TRAMMEL_PERIOD_CLEAR = 1u << 3,  /* the operator clears the cause of a stop; never starts motion */
  TRAMMEL_PERIOD_INDEX_SHIFT = 16u /* bit 16 + n: joint n waits for its index edge */
};

struct trammel_period {
  uint64_t number;                /* counts periods since the component was loaded; a gap means dropped periods */
  int64_t time;                   /* ns, CLOCK_MONOTONIC, when the period began */
  uint32_t duration;              /* ns until the targets must be reached */
  uint32_t flags;                 /* TRAMMEL_PERIOD_... */
  int64_t target[TRAMMEL_JOINTS]; /* 2^-24 pulses from machine zero; |target| <= 2^55 */
};

/* ---- from the HAL component: settings, read by the owner while the machine is off ---- */

struct trammel_settings {
  double pulses_per_unit[TRAMMEL_JOINTS]; /* 0: the machine file's */
  double max_speed[TRAMMEL_JOINTS];       /* pulses/s; 0: the machine file's */
  uint32_t step_length[TRAMMEL_JOINTS];   /* ns; 0: the machine file's; also for the next three */
  uint32_t step_space[TRAMMEL_JOINTS];
  uint32_t dir_setup[TRAMMEL_JOINTS];
  uint32_t dir_hold[TRAMMEL_JOINTS];
  uint32_t lead_periods; /* periods sent before the card begins; 0: 2 */
  uint32_t joints;       /* number of joints for which the component has pins */
};

/* ---- from the owner ---- */

enum {
  TRAMMEL_IDLE = 0,
  TRAMMEL_STREAMING = 1,
  TRAMMEL_ON_PATH = 2,
  TRAMMEL_STOPPED = 3
}; /* struct trammel_status.state */

/* Causes in addition to those of the register map, for struct trammel_status.cause. */
enum {
  TRAMMEL_CAUSE_TARGET = 64, /* a target that the driver refused; see text */
  TRAMMEL_CAUSE_OTHER = 65   /* the card was reset or used by another program; see text */
};

enum {
  TRAMMEL_STATUS_LINK = 1u << 0,   /* the card answers */
  TRAMMEL_STATUS_FAULT = 1u << 1,  /* it was stopped and not cleared yet: see cause, stop_position */
  TRAMMEL_STATUS_HELD = 1u << 2,   /* at rest in a hold */
  TRAMMEL_STATUS_PROBE = 1u << 3,  /* the probe touches */
  TRAMMEL_STATUS_AT_REST = 1u << 4 /* no axis moves, and all operations are done */
};

struct trammel_status {
  uint64_t session;                 /* unique per owner process: a new value means that the owner was replaced */
  uint64_t beat;                    /* counts the owner's turns: it stays constant if the owner is dead or stopped */
  int64_t time;                     /* ns, CLOCK_MONOTONIC, at the reading of the card */
  uint32_t state;                   /* TRAMMEL_IDLE ... */
  uint32_t flags;                   /* TRAMMEL_STATUS_... */
  int64_t position[TRAMMEL_JOINTS]; /* pulses, as counted by the card */
  double speed[TRAMMEL_JOINTS];     /* pulses/s, measured between two readings */
  uint32_t inputs;                  /* bit n: level of the card's input n after polarity and filter */
  uint32_t homed, valid;            /* bit n: state of joint n, as kept by the card */
  uint32_t fault;                   /* FAULT, bits as in the register map */
  uint32_t cause;                   /* first cause of the stop: its bit of FAULT + 1, or TRAMMEL_CAUSE_...; 0: none */
  int64_t stop_position[TRAMMEL_JOINTS];    /* pulses, at the time of the cause */
  uint64_t last_period;                     /* number of the last period that was sent to the card */
  uint32_t ahead;                           /* periods queued in the card and not yet begun */
  uint32_t late;                            /* periods that arrived after the card had to continue its line */
  uint32_t dropped;                         /* periods that never arrived: gaps of trammel_period.number */
  uint32_t missing;                         /* under-runs: streams that lacked a period */
  uint32_t refused;                         /* periods that the driver refused (too fast, beyond a soft limit) */
  uint64_t captures;                        /* number of edges of the probe */
  int64_t capture_position[TRAMMEL_JOINTS]; /* pulses, at the last edge of the probe */
  uint32_t index_latched; /* bit n: joint n has met its index edge; set until the period's bit is cleared */
  int64_t index_position[TRAMMEL_JOINTS]; /* pulses, at the index edge */
  double pulses_per_unit[TRAMMEL_JOINTS]; /* in force */
  uint32_t joints;                        /* number of joints of the card */
  /* Fields of the path operations. */
  uint64_t operations_done;        /* operations processed, in order: segments are queued, all others are executed */
  uint64_t segments_begun;         /* number of the current or last segment (struct trammel_operation.segment) */
  double distance_to_go;           /* straight distance to the end of this segment, machine units */
  double path_speed;               /* machine units/s */
  double pose[TRAMMEL_POSE];       /* the card's position on the path in LinuxCNC's coordinates; whole pulses */
  uint64_t probes;                 /* counts probing segments that have ended */
  uint32_t probe_tripped;          /* the last one met its edge */
  double probe_pose[TRAMMEL_POSE]; /* captured pose at the edge; the end of the motion if it was not met */
  uint64_t refusals;               /* counts path ends by refused operations or faults of the card; see text */
  int32_t refusal;                 /* id of the last refused operation */
  char text[128];                  /* UTF-8, ends with 0: the last refusal or stop in words */
};

/* ---- from the planner module: path operations, in order ---- */

enum trammel_operation_kind {
  TRAMMEL_LINE = 1,  /* from the end of the previous segment to `end` */
  TRAMMEL_ARC = 2,   /* helix: centre, normal, turns */
  TRAMMEL_PAUSE = 3, /* hold on the path */
  TRAMMEL_RESUME = 4,
  TRAMMEL_ABORT = 5,    /* ramp on the path, then drop what is queued */
  TRAMMEL_CLEAR = 6,    /* drop what is queued at once, as after a fault */
  TRAMMEL_SET_POSE = 7, /* `end`: the pose at which LinuxCNC assumes the machine to be; only at rest */
  TRAMMEL_SWITCH = 8    /* set `outputs` to `levels` after the earlier motions, which end at rest: M64, M65 */
};

enum { TRAMMEL_EXACT_STOP = 0, TRAMMEL_EXACT_PATH = 1, TRAMMEL_BLEND = 2 }; /* G61.1, G61, G64 P */

struct trammel_operation {
  uint32_t kind;
  int32_t id;             /* LinuxCNC's number of the motion */
  uint64_t segment;       /* counts lines and arcs from 1 */
  int32_t motion;         /* 1 rapid, 2 feed, 3 arc, 4 tool change, 5 probe: LinuxCNC's EMC_MOTION_TYPE_... */
  int32_t turns;          /* turns of an arc, as LinuxCNC counts them; negative for clockwise */
  uint32_t blending;      /* TRAMMEL_EXACT_STOP ... */
  uint32_t scale_by_feed; /* the feed override applies */
  uint32_t outputs;       /* bit n: digital output n is switched immediately before the motion */
  uint32_t levels;        /* their levels; outputs that the machine file does not name exist only in LinuxCNC */
  uint32_t probe_away;    /* motion 5: move until the probe is free; 0: until it touches */
  double end[TRAMMEL_POSE];
  double centre[3], normal[3];
  double speed;             /* programmed, machine units/s */
  double most_speed;        /* limit of the axes */
  double most_acceleration; /* machine units/s^2 */
  double tolerance;         /* tolerance of G64 P, machine units; 0: none */
};

/* Written by the planner module in each period. */
struct trammel_path_settings {
  uint64_t beat;
  double feed_scale; /* 0 .. max: the override in force, including holds and adaptive feed */
  double rapid_scale;
};

struct trammel_region {
  uint32_t version_owner; /* TRAMMEL_REGION_VERSION once the owner has attached; the next two in the same way */
  uint32_t version_hal;
  uint32_t version_planner;
  uint32_t wake; /* futex: the realtime side increments it and wakes the owner */

  TRAMMEL_APART uint64_t period_head;
  TRAMMEL_APART uint64_t period_tail;
  struct trammel_period periods[TRAMMEL_PERIODS];

  TRAMMEL_APART uint32_t settings_sequence;
  struct trammel_settings settings;

  TRAMMEL_APART uint32_t status_sequence;
  struct trammel_status status;

  TRAMMEL_APART uint64_t operation_head;
  TRAMMEL_APART uint64_t operation_tail;
  struct trammel_operation operations[TRAMMEL_OPERATIONS];

  TRAMMEL_APART uint32_t path_settings_sequence;
  struct trammel_path_settings path_settings;
};

#endif
