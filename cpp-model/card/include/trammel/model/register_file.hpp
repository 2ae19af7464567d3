// Golden model of the register file: the register map as a plain table of values, with the latencies of
// docs/developer/architecture.md. Cycle-exact at every port. One instance for each card; not thread-safe.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "trammel/card_map.hpp"
#include "trammel/model/buses.hpp"
#include "trammel/model/capture_fifo.hpp"
#include "trammel/model/link_watch.hpp"
#include "trammel/model/snapshot_writer.hpp"

namespace trammel::model {

class RegisterFile {
 public:
  static constexpr std::size_t kMaxPorts = 4;

  // Masks of engines: those of every card, those of the default card, and all engines.
  static constexpr std::uint32_t kMinEngines = card_map::engines::kLines | card_map::engines::kJerk;
  static constexpr std::uint32_t kDefaultEngines = kMinEngines | card_map::engines::kAccumulator |
                                                   card_map::engines::kDirectMode | card_map::engines::kUnderrunHold |
                                                   card_map::engines::kPathCommands | card_map::engines::kStreaming |
                                                   card_map::engines::kClasses | card_map::engines::kWatermarks;
  static constexpr std::uint32_t kMaxEngines = kDefaultEngines | card_map::engines::kArcGenerator |
                                               card_map::engines::kAccumulator8 | card_map::engines::kMachineInputs |
                                               card_map::engines::kCaptures | card_map::engines::kSoftLimits |
                                               card_map::engines::kEmergencyStop | card_map::engines::kEnables |
                                               card_map::engines::kCaptureFifo | card_map::engines::kPwm;

  struct Config {
    std::uint32_t axes = 4;               // 1 .. 8
    std::uint32_t geometry_depth = 4096;  // halfwords
    std::uint32_t feed_depth = 2560;      // halfwords
    std::uint32_t clock_hz = 100'000'000;
    std::uint32_t engines = kDefaultEngines;
    std::uint32_t build_id = 0;
    bool build_dirty = false;
    std::uint32_t board_id = 0;
    std::uint32_t ports = 1;   // 1 .. 4
    std::uint32_t inputs = 4;  // 1 .. 32; only for cards with path commands
    std::uint32_t outputs = 4;
    std::uint32_t captures = 4;    // units; only for cards with captures
    std::uint32_t idle_level = 0;  // {second pins, first pins}, a bit per axis each
  };

  struct Inputs {
    // the access; `request` is high for one clock, and comes again at the earliest in the clock after `ack`
    bool request = false;
    bool write = false;
    bool partial = false;
    std::uint8_t port = 0;
    std::uint32_t address = 0;  // byte address, 12 bits
    std::uint32_t data = 0;
    bool of_session = true;  // as in PortArbiter::Access
    bool new_session = false;
    // the card's state
    bool busy = false;
    bool direct = false;
    bool path_active = false;
    bool feed_active = false;
    bool ended = false;
    bool stopping = false;
    bool underrun = false;  // an under-run hold is active, or a piece waits for more commands
    std::uint32_t underruns = 0;
    bool stale = false;  // a line continues beyond its period
    std::uint32_t stale_ticks = 0;
    std::uint32_t limit_state = 0;
    std::uint32_t place = 0;
    bool button_hold = false;
    bool enabled = false;             // the drives are enabled
    bool enable_waits = false;        // motion waits for the drives
    bool incomplete = false;          // the stream is inside a command
    std::uint16_t geometry_room = 0;  // halfwords
    std::uint16_t feed_room = 0;
    bool geometry_low = false;  // the queue is below its watermark
    bool probed = false;
    bool probe_missed = false;
    bool waiting = false;  // the card waits for an input
    bool feed_low = false;
    std::uint32_t geometry_begun = 0;
    std::uint32_t feed_begun = 0;
    std::uint32_t rate = 0;   // 2^-32 feed ticks an enabled clock
    std::uint32_t ratio = 0;  // 2^-16, 17 bits
    std::array<std::uint32_t, card_map::kMaxAxes> position{};
    std::uint32_t fault = 0;       // the value of FAULT
    bool settled = false;          // nothing moves, and no tick is on its way
    std::uint64_t ticks_left = 0;  // ticks left of the path under way
    bool stop = false;             // event, requests a snapshot: the first cause of a stop
    bool rest = false;             // event, requests a snapshot: the end of a stop
    bool probe = false;            // event, requests a snapshot: the probe's edge
    bool mark = false;             // event, requests a snapshot: a MARK
    std::uint8_t captures = 0;     // levels: the capture units that request a snapshot
    std::uint8_t passed = 0;       // levels: the capture units that hand a capture on to the queue
    std::uint8_t edges = 0;        // bit per unit: its edge led to the active level
    std::uint32_t capture_state = 0;
    std::uint32_t inputs = 0;
    std::uint32_t raw_inputs = 0;
    InputRoles roles;
    std::uint16_t outputs = 0;
    std::uint32_t marks = 0;
    // the command checker
    bool checker_ready = true;
    bool checker_refuse = false;
    std::uint8_t checker_reason = 0;
    std::uint8_t checker_number = 0;
    // the direct loader
    bool start_done = false;
    bool start_error = false;
    std::uint8_t start_reason = 0;
    std::uint16_t loader_address = 0;  // words, 10 bits
  };

