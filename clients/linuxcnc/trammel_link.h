/* SPDX-License-Identifier: GPL-2.0-only
 *
 * The HAL component's end of the memory that it shares with `trammel linuxcnc`. attach() and detach() run when the
 * module is loaded and unloaded; all else runs in the realtime thread and never waits. */
#ifndef TRAMMEL_LINK_H
#define TRAMMEL_LINK_H

#include <errno.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "trammel/linuxcnc/shared_region.h"

struct link {
  struct trammel_region* region;
  int file;
  uint64_t head;                /* of the periods, our own count */
  struct trammel_status status; /* the last copy that succeeded */
  uint32_t settings_sequence;
  struct trammel_settings settings; /* as the owner has them */
};

static int link_lock(struct link* link, int command, int byte) {
  struct flock lock;
  memset(&lock, 0, sizeof lock);
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = byte;
  lock.l_len = 1;
  if (fcntl(link->file, command, &lock) != 0) return -1;
  return command == F_OFD_GETLK && lock.l_type != F_UNLCK ? 1 : 0;
}

/* NULL, or why it failed. */
static const char* link_open(struct link* link, const char* name) {
  char path[128];
  struct stat status;
  void* memory;
  if (snprintf(path, sizeof path, "%s/%s%s", TRAMMEL_REGION_FOLDER, TRAMMEL_REGION_PREFIX, name) >= (int)sizeof path)
    return "the name is too long";
  link->file = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (link->file < 0) return "the shared memory cannot be opened; run `trammel linuxcnc` as the same user";
  if (link_lock(link, F_OFD_SETLK, TRAMMEL_LOCK_HAL) != 0) return "another LinuxCNC is attached to this name";
  if (fstat(link->file, &status) != 0) return "the shared memory's size cannot be read";
  if (status.st_size != (off_t)sizeof(struct trammel_region)) {
    if (link_lock(link, F_OFD_GETLK, TRAMMEL_LOCK_OWNER) != 0)
      return "`trammel linuxcnc` has another layout; install module and program of one version";
    if (ftruncate(link->file, sizeof(struct trammel_region)) != 0) return "the shared memory cannot be enlarged";
  }
  memory = mmap(NULL, sizeof(struct trammel_region), PROT_READ | PROT_WRITE, MAP_SHARED, link->file, 0);
  if (memory == MAP_FAILED) return "the shared memory cannot be mapped";
  link->region = memory;
  return NULL;
}

static void link_detach(struct link* link) {
  if (link->region != NULL) munmap(link->region, sizeof(struct trammel_region));
  if (link->file >= 0) close(link->file); /* and with it the lock */
  link->region = NULL;
  link->file = -1;
}

static const char* link_attach(struct link* link, const char* name) {
  const char* error;
  memset(link, 0, sizeof *link);
  error = link_open(link, name);
  if (error == NULL && link->region->version_owner != 0 && link->region->version_owner != TRAMMEL_REGION_VERSION &&
      link_lock(link, F_OFD_GETLK, TRAMMEL_LOCK_OWNER) != 0)
    error = "`trammel linuxcnc` has another version; install module and program of one version";
  if (error != NULL) {
    link_detach(link);
    return error;
  }
  (void)mlock(link->region, sizeof(struct trammel_region)); /* without the right to, pages stay as they were touched */
  link->head = __atomic_load_n(&link->region->period_head, __ATOMIC_ACQUIRE);
  link->settings_sequence = link->region->settings_sequence & ~1u;
  __atomic_store_n(&link->region->version_hal, TRAMMEL_REGION_VERSION, __ATOMIC_RELEASE);
  return NULL;
}

/* Whether the copy is a new one. */
static int link_read_status(struct link* link) {
  static struct trammel_status copy; /* one thread, and too large for its stack */
  const struct trammel_region* region = link->region;
  int tries;
  if (__atomic_load_n(&region->version_owner, __ATOMIC_ACQUIRE) != TRAMMEL_REGION_VERSION) return 0;
  for (tries = 0; tries < TRAMMEL_TRIES; ++tries) {
    const uint32_t before = __atomic_load_n(&region->status_sequence, __ATOMIC_ACQUIRE);
    if ((before & 1u) != 0) continue;
    copy = region->status;
    __atomic_thread_fence(__ATOMIC_ACQUIRE);
    if (__atomic_load_n(&region->status_sequence, __ATOMIC_RELAXED) != before) continue;
    if (copy.session == link->status.session && copy.beat == link->status.beat) return 0;
    link->status = copy;
    return 1;
  }
  return 0;
}

/* 0 when the ring is full: the owner has not taken periods for that long. */
static int link_send(struct link* link, const struct trammel_period* period) {
  struct trammel_region* region = link->region;
  const uint64_t tail = __atomic_load_n(&region->period_tail, __ATOMIC_ACQUIRE);
  if (link->head - tail >= TRAMMEL_PERIODS && tail <= link->head) return 0;
  region->periods[link->head % TRAMMEL_PERIODS] = *period;
  ++link->head;
  __atomic_store_n(&region->period_head, link->head, __ATOMIC_RELEASE);
  __atomic_store_n(&region->version_hal, TRAMMEL_REGION_VERSION, __ATOMIC_RELAXED);
  __atomic_fetch_add(&region->wake, 1, __ATOMIC_RELEASE);
  syscall(SYS_futex, &region->wake, FUTEX_WAKE, 1, NULL, NULL, 0);
  return 1;
}

/* An owner that began with an empty memory has a sequence of 0, and is told again. */
static void link_set_settings(struct link* link, const struct trammel_settings* settings) {
  struct trammel_region* region = link->region;
  if (region->settings_sequence == link->settings_sequence && link->settings_sequence != 0 &&
      memcmp(settings, &link->settings, sizeof *settings) == 0)
    return;
  __atomic_store_n(&region->settings_sequence, link->settings_sequence + 1, __ATOMIC_RELAXED);
  __atomic_thread_fence(__ATOMIC_RELEASE);
  region->settings = *settings;
  link->settings_sequence += 2;
  __atomic_store_n(&region->settings_sequence, link->settings_sequence, __ATOMIC_RELEASE);
  link->settings = *settings;
}

#endif
