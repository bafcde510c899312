#include <lgabench/harness/worker_pool.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstring>
#include <list>
#include <optional>
#include <sstream>
#include <utility>

#include <lgabench/core/files.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/refused.hpp>
#include <lgabench/core/resources.hpp>
#include <lgabench/host/host_process.hpp>

namespace lgabench {
namespace {

using Clock = std::chrono::steady_clock;

bool is_ignored(int signal) {
  struct sigaction now {};
  return ::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

// SIGCHLD and the signals that end a run arrive in poll(); the mask is put back at the end. One that was ignored when
// lgabench began stays so (nohup). Once one of them came, more of them are ignored: who presses Ctrl-C twice still gets
// the orderly end.
class Signals {
 public:
  Signals() {
    sigset_t wanted;
    sigemptyset(&wanted);
    sigaddset(&wanted, SIGCHLD);
    for (const int signal : enders)
      if (!is_ignored(signal)) sigaddset(&wanted, signal);
    ::sigprocmask(SIG_BLOCK, &wanted, &before_);
    fd_ = ::signalfd(-1, &wanted, SFD_CLOEXEC | SFD_NONBLOCK);
    if (fd_ < 0) throw Refused("signalfd");
  }
  ~Signals() {
    ::close(fd_);
    ::sigprocmask(SIG_SETMASK, &before_, nullptr);
  }
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  int fd() const { return fd_; }
  const sigset_t& before() const { return before_; }
  /// Takes what arrived; true if the run is to end.
  bool take() const {
    signalfd_siginfo info;
    bool stop = false;
    while (::read(fd_, &info, sizeof info) == sizeof info) stop |= info.ssi_signo != SIGCHLD;
    if (stop)
      for (const int signal : enders) ::signal(signal, SIG_IGN);
    return stop;
  }

 private:
  static constexpr std::array<int, 3> enders{SIGINT, SIGTERM, SIGHUP};
  sigset_t before_{};
  int fd_ = -1;
};

struct Worker {
  std::size_t task = 0;
  pid_t pid = -1;
  Descriptor messages;  // its fd 3
  std::string partial;  // of a line
  Clock::time_point start, deadline, in_line_since;
  WorkerEnd end;
};

std::string worker_program() { return (program_directory() / "lgabench-worker").string(); }

// One thread of numerics a worker, wherever LibTorch or BLAS look for it: workers, not threads, fill the cores.
std::vector<std::string> worker_environment(const Json& job) {
  // A secret of the person's stays here, but for a worker that asks a server with it.
  const auto secret = [](const std::string& variable) {
    return variable.rfind("OPENAI_API_KEY=", 0) == 0 || variable.rfind("OPENAI_BASE_URL=", 0) == 0;
  };
  std::vector<std::string> all = environment_with({"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1", "MKL_NUM_THREADS=1",
                                                   "LGABENCH_DATA=" + fs::absolute(data_directory()).string()});
  const bool asks = job.contains("live") && job["live"].at("asks") == true;
  if (!asks) all.erase(std::remove_if(all.begin(), all.end(), secret), all.end());
  return all;
}

Worker start(std::size_t task, const WorkerTask& what, const PoolOptions& options, const Signals& signals) {
  const Descriptor job = file_in_memory(canonical(what.job));
  const Descriptor log(
      ::open(what.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0644));
  if (log.fd < 0) throw Refused(what.log.string() + ": cannot be written");
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw Refused("pipe");
  Descriptor reading(ends[0]);
  const Descriptor writing(ends[1]);
  ::fcntl(reading.fd, F_SETFL, O_NONBLOCK);
  const auto apart = [&signals] {
    ::setpgid(0, 0);  // its own group: what it starts is stopped with it, and a terminal's Ctrl-C asks us alone
    return ::sigprocmask(SIG_SETMASK, &signals.before(), nullptr) == 0;
  };
  const pid_t pid = start_process({{worker_program(), what.verb},
                                   worker_environment(what.job),
                                   {{job.fd, 0}, {log.fd, 1}, {log.fd, 2}, {writing.fd, 3}},
                                   {},
                                   apart});
  ::setpgid(pid, pid);  // whoever comes first
  Worker worker{task, pid, std::move(reading), "", Clock::now(), {}, {}, {}};
  worker.deadline =
      worker.start + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.timeout_s));
  return worker;
}

bool in_line(const Worker& worker) { return worker.end.phase == in_line_phase; }

// A line of fd 3; what is none of a worker's is dropped.
void take_line(const std::string& line, Worker& worker, const PoolEvents& events) {
  const Json message = json_or_null(line);
  if (auto complaint = read_complaint(message)) worker.end.complaint = std::move(complaint);
  if (auto waiting = read_waiting(message)) worker.end.waits_for = std::move(waiting->whom);
  const auto at = read_phase_count(message);
  if (!at) return;
  const bool waited = in_line(worker), waits = at->phase == in_line_phase;
  if (waits && !waited) worker.in_line_since = Clock::now();
  if (waited && !waits) worker.deadline += Clock::now() - worker.in_line_since;
  worker.end.phase = at->phase;
  events.progress(worker.task, at->phase, at->count);
}

// A full pipe at most: a plugin that writes there without end shall not hold up the others.
void take_messages(Worker& worker, const PoolEvents& events) {
  constexpr std::size_t longest = 1 << 16;
  char block[4096];
  for (std::size_t taken = 0; worker.messages.fd >= 0 && taken < longest; taken += sizeof block) {
    const ssize_t n = ::read(worker.messages.fd, block, sizeof block);
    if (n < 0) return;
    if (n == 0) worker.messages.close();  // all writers are gone: poll() shall not report that for ever
    worker.partial.append(block, static_cast<std::size_t>(n));
    for (std::size_t end; (end = worker.partial.find('\n')) != std::string::npos;) {
      take_line(worker.partial.substr(0, end), worker, events);
      worker.partial.erase(0, end + 1);
    }
    if (worker.partial.size() > longest) worker.partial.clear();
  }
}

void kill_group(const Worker& worker) { ::kill(-worker.pid, SIGKILL); }

// True once the worker is gone; its group goes with it, while the number is still its own.
bool reap(Worker& worker, const PoolEvents& events) {
  siginfo_t ended{};
  if (::waitid(P_PID, static_cast<id_t>(worker.pid), &ended, WEXITED | WNOHANG | WNOWAIT) != 0 || ended.si_pid == 0)
    return false;
  kill_group(worker);
  int status = 0;
  ::waitpid(worker.pid, &status, 0);
  worker.end.seconds = std::chrono::duration<double>(Clock::now() - worker.start).count();
  take_messages(worker, events);
  if (WIFSIGNALED(status)) worker.end.signal = WTERMSIG(status);
  if (WIFEXITED(status)) worker.end.exit_code = WEXITSTATUS(status);
  return true;
}

// What a method's process left behind when its worker was stopped: it became ours. No worker is meant by that.
void kill_strays(const std::list<Worker>& workers) {
  const auto is_worker = [&workers](pid_t pid) {
    return std::any_of(workers.begin(), workers.end(), [pid](const Worker& worker) { return worker.pid == pid; });
  };
  for (bool some = true; some;) {
    some = false;
    for (const pid_t pid : children_of(::getpid())) {
      if (is_worker(pid)) continue;
      some = true;
      ::kill(pid, SIGKILL);
      ::waitpid(pid, nullptr, 0);
    }
  }
}

// However this is left, no worker stays behind.
struct Crew {
  Crew() { ::prctl(PR_SET_CHILD_SUBREAPER, 1); }
  std::list<Worker> workers;
  ~Crew() {
    for (Worker& worker : workers) {
      kill_group(worker);
      ::waitpid(worker.pid, nullptr, 0);
    }
    kill_strays({});
  }
};

}  // namespace

