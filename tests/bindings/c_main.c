#include "check.h"

unsigned long checks_made = 0;
unsigned long checks_failed = 0;

void check_result(trammel_result is, trammel_result wanted, const char* words, const char* file, int line) {
  const trammel_error* error = trammel_last_error();
  int right = is == wanted;
  if (right && is != TRAMMEL_OK) right = error->result == is && strstr(error->text, words) != NULL;
  ++checks_made;
  if (right) return;
  ++checks_failed;
  fprintf(stderr, "%s:%d: %s, not %s \"%s\": %s\n", file, line, trammel_result_name(is), trammel_result_name(wanted),
          words, is == TRAMMEL_OK ? "" : error->text);
}

trammel_card* simulated_card(void) {
  trammel_card* card = NULL;
  DONE(trammel_open("sim:", &card));
  return card;
}

trammel_command command_of(int32_t kind) {
  trammel_command command;
  memset(&command, 0, sizeof command);
  command.kind = kind;
  return command;
}

trammel_command line_of(uint64_t ticks, int64_t x, int64_t y) {
  trammel_command command = command_of(TRAMMEL_LINE);
  command.as.line.ticks = ticks;
  command.as.line.pulses[0] = x;
  command.as.line.pulses[1] = y;
  return command;
}

trammel_command feed_of(uint64_t ticks) {
  trammel_command command = command_of(TRAMMEL_FEED);
  command.as.feed.ticks = ticks;
  command.as.feed.rate = (uint64_t)1 << 60;
  command.as.feed.floor = 1;
  return command;
}

int main(void) {
  test_cards();
  test_stream();
  test_positions();
  test_place();
  test_inputs();
  test_guards();
  test_machine();
  test_pwm();
  test_errors();
  printf("%lu checks of trammel.h, %lu failed\n", checks_made, checks_failed);
  return checks_failed == 0 ? 0 : 1;
}
