#include <lgabench/host/host_process.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/plugin/guarded.hpp>

namespace lgabench {

std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> all;
  std::error_code gone;
  for (const auto& thread : fs::directory_iterator(fmt::format("/proc/{}/task", parent), gone)) {
    std::ifstream file(thread.path() / "children");
    for (pid_t pid = 0; file >> pid;) all.push_back(pid);
  }
  return all;
}

namespace {

[[noreturn]] void fail(const char* what) { throw EngineError(fmt::format("{}: {}", what, std::strerror(errno))); }

// Everything else of our environment stays here: secrets, and where a run lies. A user's name: the list of them cannot
// be read, and PyTorch names its cache by it. Huge pages: a page of its own for every 4 KiB of demonstrations takes
// longer than copying them.
std::vector<std::string> environment_of(const HostCommand& command) {
  const std::string scratch = command.scratch.string();
  std::vector<std::string> all{"OMP_NUM_THREADS=1",
                               "OPENBLAS_NUM_THREADS=1",
                               "MKL_NUM_THREADS=1",
                               "LC_ALL=C.UTF-8",
                               "PYTHONHASHSEED=0",
                               "PYTHONDONTWRITEBYTECODE=1",
                               "HOME=" + scratch,
                               "TMPDIR=" + scratch,
                               "USER=lgabench",
                               "LOGNAME=lgabench",
                               "TORCHINDUCTOR_CACHE_DIR=" + scratch + "/torchinductor",
                               "LGABENCH_DATA=" + data_directory().string(),
                               "LGABENCH_ENCODER=" + fs::absolute(encoder_directory()).string(),
                               "GLIBC_TUNABLES=glibc.malloc.hugetlb=1"};
  for (const char* name : {"PATH", "LD_LIBRARY_PATH", "OPENBLAS_CORETYPE"})
    if (const char* value = std::getenv(name)) all.push_back(fmt::format("{}={}", name, value));
  all.insert(all.end(), command.also_set.begin(), command.also_set.end());
  return all;
}

std::vector<pid_t> descendants() {
  std::vector<pid_t> all = children_of(::getpid());
  for (std::size_t i = 0; i < all.size(); ++i)
    for (const pid_t pid : children_of(all[i])) all.push_back(pid);
  return all;
}

// Bytes of its own and of shared memory; pages of mapped files are the system's to drop.
long long memory_of(pid_t pid) {
  std::ifstream file(fmt::format("/proc/{}/status", pid));
  long long kib = 0;
  for (std::string line; std::getline(file, line);)
    if (line.rfind("RssAnon:", 0) == 0 || line.rfind("RssShmem:", 0) == 0)
      kib += std::atoll(line.c_str() + line.find(':') + 1);
  return kib << 10;
}

}  // namespace

HostProcess::HostProcess(const HostCommand& command)
    : memory_bytes_(command.memory_bytes), in_foreground_(command.in_foreground) {
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // what the host leaves behind becomes ours
  int sockets[2], output[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0) fail("socketpair");
  socket_ = Descriptor(sockets[0]);
  const Descriptor theirs(sockets[1]);
  if (::pipe2(output, O_CLOEXEC) != 0) fail("pipe");
  output_ = Descriptor(output[0]);
  const Descriptor printing(output[1]);
  ::fcntl(output_.fd, F_SETFL, O_NONBLOCK);
  const Descriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  ProcessStart start{command.words, environment_of(command), {{theirs.fd, 3}}, command.scratch};
  if (in_foreground_)
    start.descriptors.emplace_back(persons_input, 0);
  else
    start.descriptors.insert(start.descriptors.end(), {{nothing.fd, 0}, {printing.fd, 1}, {printing.fd, 2}});
  start.in_child = [&command] {
    if (command.in_foreground)
      ::signal(SIGINT, SIG_DFL);
    else
      ::setsid();
    return !command.confinement || command.confinement->apply();
  };
  pid_ = start_process(start);
}

HostProcess::~HostProcess() {
  stop();
  pass_on_output();
}

void HostProcess::wait(int fd, short events) {
  std::array<pollfd, 2> watched{{{fd, events, 0}, {output_.fd, POLLIN, 0}}};
  ::poll(watched.data(), watched.size(), 200);
  pass_on_output();
  watch_memory();
}

void HostProcess::watch_memory() {
  constexpr auto often = std::chrono::milliseconds(100);
  const auto now = std::chrono::steady_clock::now();
  if (memory_bytes_ <= 0 || reaped_ || now - looked_ < often) return;
  looked_ = now;
  long long total = 0;
  for (const pid_t pid : descendants()) total += memory_of(pid);
  if (total <= memory_bytes_) return;
  stop();
  throw std::bad_alloc();
}

void HostProcess::pass_on_output() {
  constexpr std::size_t most = 16 << 20;
  char block[1 << 16];
  while (output_.fd >= 0) {
    const ssize_t n = ::read(output_.fd, block, sizeof block);
    if (n == 0) output_.close();
    if (n <= 0) return;
    const std::size_t room = most - std::min(printed_, most), size = std::min(static_cast<std::size_t>(n), room);
    std::fflush(stdout);
    [[maybe_unused]] const ssize_t written = ::write(1, block, size);  // a full disk changes no result
    if (printed_ < most && static_cast<std::size_t>(n) >= room)
      to_stdout("\n(the method printed more than {} MiB; the rest is dropped)\n", most >> 20);
    printed_ += static_cast<std::size_t>(n);
  }
}

// The host's session, then those that left it, until there is none.
void HostProcess::stop() {
  if (reaped_) return;
  if (!in_foreground_) {
    ::kill(-pid_, SIGKILL);
    ::kill(pid_, SIGKILL);
  }
  ::waitpid(pid_, nullptr, 0);
  reaped_ = true;
  for (std::vector<pid_t> left = descendants(); !left.empty(); left = descendants())
    for (const pid_t pid : left) {
      ::kill(pid, SIGKILL);
      ::waitpid(pid, nullptr, 0);
    }
}

void HostProcess::explain() {
  // A process that closed its connection may not be at its end yet: it has two seconds.
  siginfo_t ended{};
  for (int i = 0; i < 400 && ended.si_pid == 0; ++i) {
    if (::waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) != 0) break;
    pass_on_output();
    if (ended.si_pid == 0) ::usleep(5000);
  }
  const bool by_itself = ended.si_pid != 0;
  stop();
  pass_on_output();
  if (!by_itself) throw MethodGone("its process closed the connection", 0);
  if (ended.si_code == CLD_EXITED) throw MethodGone(fmt::format("exited with {}", ended.si_status), 0);
  throw MethodGone(fmt::format("signal {} ({})", ended.si_status, ::strsignal(ended.si_status)), ended.si_status);
}

}  // namespace lgabench
