// SPDX-License-Identifier: GPL-2.0-only
//
// The part of LinuxCNC's HAL that the component `trammel` uses, inside the test's process: pins and parameters by name;
// the test calls the functions and sets the time.
#pragma once

#include <cstdint>

extern "C" {
int rtapi_app_main(void);
void rtapi_app_exit(void);
void set_module_parameters(const char* name, int joints);  // module parameters of trammel.c
}

namespace stub {

bool& bit(const char* name);
double& real(const char* name);
std::uint32_t& u32(const char* name);
std::int32_t& s32(const char* name);
void call(const char* function, long period);  // calls a function as HAL's thread does
extern long long now;                          // ns
const char* messages();                        // messages printed since the last call
void clear();                                  // removes all pins, before the component is loaded again

}  // namespace stub
