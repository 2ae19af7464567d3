// SPDX-License-Identifier: GPL-2.0-only
#include "stub_hal.h"

#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

extern "C" {
#include "hal.h"
#include "rtapi.h"
}

namespace stub {
namespace {

using Function = void (*)(void*, long);

struct Memory {
  std::map<std::string, void*> places;
  std::map<std::string, Function> functions;
  std::deque<double> values;  // values of the pins: eight bytes each; a deque does not move them
  std::vector<std::unique_ptr<char[]>> blocks;
  std::string printed, told;
};

Memory& memory() {
  static Memory kept;
  return kept;
}

void* find(const char* name) {
  const auto found = memory().places.find(name);
  if (found != memory().places.end()) return found->second;
  std::fprintf(stderr, "the component has no %s\n", name);
  std::abort();
}

std::string text_of(const char* format, va_list arguments) {
  char text[512];
  std::vsnprintf(text, sizeof text, format, arguments);
  return text;
}

}  // namespace

long long now = 1'000'000'000;

bool& bit(const char* name) { return *static_cast<bool*>(find(name)); }
double& real(const char* name) { return *static_cast<double*>(find(name)); }
std::uint32_t& u32(const char* name) { return *static_cast<std::uint32_t*>(find(name)); }
std::int32_t& s32(const char* name) { return *static_cast<std::int32_t*>(find(name)); }
void call(const char* function, long period) { memory().functions.at(function)(nullptr, period); }

const char* messages() {
  memory().told = memory().printed;
  memory().printed.clear();
  return memory().told.c_str();
}

void clear() { memory() = Memory{}; }

}  // namespace stub

using stub::memory;

#define STUB_PIN(type, name)                                                             \
  int hal_pin_##name##_newf(hal_pin_dir_t, type** place, int, const char* format, ...) { \
    va_list arguments;                                                                   \
    va_start(arguments, format);                                                         \
    memory().values.push_back(0);                                                        \
    void* const value = &memory().values.back();                                         \
    *place = static_cast<type*>(value);                                                  \
    memory().places[stub::text_of(format, arguments)] = value;                           \
    va_end(arguments);                                                                   \
    return 0;                                                                            \
  }
#define STUB_PARAMETER(type, name)                                                                             \
  int hal_param_##name##_newf(hal_param_dir_t, type* place, int, const char* format, ...) {                    \
    va_list arguments;                                                                                         \
    va_start(arguments, format);                                                                               \
    memory().places[stub::text_of(format, arguments)] = const_cast<void*>(static_cast<volatile void*>(place)); \
    va_end(arguments);                                                                                         \
    return 0;                                                                                                  \
  }

extern "C" {

STUB_PIN(hal_bit_t, bit)
STUB_PIN(hal_float_t, float)
STUB_PIN(hal_u32_t, u32)
STUB_PIN(hal_s32_t, s32)
STUB_PARAMETER(hal_bit_t, bit)
STUB_PARAMETER(hal_float_t, float)
STUB_PARAMETER(hal_u32_t, u32)

void* hal_malloc(long int size) {
  memory().blocks.push_back(std::make_unique<char[]>(static_cast<std::size_t>(size)));
  return memory().blocks.back().get();
}

int hal_export_funct(const char* name, void (*function)(void*, long), void*, int, int, int) {
  memory().functions[name] = function;
  return 0;
}

int hal_init(const char*) { return 1; }
int hal_ready(int) { return 0; }
int hal_exit(int) { return 0; }
long long int rtapi_get_time(void) { return stub::now; }

void rtapi_print_msg(msg_level_t, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  memory().printed += stub::text_of(format, arguments);
  va_end(arguments);
}
}
