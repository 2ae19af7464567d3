#include "trammel/transport/card_url.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>

#include "trammel/driver/errors.hpp"

namespace trammel::transport {
namespace {

using Kind = CardUrl::Kind;

constexpr const char* kForms =
    "sim:, tcp://HOST:PORT, serial:/dev/ttyUSB0, spi:/dev/spidev0.0 or mmap:/dev/uio0 "
    "(options follow a '?', with '&' between them)";

[[noreturn]] void refuse(std::string_view what, const std::string& why) {
  throw driver::ArgumentError(fmt::format("card {}: {}", what, why));
}

// A hint for a text without a scheme: ": did you mean serial:/dev/ttyUSB0?", or an empty text.
std::string hint_at_scheme(std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> kDevices[] = {
      {"/dev/tty", "serial:"}, {"/dev/pts/", "serial:"}, {"/dev/serial/", "serial:"},
      {"/dev/spidev", "spi:"}, {"/dev/uio", "mmap:"},    {"/dev/mem", "mmap:"}};
  for (const auto& [device, scheme] : kDevices) {
    if (text.substr(0, device.size()) == device) return fmt::format(": did you mean {}{}?", scheme, text);
  }
  const std::size_t colon = text.rfind(':');
  const std::string_view port = text.substr(std::min(text.size(), colon + 1));
  const bool host_and_port = colon != std::string_view::npos && colon != 0 && !port.empty() &&
                             port.find_first_not_of("0123456789") == std::string_view::npos;
  return host_and_port && text.find('/') == std::string_view::npos ? fmt::format(": did you mean tcp://{}?", text) : "";
}

std::uint64_t number(std::string_view name, std::string_view text, std::uint64_t least, std::uint64_t most) {
  const bool hex = text.substr(0, 2) == "0x";
  const std::string_view digits = text.substr(hex ? 2 : 0);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, hex ? 16 : 10);
  if (error != std::errc{} || end != digits.data() + digits.size() || value < least || value > most) {
    throw driver::ArgumentError(
        fmt::format("card: {}={}: must be a whole number from {} to {}", name, text, least, most));
  }
  return value;
}

bool yes_or_no(std::string_view name, std::string_view text) {
  if (text != "yes" && text != "no") {
    throw driver::ArgumentError(fmt::format("card: {}={}: must be yes or no", name, text));
  }
  return text == "yes";
}

// Sets an option; false if this kind of card has no option of that name.
bool set_option(CardUrl& url, std::string_view name, std::string_view value) {
  const auto of = [&](Kind kind, std::string_view option) { return url.kind == kind && name == option; };
  const bool frames = url.kind == Kind::kTcp || url.kind == Kind::kSerial || url.kind == Kind::kSpi;
  if (of(Kind::kTcp, "token") || of(Kind::kSerial, "token")) {
    url.token = value;
  } else if (of(Kind::kTcp, "hello")) {
    url.hello = yes_or_no(name, value);
  } else if (frames && name == "timeout") {
    url.timeout = std::chrono::milliseconds(number(name, value, 1, 1'000'000));
  } else if (of(Kind::kSerial, "baud")) {
    url.baud = static_cast<std::uint32_t>(number(name, value, 50, 4'000'000));
  } else if (of(Kind::kSpi, "sck")) {
    url.sck_hz = static_cast<std::uint32_t>(number(name, value, 1, 1'000'000'000));
  } else if (of(Kind::kSpi, "mode")) {
    url.mode = static_cast<unsigned>(number(name, value, 0, 3));
    if (url.mode == 1 || url.mode == 2) throw driver::ArgumentError("card: mode: the card takes modes 0 and 3");
  } else if (of(Kind::kMmap, "offset")) {
    url.offset = number(name, value, 0, std::uint64_t{1} << 40);
    if (url.offset % 4 != 0) throw driver::ArgumentError("card: offset: must be a multiple of 4");
  } else if (of(Kind::kMmap, "irq")) {
    url.interrupt = yes_or_no(name, value);
  } else if (of(Kind::kSim, "axes")) {
    url.axes = static_cast<unsigned>(number(name, value, 1, 8));
  } else if (of(Kind::kSim, "clock")) {
    url.clock_hz = static_cast<std::uint32_t>(number(name, value, 1, 4'000'000'000));
  } else {
    return false;
  }
  return true;
}

void set_options(CardUrl& url, std::string_view options) {
  while (!options.empty()) {
    const std::string_view option = options.substr(0, options.find('&'));
    options.remove_prefix(std::min(options.size(), option.size() + 1));
    const std::size_t equals = option.find('=');
    const std::string_view name = option.substr(0, equals);
    if (equals == std::string_view::npos || !set_option(url, name, option.substr(equals + 1))) {
      refuse(url.text, fmt::format("no option {} for this kind of card", name));
    }
  }
}

void set_place(CardUrl& url, std::string_view place) {
  if (place.substr(0, 2) != "//") refuse(url.text, "must be tcp://HOST:PORT");
  place.remove_prefix(2);
  const std::size_t colon = place.rfind(':');
  if (colon == std::string_view::npos || colon == 0) refuse(url.text, "must be tcp://HOST:PORT");
  std::string_view host = place.substr(0, colon);
  const bool brackets = host.front() == '[' && host.back() == ']';
  if (brackets) host = host.substr(1, host.size() - 2);
  if (host.empty() || (!brackets && host.find(':') != std::string_view::npos)) {
    refuse(url.text, "must be tcp://HOST:PORT, a host of numbers and colons as [HOST]");
  }
  url.host = host;
  url.port = static_cast<std::uint16_t>(number("port", place.substr(colon + 1), 1, 65535));
}

// Removes the token, which is only for the server.
std::string without_token(std::string_view text) {
  std::string result(text.substr(0, text.find('?')));
  std::string_view options = text.substr(result.size());
  if (!options.empty()) options.remove_prefix(1);
  char between = '?';
  while (!options.empty()) {
    const std::string_view option = options.substr(0, options.find('&'));
    options.remove_prefix(std::min(options.size(), option.size() + 1));
    if (option.substr(0, 6) == "token=") continue;
    result += between;
    result += option;
    between = '&';
  }
  return result;
}

}  // namespace

CardUrl parse_card_url(const std::string& text) {
  constexpr std::pair<std::string_view, Kind> kKinds[] = {{"sim:", Kind::kSim},
                                                          {"tcp:", Kind::kTcp},
                                                          {"serial:", Kind::kSerial},
                                                          {"spi:", Kind::kSpi},
                                                          {"mmap:", Kind::kMmap}};
  CardUrl url;
  url.text = without_token(text);
  const std::size_t question = text.find('?');
  const std::string_view place = std::string_view(text).substr(0, question);
  for (const auto& [scheme, kind] : kKinds) {
    if (place.substr(0, scheme.size()) != scheme) continue;
    url.kind = kind;
    const std::string_view rest = place.substr(scheme.size());
    if (kind == Kind::kTcp) {
      set_place(url, rest);
    } else if (kind == Kind::kSim) {
      if (!rest.empty()) refuse(url.text, "sim: takes options alone, as sim:?axes=4");
    } else {
      if (rest.empty() || rest.front() != '/') refuse(url.text, fmt::format("must be {}/dev/...", scheme));
      url.device = rest;
    }
    if (question != std::string::npos) set_options(url, std::string_view(text).substr(question + 1));
    return url;
  }
  refuse(url.text, fmt::format("must be {}{}", kForms, hint_at_scheme(url.text)));
}

}  // namespace trammel::transport
