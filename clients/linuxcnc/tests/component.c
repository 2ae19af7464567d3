/* SPDX-License-Identifier: GPL-2.0-only
 *
 * The component, with a setter for its module parameters.
 */
#include "../trammel.c"

void set_module_parameters(const char* memory_name, int number) {
  name = (char*)memory_name;
  joints = number;
}
