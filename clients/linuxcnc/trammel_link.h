/* SPDX-License-Identifier: GPL-2.0-only
 *
 * The component's end of the shared memory (trammel/linuxcnc/shared_region.h): attaches it, fills the ring of periods,
 * writes the settings. The planner module's header has the functions that both need: reading the status, waking the
 * owner. All functions except link_attach() neither wait nor allocate, and make no system call except FUTEX_WAKE. One
 * thread.
 */
#ifndef TRAMMEL_LINK_H
#define TRAMMEL_LINK_H

#include "trammel_planner_ring.h"

struct link {
  struct ring ring; /* the region and the status; its operations belong to the planner module */
  int file;         /* open descriptor: holds the lock */
  uint64_t number;  /* number of the last period; dropped periods count */
  uint64_t head;
  int64_t times[TRAMMEL_PERIODS]; /* start times of the last periods, by number */
  struct trammel_settings settings;
};

static int link_path(char* path, size_t size, const char* name) {
  const int length = snprintf(path, size, "%s/%s%s", TRAMMEL_REGION_FOLDER, TRAMMEL_REGION_PREFIX, name);
  if (strchr(name, '/') != NULL) return -EINVAL;
  return length < (int)size ? 0 : -ENAMETOOLONG;
}

/* Creates the region if it does not exist. Returns 0 or -errno; -EBUSY: another component uses it; -EPROTO: its owner
   uses another layout. */
static int link_attach(struct link* link, const char* name) {
  char path[128];
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = TRAMMEL_LOCK_HAL, .l_len = 1};
  struct stat found;
  struct trammel_region* region;
  int fd, error = link_path(path, sizeof path, name);
  if (error != 0) return error;
  fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (fd < 0) return -errno;
  error = fstat(fd, &found) != 0                      ? -errno
          : fcntl(fd, F_OFD_SETLK, &lock) != 0        ? -EBUSY
          : found.st_size >= (off_t)sizeof *region    ? 0
          : ftruncate(fd, (off_t)sizeof *region) != 0 ? -errno
                                                      : 0;
  if (error != 0) {
    close(fd);
    return error;
  }
  region = mmap(NULL, sizeof *region, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, fd, 0);
  if (region == MAP_FAILED) {
    error = -errno;
    close(fd);
    return error;
  }
  if (ring_check_version(region, fd, TRAMMEL_LOCK_PLANNER) != 0) {
    munmap(region, sizeof *region);
    close(fd);
    return -EPROTO;
  }
  region->version_hal = TRAMMEL_REGION_VERSION;
  link->file = fd;
  link->ring.region = region;
  link->head = __atomic_load_n(&region->period_head, __ATOMIC_RELAXED);
  return 0;
}

static void link_detach(struct link* link) {
  if (link->ring.region == NULL) return;
  munmap(link->ring.region, sizeof *link->ring.region);
  close(link->file);
  link->ring.region = NULL;
}

/* Whether the owner has attached with this layout. */
static int link_has_owner(const struct link* link) {
  return __atomic_load_n(&link->ring.region->version_owner, __ATOMIC_RELAXED) == TRAMMEL_REGION_VERSION;
}

/* The slot of the next period; NULL if the owner has not read the old periods. The number increases in both cases. */
static struct trammel_period* link_period(struct link* link, int64_t time) {
  struct trammel_region* const region = link->ring.region;
  struct trammel_period* period = &region->periods[link->head % TRAMMEL_PERIODS];
  ++link->number;
  link->times[link->number % TRAMMEL_PERIODS] = time;
  if (link->head - __atomic_load_n(&region->period_tail, __ATOMIC_ACQUIRE) >= TRAMMEL_PERIODS) return NULL;
  memset(period, 0, sizeof *period);
  period->number = link->number;
  period->time = time;
  return period;
}

static void link_publish(struct link* link) {
  __atomic_store_n(&link->ring.region->period_head, ++link->head, __ATOMIC_RELEASE);
}

/* Longest time in seconds from a period's start until the card reaches its targets: the age of the newest period that
   the card had when the status was read, plus that period, plus the periods queued before it. 0: unknown. */
static double link_latency(const struct link* link, double period) {
  const struct trammel_status* status = &link->ring.status;
  int64_t age;
  if (status->last_period == 0 || link->number - status->last_period >= TRAMMEL_PERIODS) return 0;
  age = status->time - link->times[status->last_period % TRAMMEL_PERIODS];
  return (double)age * 1e-9 + period * (1.0 + (double)status->ahead);
}

static void link_write_settings(struct link* link, const struct trammel_settings* settings) {
  struct trammel_region* const region = link->ring.region;
  if (memcmp(settings, &link->settings, sizeof *settings) == 0) return;
  link->settings = *settings;
  __atomic_store_n(&region->settings_sequence, region->settings_sequence + 1, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  region->settings = *settings;
  __atomic_store_n(&region->settings_sequence, region->settings_sequence + 1, __ATOMIC_RELEASE);
}

#endif
