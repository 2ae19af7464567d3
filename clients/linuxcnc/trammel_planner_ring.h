/* SPDX-License-Identifier: 0BSD
 *
 * The planner module's end of the shared memory (trammel/linuxcnc/shared_region.h): attaches it, fills the ring of
 * path operations, reads the owner's status. Uses no types of LinuxCNC. All functions except ring_attach() neither
 * wait nor allocate, and make no system call except FUTEX_WAKE. One thread.
 */
#ifndef TRAMMEL_PLANNER_RING_H
#define TRAMMEL_PLANNER_RING_H

#include <errno.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "trammel/linuxcnc/shared_region.h"

struct ring {
  struct trammel_region* region;
  uint64_t head;                /* operations published */
  uint64_t written;             /* operations filled; those from `head` on are not published yet */
  struct trammel_status status; /* last consistent copy */
  uint32_t stale;               /* number of failed copies */
};

static int ring_is_locked(int file, int byte) {
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = byte, .l_len = 1};
  return fcntl(file, F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

/* The file outlives its owner. If an owner of another version has left it and no process uses it, it is cleared.
   Returns 0 or -EPROTO. `other`: the lock of the other module. */
static int ring_check_version(struct trammel_region* region, int file, int other) {
  if (region->version_owner == 0 || region->version_owner == TRAMMEL_REGION_VERSION) return 0;
  if (ring_is_locked(file, TRAMMEL_LOCK_OWNER) || ring_is_locked(file, other)) return -EPROTO;
  memset(region, 0, sizeof *region);
  return 0;
}

/* Explains an error of attaching. */
static const char* ring_text_of(int error) {
  return error == -EBUSY    ? "another LinuxCNC has it: end that one, or choose another name for each"
         : error == -EPROTO ? "`trammel linuxcnc` is of another version: install both from one package"
         : error == -EINVAL ? "the name has a slash"
         : error == -EACCES
             ? "it belongs to another user: run `trammel linuxcnc` as the user of LinuxCNC. A file that is "
               "left of another user may be deleted when both have ended"
             : strerror(-error);
}

/* Creates the region if it does not exist, as the user who runs LinuxCNC. Returns 0 or -errno; -EBUSY: another planner
   module uses it; -EPROTO: its owner uses another layout. The descriptor stays open because it holds the lock. */
static int ring_attach(struct ring* ring, const char* name) {
  char path[128];
  struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = TRAMMEL_LOCK_PLANNER, .l_len = 1};
  struct stat found;
  struct trammel_region* region;
  int fd;
  if (snprintf(path, sizeof path, "%s/%s%s", TRAMMEL_REGION_FOLDER, TRAMMEL_REGION_PREFIX, name) >= (int)sizeof path) {
    return -ENAMETOOLONG;
  }
  fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (fd < 0) return -errno;
  if (fstat(fd, &found) != 0) return -errno;
  if (fcntl(fd, F_OFD_SETLK, &lock) != 0) return -EBUSY;
  if (found.st_size < (off_t)sizeof *region && ftruncate(fd, sizeof *region) != 0) return -errno;
  region = mmap(NULL, sizeof *region, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, fd, 0);
  if (region == MAP_FAILED) return -errno;
  if (ring_check_version(region, fd, TRAMMEL_LOCK_HAL) != 0) return -EPROTO;
  region->version_planner = TRAMMEL_REGION_VERSION;
  ring->region = region;
  ring->head = ring->written = __atomic_load_n(&region->operation_head, __ATOMIC_RELAXED);
  return 0;
}

static void ring_wake(struct ring* ring) {
  __atomic_add_fetch(&ring->region->wake, 1, __ATOMIC_RELEASE);
  syscall(SYS_futex, &ring->region->wake, FUTEX_WAKE, 1, NULL, NULL, 0);
}

static uint64_t ring_free(const struct ring* ring) {
  return TRAMMEL_OPERATIONS - (ring->written - __atomic_load_n(&ring->region->operation_tail, __ATOMIC_ACQUIRE));
}

/* The next slot, zeroed; NULL if the ring is full. ring_fill() counts it as filled. */
static struct trammel_operation* ring_slot(struct ring* ring, uint32_t kind) {
  struct trammel_operation* operation = &ring->region->operations[ring->written % TRAMMEL_OPERATIONS];
  if (ring_free(ring) == 0) return NULL;
  memset(operation, 0, sizeof *operation);
  operation->kind = kind;
  return operation;
}

static void ring_fill(struct ring* ring) { ++ring->written; }

static struct trammel_operation* ring_next(struct ring* ring) {
  return &ring->region->operations[ring->head % TRAMMEL_OPERATIONS];
}

static void ring_publish_one(struct ring* ring) {
  __atomic_store_n(&ring->region->operation_head, ++ring->head, __ATOMIC_RELEASE);
}

/* Reads the owner's status. Returns 0, or -1 and keeps the last consistent copy if the owner is writing it. */
static int ring_read_status(struct ring* ring) {
  const struct trammel_region* region = ring->region;
  struct trammel_status copy;
  int tries;
  for (tries = 0; tries < TRAMMEL_TRIES; ++tries) {
    const uint32_t before = __atomic_load_n(&region->status_sequence, __ATOMIC_ACQUIRE);
    if (before & 1) continue;
    memcpy(&copy, &region->status, sizeof copy);
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    if (before != __atomic_load_n(&region->status_sequence, __ATOMIC_RELAXED)) continue;
    ring->status = copy;
    return 0;
  }
  ++ring->stale;
  return -1;
}

static void ring_write_scales(struct ring* ring, double feed, double rapid) {
  struct trammel_region* region = ring->region;
  __atomic_store_n(&region->path_settings_sequence, region->path_settings_sequence + 1, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  ++region->path_settings.beat;
  region->path_settings.feed_scale = feed;
  region->path_settings.rapid_scale = rapid;
  __atomic_store_n(&region->path_settings_sequence, region->path_settings_sequence + 1, __ATOMIC_RELEASE);
}

#endif
