#include <lgabench/host/host_process.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <new>
#include <set>
#include <utility>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/refused.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/tree.hpp>
#include <lgabench/host/last_words.hpp>
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

[[noreturn]] void fail(const char* what) { throw EngineError(refused_text(what)); }

constexpr const char* of_secrets[] = {"KEY", "TOKEN", "SECRET", "PASSWORD", "CREDENTIAL"};

// All of our environment that is not among them, but names that speak of secrets.
void add_ours(std::vector<std::string>& all) {
  for (char** one = environ; *one; ++one) {
    const std::string entry = *one, name = entry.substr(0, entry.find('=') + 1);
    const auto names = [&name](const char* word) { return name.find(word) != name.npos; };
    const auto sets = [&name](const std::string& other) { return other.rfind(name, 0) == 0; };
    if (std::none_of(std::begin(of_secrets), std::end(of_secrets), names) && std::none_of(all.begin(), all.end(), sets))
      all.push_back(entry);
  }
}

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
  if (command.trusted) {
    const auto is_users = [](const std::string& one) {
      return one.rfind("HOME=", 0) == 0 || one.rfind("USER=", 0) == 0 || one.rfind("LOGNAME=", 0) == 0;
    };
    all.erase(std::remove_if(all.begin(), all.end(), is_users), all.end());
    add_ours(all);
  }
  return all;
}

// Processes of plugins that this worker has. One thread.
std::vector<pid_t>& hosts() {
  static std::vector<pid_t> all;
  return all;
}

// Of the host, and what others left behind: not the other hosts, nor what is below them. A few more than `most` end it.
// Each is sent the signal, unless that is 0, before its own are looked for.
std::vector<pid_t> descendants(pid_t host, int signal, std::size_t most = SIZE_MAX) {
  const auto is_others = [host](pid_t pid) { return pid != host && contains(hosts(), pid); };
  std::vector<pid_t> all = children_of(::getpid());
  all.erase(std::remove_if(all.begin(), all.end(), is_others), all.end());
  for (std::size_t i = 0; i < all.size() && all.size() <= most; ++i) {
    if (signal != 0) ::kill(all[i], signal);
    for (const pid_t pid : children_of(all[i])) all.push_back(pid);
  }
  return all;
}

// What processes have of the system.
struct Use {
  long long memory = 0;         // bytes
  std::size_t tasks = 0;        // processes and their threads
  std::uintmax_t nameless = 0;  // bytes on the disk of open files that were deleted
  std::set<std::pair<dev_t, ino_t>> counted{};
};

// Its own memory and shared one, with the tables of its pages, and what the system keeps of each thread; pages of
// mapped files are the system's to drop.
void add_status(pid_t pid, Use& use) {
  constexpr long long task_kib = 100;
  std::ifstream file(fmt::format("/proc/{}/status", pid));
  for (std::string line; std::getline(file, line);) {
    const std::string name = line.substr(0, line.find(':'));
    const long long number = std::atoll(line.c_str() + std::min(line.size(), name.size() + 1));
    if (name == "RssAnon" || name == "RssShmem" || name == "VmPTE") use.memory += number << 10;
    if (name != "Threads") continue;
    use.tasks += static_cast<std::size_t>(number);
    use.memory += number * task_kib << 10;
  }
}

// Each pipe and socket as if it were full.
void add_descriptors(pid_t pid, Use& use) {
  constexpr long long pipe_bytes = 1 << 16, socket_bytes = 1 << 18;
  std::error_code gone;
  fs::directory_iterator link(fmt::format("/proc/{}/fd", pid), gone);
  for (; !gone && link != fs::directory_iterator(); link.increment(gone)) {
    struct stat about {};
    if (::stat(link->path().c_str(), &about) != 0 || !use.counted.emplace(about.st_dev, about.st_ino).second) continue;
    if (S_ISFIFO(about.st_mode)) use.memory += pipe_bytes;
    if (S_ISSOCK(about.st_mode)) use.memory += socket_bytes;
    const bool in_memory = fs::read_symlink(link->path(), gone).native().rfind("/memfd:", 0) == 0;  // the worker's
    if (S_ISREG(about.st_mode) && about.st_nlink == 0 && !in_memory)
      use.nameless += static_cast<std::uintmax_t>(about.st_blocks) * 512;
  }
}

}  // namespace

