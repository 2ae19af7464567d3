// SPDX-License-Identifier: GPL-2.0-only
//
// The component `trammel`, run period by period with a HAL and an owner inside the test: no thread, no clock.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "stub_hal.h"
#include "trammel/linuxcnc/shared_region.h"

namespace {

constexpr long kPeriod = 1'000'000;
constexpr double kScale = 80;
constexpr double kUnit = 16777216.0;  // units of targets per pulse

std::string joint(int n, const char* pin) {
  std::string text = "trammel.joint.00.";
  text[15] = static_cast<char>('0' + n);
  return text + pin;
}

// Component and owner in one process. The simulated card reaches each target one period later.
class Component : public ::testing::Test {
 protected:
  void SetUp() override { load(); }
  void TearDown() override {
    if (loaded_) rtapi_app_exit();
    munmap(region_, sizeof *region_);
    unlink(path_.c_str());
  }

  void load() {
    name_ = "component" + std::to_string(getpid());
    path_ = std::string(TRAMMEL_REGION_FOLDER) + "/" + TRAMMEL_REGION_PREFIX + name_;
    unlink(path_.c_str());
    stub::clear();
    set_module_parameters(name_.c_str(), 3);
    ASSERT_EQ(rtapi_app_main(), 0) << stub::messages();
    loaded_ = true;
    const int file = open(path_.c_str(), O_RDWR);
    ASSERT_GE(file, 0);
    region_ = static_cast<trammel_region*>(
        mmap(nullptr, sizeof(trammel_region), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
    close(file);
    ASSERT_NE(region_, MAP_FAILED);
    region_->version_owner = TRAMMEL_REGION_VERSION;
    status_.session = 7;
    status_.flags = TRAMMEL_STATUS_LINK | TRAMMEL_STATUS_AT_REST;
    for (double& scale : status_.pulses_per_unit) scale = kScale;
    status_.joints = 4;
  }

  // The owner's turn: reads the periods in the ring, and publishes the status.
  void owner() {
    for (; region_->period_tail != region_->period_head; ++region_->period_tail) {
      last_ = region_->periods[region_->period_tail % TRAMMEL_PERIODS];
      periods_.push_back(*last_);
      if (!(last_->flags & TRAMMEL_PERIOD_ENABLE) || status_.state == TRAMMEL_STOPPED) continue;
      for (int n = 0; n < TRAMMEL_JOINTS; ++n) {
        status_.position[n] = std::llround(static_cast<double>(last_->target[n]) / kUnit);
      }
    }
    const bool enabled = last_ && last_->flags & TRAMMEL_PERIOD_ENABLE;
    if (status_.state != TRAMMEL_STOPPED) status_.state = enabled ? TRAMMEL_STREAMING : TRAMMEL_IDLE;
    ++status_.beat;
    status_.time = stub::now;
    status_.last_period = last_ ? last_->number : 0;
    publish();
  }

  void publish() {
    ++region_->status_sequence;
    region_->status = status_;
    ++region_->status_sequence;
  }

  // Runs one period; `between` is LinuxCNC's work between read and write.
  template <class Between>
  void period(Between between, bool with_owner = true) {
    stub::now += kPeriod;
    if (with_owner) owner();
    stub::call("trammel.read", kPeriod);
    between();
    stub::call("trammel.write", kPeriod);
  }
  void periods(int count, bool with_owner = true) {
    for (int n = 0; n < count; ++n) period([] {}, with_owner);
  }

  void enable(bool on) {
    for (int n = 0; n < 3; ++n) stub::bit(joint(n, "enable").c_str()) = on;
  }
  // As in LinuxCNC, the command equals the feedback while the machine is off.
  void switch_on() {
    periods(3);
    for (int n = 0; n < 3; ++n) command(n) = feedback(n);
    enable(true);
    periods(2);
  }
  static double& command(int n) { return stub::real(joint(n, "position-cmd").c_str()); }
  static double& feedback(int n) { return stub::real(joint(n, "position-fb").c_str()); }
  double target(int n) const { return static_cast<double>(last_->target[n]) / kUnit; }  // pulses
  bool enabled() const { return (last_->flags & TRAMMEL_PERIOD_ENABLE) != 0; }
  void stop(unsigned cause) {
    status_.state = TRAMMEL_STOPPED;
    status_.flags |= TRAMMEL_STATUS_FAULT;
    status_.cause = cause;
  }

  std::string name_, path_;
  bool loaded_ = false;
  trammel_region* region_ = nullptr;
  trammel_status status_{};
  std::optional<trammel_period> last_;
  std::vector<trammel_period> periods_;
};

TEST_F(Component, TargetsAreTheCommandsExactly) {
  switch_on();
  std::vector<double> commands;
  const std::size_t before = periods_.size();
  for (int k = 0; k < 1000; ++k) {
    period([&] {
      command(1) = 3 * std::sin(k * 0.01);
      commands.push_back(command(1));
    });
  }
  owner();
  ASSERT_EQ(periods_.size(), before + 1 + commands.size());
  for (std::size_t k = 0; k < commands.size(); ++k) {
    EXPECT_NEAR(static_cast<double>(periods_[before + 1 + k].target[1]) / kUnit, commands[k] * kScale, 1e-7);
    EXPECT_EQ(periods_[before + 1 + k].number, periods_[before].number + 1 + k);
    EXPECT_EQ(periods_[before + 1 + k].duration, static_cast<unsigned>(kPeriod));
  }
  EXPECT_EQ(stub::u32("trammel.packet-error-total"), 0U);
}

TEST_F(Component, FollowsOnlyWhileAJointIsEnabled) {
  periods(3);
  EXPECT_FALSE(enabled());
  switch_on();
  EXPECT_TRUE(enabled());
  enable(false);
  periods(2);
  EXPECT_FALSE(enabled());
}

TEST_F(Component, JointThatIsDisabledByItselfStays) {
  switch_on();
  for (int k = 0; k < 10; ++k)
    period([&] {
      command(0) += 0.01;
      command(1) += 0.01;
    });
  owner();
  const double there = target(0);
  stub::bit(joint(0, "enable").c_str()) = false;
  for (int k = 0; k < 10; ++k)
    period([&] {
      command(0) += 0.01;
      command(1) += 0.01;
    });
  owner();
  EXPECT_TRUE(enabled());
  EXPECT_EQ(target(0), there);
  EXPECT_NEAR(target(1), 0.2 * kScale, 1e-6);
  // The joint is enabled again too far away: this would be a jump.
  stub::bit(joint(0, "enable").c_str()) = true;
  periods(3);
  EXPECT_FALSE(enabled());
  EXPECT_TRUE(stub::bit("trammel.fault"));
}

TEST_F(Component, DoesNotBeginFarFromTheCommandWithoutALimitOfAcceleration) {
  periods(3);
  command(0) = 1;  // 80 pulses away
  enable(true);
  periods(3);
  EXPECT_FALSE(enabled());
  EXPECT_NE(std::string(stub::messages()).find("not where the card stands"), std::string::npos);
  enable(false);
  periods(1);
  for (int n = 0; n < 3; ++n) stub::real(joint(n, "maxaccel").c_str()) = 1000;
  enable(true);
  periods(200);
  EXPECT_TRUE(enabled());
  EXPECT_EQ(target(0), kScale);
}

TEST_F(Component, ClipsSpeedAndAccelerationAndArrivesWithoutOvershoot) {
  stub::real(joint(2, "maxvel").c_str()) = 50;
  stub::real(joint(2, "maxaccel").c_str()) = 1000;
  switch_on();
  command(2) = 10;
  const std::size_t before = periods_.size();
  periods(400);
  double speed = 0;
  double most = 0;
  for (std::size_t k = before + 1; k < periods_.size(); ++k) {
    const double step = static_cast<double>(periods_[k].target[2] - periods_[k - 1].target[2]) / kUnit / kScale;
    EXPECT_LE(std::abs(step - speed), 1000 * 1e-6 + 1e-9) << k;
    speed = step;
    most = std::max(most, speed);
    EXPECT_GE(step, -1e-9) << k;
  }
  EXPECT_NEAR(most, 0.05, 1e-9);
  EXPECT_EQ(target(2), 10 * kScale);
}

TEST_F(Component, CommandThatIsNoNumberStopsItsJoint) {
  switch_on();
  for (int k = 0; k < 10; ++k) period([&] { command(0) += 0.01; });
  owner();
  const double there = target(0);
  period([] { command(0) = std::nan(""); });
  owner();
  EXPECT_EQ(target(0), there);
}

TEST_F(Component, LinkFallsAfterTheStatedPeriodsAndNothingMovesByItself) {
  switch_on();
  periods(250, false);
  EXPECT_TRUE(stub::bit("trammel.link-ok"));
  EXPECT_TRUE(stub::bit("trammel.packet-error"));
  periods(1, false);
  EXPECT_FALSE(stub::bit("trammel.link-ok"));
  EXPECT_TRUE(stub::bit("trammel.fault"));
  EXPECT_EQ(stub::s32("trammel.packet-error-level"), 10);
  EXPECT_NE(std::string(stub::messages()).find("does not answer"), std::string::npos);
  periods(250, false);
  periods_.clear();
  periods(10);  // the owner runs again
  EXPECT_TRUE(stub::bit("trammel.link-ok"));
  EXPECT_FALSE(enabled());
  EXPECT_TRUE(stub::bit("trammel.fault"));
  enable(false);
  periods(2);
  EXPECT_FALSE(stub::bit("trammel.fault"));
  for (int n = 0; n < 3; ++n) command(n) = feedback(n);
  enable(true);
  periods(3);
  EXPECT_TRUE(enabled());
}

TEST_F(Component, PeriodsThatComeAtOnceLoseNoLink) {
  switch_on();
  for (int n = 0; n < 600; ++n) {
    stub::now += 20'000;
    stub::call("trammel.read", kPeriod);
    stub::call("trammel.write", kPeriod);
  }
  EXPECT_TRUE(stub::bit("trammel.link-ok"));
}

TEST_F(Component, AnotherOwnerIsASessionLost) {
  switch_on();
  status_.session = 8;
  periods(2);
  EXPECT_TRUE(stub::bit("trammel.session-lost"));
  EXPECT_FALSE(enabled());
  enable(false);
  periods(2);
  EXPECT_FALSE(stub::bit("trammel.session-lost"));
}

TEST_F(Component, StopOfTheCardEndsFollowingUntilTheMachineWasOff) {
  switch_on();
  stop(12);
  periods(2);
  EXPECT_TRUE(stub::bit("trammel.fault"));
  EXPECT_EQ(stub::u32("trammel.stop-cause"), 12U);
  EXPECT_FALSE(enabled());
  stub::bit("trammel.clear") = true;
  periods(1);
  owner();
  EXPECT_TRUE(last_->flags & TRAMMEL_PERIOD_CLEAR);
  status_.state = TRAMMEL_IDLE;
  status_.flags &= ~static_cast<unsigned>(TRAMMEL_STATUS_FAULT);
  periods(5);
  EXPECT_FALSE(last_->flags & TRAMMEL_PERIOD_CLEAR) << "the rising edge alone";
  EXPECT_FALSE(enabled()) << "clearing starts nothing";
  enable(false);
  periods(2);
  enable(true);
  periods(2);
  EXPECT_TRUE(enabled());
}

TEST_F(Component, ClearThatIsDroppedIsSentInTheNextPeriod) {
  periods(3);
  stub::u32("trammel.test-drop-one-in") = 1;
  stub::bit("trammel.clear") = true;
  periods(2);
  stub::u32("trammel.test-drop-one-in") = 0;
  periods(1);
  owner();
  EXPECT_TRUE(last_->flags & TRAMMEL_PERIOD_CLEAR);
}

TEST_F(Component, DroppedPeriodsAreGapsAndErrors) {
  switch_on();
  stub::u32("trammel.test-drop-one-in") = 10;
  const std::size_t before = periods_.size();
  periods(100);
  owner();
  EXPECT_EQ(periods_.size() - before, 91U);
  EXPECT_EQ(periods_.back().number - periods_[before - 1].number, 101U);
  EXPECT_EQ(stub::u32("trammel.packet-error-total"), 10U);
}

TEST_F(Component, FullRingDropsAndGoesOn) {
  switch_on();
  stub::u32("trammel.link-periods") = 1000;
  const std::uint64_t before = region_->period_head;
  periods(TRAMMEL_PERIODS + 50, false);
  EXPECT_EQ(region_->period_head - region_->period_tail, static_cast<unsigned>(TRAMMEL_PERIODS));
  periods(1);
  EXPECT_EQ(region_->period_head, before + TRAMMEL_PERIODS);
}

TEST_F(Component, IndexEdgeBecomesZeroWithoutAJump) {
  switch_on();
  for (int k = 0; k < 10; ++k) period([] { command(0) += 0.01; });
  stub::bit(joint(0, "index-enable").c_str()) = true;
  period([] { command(0) += 0.01; });
  owner();
  EXPECT_EQ(last_->flags >> TRAMMEL_PERIOD_INDEX_SHIFT, 1U);
  status_.index_latched = 1;
  status_.index_position[0] = 3;
  const double before = target(0);
  stub::now += kPeriod;
  owner();
  stub::call("trammel.read", kPeriod);
  EXPECT_FALSE(stub::bit(joint(0, "index-enable").c_str()));
  EXPECT_NEAR(feedback(0), (before - 3) / kScale, 1e-9);
  command(0) = feedback(0) + 0.01;  // as LinuxCNC does: continues from the feedback
  stub::call("trammel.write", kPeriod);
  owner();
  EXPECT_NEAR(target(0), before + 0.01 * kScale, 1e-6);
  EXPECT_EQ(last_->flags >> TRAMMEL_PERIOD_INDEX_SHIFT, 0U);
  // The owner's bit is still set; a new request for an index means another one.
  stub::bit(joint(0, "index-enable").c_str()) = true;
  periods(1);
  EXPECT_TRUE(stub::bit(joint(0, "index-enable").c_str()));
}

TEST_F(Component, PathModeEchoesTheCommandWhileTheMachineIsOn) {
  stub::bit("trammel.planner-module") = true;
  switch_on();
  stub::bit("trammel.coord-mode") = true;
  period([] { command(0) = 5; });
  period([] {});
  EXPECT_EQ(feedback(0), 5);
  owner();
  EXPECT_TRUE(last_->flags & TRAMMEL_PERIOD_PATH);
  status_.position[0] = 40;
  enable(false);
  periods(1, false);
  publish();
  periods(1, false);
  EXPECT_EQ(feedback(0), 0.5) << "the card's, which still ramps";
}

TEST_F(Component, PathModeShowsTheCardsPositionAfterAStop) {
  stub::bit("trammel.planner-module") = true;
  switch_on();
  stub::bit("trammel.coord-mode") = true;
  period([] { command(0) = 5; });
  stop(3);
  status_.position[0] = 40;
  periods(2);
  EXPECT_EQ(feedback(0), 0.5);
}

TEST_F(Component, WatchdogBitAsksToClearWhenItIsWrittenFalse) {
  periods(2);
  status_.fault = 1U << 14U;
  periods(2);
  EXPECT_TRUE(stub::bit("trammel.watchdog.has_bit"));
  stub::bit("trammel.watchdog.has_bit") = false;
  periods(1);
  owner();
  EXPECT_TRUE(last_->flags & TRAMMEL_PERIOD_CLEAR);
  status_.fault = 0;
  periods(2);
  EXPECT_FALSE(stub::bit("trammel.watchdog.has_bit"));
}

TEST_F(Component, SettingsGoToTheOwnerAndScaleShowsTheMachineFiles) {
  periods(2);
  EXPECT_EQ(stub::real(joint(0, "position-scale").c_str()), kScale);
  EXPECT_EQ(region_->settings.pulses_per_unit[0], 0);
  EXPECT_EQ(region_->settings.joints, 3U);
  stub::real(joint(0, "position-scale").c_str()) = 100;
  stub::real(joint(1, "maxvel").c_str()) = 20;
  stub::u32(joint(1, "dirhold").c_str()) = 700;
  stub::u32("trammel.lead-periods") = 4;
  periods(1);
  EXPECT_EQ(region_->settings.pulses_per_unit[0], 100);
  EXPECT_DOUBLE_EQ(region_->settings.max_speed[1], 1.05 * 20 * kScale);
  EXPECT_EQ(region_->settings.dir_hold[1], 700U);
  EXPECT_EQ(region_->settings.lead_periods, 4U);
  EXPECT_EQ(region_->settings_sequence % 2, 0U);
}

TEST_F(Component, TornStatusKeepsTheLastOneAndIsAnError) {
  switch_on();
  status_.inputs = 5;
  periods(1);
  region_->status_sequence |= 1U;
  region_->status.inputs = 0;
  periods(1, false);
  EXPECT_TRUE(stub::bit("trammel.input-00"));
  EXPECT_TRUE(stub::bit("trammel.input-02"));
  EXPECT_TRUE(stub::bit("trammel.input-01-not"));
  EXPECT_TRUE(stub::bit("trammel.packet-error"));
  ++region_->status_sequence;
}

TEST_F(Component, LatencyIsTheAgeOfTheCardsNewestPeriodAndWhatIsQueued) {
  switch_on();
  status_.ahead = 2;
  periods(3);
  // The owner reads one period later: one period of age, two queued, one under way.
  EXPECT_NEAR(stub::real("trammel.latency"), 0.004, 1e-9);
}

TEST_F(Component, TellsItsLongestPeriodAndTheOwnersLongestSilence) {
  switch_on();
  periods(3, false);
  stub::now += 4 * kPeriod;
  periods(2);
  EXPECT_EQ(stub::u32("trammel.longest-period"), 5 * kPeriod);
  EXPECT_EQ(stub::u32("trammel.longest-silence"), 8 * kPeriod);
}

TEST_F(Component, UnloadedComponentSwitchesTheMachineOff) {
  switch_on();
  EXPECT_TRUE(enabled());
  rtapi_app_exit();
  loaded_ = false;
  owner();
  EXPECT_FALSE(enabled());
}

TEST_F(Component, HoldsItsLockFromLoadingToUnloading) {
  const auto lock = [this] {
    const int file = open(path_.c_str(), O_RDWR);
    flock wanted{};
    wanted.l_type = F_WRLCK;
    wanted.l_start = TRAMMEL_LOCK_HAL;
    wanted.l_len = 1;
    const bool free = fcntl(file, F_OFD_SETLK, &wanted) == 0;
    close(file);
    return free;
  };
  EXPECT_FALSE(lock());
  rtapi_app_exit();
  loaded_ = false;
  EXPECT_TRUE(lock());
}

// The memory outlives its owner: after an update, a file left by an owner that has ended does not block LinuxCNC.
TEST_F(Component, ARegionThatAnotherVersionHasLeftBeginsAnew) {
  rtapi_app_exit();
  loaded_ = false;
  region_->version_owner = TRAMMEL_REGION_VERSION + 1;
  region_->period_head = 77;
  const int owner = open(path_.c_str(), O_RDWR);
  ASSERT_GE(owner, 0);
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = TRAMMEL_LOCK_OWNER;
  lock.l_len = 1;
  ASSERT_EQ(fcntl(owner, F_OFD_SETLK, &lock), 0);
  EXPECT_EQ(rtapi_app_main(), -EPROTO) << "that owner lives";
  EXPECT_EQ(region_->period_head, 77U);
  close(owner);
  ASSERT_EQ(rtapi_app_main(), 0) << stub::messages();
  loaded_ = true;
  EXPECT_EQ(region_->version_owner, 0U);
  EXPECT_EQ(region_->version_hal, TRAMMEL_REGION_VERSION);
  EXPECT_EQ(region_->period_head, 0U);
}

}  // namespace
