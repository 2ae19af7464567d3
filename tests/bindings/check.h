// Shared by the tests of trammel.h: checks, a count of the checks, and cards.
#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>
#include <string.h>

#include "trammel.h"

extern unsigned long checks_made;
extern unsigned long checks_failed;

#define CHECK(condition)                                                      \
  do {                                                                        \
    ++checks_made;                                                            \
    if (!(condition)) {                                                       \
      ++checks_failed;                                                        \
      fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
    }                                                                         \
  } while (0)

// A call that must succeed.
#define DONE(call) check_result((call), TRAMMEL_OK, "", __FILE__, __LINE__)
// A call that must fail with `result` and with `words` in the error text.
#define FAILS(call, result, words) check_result((call), (result), (words), __FILE__, __LINE__)

void check_result(trammel_result is, trammel_result wanted, const char* words, const char* file, int line);

// A simulated card of 4 axes and 1 MHz.
trammel_card* simulated_card(void);

trammel_command line_of(uint64_t ticks, int64_t x, int64_t y);
// A feed piece with one tick every 16 clocks.
trammel_command feed_of(uint64_t ticks);
trammel_command command_of(int32_t kind);

void test_cards(void);
void test_errors(void);
void test_guards(void);
void test_inputs(void);
void test_machine(void);
void test_place(void);
void test_positions(void);
void test_pwm(void);
void test_stream(void);

#endif
