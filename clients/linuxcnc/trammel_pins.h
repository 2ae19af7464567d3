/* SPDX-License-Identifier: GPL-2.0-only
 *
 * Pins and parameters of the component `trammel`. Names are those of hostmot2 if the meaning is the same.
 */
#ifndef TRAMMEL_PINS_H
#define TRAMMEL_PINS_H

#include "hal.h"
#include "trammel/linuxcnc/shared_region.h"

enum { CARD_INPUTS = 32 };

struct joint_pins {
  hal_float_t *position_cmd, *position_fb, *velocity_fb, *stop_position;
  hal_bit_t *enable, *homed, *index_enable;
  hal_s32_t* counts;
  hal_float_t position_scale, maxvel, maxaccel;        /* parameters from here on */
  hal_u32_t step_len, step_space, dir_setup, dir_hold; /* ns */
};

struct card_pins {
  hal_bit_t *hold, *clear, *coord_mode;
  hal_bit_t *probe, *fault, *link_ok, *session_lost, *packet_error, *watchdog, *held, *at_rest;
  hal_bit_t *input[CARD_INPUTS], *input_not[CARD_INPUTS];
  hal_u32_t *stop_cause, *underrun, *late, *dropped, *refused, *ahead, *packet_error_total, *longest_read,
      *longest_write, *longest_period, *longest_silence;
  hal_s32_t* packet_error_level;
  hal_float_t* latency;
  hal_u32_t lead_periods, link_periods, test_drop_one_in; /* parameters from here on */
  hal_bit_t planner_module;
  struct joint_pins joint[TRAMMEL_JOINTS];
};

static int export_joint(struct joint_pins* j, int n, int id) {
  int bad = 0;
  bad |= hal_pin_float_newf(HAL_IN, &j->position_cmd, id, "trammel.joint.%02d.position-cmd", n);
  bad |= hal_pin_float_newf(HAL_OUT, &j->position_fb, id, "trammel.joint.%02d.position-fb", n);
  bad |= hal_pin_float_newf(HAL_OUT, &j->velocity_fb, id, "trammel.joint.%02d.velocity-fb", n);
  bad |= hal_pin_float_newf(HAL_OUT, &j->stop_position, id, "trammel.joint.%02d.stop-position", n);
  bad |= hal_pin_bit_newf(HAL_IN, &j->enable, id, "trammel.joint.%02d.enable", n);
  bad |= hal_pin_bit_newf(HAL_OUT, &j->homed, id, "trammel.joint.%02d.homed", n);
  bad |= hal_pin_bit_newf(HAL_IO, &j->index_enable, id, "trammel.joint.%02d.index-enable", n);
  bad |= hal_pin_s32_newf(HAL_OUT, &j->counts, id, "trammel.joint.%02d.counts", n);
  bad |= hal_param_float_newf(HAL_RW, &j->position_scale, id, "trammel.joint.%02d.position-scale", n);
  bad |= hal_param_float_newf(HAL_RW, &j->maxvel, id, "trammel.joint.%02d.maxvel", n);
  bad |= hal_param_float_newf(HAL_RW, &j->maxaccel, id, "trammel.joint.%02d.maxaccel", n);
  bad |= hal_param_u32_newf(HAL_RW, &j->step_len, id, "trammel.joint.%02d.steplen", n);
  bad |= hal_param_u32_newf(HAL_RW, &j->step_space, id, "trammel.joint.%02d.stepspace", n);
  bad |= hal_param_u32_newf(HAL_RW, &j->dir_setup, id, "trammel.joint.%02d.dirsetup", n);
  bad |= hal_param_u32_newf(HAL_RW, &j->dir_hold, id, "trammel.joint.%02d.dirhold", n);
  return bad;
}

static int export_inputs(struct card_pins* c, int id) {
  int n, bad = 0;
  for (n = 0; n < CARD_INPUTS; ++n) {
    bad |= hal_pin_bit_newf(HAL_OUT, &c->input[n], id, "trammel.input-%02d", n);
    bad |= hal_pin_bit_newf(HAL_OUT, &c->input_not[n], id, "trammel.input-%02d-not", n);
  }
  return bad;
}

static int export_card(struct card_pins* c, int id) {
  int bad = 0;
  bad |= hal_pin_bit_newf(HAL_IN, &c->hold, id, "trammel.hold");
  bad |= hal_pin_bit_newf(HAL_IN, &c->clear, id, "trammel.clear");
  bad |= hal_pin_bit_newf(HAL_IN, &c->coord_mode, id, "trammel.coord-mode");
  bad |= hal_pin_bit_newf(HAL_OUT, &c->probe, id, "trammel.probe");
  bad |= hal_pin_bit_newf(HAL_OUT, &c->fault, id, "trammel.fault");
  bad |= hal_pin_bit_newf(HAL_OUT, &c->link_ok, id, "trammel.link-ok");
  bad |= hal_pin_bit_newf(HAL_OUT, &c->session_lost, id, "trammel.session-lost");
  bad |= hal_pin_bit_newf(HAL_OUT, &c->packet_error, id, "trammel.packet-error");
  bad |= hal_pin_bit_newf(HAL_OUT, &c->held, id, "trammel.held");
  bad |= hal_pin_bit_newf(HAL_OUT, &c->at_rest, id, "trammel.at-rest");
  bad |= hal_pin_bit_newf(HAL_IO, &c->watchdog, id, "trammel.watchdog.has_bit");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->stop_cause, id, "trammel.stop-cause");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->underrun, id, "trammel.underrun");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->late, id, "trammel.late");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->dropped, id, "trammel.dropped");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->refused, id, "trammel.refused");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->ahead, id, "trammel.ahead");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->packet_error_total, id, "trammel.packet-error-total");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->longest_read, id, "trammel.longest-read");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->longest_write, id, "trammel.longest-write");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->longest_period, id, "trammel.longest-period");
  bad |= hal_pin_u32_newf(HAL_OUT, &c->longest_silence, id, "trammel.longest-silence");
  bad |= hal_pin_s32_newf(HAL_OUT, &c->packet_error_level, id, "trammel.packet-error-level");
  bad |= hal_pin_float_newf(HAL_OUT, &c->latency, id, "trammel.latency");
  bad |= hal_param_u32_newf(HAL_RW, &c->lead_periods, id, "trammel.lead-periods");
  bad |= hal_param_u32_newf(HAL_RW, &c->link_periods, id, "trammel.link-periods");
  bad |= hal_param_u32_newf(HAL_RW, &c->test_drop_one_in, id, "trammel.test-drop-one-in");
  bad |= hal_param_bit_newf(HAL_RW, &c->planner_module, id, "trammel.planner-module");
  return bad | export_inputs(c, id);
}

#endif
