// Homing behind a link that is slow, late or bad, or is cut during the search. The edge is always the one that the card
// has captured. Without a host the card stops on a ramp. The links in memory use the card's time, so that each run is
// the same; the socket and the terminal use a server's time.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <cstdlib>
#include <deque>
#include <functional>
#include <random>
#include <thread>

#include "trammel/card_map.hpp"
#include "trammel/driver/card_timing.hpp"
#include "trammel/driver/frame_bus.hpp"
#include "trammel/driver/watchdog_scope.hpp"
#include "trammel/frames/endpoint.hpp"
#include "trammel/run/card_place.hpp"
#include "trammel/run/configure.hpp"
#include "trammel/run/homing.hpp"
#include "trammel/serve/card_server.hpp"
#include "trammel/transport/card_url.hpp"
#include "trammel/transport/connection.hpp"
#include "trammel/world/engine_in_world.hpp"
#include "trammel/world/world_file.hpp"

namespace trammel::serve {
namespace {

using namespace std::chrono_literals;
namespace field = card_map::field;
constexpr std::uint32_t kHomeClock = 1'000'000;
constexpr double kHomePulse = 1.0 / 80;  // mm

const machine::Machine& first_machine() {
  static const machine::Machine machine = machine::load_machine(TRAMMEL_EXAMPLES_DIR "/first-machine.toml");
  return machine;
}

// A card with the default world behind its pins.
struct CardInDefaultWorld {
  world::World world{world::default_world(), kHomeClock};
  world::EngineInWorld engine{sim::make_model_engine(sim::EngineOptions{4, kHomeClock, false}), world};
};

// Disturbances of frames by a link.
struct LinkFaults {
  std::chrono::nanoseconds byte = 0ns;     // duration of a byte on the line
  std::chrono::nanoseconds latency = 0ns;  // in each direction
  unsigned one_in = 0;                     // one frame in so many is spoiled; 0: none
};

// A stream of bytes to the card, in the card's time.
class LinkInCardTime final : public driver::ByteLink {
 public:
  LinkInCardTime(sim::Engine& engine, const LinkFaults& faults)
      : engine_(engine), faults_(faults), endpoint_([this](bool write, std::uint32_t address, std::uint32_t data) {
          driver::Access access = write ? driver::write_of(address, data) : driver::read_of(address);
          const bool made = engine_.transfer(&access, 1) == 1;
          return frames::Endpoint::Answer{!made, access.data};
        }) {}

  void send(const std::uint8_t* bytes, std::size_t count) override {
    if (is_cut()) throw driver::LinkError("the cable is out");
    frames::Bytes sent(bytes, bytes + count);
    sleep(time_of(count));
    spoil(sent);
    frames::Bytes reply;
    for (const std::uint8_t byte : sent) endpoint_.take(byte, reply);
    spoil(reply);
    back_.insert(back_.end(), reply.begin(), reply.end());
  }
  std::size_t receive(std::uint8_t* bytes, std::size_t room, std::chrono::nanoseconds longest) override {
    if (back_.empty()) {
      sleep(longest);
      return 0;
    }
    std::size_t count = 0;
    for (; count < room && !back_.empty(); ++count) {
      bytes[count] = back_.front();
      back_.pop_front();
    }
    sleep(time_of(count));
    return count;
  }
  void restart() override {
    if (is_cut()) throw driver::LinkError("the cable is out");
    endpoint_.connect();
    back_.clear();
  }
  std::chrono::nanoseconds time_of(std::size_t bytes) const override {
    return faults_.latency + faults_.byte * static_cast<std::int64_t>(bytes);
  }
  std::chrono::nanoseconds now() const override { return driver::time_of(engine_.cycles(), kHomeClock); }
  void sleep(std::chrono::nanoseconds time) override {
    if (time.count() > 0) engine_.sleep(time);
  }
  void cut_when(std::function<bool()> cut) { cut_ = std::move(cut); }
  unsigned spoiled() const { return spoiled_; }

