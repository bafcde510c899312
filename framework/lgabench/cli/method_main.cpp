// lgabench-method: the process that a method's code runs in. lgabench-worker starts it, with the socket as
// descriptor 3.
#include <execinfo.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <lgabench/core/flush_denormals.hpp>
#include <lgabench/host/process_state.hpp>
#include <lgabench/host/serve.hpp>

namespace {

// What led to a crash, for the cell's log; the signal then takes its course.
void print_backtrace(int) {
  constexpr int most = 64;
  void* frames[most];
  constexpr char head[] = "lgabench-method crashed; addr2line -e FILE OFFSET tells the lines:\n";
  [[maybe_unused]] const ssize_t written = ::write(2, head, sizeof head - 1);
  ::backtrace_symbols_fd(frames, ::backtrace(frames, most), 2);
}

// On a stack of its own: the other one may have overflowed.
void print_backtraces() {
  static char stack[1 << 16];
  stack_t other{};
  other.ss_sp = stack;
  other.ss_size = sizeof stack;
  ::sigaltstack(&other, nullptr);
  void* loads_the_unwinder[1];
  ::backtrace(loads_the_unwinder, 1);
  struct sigaction action {};
  action.sa_handler = print_backtrace;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_ONSTACK);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) ::sigaction(signal, &action, nullptr);
}

}  // namespace

// --perturb BYTE: as perturb_heap(), for check-plugin.
int main(int argc, char** argv) {
  using namespace lgabench;
  constexpr int socket = 3;
  flush_denormals();
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // a crash loses no line
  print_backtraces();
  if (argc == 3 && std::string_view(argv[1]) == "--perturb") perturb_heap(std::atoi(argv[2]));
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
