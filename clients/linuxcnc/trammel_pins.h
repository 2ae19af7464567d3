/* SPDX-License-Identifier: GPL-2.0-only
 *
 * Pins and parameters of the HAL component `trammel`; docs/user/linuxcnc.md describes them. */
#ifndef TRAMMEL_PINS_H
#define TRAMMEL_PINS_H

#include "hal.h"
#include "rtapi.h"
#include "trammel/linuxcnc/shared_region.h"

enum { TRAMMEL_INPUT_PINS = 16 };

struct joint {
  hal_float_t *position_cmd, *position_fb, *velocity_fb, *stop_position, *probe_position;
  hal_s32_t *counts;
  hal_bit_t *enable, *index_enable, *homed, *valid;
  hal_float_t position_scale, maxvel, maxaccel;
  hal_u32_t steplen, stepspace, dirsetup, dirhold;
  /* Not of HAL. */
  int64_t target;      /* 2^-24 pulses from machine zero */
  int64_t offset;      /* pulses: machine zero to position 0, moved by an index */
  uint64_t index_sent; /* number of the first period that asked for the index; 0: none */
};

struct card {
  hal_bit_t *clear, *hold, *path;
  hal_bit_t *link_ok, *ready, *fault, *session_lost, *probe, *held, *at_rest, *packet_error, *has_bit;
  hal_u32_t *underrun, *late, *dropped, *refused, *ahead, *stop_cause, *probe_count, *packet_errors;
  hal_u32_t *packet_error_level, *longest_read, *longest_write;
  hal_bit_t *input[TRAMMEL_INPUT_PINS], *input_not[TRAMMEL_INPUT_PINS];
  hal_u32_t lead_periods, link_periods, test_drop;
  struct joint joints[TRAMMEL_JOINTS];
};

static int export_joint(struct joint *joint, int id, int number) {
  const char *prefix = "trammel.0.stepgen";
  int error = 0;
  error |= hal_pin_float_newf(HAL_IN, &joint->position_cmd, id, "%s.%02d.position-cmd", prefix, number);
  error |= hal_pin_float_newf(HAL_OUT, &joint->position_fb, id, "%s.%02d.position-fb", prefix, number);
  error |= hal_pin_float_newf(HAL_OUT, &joint->velocity_fb, id, "%s.%02d.velocity-fb", prefix, number);
  error |= hal_pin_float_newf(HAL_OUT, &joint->stop_position, id, "%s.%02d.stop-position", prefix, number);
  error |= hal_pin_float_newf(HAL_OUT, &joint->probe_position, id, "%s.%02d.probe-position", prefix, number);
  error |= hal_pin_s32_newf(HAL_OUT, &joint->counts, id, "%s.%02d.counts", prefix, number);
  error |= hal_pin_bit_newf(HAL_IN, &joint->enable, id, "%s.%02d.enable", prefix, number);
  error |= hal_pin_bit_newf(HAL_IO, &joint->index_enable, id, "%s.%02d.index-enable", prefix, number);
  error |= hal_pin_bit_newf(HAL_OUT, &joint->homed, id, "%s.%02d.homed", prefix, number);
  error |= hal_pin_bit_newf(HAL_OUT, &joint->valid, id, "%s.%02d.valid", prefix, number);
  error |= hal_param_float_newf(HAL_RW, &joint->position_scale, id, "%s.%02d.position-scale", prefix, number);
  error |= hal_param_float_newf(HAL_RW, &joint->maxvel, id, "%s.%02d.maxvel", prefix, number);
  error |= hal_param_float_newf(HAL_RW, &joint->maxaccel, id, "%s.%02d.maxaccel", prefix, number);
  error |= hal_param_u32_newf(HAL_RW, &joint->steplen, id, "%s.%02d.steplen", prefix, number);
  error |= hal_param_u32_newf(HAL_RW, &joint->stepspace, id, "%s.%02d.stepspace", prefix, number);
  error |= hal_param_u32_newf(HAL_RW, &joint->dirsetup, id, "%s.%02d.dirsetup", prefix, number);
  error |= hal_param_u32_newf(HAL_RW, &joint->dirhold, id, "%s.%02d.dirhold", prefix, number);
  return error;
}

