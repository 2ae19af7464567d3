// SPDX-License-Identifier: GPL-2.0-only
//
// LinuxCNC's HAL as far as the component `trammel` uses it, in the test's own process: pins and parameters by name,
// functions called by the test, time set by it.
#pragma once

#include <cstdint>

extern "C" {
int rtapi_app_main(void);
void rtapi_app_exit(void);
void set_module_parameters(const char* name, int joints);  // of trammel.c
}

namespace stub {

bool& bit(const char* name);
double& real(const char* name);
std::uint32_t& u32(const char* name);
std::int32_t& s32(const char* name);
void call(const char* function, long period);  // of the thread
extern long long now;                          // ns
const char* messages();                        // printed since the last call
void clear();                                  // forgets all pins: before the component is loaded again

}  // namespace stub
