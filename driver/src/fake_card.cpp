// The fake's registers and its command checker; its motion is in fake_card_motion.cpp.
#include "trammel/driver/fake_card.hpp"

#include <utility>

namespace trammel::driver {
namespace {

namespace map = card_map;
namespace reg = card_map::reg;
namespace field = card_map::field;

bool in_limits(const map::Register& entry, std::uint32_t value, std::uint32_t engines) {
  if ((value & ~map::bits_with_meaning(entry, engines)) != 0) {
    return false;
  }
  const std::uint32_t lowest_bit = entry.limited & ~(entry.limited - 1);
  const std::uint32_t limited = entry.limited == 0 ? 0 : (value & entry.limited) / lowest_bit;
  return entry.limited == 0 || (limited >= entry.minimum && limited <= entry.maximum);
}

}  // namespace

FakeCard::FakeCard(FakeCardOptions options) : options_(std::move(options)) {
  for (const map::Register& entry : map::kRegisters) {
    for (std::uint32_t slot = 0; slot < entry.count; ++slot) {
      const std::uint32_t address = map::slot_address(entry, slot);
      if (entry.access == map::Access::Setting) {
        settings_[address] = entry.reset;
      } else if (entry.access == map::Access::Snapshot) {
        snapshot_[address] = entry.reset;
      }
    }
  }
  snapshot_before_ = snapshot_;
}

std::uint32_t FakeCard::read(std::uint32_t address) {
  ++accesses_;
  run(options_.clocks_per_access);
  const map::Register& entry = require_register(address, Direction::kRead);
  switch (entry.access) {
    case map::Access::Constant:
      return constant(entry);
    case map::Access::Live:
    case map::Access::ClearOnes:
      return live(address);
    case map::Access::Snapshot:
      return (time_ < snapshot_until_ ? snapshot_before_ : snapshot_).at(address);
    case map::Access::Setting:
      return setting(address);
    case map::Access::Command:
      break;
  }
  refuse(map::Reason::WriteOnly, address, Direction::kRead);
}

void FakeCard::write(std::uint32_t address, std::uint32_t value) {
  ++accesses_;
  run(options_.clocks_per_access);
  write_word(address, value);
}

void FakeCard::write_block(std::uint32_t address, const std::uint32_t* words, std::size_t count,
                           Addressing addressing) {
  if (count == 0) {
    return;
  }
  ++accesses_;
  for (std::size_t i = 0; i < count; ++i) {
    run(options_.clocks_per_access);
    write_word(addressing == Addressing::kFixed ? address : address + 4 * static_cast<std::uint32_t>(i), words[i]);
  }
}

void FakeCard::write_word(std::uint32_t address, std::uint32_t value) {
  const map::Register& entry = require_register(address, Direction::kWrite);
  if (entry.access == map::Access::Constant || entry.access == map::Access::Live ||
      entry.access == map::Access::Snapshot) {
    refuse(map::Reason::ReadOnly, address, Direction::kWrite);
  }
  if (!in_limits(entry, value, options_.engines)) {
    refuse(map::Reason::BadValue, address, Direction::kWrite);
  }
  if (entry.access == map::Access::Setting) {
    settings_[address] = value;
  } else if (address == reg::kFault) {
    fault_ &= ~value;
  } else if (address == reg::kRefusal) {
    refusal_ = value != 0 ? 0 : refusal_;
  } else if (address == reg::kControl) {
    control(value);
  } else if (address == reg::kStream) {
    stream_word(value);
  } else if (address == reg::kStart) {
    start_direct(value);
  }
}

const map::Register& FakeCard::require_register(std::uint32_t address, Direction direction) {
  const map::Slot slot = map::find_register(address);
  if (slot.entry == nullptr || !map::has_engine(options_.engines, slot.entry->engine) ||
      (slot.entry->only_present_axes && slot.index >= options_.axes)) {
    refuse(map::Reason::UnknownAddress, address, direction);
  }
  return *slot.entry;
}

void FakeCard::latch_refusal(map::Reason reason, std::uint32_t address, std::uint8_t command_number) {
  if (refusal_ == 0) {
    refusal_ = static_cast<std::uint32_t>(reason) << field::kRefusalReasonShift |
               std::uint32_t{command_number} << field::kRefusalCommandShift |
               (address << field::kRefusalAddressShift & field::kRefusalAddress);
  }
}

void FakeCard::refuse(map::Reason reason, std::uint32_t address, Direction direction) {
  latch_refusal(reason, address);
  throw BusError(address, direction, "refused by the card");
}

std::uint32_t FakeCard::constant(const map::Register& entry) const {
  const auto forced = options_.constants.find(entry.address);
  if (forced != options_.constants.end()) {
    return forced->second;
  }
  switch (entry.address) {
    case reg::kAxes:
      return options_.axes;
    case reg::kClockHz:
      return options_.clock_hz;
    case reg::kEngines:
      return options_.engines;
    case reg::kCommandsVersion:
      return map::kCommandsVersionValue;
    case reg::kPorts:
      return 1;
    case reg::kGeometryDepth:
      return options_.geometry_depth;
    case reg::kFeedDepth:
      return options_.feed_depth;
    default:
      return entry.reset;
  }
}

std::uint32_t FakeCard::live(std::uint32_t address) const {
  switch (address) {
    case reg::kFault:
      return fault_;
    case reg::kRefusal:
      return refusal_;
    case reg::kGeometryRoom:
      return options_.geometry_depth - geometry_.used;
    case reg::kFeedRoom:
      return options_.feed_depth - feed_.used;
    case reg::kGeometryBegun:
      return geometry_.begun;
    case reg::kFeedBegun:
      return feed_.begun;
    default:
      return status();
  }
}

std::uint32_t FakeCard::status() const {
  std::uint32_t value = 0;
  const auto set = [&value](bool condition, std::uint32_t bit) { value |= condition ? bit : 0; };
  set(busy(), field::kStatusBusy);
  set(direct_left_ != 0, field::kStatusDirect);
  set(geometry_.left != 0, field::kStatusPathActive);
  set(feed_.left != 0, field::kStatusFeedActive);
  set(ratio() == 0, field::kStatusHeld);
  set(ended_, field::kStatusEnded);
  set(fault_ != 0, field::kStatusFaulted);
  set(refusal_ != 0, field::kStatusRefused);
  set(time_ < snapshot_until_, field::kStatusSnapshot);
  set(!partial_.empty(), field::kStatusIncomplete);
  return value;
}

void FakeCard::take_snapshot(map::Area area) {
  if (time_ >= snapshot_until_) {
    snapshot_before_ = snapshot_;
  }
  snapshot_[reg::fault(area)] = fault_;
  snapshot_[reg::status(area)] = status() & ~field::kStatusSnapshot;
  snapshot_[reg::time_lo(area)] = static_cast<std::uint32_t>(time_);
  snapshot_[reg::time_hi(area)] = static_cast<std::uint32_t>(time_ >> 32);
  const FeedCommand* feed = feed_.left != 0 ? std::get_if<FeedCommand>(&feed_.command) : nullptr;
  snapshot_[reg::rate(area)] = feed != nullptr ? static_cast<std::uint32_t>(feed->rate >> 32) : 0;
  snapshot_[reg::ratio(area)] = ratio();
  snapshot_[reg::geometry_begun(area)] = geometry_.begun;
  snapshot_[reg::feed_begun(area)] = feed_.begun;
  for (unsigned axis = 0; axis < options_.axes; ++axis) {
    snapshot_[reg::position(area, axis)] = static_cast<std::uint32_t>(position_[axis]);
  }
  snapshot_until_ = time_ + options_.clocks_per_snapshot;
}

void FakeCard::control(std::uint32_t value) {
  if ((value & field::kControlSnapshot) != 0) {
    take_snapshot(map::Area::Snap);
  }
  if ((value & field::kControlAbort) != 0) {
    cut();
  } else if ((value & field::kControlFlush) != 0 && !partial_.empty()) {
    latch_refusal(map::Reason::Truncated, reg::kControl, static_cast<std::uint8_t>(partial_[0] >> 24));
    partial_.clear();
    stream_open_ = false;
  }
}

void FakeCard::refuse_command(std::uint8_t number, map::Reason reason) { injected_[number] = reason; }

void FakeCard::stream_word(std::uint32_t word) {
  if (direct_left_ != 0) {
    refuse(map::Reason::Busy, reg::kStream, Direction::kWrite);
  }
  if (fault_ != 0) {
    refuse(map::Reason::Faulted, reg::kStream, Direction::kWrite);
  }
  if (!stream_open_) {
    refuse(map::Reason::StreamClosed, reg::kStream, Direction::kWrite);
  }
  partial_.push_back(word);
  if (partial_.size() == 1) {
    check_header();
  }
  if (partial_.size() == (partial_[0] >> 16 & 0xFF)) {
    accept_command();
  }
}

void FakeCard::check_header() {
  const std::uint32_t header = partial_[0];
  const auto mask = static_cast<std::uint8_t>(header >> 8);
  const map::Command* layout = map::find_command(static_cast<std::uint8_t>(header));
  if (layout == nullptr || !map::has_engine(options_.engines, layout->engine)) {
    refuse_partial(map::Reason::UnknownOpcode);
  }
  const bool good_mask = layout->mask_rule == map::MaskRule::Flags  ? map::flags_good(*layout, mask, options_.engines)
                         : layout->mask_rule == map::MaskRule::None ? mask == 0
                                                                    : mask != 0 && mask >> options_.axes == 0;
  if (!good_mask) {
    refuse_partial(map::Reason::BadMask);
  }
  if ((header >> 16 & 0xFF) != map::words(*layout, mask)) {
    refuse_partial(map::Reason::BadLength);
  }
  if (header >> 24 != next_number_) {
    refuse_partial(map::Reason::BadNumber);
  }
  const std::uint32_t needed = map::queue_halfwords(*layout, mask);
  if ((layout->to_geometry && needed > options_.geometry_depth - geometry_.used) ||
      (layout->to_feed && needed > options_.feed_depth - feed_.used)) {
    refuse_partial(map::Reason::NoRoom);
  }
}

void FakeCard::accept_command() {
  const auto injected = injected_.find(static_cast<std::uint8_t>(partial_[0] >> 24));
  if (injected != injected_.end()) {
    refuse_partial(injected->second);
  }
  DecodedCommand decoded;
  try {
    decoded = decode(partial_.data(), partial_.size());
  } catch (const ArgumentError&) {
    refuse_partial(map::Reason::BadField);
  }
  const map::Command& layout = *map::find_command(static_cast<std::uint8_t>(partial_[0]));
  const std::uint32_t halfwords = map::queue_halfwords(layout, static_cast<std::uint8_t>(partial_[0] >> 8));
  for (Queue* queue : {layout.to_geometry ? &geometry_ : nullptr, layout.to_feed ? &feed_ : nullptr}) {
    if (queue != nullptr) {
      queue->commands.push_back({decoded.command, halfwords});
      queue->used += halfwords;
    }
  }
  accepted_.push_back(decoded);
  partial_.clear();
  ++next_number_;
  ended_ = false;
}

void FakeCard::refuse_partial(map::Reason reason) {
  latch_refusal(reason, reg::kStream, static_cast<std::uint8_t>(partial_[0] >> 24));
  partial_.clear();
  stream_open_ = false;
  throw BusError(reg::kStream, Direction::kWrite, "refused by the card");
}

}  // namespace trammel::driver
