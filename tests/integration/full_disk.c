// LD_PRELOAD: a disk that is full. Counts write() and fsync() on files below $FULL_DISK_UNDER, over all processes that
// share the file $FULL_DISK_COUNT, and fails number $FULL_DISK_AT (with $FULL_DISK_STAYS all after it as well). With
// $FULL_DISK_KILLS it counts rename() as well, and the process is killed in the place of the call.
// $FULL_DISK_FREE any disk is said to have so many bytes left.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/statvfs.h>
#include <unistd.h>

static atomic_int* counter(void) {
  static atomic_int* shared;
  if (!shared) {
    const int fd = open(getenv("FULL_DISK_COUNT"), O_RDWR | O_CLOEXEC);
    shared = mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    close(fd);
    if (shared == MAP_FAILED) abort();
  }
  return shared;
}

static int fails_at(const char* path) {
  const char* under = getenv("FULL_DISK_UNDER");
  if (!under || strncmp(path, under, strlen(under)) != 0) return 0;
  const int number = atomic_fetch_add(counter(), 1) + 1, at = atoi(getenv("FULL_DISK_AT"));
  if (number == at && getenv("FULL_DISK_KILLS")) raise(SIGKILL);
  return number == at || (number > at && getenv("FULL_DISK_STAYS"));
}

static int fails(int fd) {
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
  const ssize_t n = readlink(link, path, sizeof path - 1);
  if (n < 0) return 0;
  path[n] = 0;
  return fails_at(path);
}

ssize_t write(int fd, const void* bytes, size_t size) {
  static ssize_t (*real)(int, const void*, size_t);
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "write");
  if (!fails(fd)) return real(fd, bytes, size);
  errno = ENOSPC;
  return -1;
}

int statvfs(const char* path, struct statvfs* about) {
  static int (*real)(const char*, struct statvfs*);
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "statvfs");
  const int failed = real(path, about);
  if (!failed && getenv("FULL_DISK_FREE")) about->f_bavail = strtoul(getenv("FULL_DISK_FREE"), NULL, 10) / about->f_frsize;
  return failed;
}

int fsync(int fd) {
  static int (*real)(int);
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "fsync");
  if (!fails(fd)) return real(fd);
  errno = ENOSPC;
  return -1;
}

int rename(const char* from, const char* to) {
  static int (*real)(const char*, const char*);
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "rename");
  char path[4096];
  if (getenv("FULL_DISK_KILLS") && realpath(from, path)) fails_at(path);
  return real(from, to);
}
