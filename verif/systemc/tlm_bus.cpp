#include "tlm_bus.hpp"

#include <cstring>
#include <vector>

#include "trammel/driver/errors.hpp"

namespace trammel::platform {

namespace {

constexpr unsigned kWord = 4;  // bytes
constexpr std::uint64_t kWindow = 4096;

// A payload that does not free its extension, whatever ends the transaction.
class Burst {
 public:
  Burst() { payload.set_extension(&end); }
  ~Burst() { payload.clear_extension(&end); }
  Burst(const Burst&) = delete;
  Burst& operator=(const Burst&) = delete;

  tlm::tlm_generic_payload payload;
  BurstEnd end;
};

// Whether `next` goes on a burst that began with `first` and has `count` words.
bool joins(const driver::Access& first, const driver::Access& next, std::size_t count, bool fixed) {
  return next.write == first.write && next.address == first.address + (fixed ? 0 : kWord * count);
}

}  // namespace

sc_core::sc_time to_sc(std::chrono::nanoseconds time) { return {static_cast<double>(time.count()), sc_core::SC_NS}; }

Host::Host(const sc_core::sc_module_name& name, Software software, const sc_core::sc_time& start,
           std::function<void()> finished)
    : sc_module(name), software_(std::move(software)), start_(start), finished_(std::move(finished)) {
  SC_HAS_PROCESS(Host);
  SC_THREAD(run);
  set_stack_size(8U << 20);  // a planner is on it
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
    while (begin + words < count && joins(accesses[begin], accesses[begin + words], words, fixed)) ++words;
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
  const tlm::tlm_response_status status = payload.get_response_status();
  const std::size_t made = status == tlm::TLM_OK_RESPONSE ? count : end.made;
  for (std::size_t i = 0; i < made; ++i) accesses[i].data = data[i];
  if (status == tlm::TLM_OK_RESPONSE || status == tlm::TLM_GENERIC_ERROR_RESPONSE) return made;
  throw driver::LinkError(end.failure.empty() ? "TLM target: " + payload.get_response_string() : end.failure);
}

void Host::transport(tlm::tlm_generic_payload& payload) {
  ++bursts_;
  sc_core::sc_time delay = keeper_.get_local_time();
  socket->b_transport(payload, delay);
  keeper_.set(delay);
  if (keeper_.need_sync()) keeper_.sync();
}

void Host::sleep(std::chrono::nanoseconds time) {
  keeper_.inc(to_sc(time));
  if (keeper_.need_sync()) keeper_.sync();
}

bool Host::wait_for_interrupt(std::chrono::nanoseconds longest) {
  synchronise();
  if (!irq.read()) wait(to_sc(longest), irq.posedge_event());
  return irq.read();
}

RegisterTarget::RegisterTarget(const sc_core::sc_module_name& name) : sc_module(name) {
  socket.register_b_transport(this, &RegisterTarget::b_transport);
}

void RegisterTarget::b_transport(tlm::tlm_generic_payload& payload, sc_core::sc_time& delay) {
  const std::size_t words = payload.get_data_length() / kWord;
  const bool fixed = payload.get_streaming_width() < payload.get_data_length();
  const std::uint64_t last = payload.get_address() + (fixed ? 0 : kWord * (words - 1));
  if (payload.get_byte_enable_ptr() != nullptr) return payload.set_response_status(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
  if (payload.is_write() == payload.is_read()) return payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
  if (words == 0 || payload.get_data_length() % kWord != 0 || payload.get_streaming_width() == 0 ||
      (fixed && payload.get_streaming_width() != kWord))
    return payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);
  if (payload.get_address() % kWord != 0 || last >= kWindow)
    return payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);

  std::vector<driver::Access> accesses(words);
  for (std::size_t i = 0; i < words; ++i) {
    accesses[i].address = static_cast<std::uint32_t>(payload.get_address() + (fixed ? 0 : kWord * i));
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

}  // namespace trammel::platform
