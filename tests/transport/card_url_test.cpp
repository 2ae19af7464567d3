#include "trammel/transport/card_url.hpp"

#include <gmock/gmock.h>

#include "trammel/driver/errors.hpp"

namespace trammel::transport {
namespace {

using ::testing::HasSubstr;
using Kind = CardUrl::Kind;

TEST(CardUrl, OfEveryKind) {
  const CardUrl sim = parse_card_url("sim:?axes=8&clock=2500000");
  EXPECT_EQ(sim.kind, Kind::kSim);
  EXPECT_EQ(sim.axes, 8U);
  EXPECT_EQ(sim.clock_hz, 2'500'000U);
  EXPECT_EQ(parse_card_url("sim:").axes, 4U);

  const CardUrl tcp = parse_card_url("tcp://localhost:5001?timeout=500&token=abc&hello=no");
  EXPECT_EQ(tcp.kind, Kind::kTcp);
  EXPECT_EQ(tcp.host, "localhost");
  EXPECT_EQ(tcp.port, 5001);
  EXPECT_EQ(tcp.token, "abc");
  EXPECT_FALSE(tcp.hello);
  EXPECT_EQ(tcp.timeout, std::chrono::milliseconds(500));
  EXPECT_EQ(tcp.text, "tcp://localhost:5001?timeout=500&hello=no") << "without what is nobody else's business";
  EXPECT_EQ(parse_card_url("tcp://[::1]:5001").host, "::1");
  EXPECT_TRUE(parse_card_url("tcp://h:1").hello);

  const CardUrl serial = parse_card_url("serial:/dev/ttyUSB0?baud=1000000");
  EXPECT_EQ(serial.kind, Kind::kSerial);
  EXPECT_EQ(serial.device, "/dev/ttyUSB0");
  EXPECT_EQ(serial.baud, 1'000'000U);
  EXPECT_EQ(parse_card_url("serial:/dev/ttyUSB0").baud, 115'200U);

  const CardUrl spi = parse_card_url("spi:/dev/spidev0.0?sck=12500000&mode=3");
  EXPECT_EQ(spi.kind, Kind::kSpi);
  EXPECT_EQ(spi.sck_hz, 12'500'000U);
  EXPECT_EQ(spi.mode, 3U);

  const CardUrl memory = parse_card_url("mmap:/dev/mem?offset=0x43C00004&irq=no");
  EXPECT_EQ(memory.kind, Kind::kMmap);
  EXPECT_EQ(memory.device, "/dev/mem");
  EXPECT_EQ(memory.offset, 0x43C00004U);
  EXPECT_FALSE(memory.interrupt);
}

struct BadUrl {
  const char* text;
  const char* message;
};

class BadCardUrl : public ::testing::TestWithParam<BadUrl> {};

TEST_P(BadCardUrl, SaysWhatToWrite) {
  try {
    parse_card_url(GetParam().text);
    FAIL() << GetParam().text;
  } catch (const driver::ArgumentError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(
    CardUrl, BadCardUrl,
    ::testing::Values(
        BadUrl{"", "must be sim:, tcp://"}, BadUrl{"usb:1", "must be sim:, tcp://"},
        BadUrl{"/dev/ttyUSB0", "did you mean serial:/dev/ttyUSB0?"}, BadUrl{"/dev/uio0", "did you mean mmap:"},
        BadUrl{"pi.local:7000", "did you mean tcp://pi.local:7000?"}, BadUrl{"sim:4", "as sim:?axes=4"},
        BadUrl{"sim:?axes=9", "axes=9: must be a whole number from 1 to 8"},
        BadUrl{"tcp:localhost:1", "tcp://HOST:PORT"}, BadUrl{"tcp://localhost", "tcp://HOST:PORT"},
        BadUrl{"tcp://:5", "tcp://HOST:PORT"}, BadUrl{"tcp://::1:5", "as [HOST]"},
        BadUrl{"tcp://h:0", "from 1 to 65535"}, BadUrl{"tcp://h:65536", "from 1 to 65535"},
        BadUrl{"tcp://h:5?baud=9600", "no option baud"}, BadUrl{"tcp://h:5?hello=maybe", "yes or no"},
        BadUrl{"tcp://h:5?token", "no option token"}, BadUrl{"serial:ttyUSB0", "serial:/dev/"},
        BadUrl{"serial:", "serial:/dev/"}, BadUrl{"serial:/dev/ttyUSB0?baud=fast", "baud=fast"},
        BadUrl{"spi:/dev/spidev0.0?mode=1", "modes 0 and 3"}, BadUrl{"mmap:/dev/mem?offset=0x2", "multiple of 4"},
        BadUrl{"mmap:/dev/mem?offset=-4", "offset=-4"}, BadUrl{"mmap:/dev/mem?timeout=5", "no option timeout"}));

}  // namespace
}  // namespace trammel::transport
