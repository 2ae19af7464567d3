// The answer to '?', field by field.
#include "trammel/grbl/status_report.hpp"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace trammel::grbl {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Report router_report(bool busy = false) {
  Report report;
  report.state = busy ? "Run" : "Idle";
  report.busy = busy;
  report.position = "1.000,2.000,3.000";
  report.work_position = "0.000,0.000,0.000";
  report.offset = "1.000,2.000,3.000";
  return report;
}

// Indexes of those of `count` reports that have the field.
std::vector<int> places_of(StatusReport& status, const Report& report, const std::string& field, int count) {
  std::vector<int> places;
  for (int n = 0; n < count; ++n) {
    if (status.text(report, 1).find("|" + field + ":") != std::string::npos) places.push_back(n);
  }
  return places;
}

TEST(StatusReport, HasOffsetsFirstThenOverrides) {
  StatusReport status;
  const Report report = router_report();
  EXPECT_EQ(status.text(report, 1), "<Idle|MPos:1.000,2.000,3.000|FS:0,0|WCO:1.000,2.000,3.000>");
  EXPECT_EQ(status.text(report, 1), "<Idle|MPos:1.000,2.000,3.000|FS:0,0|Ov:100,100,100>");
  EXPECT_EQ(status.text(report, 1), "<Idle|MPos:1.000,2.000,3.000|FS:0,0>");
}

TEST(StatusReport, RepeatsThemEachTenthWhileIdle) {
  StatusReport offsets;
  EXPECT_THAT(places_of(offsets, router_report(), "WCO", 45), ElementsAre(0, 10, 20, 30, 40));
  StatusReport overrides;
  EXPECT_THAT(places_of(overrides, router_report(), "Ov", 45), ElementsAre(1, 11, 21, 31, 41));
}

TEST(StatusReport, RepeatsThemMoreSeldomWhileBusy) {
  StatusReport offsets;
  EXPECT_THAT(places_of(offsets, router_report(true), "WCO", 95), ElementsAre(0, 30, 60, 90));
  StatusReport overrides;
  EXPECT_THAT(places_of(overrides, router_report(true), "Ov", 95), ElementsAre(1, 21, 41, 61, 81));
}

// As in Grbl, no report has both fields, so that reports stay short.
TEST(StatusReport, NeverHasBoth) {
  StatusReport status;
  unsigned both = 0;
  for (int n = 0; n < 2000; ++n) {
    if (n % 7 == 0) status.overrides_changed();
    if (n % 13 == 0) status.offsets_changed();
    const std::string text = status.text(router_report(n % 100 < 50), 1);
    both += text.find("|WCO:") != std::string::npos && text.find("|Ov:") != std::string::npos ? 1U : 0U;
  }
  EXPECT_EQ(both, 0U);
}

TEST(StatusReport, TellsAChangeAtOnce) {
  StatusReport status;
  const Report report = router_report(true);
  for (int n = 0; n < 5; ++n) status.text(report, 1);
  status.overrides_changed();
  EXPECT_THAT(status.text(report, 1), HasSubstr("|Ov:"));
  status.offsets_changed();
  EXPECT_THAT(status.text(report, 1), HasSubstr("|WCO:"));
  EXPECT_THAT(status.text(report, 1), Not(HasSubstr("|WCO:")));
}

TEST(StatusReport, HasTheFieldsThatTheMaskAsksFor) {
  Report report = router_report();
  report.blocks_free = 15;
  report.bytes_free = 128;
  const auto begin = [&](unsigned mask) {
    StatusReport status;
    const std::string text = status.text(report, mask);
    return text.substr(0, text.find("|FS"));
  };
  EXPECT_EQ(begin(0), "<Idle|WPos:0.000,0.000,0.000");
  EXPECT_EQ(begin(1), "<Idle|MPos:1.000,2.000,3.000");
  EXPECT_EQ(begin(2), "<Idle|WPos:0.000,0.000,0.000|Bf:15,128");
  EXPECT_EQ(begin(3), "<Idle|MPos:1.000,2.000,3.000|Bf:15,128");
  EXPECT_EQ(begin(255), begin(3));
}

TEST(StatusReport, HasFieldsOnlyWhenTheyTellSomething) {
  StatusReport status;
  Report report = router_report(true);
  status.text(report, 1);
  report.line = 12'345;
  report.feed = 1234.4;
  report.speed = 8000;
  report.pins = "PXZ";
  report.accessories = "SFM";
  report.feed_override = 120;
  report.rapid_override = 25;
  report.spindle_override = 90;
  EXPECT_EQ(status.text(report, 1), "<Run|MPos:1.000,2.000,3.000|Ln:12345|FS:1234,8000|Pn:PXZ|Ov:120,25,90|A:SFM>");
  EXPECT_EQ(status.text(report, 1), "<Run|MPos:1.000,2.000,3.000|Ln:12345|FS:1234,8000|Pn:PXZ>");
}

}  // namespace
}  // namespace trammel::grbl
