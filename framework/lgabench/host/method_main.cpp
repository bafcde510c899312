// lgabench-method: the process that a method's code runs in. lgabench-worker starts it, with the socket as
// descriptor 3.
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/host/last_words.hpp>
#include <lgabench/host/process_state.hpp>
#include <lgabench/host/serve.hpp>

// --perturb BYTE: as perturb_heap(), for check-plugin.
int main(int argc, char** argv) {
  using namespace lgabench;
  flush_denormals();
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a crash loses no line
  tell_how_it_ends();
  if (argc == 3 && std::string_view(argv[1]) == "--perturb") perturb_heap(std::atoi(argv[2]));
  int status = 0;
  try {
    Channel channel(Descriptor(plugin_socket), [](short events) {
      pollfd watched{plugin_socket, events, 0};
      ::poll(&watched, 1, -1);
    });
    if (!serve(channel)) status = connection_lost;
  } catch (const std::exception& e) {
    fmt::print(stderr, "lgabench-method: {} (it is started by lgabench-worker)\n", e.what());
    tell_end(fmt::format("got no frame of lgabench's (does it read from descriptor {}?): {}", plugin_socket, e.what()));
    status = 2;
  }
  // All was said. What plugins do at exit can neither help nor harm any more.
  std::fflush(nullptr);
  ::_exit(status);
}
