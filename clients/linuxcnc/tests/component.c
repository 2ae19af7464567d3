/* SPDX-License-Identifier: GPL-2.0-only
 * The component, with its module parameters within the test's reach.
 */
#include "../trammel.c"

void set_module_parameters(const char* memory_name, int number) {
  name = (char*)memory_name;
  joints = number;
}