  // Events and `setting.set` are high in the clock of `ack`; `flush` is high one clock earlier (never with `abort`).
  struct Outputs {
    bool ack = false;
    bool error = false;
    std::uint32_t data = 0;
    Setting setting;  // address and data are valid with `set`
    std::uint32_t clear_fault = 0;
    bool irq = false;
    bool stream_write = false;
    std::uint32_t stream_word = 0;
    bool abort = false;
    bool probe_clear = false;
    bool flush = false;
    bool start = false;
    std::uint8_t start_mask = 0;
    bool loader_valid = false;  // not a port: `loader_data` answers the loader; otherwise it is undefined
    std::uint32_t loader_data = 0;
    bool strobe = false;  // the snapshot takes the inputs of this clock
  };
  enum class Stage { Idle, Decode, Wait, Act, Respond, Sent, Judge, Load };
  using Values = std::array<std::uint32_t, card_map::kMaxAxes + 8>;  // an area, by words
  struct LoaderRead {
    bool valid = false;
    std::uint32_t data = 0;
  };
  // All that the next clock() depends on besides its inputs.
  struct State {
    Outputs out;
    std::uint64_t time = 0;
    // The access under way.
    Stage stage = Stage::Idle;
    bool write = false;
    bool partial = false;
    std::uint8_t port = 0;
    std::uint32_t address = 0;
    bool of_session = true;
    bool new_session = false;
    std::uint32_t word = 0;  // last word written
    card_map::Slot slot{nullptr, 0};
    card_map::Reason reason = card_map::Reason::None;
    std::uint32_t answer = 0;
    bool word_refused = false;      // the checker has refused the word
    std::uint8_t stream_owner = 0;  // port of the command under way
    bool snapshot_asked = false;    // CONTROL requests a snapshot in this clock
    std::array<std::uint32_t, card_map::kWindowBytes / 4>
        stored{};  // all that can be read back: constants, settings, latched values
    std::uint32_t irq_enable = 0;
    SnapshotWriter snapshot{1};
    LinkWatch link{};
    Values latched{};
    CaptureFifo queue{};
    std::array<std::uint32_t, kMaxPorts> refusal{};  // by port, as the register reads; a reason is never 0
    bool loading = false;
    LoaderRead loader_read;
  };

  explicit RegisterFile(const Config& config);

  // Back to the state in reset.
  void reset();

  // One rising edge with reset low.
  void clock(const Inputs& in);

  const Outputs& outputs() const { return state_.out; }
  // True if a unit of LINK_TIMEOUT passes in the clock `time`. The card sees its clock counter two clocks late.
  static bool link_unit(std::uint64_t time) {
    return ((time - 2) >> LinkWatch::kUnitBits & 1) != ((time - 3) >> LinkWatch::kUnitBits & 1);
  }
  const LinkWatch& link() const { return state_.link; }
  const State& state() const { return state_; }
  State& state() { return state_; }

  // STATUS with these inputs, as the interrupt and lockstep see it: `refused` means a refusal on any port.
  std::uint32_t status(const Inputs& in) const;
  // The capture units that learn in this clock that their snapshot is taken.
  std::uint8_t captured(std::uint8_t captures) const { return state_.snapshot.captured(captures); }
  // The capture units that learn in this clock that their capture is in the queue, or lost.
  std::uint8_t queued(std::uint8_t passed) const { return CaptureFifo::queued(passed); }
  // The level of `irq` one clock later.
  bool interrupt(const Inputs& in) const;

  // True while the registers are filled after a reset. No snapshot can be taken then.
  bool filling() const;

  // Clocks since reset.
  std::uint64_t time() const { return state_.time; }

 private:
  void clear_events();
  std::uint32_t status_for(const Inputs& in, bool refused) const;
  std::uint32_t live(const Inputs& in) const;
  card_map::Reason judge(const Inputs& in) const;
  card_map::Reason judge_write(const Inputs& in) const;
  void step_access(const Inputs& in);
  void begin(const Inputs& in);
  void act(const Inputs& in);
  void take_effect();
  void finish(bool error, std::uint32_t data = 0);
  void refuse(std::uint8_t reason, std::uint8_t number = 0);
  void step_snapshot(const Inputs& in, bool host);
  std::size_t written_at(std::uint32_t word) const;
  void take_values(const Inputs& in);
  void step_queue(const Inputs& in, const Setting& setting);
  std::uint32_t read(std::uint32_t address) const;
  void step_link();
  void step_loader(const Inputs& in);
  void refuse_checked(const Inputs& in);
  std::uint32_t& stored(std::uint32_t address) { return state_.stored[address / 4]; }
  std::uint32_t stored(std::uint32_t address) const { return state_.stored[address / 4]; }

  Config config_;

  State state_;
};

}  // namespace trammel::model
