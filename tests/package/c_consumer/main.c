// A line on the simulated card; fails if it does not arrive.
#include <stdio.h>
#include <trammel.h>

int main(void) {
  const trammel_one_shot line = {.pulses = {20, 40}, .duration_ns = 1000000};
  trammel_card* card = NULL;
  trammel_snapshot snapshot = {0};
  trammel_result result = trammel_open("sim:", &card);
  if (result == TRAMMEL_OK) result = trammel_run_line(card, &line, 1000000000, NULL);
  if (result == TRAMMEL_OK) result = trammel_read_snapshot(card, &snapshot);
  trammel_close(card);
  if (result != TRAMMEL_OK) {
    fprintf(stderr, "%s: %s\n", trammel_result_name(result), trammel_last_error()->text);
    return 1;
  }
  printf("x %ld, y %ld\n", (long)snapshot.position[0], (long)snapshot.position[1]);
  return snapshot.position[0] == 20 && snapshot.position[1] == 40 ? 0 : 1;
}
