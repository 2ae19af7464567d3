#include "trammel/grbl/status_report.hpp"

#include <fmt/format.h>

namespace trammel::grbl {
namespace {

// Number of reports between two WCO and between two Ov: report.c and config.h of Grbl 1.1h.
constexpr unsigned kOffsetBusy = 30;
constexpr unsigned kOffsetIdle = 10;
constexpr unsigned kOverridesBusy = 20;
constexpr unsigned kOverridesIdle = 10;

}  // namespace

std::string StatusReport::text(const Report& report, unsigned mask) {
  const bool machine = (mask & 1U) != 0;
  std::string text = fmt::format("<{}|{}:{}", report.state, machine ? "MPos" : "WPos",
                                 machine ? report.position : report.work_position);
  if ((mask & 2U) != 0) text += fmt::format("|Bf:{},{}", report.blocks_free, report.bytes_free);
  if (report.line > 0) text += fmt::format("|Ln:{}", report.line);
  text += fmt::format("|FS:{:.0f},{:.0f}", report.feed, report.speed);
  if (!report.pins.empty()) text += "|Pn:" + report.pins;
  if (offset_in_ > 0) {
    --offset_in_;
  } else {
    offset_in_ = (report.busy ? kOffsetBusy : kOffsetIdle) - 1;
    if (overrides_in_ == 0) overrides_in_ = 1;
    text += "|WCO:" + report.offset;
  }
  if (overrides_in_ > 0) {
    --overrides_in_;
  } else {
    overrides_in_ = (report.busy ? kOverridesBusy : kOverridesIdle) - 1;
    text += fmt::format("|Ov:{},{},{}", report.feed_override, report.rapid_override, report.spindle_override);
    if (!report.accessories.empty()) text += "|A:" + report.accessories;
  }
  return text + ">";
}

}  // namespace trammel::grbl
