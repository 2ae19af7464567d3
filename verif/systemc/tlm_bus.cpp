#include "tlm_bus.hpp"

#include <algorithm>
#include <cstring>
#include <vector>

#include "trammel/driver/errors.hpp"

namespace trammel::platform {

namespace {

constexpr unsigned kWord = 4;  // bytes
constexpr std::uint64_t kWindow = 4096;

// A payload that never frees its extension, however the transaction ends.
class Burst {
 public:
  Burst() { payload.set_extension(&end); }
  ~Burst() { payload.clear_extension(&end); }
  Burst(const Burst&) = delete;
  Burst& operator=(const Burst&) = delete;

  tlm::tlm_generic_payload payload;
  BurstEnd end;
};

// True if `next` continues a burst that began with `first` and has `count` words.
bool joins(const driver::Access& first, const driver::Access& next, std::size_t count, bool fixed) {
  return next.write == first.write && next.address == first.address + (fixed ? 0 : kWord * count);
}

}  // namespace

sc_core::sc_time to_sc(std::chrono::nanoseconds time, const sc_core::sc_time& now) {
  const sc_core::sc_time most = sc_core::sc_max_time() - now;
  const auto wanted = std::max(0.0, static_cast<double>(time.count()));
  return wanted < most / sc_core::sc_time(1, sc_core::SC_NS) ? sc_core::sc_time(wanted, sc_core::SC_NS) : most;
}

Host::Host(const sc_core::sc_module_name& name, Software software, const sc_core::sc_time& start,
           std::function<void()> finished)
    : sc_module(name), software_(std::move(software)), start_(start), finished_(std::move(finished)) {
  SC_HAS_PROCESS(Host);
  SC_THREAD(run);
  set_stack_size(8U << 20);  // large enough for a planner
}

void Host::run() {
  wait(start_);
  keeper_.reset();
  try {
    software_(*this);
    synchronise();
  } catch (const sc_core::sc_unwind_exception&) {
    throw;  // SystemC ends the thread
  } catch (...) {
    failure_ = std::current_exception();
  }
  done_ = true;
  finished_();
}

std::size_t Host::transfer(driver::Access* accesses, std::size_t count) {
  for (std::size_t begin = 0; begin < count;) {
    const bool fixed = begin + 1 < count && accesses[begin + 1].address == accesses[begin].address;
    std::size_t words = 1;
    while (counts_words_ && begin + words < count && joins(accesses[begin], accesses[begin + words], words, fixed))
      ++words;
    const std::size_t made = burst(accesses + begin, words);
    if (made != words) return begin + made;
    begin += words;
  }
  return count;
}

std::size_t Host::burst(driver::Access* accesses, std::size_t count) {
  std::vector<std::uint32_t> data(count);
  for (std::size_t i = 0; i < count; ++i) data[i] = accesses[i].data;
  Burst burst;
  tlm::tlm_generic_payload& payload = burst.payload;
  const BurstEnd& end = burst.end;
  const bool fixed = count > 1 && accesses[1].address == accesses[0].address;
  payload.set_command(accesses[0].write ? tlm::TLM_WRITE_COMMAND : tlm::TLM_READ_COMMAND);
  payload.set_address(accesses[0].address);
  payload.set_data_ptr(reinterpret_cast<unsigned char*>(data.data()));
  payload.set_data_length(static_cast<unsigned>(kWord * count));
  payload.set_streaming_width(static_cast<unsigned>(kWord * (fixed ? 1 : count)));
  transport(payload);
  const std::size_t made = words_made(payload, end);
  for (std::size_t i = 0; i < made; ++i) accesses[i].data = data[i];
  return made;
}

std::size_t Host::words_made(const tlm::tlm_generic_payload& payload, const BurstEnd& end) {
  const std::size_t count = payload.get_data_length() / kWord;
  counts_words_ = end.made.has_value();
  if (payload.is_response_ok()) return count;
  if (payload.get_response_status() != tlm::TLM_GENERIC_ERROR_RESPONSE)
    throw driver::LinkError(end.failure.empty() ? "TLM target: " + payload.get_response_string() : end.failure);
  if (count == 1) return 0;
  if (!end.made || *end.made >= count)
    throw driver::LinkError("TLM target: a burst was refused, and BurstEnd does not say at which word");
  return *end.made;
}

void Host::transport(tlm::tlm_generic_payload& payload) {
  ++bursts_;
  sc_core::sc_time delay = keeper_.get_local_time();
  socket->b_transport(payload, delay);
  keeper_.set(delay);
  if (keeper_.need_sync()) keeper_.sync();
}

void Host::sleep(std::chrono::nanoseconds time) {
  keeper_.inc(to_sc(time, keeper_.get_current_time()));
  if (keeper_.need_sync()) keeper_.sync();
}

bool Host::wait_for_interrupt(std::chrono::nanoseconds longest) {
  synchronise();
  if (!irq.read()) wait(to_sc(longest), irq.posedge_event());
  return irq.read();
}

RegisterTarget::RegisterTarget(const sc_core::sc_module_name& name) : sc_module(name) {
  socket.register_b_transport(this, &RegisterTarget::b_transport);
  socket.register_transport_dbg(this, &RegisterTarget::transport_dbg);
}

void RegisterTarget::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  const std::size_t words = payload.get_data_length() / kWord;
  const bool fixed = payload.get_streaming_width() < payload.get_data_length();
  const std::uint64_t address = payload.get_address();
  if (payload.get_byte_enable_ptr() != nullptr) return payload.set_response_status(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
  if (payload.is_write() == payload.is_read()) return payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
  if (words == 0 || payload.get_data_length() % kWord != 0 || payload.get_streaming_width() == 0 ||
      (fixed && payload.get_streaming_width() != kWord))
    return payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);
  if (address % kWord != 0 || address >= kWindow || (!fixed && words > (kWindow - address) / kWord))
    return payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);

  std::vector<driver::Access> accesses(words);
  for (std::size_t i = 0; i < words; ++i) {
    accesses[i].address = static_cast<std::uint32_t>(address + (fixed ? 0 : kWord * i));
    accesses[i].write = payload.is_write();
    std::memcpy(&accesses[i].data, payload.get_data_ptr() + kWord * i, kWord);
  }
  BurstEnd* const end = payload.get_extension<BurstEnd>();
  std::size_t made = 0;
  try {
    made = transfer(accesses.data(), words, delay);
  } catch (const driver::LinkError& error) {
    if (end != nullptr) end->failure = error.what();
    return payload.set_response_status(tlm::TLM_INCOMPLETE_RESPONSE);
  }
  if (end != nullptr) end->made = made;
  for (std::size_t i = 0; payload.is_read() && i < made; ++i)
    std::memcpy(payload.get_data_ptr() + kWord * i, &accesses[i].data, kWord);
  payload.set_response_status(made == words ? tlm::TLM_OK_RESPONSE : tlm::TLM_GENERIC_ERROR_RESPONSE);
}

unsigned RegisterTarget::transport_dbg(tlm::tlm_generic_payload& payload) {
  const std::uint64_t address = payload.get_address();
  if (!payload.is_read() || address >= kWindow) return 0;
  const std::uint64_t end = std::min<std::uint64_t>(kWindow, address + payload.get_data_length());
  const std::uint64_t first = address / kWord * kWord;
  std::vector<driver::Access> reads;
  for (std::uint64_t at = first; at < end; at += kWord)
    reads.push_back(driver::read_of(static_cast<std::uint32_t>(at)));
  reads.resize(peek(reads.data(), reads.size()));
  std::vector<std::uint32_t> words;
  for (const driver::Access& read : reads) words.push_back(read.data);
  const std::uint64_t known = std::min<std::uint64_t>(end, first + kWord * words.size());
  if (known <= address) return 0;
  std::memcpy(payload.get_data_ptr(), reinterpret_cast<const unsigned char*>(words.data()) + (address - first),
              known - address);
  return static_cast<unsigned>(known - address);
}

}  // namespace trammel::platform
