// Starts processes that start processes, each in a session of its own, until there were as many as its argument says.
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

int main(int count, char** words) {
  const int most = count > 1 ? atoi(words[1]) : 0;
  int* const started = mmap(NULL, sizeof *started, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (started == MAP_FAILED) return 1;
  while (__atomic_add_fetch(started, 1, __ATOMIC_RELAXED) < most)
    if (fork() == 0) setsid();
  for (;;) pause();
}