bool run_workers(std::size_t tasks, const std::function<WorkerTask(std::size_t)>& make, const PoolOptions& options,
                 const PoolEvents& events) {
  const Signals signals;
  Crew crew;
  Clock::time_point awake = Clock::now();
  std::optional<WorkerTask> made;  // of the next task
  for (std::size_t next = 0; next < tasks || !crew.workers.empty();) {
    while (next < tasks && crew.workers.size() < static_cast<std::size_t>(options.jobs)) {
      WorkerEnd not_begun;
      try {
        if (!made) made = make(next);
        crew.workers.push_back(start(next, *made, options, signals));
      } catch (const Refused& e) {
        if (e.may_pass() && !crew.workers.empty()) break;  // again when one of them has ended
        not_begun.complaint = Complaint{e.what()};
      } catch (const std::exception& e) {  // no place on the disk
        not_begun.complaint = Complaint{e.what()};
      }
      made.reset();
      events.started(next);
      if (not_begun.complaint) events.ended(next, not_begun);
      ++next;
    }
    std::vector<pollfd> watched{{signals.fd(), POLLIN, 0}};
    for (const Worker& worker : crew.workers) watched.push_back({worker.messages.fd, POLLIN, 0});
    ::poll(watched.data(), watched.size(), 200);
    if (signals.take()) return false;
    // Time in which we did not run (stopped, suspended by a batch system) may have stopped the workers too.
    const Clock::time_point now = Clock::now();
    const auto asleep = now - std::exchange(awake, now);
    if (asleep > std::chrono::seconds(1))
      for (Worker& worker : crew.workers) worker.deadline += asleep;
    for (auto worker = crew.workers.begin(); worker != crew.workers.end();) {
      take_messages(*worker, events);
      if (!worker->end.timed_out && !in_line(*worker) && Clock::now() > worker->deadline) {
        worker->end.timed_out = true;
        kill_group(*worker);
      }
      if (!reap(*worker, events)) {
        ++worker;
        continue;
      }
      const Worker gone = std::move(*worker);
      worker = crew.workers.erase(worker);
      kill_strays(crew.workers);
      events.ended(gone.task, gone.end);
    }
    events.tick();
  }
  return true;
}