static int export_bits(struct card *card, int id) {
  int error = 0;
  int n;
  error |= hal_pin_bit_newf(HAL_IN, &card->clear, id, "trammel.0.clear");
  error |= hal_pin_bit_newf(HAL_IN, &card->hold, id, "trammel.0.hold");
  error |= hal_pin_bit_newf(HAL_IN, &card->path, id, "trammel.0.path");
  error |= hal_pin_bit_newf(HAL_OUT, &card->link_ok, id, "trammel.0.link-ok");
  error |= hal_pin_bit_newf(HAL_OUT, &card->ready, id, "trammel.0.ready");
  error |= hal_pin_bit_newf(HAL_OUT, &card->fault, id, "trammel.0.fault");
  error |= hal_pin_bit_newf(HAL_OUT, &card->session_lost, id, "trammel.0.session-lost");
  error |= hal_pin_bit_newf(HAL_OUT, &card->probe, id, "trammel.0.probe");
  error |= hal_pin_bit_newf(HAL_OUT, &card->held, id, "trammel.0.held");
  error |= hal_pin_bit_newf(HAL_OUT, &card->at_rest, id, "trammel.0.at-rest");
  error |= hal_pin_bit_newf(HAL_OUT, &card->packet_error, id, "trammel.0.packet-error");
  error |= hal_pin_bit_newf(HAL_IO, &card->has_bit, id, "trammel.0.watchdog.has_bit");
  for (n = 0; n < TRAMMEL_INPUT_PINS; ++n) {
    error |= hal_pin_bit_newf(HAL_OUT, &card->input[n], id, "trammel.0.input-%02d", n);
    error |= hal_pin_bit_newf(HAL_OUT, &card->input_not[n], id, "trammel.0.input-%02d-not", n);
  }
  return error;
}

/* 0, or that HAL refused one. */
static int export_card(struct card *card, int id, int joints) {
  int error = export_bits(card, id);
  int n;
  error |= hal_pin_u32_newf(HAL_OUT, &card->underrun, id, "trammel.0.underrun");
  error |= hal_pin_u32_newf(HAL_OUT, &card->late, id, "trammel.0.late");
  error |= hal_pin_u32_newf(HAL_OUT, &card->dropped, id, "trammel.0.dropped");
  error |= hal_pin_u32_newf(HAL_OUT, &card->refused, id, "trammel.0.refused");
  error |= hal_pin_u32_newf(HAL_OUT, &card->ahead, id, "trammel.0.ahead");
  error |= hal_pin_u32_newf(HAL_OUT, &card->stop_cause, id, "trammel.0.stop-cause");
  error |= hal_pin_u32_newf(HAL_OUT, &card->probe_count, id, "trammel.0.probe-count");
  error |= hal_pin_u32_newf(HAL_OUT, &card->packet_errors, id, "trammel.0.packet-error-total");
  error |= hal_pin_u32_newf(HAL_OUT, &card->packet_error_level, id, "trammel.0.packet-error-level");
  error |= hal_pin_u32_newf(HAL_OUT, &card->longest_read, id, "trammel.0.longest-read");
  error |= hal_pin_u32_newf(HAL_OUT, &card->longest_write, id, "trammel.0.longest-write");
  error |= hal_param_u32_newf(HAL_RW, &card->lead_periods, id, "trammel.0.lead-periods");
  error |= hal_param_u32_newf(HAL_RW, &card->link_periods, id, "trammel.0.link-periods");
  error |= hal_param_u32_newf(HAL_RW, &card->test_drop, id, "trammel.0.test-drop");
  for (n = 0; n < joints; ++n) error |= export_joint(&card->joints[n], id, n);
  return error;
}

#endif
