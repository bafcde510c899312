#include <lgabench/core/process.hpp>

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>

#include <lgabench/core/refused.hpp>

namespace lgabench {
namespace {

// As exec takes them: pointers into the words, and a null pointer at the end.
std::vector<char*> pointers(const std::vector<std::string>& words) {
  std::vector<char*> all;
  for (const std::string& word : words) all.push_back(const_cast<char*>(word.c_str()));
  all.push_back(nullptr);
  return all;
}

constexpr int not_started = 127;  // an exit status, as a shell's

// How far a process came on the way to its program, and errno: as it tells its parent. Nothing where it got there.
enum class Stage { done, directory, in_child, descriptors, program };
struct Stopped {
  Stage step = Stage::done;
  int reason = 0;
};

// Waits until the program runs, or the process has said why it does not. Not for long: somebody may stop it before.
Stopped told_by(const Descriptor& pipe) {
  constexpr int longest_ms = 2000;
  Stopped stopped;
  ssize_t n = 0;
  pollfd watched{pipe.fd, POLLIN, 0};
  if (::poll(&watched, 1, longest_ms) == 0) return stopped;
  while ((n = ::read(pipe.fd, &stopped, sizeof stopped)) < 0 && errno == EINTR) {
  }
  return n == sizeof stopped ? stopped : Stopped();
}

std::string said_of(Stage step, const ProcessStart& start) {
  const std::string program = start.words.front();
  switch (step) {
    case Stage::directory:
      return start.directory.string() + ": cannot be entered";
    case Stage::in_child:
      return program + ": cannot be prepared";
    case Stage::descriptors:
      return program + ": cannot be given its files";
    default:
      return program + ": cannot be started";
  }
}

// Whoever started this program may ignore the ends of children, as a shell's trap '' CHLD does: none could be waited
// for.
void keep_ends_of_children() {
  struct sigaction now {};
  if (::sigaction(SIGCHLD, nullptr, &now) == 0 && (now.sa_handler == SIG_IGN || (now.sa_flags & SA_NOCLDWAIT) != 0))
    ::signal(SIGCHLD, SIG_DFL);
}

}  // namespace

std::vector<std::string> environment_with(const std::vector<std::string>& set) {
  const auto name = [](const std::string& variable) { return variable.substr(0, variable.find('=') + 1); };
  std::vector<std::string> all = set;
  for (char** variable = environ; *variable; ++variable) {
    const std::string text = *variable;
    const auto same = [&](const std::string& one) { return name(one) == name(text); };
    if (std::none_of(set.begin(), set.end(), same)) all.push_back(text);
  }
  return all;
}

pid_t start_process(const ProcessStart& start) {
  // Nothing is allocated between fork and exec, but by in_child.
  const std::vector<char*> words = pointers(start.words), variables = pointers(start.variables);
  int last = 2;
  for (const auto& [ours, its] : start.descriptors) last = std::max(last, its);
  std::vector<int> spare(start.descriptors.size());
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw Refused("pipe");
  Descriptor reading(ends[0]);
  Descriptor writing(ends[1]);
  keep_ends_of_children();
  const pid_t parent = ::getpid();

  const pid_t pid = ::fork();
  if (pid < 0) throw Refused("fork");
  if (pid > 0) {
    writing.close();
    if (const auto [step, reason] = told_by(reading); step != Stage::done) {
      wait_for(pid);
      throw Refused(said_of(step, start), reason);
    }
    return pid;
  }
  reading.close();
  const auto give_up = [&writing](Stage step) {
    const Stopped stopped{step, errno};
    [[maybe_unused]] const ssize_t written =
        ::write(writing.fd, &stopped, sizeof stopped);  // or nobody listens any more
    ::_exit(not_started);
  };
  ::signal(SIGXFSZ, SIG_DFL);  // which lgabench ignores
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(not_started);  // which died before that took effect
  if (!start.directory.empty() && ::chdir(start.directory.c_str()) != 0) give_up(Stage::directory);
  errno = 0;
  if (start.in_child && !start.in_child()) give_up(Stage::in_child);
  // By way of numbers beyond all that are wanted: one may be another's, and dup2 onto itself would keep CLOEXEC.
  // Each of ours is closed after its last use: few may be left.
  for (std::size_t i = 0; i < spare.size(); ++i) {
    const int ours = start.descriptors[i].first;
    if ((spare[i] = ::fcntl(ours, F_DUPFD_CLOEXEC, last + 1)) < 0) give_up(Stage::descriptors);
    bool is_last = ours > 2;
    for (std::size_t j = i + 1; j < spare.size(); ++j) is_last = is_last && start.descriptors[j].first != ours;
    if (is_last) ::close(ours);
  }
  if (writing.fd <= last && (writing.fd = ::fcntl(writing.fd, F_DUPFD_CLOEXEC, last + 1)) < 0) ::_exit(not_started);
  for (std::size_t i = 0; i < spare.size(); ++i)
    if (::dup2(spare[i], start.descriptors[i].second) < 0) give_up(Stage::descriptors);
  // Before Linux 5.11 only what lgabench opened itself, with O_CLOEXEC, is closed.
  ::syscall(SYS_close_range, static_cast<unsigned>(last + 1), ~0u, CLOSE_RANGE_CLOEXEC);
  ::execvpe(words[0], words.data(), variables.data());
  give_up(Stage::program);
  ::_exit(not_started);
}

int wait_for(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

Descriptor file_in_memory(std::string_view bytes) {
  Descriptor file(::memfd_create("lgabench", MFD_CLOEXEC));
  if (file.fd < 0) throw Refused("memfd_create");
  while (!bytes.empty()) {
    const ssize_t n = ::write(file.fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Refused("a file in memory cannot be written");
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  if (::lseek(file.fd, 0, SEEK_SET) != 0) throw Refused("a file in memory cannot be read");
  return file;
}

std::string bytes_of(const Descriptor& file) {
  std::string bytes;
  char block[1 << 16];
  for (;;) {
    const ssize_t n = ::pread(file.fd, block, sizeof block, static_cast<off_t>(bytes.size()));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw Refused("a file in memory cannot be read");
    if (n == 0) return bytes;
    bytes.append(block, static_cast<std::size_t>(n));
  }
}

}  // namespace lgabench
