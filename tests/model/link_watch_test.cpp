// The rules of the watch over the link of the writing session, on the golden core: when the card stops, and whose
// silence stops it.
#include "trammel/model/link_watch.hpp"

#include <gtest/gtest.h>

#include "core_bench.hpp"

namespace trammel::testing::link_watch {
namespace {

namespace reg = card_map::reg;
namespace field = card_map::field;

constexpr std::uint64_t kLinkUnit = std::uint64_t{1} << model::LinkWatch::kUnitBits;

// A host at the inner port, in a session of one of the ports.
struct LinkHost {
  CoreBench& card;
  std::uint8_t port = 0;
  bool begins = false;  // its next access is the first one of a session
  bool of_session = true;

  bool access(std::uint32_t address, bool write, std::uint32_t data) {
    model::CoreModel::Inputs in;
    in.request = true;
    in.write = write;
    in.address = address;
    in.data = data;
    in.port = port;
    in.of_session = of_session;
    in.new_session = begins;
    begins = false;
    card.clock(in);
    while (!card.core.answer().ack) {
      in.request = false;
      card.clock(in);
    }
    return !card.core.answer().error;
  }
  bool write(std::uint32_t address, std::uint32_t data) { return access(address, true, data); }
  void look() { access(reg::kStatus, false, 0); }
};

model::CardConfig with_two_ports() {
  model::CardConfig config;
  config.axes = 2;
  config.ports = 2;
  return config;
}

class LinkWatch : public ::testing::Test {
 protected:
  LinkWatch() { bench.skips = true; }
  // Makes `times` accesses, a quarter of a unit apart.
  void looks(LinkHost& host, unsigned times) {
    for (; times != 0; --times) {
      skip::run(bench.core, kLinkUnit / 4);
      host.look();
    }
  }
  void pass(std::uint64_t clocks) { skip::run(bench.core, clocks); }
  bool lost() const { return (bench.core.outputs().fault & field::kFaultLinkLoss) != 0; }

  CoreBench bench{with_two_ports()};
  LinkHost writer{bench};
  LinkHost reader{bench, 1};
};

TEST_F(LinkWatch, SilenceOfTheWriterStopsTheCard) {
  writer.write(reg::kLinkTimeout, 2);
  looks(writer, 40);
  EXPECT_FALSE(lost()) << "each access starts it anew";
  pass(2 * kLinkUnit - 20);
  EXPECT_FALSE(lost());
  pass(kLinkUnit + 20);
  EXPECT_TRUE(lost());
}

TEST_F(LinkWatch, ItCountsInWholeUnits) {
  for (const std::uint64_t late : {std::uint64_t{0}, kLinkUnit / 3, kLinkUnit - 40}) {
    CoreBench card(with_two_ports());
    card.skips = true;
    LinkHost host{card};
    skip::run(card.core, kLinkUnit + late);
    host.write(reg::kLinkTimeout, 3);
    const std::uint64_t begin = card.core.cycles();
    while (card.core.outputs().fault == 0) card.idle(1);
    EXPECT_GT(card.core.cycles() - begin, 3 * kLinkUnit) << late;
    EXPECT_LE(card.core.cycles() - begin, 4 * kLinkUnit + 3) << late;
  }
}

TEST_F(LinkWatch, AReaderNeitherFeedsNorTripsIt) {
  reader.look();
  writer.write(reg::kLinkTimeout, 2);
  looks(reader, 16);
  EXPECT_TRUE(lost()) << "the reader feeds nothing";
  writer.write(reg::kLinkTimeout, 2);
  writer.write(reg::kFault, ~0U & field::kFaultLinkLoss);
  looks(writer, 40);
  EXPECT_FALSE(lost()) << "its silence does not count";
}

TEST_F(LinkWatch, ALaterSessionAtThePortFeedsNothing) {
  writer.write(reg::kLinkTimeout, 2);
  writer.begins = true;
  looks(writer, 16);
  EXPECT_TRUE(lost());
  writer.write(reg::kFault, field::kFaultLinkLoss);
  pass(10);
  EXPECT_TRUE(lost()) << "it lasts until LINK_TIMEOUT is written";
  writer.write(reg::kLinkTimeout, 2);
  writer.write(reg::kFault, field::kFaultLinkLoss);
  looks(writer, 40);
  EXPECT_FALSE(lost()) << "the session that writes it is the one that is watched";
}

TEST_F(LinkWatch, NeitherRefusedAccessesNorThePortsOwnFeedIt) {
  writer.write(reg::kLinkTimeout, 2);
  for (unsigned i = 0; i < 16; ++i) {
    pass(kLinkUnit / 4);
    EXPECT_FALSE(writer.write(reg::kMagic, 0));
    LinkHost port{bench, 0, false, false};
    port.look();
  }
  EXPECT_TRUE(lost());
}

TEST_F(LinkWatch, ItIsOffWithoutATime) {
  writer.look();
  pass(10 * kLinkUnit);
  writer.write(reg::kLinkTimeout, 2);
  writer.write(reg::kLinkTimeout, 0);
  pass(10 * kLinkUnit);
  EXPECT_FALSE(lost());
}

}  // namespace
}  // namespace trammel::testing::link_watch