int run_in_foreground(const Json& job) {
  const Descriptor file = file_in_memory(canonical(job));
  ::signal(SIGINT, SIG_IGN);
  const int status = wait_for(start_process(
      {{worker_program(), "cell"}, worker_environment(job), {{file.fd, 0}, {STDIN_FILENO, persons_input}}}));
  ::signal(SIGINT, SIG_DFL);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// A worker that leaks meets its own limit before the job's.
Limits worker_limits(const PoolOptions& options) {
  constexpr double gib = 1 << 30, least = 4 * gib;
  const double share = std::max(usable_bytes() / options.jobs, std::min(least, usable_bytes()));
  const double memory = options.memory_gib > 0 ? options.memory_gib * gib : share;
  return {static_cast<long long>(options.timeout_s) + 60, static_cast<long long>(memory)};
}

WorkerFault why_it_ended(const WorkerEnd& end, double timeout_s) {
  const std::string where = end.phase.empty() ? "before its first phase" : "in phase " + end.phase;
  // Methods, perturbations and perceivers have processes of their own.
  const char* const itself = " of the worker itself, in which engine and environment run";
  const std::string awaited = end.waits_for.empty() ? itself : fmt::format(": {} did not answer", end.waits_for);
  if (end.timed_out) return {fmt::format("stopped after {} s {}{}", timeout_s, where, awaited), "plugin"};
  if (end.signal != 0) {
    const bool outside = end.signal == SIGKILL || end.signal == SIGTERM;  // a person, or memory ran out
    return {fmt::format("signal {} ({}) {}{}", end.signal, ::strsignal(end.signal), where, outside ? "" : itself),
            outside ? "host" : "plugin"};
  }
  if (end.complaint) return {end.complaint->reason, end.complaint->by_plugin ? "plugin" : "host"};
  return {fmt::format("exited with {} {}{}", end.exit_code, where, itself), "plugin"};
}

std::vector<std::string> log_tail(const fs::path& log) {
  constexpr std::size_t lines = 20, longest = 400;
  std::istringstream text;
  try {
    text.str(read_file(log, Links::refused));
  } catch (const InputError&) {  // a plugin took it away
  }
  std::vector<std::string> last;
  for (std::string line; std::getline(text, line);) {
    if (line.size() > longest) line = line.substr(0, longest) + "...";
    for (char& c : line)  // whatever was printed, status.json stays text
      if (static_cast<unsigned char>(c) >= 0x80 || (static_cast<unsigned char>(c) < 0x20 && c != '\t')) c = '?';
    if (last.size() == lines) last.erase(last.begin());
    last.push_back(line);
  }
  return last;
}

}  // namespace lgabench
