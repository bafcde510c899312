// LD_PRELOAD: a system that refuses the calls that $REFUSED lists ("flock pthread_create"), with the error number
// $REFUSED_WITH.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int refused(const char* call) {
  const char* const calls = getenv("REFUSED");
  if (!calls || !strstr(calls, call)) return 0;
  errno = atoi(getenv("REFUSED_WITH"));
  return 1;
}

int flock(int fd, int operation) {
  static int (*real)(int, int);
  if (refused("flock")) return -1;
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "flock");
  return real(fd, operation);
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*), void* argument) {
  static int (*real)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  if (refused("pthread_create")) return errno;
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "pthread_create");
  return real(thread, attributes, work, argument);
}

// Of a directory, as "fsync" says.
int fsync(int fd) {
  static int (*real)(int);
  struct stat about;
  if (fstat(fd, &about) == 0 && S_ISDIR(about.st_mode) && refused("fsync")) return -1;
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "fsync");
  return real(fd);
}

int memfd_create(const char* name, unsigned flags) {
  static int (*real)(const char*, unsigned);
  if (refused("memfd_create")) return -1;
  if (!real) *(void**)&real = dlsym(RTLD_NEXT, "memfd_create");
  return real(name, flags);
}