 private:
  bool is_cut() { return cut_now_ = cut_now_ || (cut_ && cut_()); }
  // Removes a byte or changes a bit of it.
  void spoil(frames::Bytes& bytes) {
    if (faults_.one_in == 0 || bytes.empty() || random_() % faults_.one_in != 0) return;
    ++spoiled_;
    const auto place = static_cast<std::ptrdiff_t>(random_() % bytes.size());
    if (random_() % 2 == 0) {
      bytes.erase(bytes.begin() + place);
    } else {
      std::uint8_t& byte = bytes[static_cast<std::size_t>(place)];
      byte = static_cast<std::uint8_t>(byte ^ 1U << random_() % 8);
    }
  }

  sim::Engine& engine_;
  LinkFaults faults_;
  frames::Endpoint endpoint_;
  std::deque<std::uint8_t> back_;
  std::mt19937 random_{5};
  std::function<bool()> cut_;
  bool cut_now_ = false;
  unsigned spoiled_ = 0;
};

struct Homed {
  std::vector<run::HomedAxis> axes;
  driver::CardPlace place;
};

// Homes X, Y and Z as `trammel home` does. `silence`: the watchdog's time, 0: off. The host refreshes the watchdog by
// its own clock, which is slower than the card's here, so these tests do not judge the refreshing.
Homed home_all(driver::Bus& bus, std::chrono::nanoseconds silence = 2s) {
  driver::Card card = driver::Card::open(bus);
  run::configure(card, first_machine());
  run::MachinePosition position(card.read_snapshot(), first_machine());
  const driver::WatchdogScope watchdog(card, silence);
  Homed homed{run::home(card, first_machine(), position, {0, 1, 2}), {}};
  homed.place = run::read_card_place(card);
  EXPECT_EQ(card.read_faults(), 0U);
  return homed;
}

const Homed& homed_without_link() {
  static const Homed homed = [] {
    CardInDefaultWorld here;
    return home_all(here.engine);
  }();
  return homed;
}

// Each axis's edge and machine zero equal those of a card without a link.
void expect_same_edges(const Homed& homed) {
  const Homed& wanted = homed_without_link();
  ASSERT_EQ(homed.axes.size(), 3U);
  EXPECT_EQ(homed.place.bits.homed, 7);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(homed.axes[n].axis, wanted.axes[n].axis);
    EXPECT_NEAR(homed.axes[n].edge, wanted.axes[n].edge, 1.01 * kHomePulse) << n;
    EXPECT_NEAR(homed.axes[n].search_edge, homed.axes[n].edge, 1.01 * kHomePulse) << n;
    EXPECT_NEAR(homed.place.zero[n], wanted.place.zero[n], 1) << n;
  }
}

void expect_no_lost_steps(const world::World& world) {
  for (std::size_t n = 0; n < world.axes(); ++n) EXPECT_EQ(world.carriage(n).lost(), 0) << n;
}

struct Tried {
  Homed homed;
  unsigned spoiled;
  double seconds;  // card time
};

Tried home_behind(const LinkFaults& faults) {
  CardInDefaultWorld here;
  LinkInCardTime link(here.engine, faults);
  driver::FrameBus::Options options;
  options.answer = 100ms;
  options.sends = 8;
  driver::FrameBus bus(link, options);
  Tried tried{home_all(bus, 0s), link.spoiled(), 0};
  tried.seconds = static_cast<double>(here.engine.cycles()) / kHomeClock;
  expect_no_lost_steps(here.world);
  EXPECT_EQ(here.engine.positions()[0] - tried.homed.place.zero[0], 0) << "X stands at 0";
  return tried;
}

TEST(HomingOnLinks, ASerialLineOf115200Baud) { expect_same_edges(home_behind({86'806ns, 0ns, 0}).homed); }

TEST(HomingOnLinks, LatencyCostsTimeAndNoPulse) {
  const double without = home_behind({}).seconds;
  for (const auto latency : {2ms, 20ms, 60ms}) {
    SCOPED_TRACE(latency.count());
    const Tried tried = home_behind({0ns, latency, 0});
    expect_same_edges(tried.homed);
    EXPECT_GT(tried.seconds, without);
    fmt::print("homed in {:.1f} s of the card, {:.1f} s without latency\n", tried.seconds, without);
  }
}

TEST(HomingOnLinks, ALinkThatSpoilsFrames) {
  const Tried tried = home_behind({86'806ns, 1ms, 8});
  expect_same_edges(tried.homed);
  EXPECT_GT(tried.spoiled, 50U);
  fmt::print("{} frames spoiled\n", tried.spoiled);
}

// The card stops on the ramp of an under-run hold, and then the watchdog latches that the host is silent. The axis does
// not count as homed.
void expect_stop_without_host(std::size_t axis, double millimetres) {
  CardInDefaultWorld here;
  LinkInCardTime link(here.engine, {86'806ns, 0ns, 0});
  driver::FrameBus bus(link);
  const world::Carriage& carriage = here.world.carriage(axis);
  link.cut_when([&] { return std::abs(carriage.position()) > millimetres / kHomePulse; });
  EXPECT_THROW(home_all(bus), driver::LinkError);
  ASSERT_TRUE(here.engine.read(card_map::reg::kStatus) & field::kStatusBusy) << "it is searching";
  // The commands sent so far end in an under-run hold, which is a ramp, long before the watchdog expires.
  here.engine.sleep(500ms);
  const std::uint32_t status = here.engine.read(card_map::reg::kStatus);
  EXPECT_TRUE(status & field::kStatusUnderrun);
  EXPECT_TRUE(status & field::kStatusHeld);
  EXPECT_FALSE(status & field::kStatusFaulted);
  const std::vector<std::int64_t> held_at = here.engine.positions();
  here.engine.sleep(6s);
  EXPECT_EQ(here.engine.positions(), held_at);
  driver::Card card = driver::Card::open(here.engine);
  const driver::Snapshot end = card.read_snapshot();
  EXPECT_EQ(end.faults & field::kFaultWatchdog, field::kFaultWatchdog) << end.faults;
  EXPECT_FALSE(end.status.busy);
  EXPECT_FALSE(end.status.stopping);
  const double beyond = std::abs(end.position[axis]) * kHomePulse - millimetres;
  fmt::print("cut in the search of axis {}: faults {:#x}, stands {:.2f} mm behind the cut\n", axis, end.faults, beyond);
  EXPECT_GT(beyond, 0.1);
  EXPECT_LT(beyond, 10) << "far before the switch";
  EXPECT_TRUE(card.read_rest().exact());
  const driver::CardPlace place = run::read_card_place(card);
  EXPECT_EQ(place.bits.homed & 1U << axis, 0U) << "axes of an earlier sequence may be";
  expect_no_lost_steps(here.world);
  here.engine.sleep(1s);
  EXPECT_EQ(card.read_snapshot().position, end.position) << "nothing moves by itself";
  // The next host homes the axis.
  card.clear_faults();
  const Homed homed = home_all(here.engine);
  EXPECT_EQ(homed.place.bits.homed, 7);
  EXPECT_NEAR(homed.place.zero[0], homed_without_link().place.zero[0], 1);
}

TEST(HomingOnLinks, ALinkThatIsCutInTheSearchLeavesACardThatStops) {
  expect_stop_without_host(2, 20);
  expect_stop_without_host(0, 30);
}

// A server of such a card, in its own thread.
class ServedInWorld {
 public:
  explicit ServedInWorld(std::unique_ptr<transport::Listener> listener) : listener_(std::move(listener)) {
    Settings settings;
    settings.token = "secret";
    settings.clock_hz = kHomeClock;
    settings.real_time = false;
    settings.world = &here_.world;
    server_ = std::make_unique<CardServer>(here_.engine, *listener_, settings);
    thread_ = std::thread([this] {
      while (!ended_) server_->turn();
    });
  }
  ~ServedInWorld() {
    ended_ = true;
    thread_.join();
  }
  std::string url() const { return listener_->url() + "?token=secret&timeout=20000"; }

 private:
  CardInDefaultWorld here_;
  std::unique_ptr<transport::Listener> listener_;
  std::unique_ptr<CardServer> server_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

void expect_homed_at(std::unique_ptr<transport::Listener> listener) {
  const ServedInWorld served(std::move(listener));
  transport::Connection connection(transport::parse_card_url(served.url()));
  expect_same_edges(home_all(connection.bus()));
}

TEST(HomingOnLinks, ASocket) { expect_homed_at(transport::listen_tcp("127.0.0.1", 0)); }
TEST(HomingOnLinks, APseudoTerminal) { expect_homed_at(transport::open_pseudo_terminal()); }

}  // namespace
}  // namespace trammel::serve