HostProcess::HostProcess(const HostCommand& command)
    : memory_bytes_(command.memory_bytes), in_foreground_(command.in_foreground) {
  ::prctl(PR_SET_CHILD_SUBREAPER, 1);  // what the host leaves behind becomes ours
  scratch_ = Descriptor(::open(command.scratch.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  if (scratch_.fd < 0) fail(command.scratch.c_str());
  int sockets[2], output[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, sockets) != 0) fail("socketpair");
  socket_ = Descriptor(sockets[0]);
  Descriptor theirs(sockets[1]);
  if (::pipe2(output, O_CLOEXEC) != 0) fail("pipe");
  output_ = Descriptor(output[0]);
  const Descriptor printing(output[1]);
  ::fcntl(output_.fd, F_SETFL, O_NONBLOCK);
  const Descriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  ProcessStart start{command.words, environment_of(command), {{theirs.fd, plugin_socket}}, command.scratch};
  if (in_foreground_)
    start.descriptors.emplace_back(persons_input, 0);
  else
    start.descriptors.insert(start.descriptors.end(), {{nothing.fd, 0}, {printing.fd, 1}, {printing.fd, 2}});
  start.in_child = [&command, &theirs] {
    if (command.in_foreground)
      ::signal(SIGINT, SIG_DFL);
    else
      ::setsid();
    if (command.offline && has_seccomp() && !refuse_internet()) return false;
    return !command.confinement || command.confinement->apply(theirs.fd);
  };
  pid_ = start_process(start);
  hosts().push_back(pid_);
  theirs.close();
  if (command.confinement && has_seccomp()) calls_ = NotedCalls(socket_.fd);
}

HostProcess::~HostProcess() {
  stop();
  pass_on_output();
}

void HostProcess::wait(int fd, short events) {
  attend(fd, events, 200);
  watch_use();
}

void HostProcess::attend(int fd, short events, int milliseconds) {
  std::array<pollfd, 3> watched{{{fd, events, 0}, {output_.fd, POLLIN, 0}, {calls_.descriptor(), POLLIN, 0}}};
  ::poll(watched.data(), watched.size(), milliseconds);
  pass_on_output();
  calls_.take(watched[2].revents);
}

// Ten times a second; less often where looking takes long, more often where much is started.
void HostProcess::watch_use() {
  using Clock = std::chrono::steady_clock;
  constexpr std::uintmax_t most_bytes = std::uintmax_t{4} << 30, most_files = 10000;
  constexpr std::size_t most_tasks = 1000;
  const Clock::time_point start = Clock::now();
  if (reaped_ || (start < look_again_ && calls_.started() < started_ + most_tasks)) return;
  started_ = calls_.started();
  Use use;
  const std::vector<pid_t> all = descendants(pid_, 0, most_tasks);
  if (all.size() <= most_tasks)
    for (const pid_t pid : all) add_status(pid, use);
  const auto gone_for = [this](const std::string& reason) {
    stop();
    throw MethodGone(reason, 0);
  };
  if (std::max(all.size(), use.tasks) > most_tasks)
    gone_for(fmt::format("it had more than {} processes and threads", most_tasks));
  for (const pid_t pid : all) add_descriptors(pid, use);
  const TreeSize files = tree_size(scratch_.fd, most_files);
  look_again_ = start + std::max<Clock::duration>(std::chrono::milliseconds(100), 20 * (Clock::now() - start));
  if (memory_bytes_ > 0 && use.memory > memory_bytes_) {
    stop();
    throw std::bad_alloc();
  }
  if (files.files > most_files)
    gone_for(fmt::format("it made more than {} files, or directories 100 deep, in its scratch directory", most_files));
  const std::uintmax_t allowed =
      memory_bytes_ > 0 ? std::min(most_bytes, static_cast<std::uintmax_t>(memory_bytes_)) : most_bytes;
  if (files.bytes + use.nameless > allowed)
    gone_for(fmt::format("its files in its scratch directory took more than {:.1f} GiB",
                         static_cast<double>(allowed) / (1 << 30)));
}

std::vector<std::string> HostProcess::started() const {
  std::vector<std::string> all;
  for (const pid_t pid : descendants(pid_, 0)) {
    std::string name;
    std::getline(std::ifstream(fmt::format("/proc/{}/comm", pid)), name);
    if (pid != pid_ && !name.empty()) all.push_back(fmt::format("{} {}", pid, name));
  }
  return all;
}

ProcessUse HostProcess::used() const {
  ProcessUse use;
  clockid_t clock{};
  timespec time{};
  if (::clock_getcpuclockid(pid_, &clock) == 0 && ::clock_gettime(clock, &time) == 0)
    use.cpu_s = static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  std::ifstream status(fmt::format("/proc/{}/status", pid_));
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) use.peak_bytes = std::atoll(line.c_str() + std::strlen("VmHWM:")) << 10;
  return use;
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
      to_stdout("\n(it printed more than {} MiB; the rest is dropped)\n", most >> 20);
    printed_ += static_cast<std::size_t>(n);
  }
}

// The host's session, then those that left it, until there is none. Who starts another waits for an answer meanwhile.
void HostProcess::stop() {
  if (reaped_) return;
  if (!in_foreground_) {
    ::kill(-pid_, SIGKILL);
    ::kill(pid_, SIGKILL);
  }
  ::waitpid(pid_, nullptr, 0);
  reaped_ = true;
  hosts().erase(std::remove(hosts().begin(), hosts().end(), pid_), hosts().end());
  const auto killed = [this] { return descendants(pid_, SIGKILL); };
  for (std::vector<pid_t> left = killed(); !left.empty(); left = killed())
    for (const pid_t pid : left) ::waitpid(pid, nullptr, 0);
}

void HostProcess::explain(const std::string& last_words) {
  // A process that closed its connection may not be at its end yet: it has two seconds.
  siginfo_t ended{};
  for (int i = 0; i < 400 && ended.si_pid == 0; ++i) {
    if (::waitid(P_PID, static_cast<id_t>(pid_), &ended, WEXITED | WNOHANG | WNOWAIT) != 0) break;
    if (ended.si_pid == 0) attend(-1, 0, 5);
  }
  const bool by_itself = ended.si_pid != 0;
  stop();
  pass_on_output();
  const bool exited = ended.si_code == CLD_EXITED;
  if (!by_itself || (exited && ended.si_status == connection_lost && last_words.empty()))
    throw MethodGone(
        fmt::format("closed descriptor {}, or put another file there: lgabench talks with it there,", plugin_socket),
        0);
  const std::string words = !last_words.empty() ? last_words + ": "
                            : exited            ? "its process ended in the middle of a call: "
                                                : "";
  if (exited) throw MethodGone(fmt::format("{}exited with {}", words, ended.si_status), 0);
  throw MethodGone(fmt::format("{}signal {} ({})", words, ended.si_status, ::strsignal(ended.si_status)),
                   ended.si_status);
}

}  // namespace lgabench
