#include <lgabench/host/last_words.hpp>

#include <execinfo.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include <lgabench/host/frames.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {
namespace {

pid_t owner = 0;  // not a process that the plugin forked

std::string ends_frame(const std::string& reason) {
  return frame_bytes({{"type", "ends"}, {"reason", reason.substr(0, 2000)}});
}

// Another thread's frame could come into the middle of the first one's. May be called in a signal's handler.
void say(const std::string& frame) {
  if (::getpid() != owner || ::gettid() != owner) return;
  [[maybe_unused]] const ssize_t n = ::send(plugin_socket, frame.data(), frame.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

void print_backtrace(const char* head) {
  std::array<void*, 64> frames{};
  [[maybe_unused]] const ssize_t n = ::write(2, head, std::char_traits<char>::length(head));
  ::backtrace_symbols_fd(frames.data(), ::backtrace(frames.data(), static_cast<int>(frames.size())), 2);
}

void say_it_called(const char* function) {
  if (::getpid() != owner) return;
  say(ends_frame(fmt::format("ended its own process by {}()", function)));
  print_backtrace("lgabench-method: its process is ended from here; addr2line -e FILE OFFSET tells the lines:\n");
}

// Whether the address was wanted for the stack of the thread that crashed.
bool is_on_stack(const void* address, const void* context) {
  constexpr std::uintptr_t near = 1 << 16;  // what one function puts there at once, mostly
  const mcontext_t& registers = static_cast<const ucontext_t*>(context)->uc_mcontext;
#if defined(__x86_64__)
  const auto stack = static_cast<std::uintptr_t>(registers.gregs[REG_RSP]);
#else
  const auto stack = static_cast<std::uintptr_t>(registers.sp);
#endif
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  return wanted + near > stack && wanted < stack + near;
}

// Made before a crash, in which nothing may be allocated.
const std::string& overflow() {
  static const std::string frame = ends_frame("its stack overflowed (does a function call itself without end?)");
  return frame;
}

// What led to a crash, for the cell's log; the signal then takes its course.
void crashed(int signal, siginfo_t* about, void* context) {
  if (signal == SIGSEGV && about && about->si_code > 0 && is_on_stack(about->si_addr, context)) say(overflow());
  print_backtrace("lgabench-method crashed; addr2line -e FILE OFFSET tells the lines:\n");
}

// On a stack of its own: the other one may have overflowed.
void watch_crashes() {
  static char stack[1 << 16];
  stack_t other{};
  other.ss_sp = stack;
  other.ss_size = sizeof stack;
  ::sigaltstack(&other, nullptr);  // refused only where the stack were too small
  void* loads_the_unwinder[1];
  ::backtrace(loads_the_unwinder, 1);
  struct sigaction action {};
  action.sa_sigaction = crashed;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_ONSTACK | SA_SIGINFO);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) ::sigaction(signal, &action, nullptr);
}

[[noreturn]] void terminated() {
  const std::string reason =
      std::current_exception()
          ? fmt::format("\"{}\" was thrown where nothing may be (a noexcept function, a destructor, a thread)",
                        current_exception_text())
          : "called std::terminate() (was a thread neither joined nor detached?)";
  say(ends_frame(reason));
  fmt::print(stderr, "lgabench-method: {}\n", reason);
  std::abort();
}

}  // namespace

void tell_end(const std::string& reason) { say(ends_frame(reason)); }

void tell_how_it_ends() {
  owner = ::getpid();
  overflow();
  watch_crashes();
  std::set_terminate(terminated);
  std::atexit([] { say_it_called("exit"); });
  std::at_quick_exit([] { say_it_called("quick_exit"); });
}

}  // namespace lgabench
