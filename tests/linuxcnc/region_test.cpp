// The owner's end of the shared memory: its only owner, the state that a new owner finds, and records that are read
// while they are written.
#include "trammel/linuxcnc/region.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "servo_bench.hpp"

namespace trammel::linuxcnc {
namespace {

using namespace std::chrono_literals;

void post_period(Region& region, std::uint64_t number) {
  trammel_region& memory = region.memory();
  memory.periods[memory.period_head % TRAMMEL_PERIODS].number = number;
  ++memory.period_head;
}

TEST(Region, HasOneOwner) {
  const RegionFolder folder;
  {
    const Region first("one", folder.path);
    EXPECT_THROW(Region("one", folder.path), RegionError);
    EXPECT_NO_THROW(Region("two", folder.path));
  }
  EXPECT_NO_THROW(Region("one", folder.path));
}

TEST(Region, IsOfItsUserAlone) {
  const RegionFolder folder;
  const Region region("one", folder.path);
  struct stat status {};
  ASSERT_EQ(::stat(region.path().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0600U);
  EXPECT_EQ(static_cast<std::size_t>(status.st_size), sizeof(trammel_region));
}

TEST(Region, RefusesNamesThatLeaveItsFolder) {
  for (const char* name : {"", "../x", "a b", "a/b"}) EXPECT_THROW(Region(name, "/tmp"), RegionError) << name;
}

TEST(Region, GivesPeriodsInOrderAndWrapsAround) {
  const RegionFolder folder;
  Region region("one", folder.path);
  EXPECT_FALSE(region.take_period());
  for (std::uint64_t n = 1; n <= 3 * TRAMMEL_PERIODS; ++n) {
    post_period(region, n);
    const auto period = region.take_period();
    ASSERT_TRUE(period);
    EXPECT_EQ(period->number, n);
  }
  EXPECT_FALSE(region.take_period());
}

TEST(Region, ANewOwnerDropsWhatWasMeantForTheOneBefore) {
  const RegionFolder folder;
  std::uint64_t session = 0;
  {
    Region region("one", folder.path);
    post_period(region, 1);
    region.publish({});
    session = region.memory().status.session;
  }
  Region region("one", folder.path);
  EXPECT_FALSE(region.take_period());
  region.publish({});
  EXPECT_NE(region.memory().status.session, session);
}

// A module of another version still runs, so its memory is not changed.
TEST(Region, RefusesModulesOfAnotherVersion) {
  const RegionFolder folder;
  const std::string path = folder.path + "/" TRAMMEL_REGION_PREFIX "one";
  { const Region region("one", folder.path); }
  const int file = ::open(path.c_str(), O_RDWR);
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_start = TRAMMEL_LOCK_HAL;
  lock.l_len = 1;
  ASSERT_EQ(::fcntl(file, F_OFD_SETLK, &lock), 0);
  const std::uint32_t other = TRAMMEL_REGION_VERSION + 1;
  ASSERT_EQ(::pwrite(file, &other, sizeof other, offsetof(trammel_region, version_hal)), ssize_t{sizeof other});
  EXPECT_THROW(Region("one", folder.path), RegionError);
  const std::uint32_t same = TRAMMEL_REGION_VERSION;
  ASSERT_EQ(::pwrite(file, &same, sizeof same, offsetof(trammel_region, version_hal)), ssize_t{sizeof same});
  {
    const Region region("one", folder.path);
    EXPECT_TRUE(region.has_hal());
    EXPECT_FALSE(region.has_planner());
  }
  ::close(file);
  EXPECT_NO_THROW(Region("one", folder.path));
}

TEST(Region, ReadsSettingsOnceAndNotWhileTheyAreWritten) {
  const RegionFolder folder;
  Region region("one", folder.path);
  trammel_region& memory = region.memory();
  EXPECT_FALSE(region.new_settings());
  memory.settings_sequence = 1;
  memory.settings.joints = 3;
  EXPECT_FALSE(region.new_settings());
  memory.settings_sequence = 2;
  const auto settings = region.new_settings();
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->joints, 3U);
  EXPECT_FALSE(region.new_settings());
}

TEST(Region, AStatusIsWholeWhenItsSequenceIsEven) {
  const RegionFolder folder;
  Region region("one", folder.path);
  std::atomic<bool> ended{false};
  std::uint64_t torn = 0;
  std::atomic<std::uint64_t> read{0};
  const trammel_region& memory = region.memory();
  std::thread reader([&] {
    while (!ended) {
      const std::uint32_t before = __atomic_load_n(&memory.status_sequence, __ATOMIC_ACQUIRE);
      if ((before & 1U) != 0) continue;
      const trammel_status copy = memory.status;
      __atomic_thread_fence(__ATOMIC_ACQUIRE);
      if (__atomic_load_n(&memory.status_sequence, __ATOMIC_RELAXED) != before) continue;
      ++read;
      for (unsigned n = 1; n < TRAMMEL_JOINTS; ++n) torn += copy.position[n] != copy.position[0] ? 1 : 0;
    }
  });
  // Publishes until the reader, which may start late on a busy machine, has read a thousand copies.
  trammel_status status{};
  for (std::int64_t n = 0; n < 100'000 || read < 1000; ++n) {
    for (std::int64_t& position : status.position) position = n;
    region.publish(status);
  }
  ended = true;
  reader.join();
  EXPECT_EQ(torn, 0U);
}

TEST(Region, WakesWhenItIsTold) {
  const RegionFolder folder;
  Region region("one", folder.path);
  ++region.memory().wake;
  const auto begun = std::chrono::steady_clock::now();
  region.wait(10s);
  EXPECT_LT(std::chrono::steady_clock::now() - begun, 5s);
  region.wait(1ms);  // nothing arrives, so it waits for the whole time
}

}  // namespace
}  // namespace trammel::linuxcnc
