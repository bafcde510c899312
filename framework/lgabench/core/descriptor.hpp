// Owns a file descriptor.
#pragma once
#include <unistd.h>

#include <utility>

namespace lgabench {

struct Descriptor {
  int fd = -1;
  explicit Descriptor(int f = -1) : fd(f) {}
  Descriptor(Descriptor&& other) noexcept : fd(std::exchange(other.fd, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd, other.fd);
    return *this;
  }
  ~Descriptor() { close(); }
  void close() {
    if (fd >= 0) ::close(std::exchange(fd, -1));
  }
};

}  // namespace lgabench
