// lgabench-method: the process that a method's code runs in. lgabench-worker starts it, with the socket as
// descriptor 3.
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>

#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/host/serve.hpp>

int main() {
  using namespace lgabench;
  constexpr int socket = 3;
  flush_denormals();
  int status = 0;
  try {
    Channel channel(Descriptor(socket), [](short events) {
      pollfd watched{socket, events, 0};
      ::poll(&watched, 1, -1);
    });
    serve(channel);
  } catch (const std::exception& e) {
    fmt::print(stderr, "lgabench-method: {} (it is started by lgabench-worker)\n", e.what());
    status = 2;
  }
  // All was said. What plugins do at exit can neither help nor harm any more.
  std::fflush(nullptr);
  ::_exit(status);
}
