// What the system may refuse, and the shares of it that a job has.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/directories.hpp>
#include <lgabench/core/file_lock.hpp>
#include <lgabench/core/parallel.hpp>
#include <lgabench/core/process.hpp>
#include <lgabench/core/refused.hpp>
#include <lgabench/core/resources.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

// A variable's value while this object lives.
class Variable {
 public:
  Variable(std::string name, const std::string& value) : name_(std::move(name)) {
    if (const char* old = std::getenv(name_.c_str())) had_ = true, old_ = old;
    ::setenv(name_.c_str(), value.c_str(), 1);
  }
  ~Variable() {
    if (had_)
      ::setenv(name_.c_str(), old_.c_str(), 1);
    else
      ::unsetenv(name_.c_str());
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  std::string name_, old_;
  bool had_ = false;
};

// What the call makes of a process of its own, whose limits it may lower: its exit status.
template <class Call>
int in_a_process(Call&& call) {
  const pid_t pid = ::fork();
  if (pid == 0) ::_exit(call());
  const int status = wait_for(pid);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 100 + WTERMSIG(status);
}

int lowered(int resource, rlim_t value) {
  const rlimit both{value, value};
  return ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

Descriptor opened(const fs::path& path) { return Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC)); }

TEST(Locks, TellAnothersLockFromAFileSystemWithoutThem) {
  const TemporaryDirectory directory;
  const fs::path path = directory.path / "locked";
  write_file(path, "");
  const Descriptor first = opened(path), second = opened(path);
  EXPECT_TRUE(try_lock(first.fd, Lock::exclusive, path));
  EXPECT_FALSE(try_lock(second.fd, Lock::shared, path));
  EXPECT_TRUE(is_locked(second.fd));
  constexpr int none = -1;
  const std::string said = message_of<InputError>([&] { try_lock(none, Lock::exclusive, "/net/out"); });
  EXPECT_SAYS(said, "/net/out: cannot be locked: this file system has no locks (Bad file descriptor)");
  EXPECT_SAYS(said, "set LGABENCH_NO_LOCKS=1");
  EXPECT_SAYS(message_of<InputError>([&] { wait_for_lock(none, Lock::exclusive, "/net/out"); }), "has no locks");
  EXPECT_FALSE(is_locked(none));
  const Variable without("LGABENCH_NO_LOCKS", "1");
  EXPECT_TRUE(try_lock(none, Lock::exclusive, path));
  EXPECT_FALSE(try_lock(second.fd, Lock::exclusive, path)) << "a lock that is there still counts";
  wait_for_lock(none, Lock::exclusive, path);
}

TEST(Directories, SayWhatIsInTheWay) {
  const TemporaryDirectory directory;
  const fs::path link = directory.path / "link", file = directory.path / "file";
  fs::create_symlink("nowhere", link);
  write_file(file, "");
  for (const fs::path& made : {link, link / "below"})
    EXPECT_SAYS(message_of<InputError>([&] { make_directories(made); }),
                "cannot be made: " + link.string() + " is a symbolic link to nowhere, which is not there");
  for (const fs::path& made : {file, file / "below"})
    EXPECT_SAYS(message_of<InputError>([&] { make_directories(made); }), file.string() + " is not a directory");
  EXPECT_SAYS(message_of<InputError>([&] { write_file(link / "a", ""); }), "is a symbolic link to nowhere");
  EXPECT_SAYS(message_of<InputError>([&] { make_directories("/proc/none"); }),
              "/proc/none: cannot be made: No such file");
  fs::create_directory(directory.path / "nowhere");
  make_directories(link / "below");
  EXPECT_TRUE(fs::is_directory(directory.path / "nowhere/below"));
}

TEST(Directories, TheTemporaryOneIsNamedWithItsVariable) {
  {
    const Variable wrong("TMPDIR", "/not/on/this/node");
    EXPECT_EQ(message_of<InputError>([] { Scratch("test"); }),
              "TMPDIR=/not/on/this/node: No such file or directory; set TMPDIR to a directory for temporary files");
  }
  const Variable unwritable("TMPDIR", "/proc");
  EXPECT_SAYS(message_of<InputError>([] { Scratch("test"); }), "; set TMPDIR to a directory that can be written");
}

// A root with what /proc and the control groups say.
struct Root : TemporaryDirectory {
  void set(const std::string& file, const std::string& text) const { write_file(path / file, text); }
};

constexpr double none = std::numeric_limits<double>::infinity();

TEST(JobLimits, OfVersion2AreTheLeastOfAllGroupsAbove) {
  const Root root;
  root.set("proc/self/mountinfo", "30 23 0:26 / /sys/fs/cgroup rw,nosuid - cgroup2 cgroup2 rw,nsdelegate\n");
  root.set("proc/self/cgroup", "0::/slurm/job/step\n");
  root.set("sys/fs/cgroup/slurm/job/step/cpu.max", "max 100000\n");
  EXPECT_EQ(cgroup_limits(root.path).cores, none);
  root.set("sys/fs/cgroup/slurm/job/cpu.max", "150000 100000\n");
  root.set("sys/fs/cgroup/slurm/cpu.max", "400000 100000\n");
  root.set("sys/fs/cgroup/slurm/job/step/memory.max", "max\n");
  root.set("sys/fs/cgroup/slurm/job/memory.max", "2147483648\n");
  EXPECT_EQ(cgroup_limits(root.path).cores, 1.5);
  EXPECT_EQ(cgroup_limits(root.path).bytes, 2147483648.0);
}

TEST(JobLimits, OfVersion1AreThoseOfEachController) {
  const Root root;
  root.set("proc/self/mountinfo",
           "31 23 0:27 /docker/4f /sys/fs/cgroup/cpu,cpuacct rw - cgroup cgroup rw,cpu,cpuacct\n"
           "32 23 0:28 /docker/4f /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n");
  root.set("proc/self/cgroup", "5:cpu,cpuacct:/docker/4f/inner\n4:memory:/elsewhere\n");
  root.set("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_quota_us", "-1\n");
  root.set("sys/fs/cgroup/cpu,cpuacct/cpu.cfs_period_us", "100000\n");
  EXPECT_EQ(cgroup_limits(root.path).cores, none);
  root.set("sys/fs/cgroup/cpu,cpuacct/inner/cpu.cfs_quota_us", "50000\n");
  root.set("sys/fs/cgroup/cpu,cpuacct/inner/cpu.cfs_period_us", "100000\n");
  root.set("sys/fs/cgroup/memory/memory.limit_in_bytes", "1073741824\n");
  EXPECT_EQ(cgroup_limits(root.path).cores, .5);
  EXPECT_EQ(cgroup_limits(root.path).bytes, 1073741824.0);
}

TEST(JobLimits, WithoutGroupsThereAreNone) {
  const Root root;
  EXPECT_EQ(cgroup_limits(root.path).cores, none);
  EXPECT_EQ(cgroup_limits(root.path).bytes, none);
}

TEST(JobLimits, SlurmSaysWhatItGave) {
  EXPECT_EQ(slurm_limits().cores, none);
  const Variable job("SLURM_JOB_ID", "7"), node("SLURM_CPUS_ON_NODE", "8"), memory("SLURM_MEM_PER_CPU", "1024");
  EXPECT_EQ(slurm_limits().cores, 8);
  EXPECT_EQ(slurm_limits().bytes, 8.0 * (1 << 30));
  const Variable task("SLURM_CPUS_PER_TASK", "4"), all("SLURM_MEM_PER_NODE", "0");
  EXPECT_EQ(slurm_limits().cores, 4);
  EXPECT_EQ(slurm_limits().bytes, 8.0 * (1 << 30)) << "0 is all that the node has";
}

TEST(JobLimits, AJobHasACoreAndMemory) {
  EXPECT_GE(usable_cores(), 1);
  EXPECT_GT(usable_bytes(), 1e8);
}

// Stacks of threads fit no more into what is left of the address space.
void leave_no_room_for_stacks() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  lowered(RLIMIT_AS, pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + (20 << 20));
}

TEST(Refusals, FewerThreadsDoAllTheWork) {
  EXPECT_EQ(in_a_process([] {
              leave_no_room_for_stacks();
              std::atomic<int> calls = 0;
              std::vector<std::thread> helpers = start_helpers(64, [&calls] { ++calls; });
              const auto started = static_cast<int>(helpers.size());
              for (std::thread& helper : helpers) helper.join();
              if (started >= 64 || calls != started) return 1;
              std::atomic<int> done = 0;
              in_parallel(100, [&done](std::size_t) { ++done; });
              return done == 100 ? 0 : 2;
            }),
            0);
}

TEST(Refusals, AThreadThatIsNeededIsAnError) {
  EXPECT_EQ(
      in_a_process([] {
        leave_no_room_for_stacks();
        std::vector<std::thread> held;
        try {
          while (held.size() < 64) held.push_back(start_thread([] { ::pause(); }));
        } catch (const Refused& e) {
          const std::string said = e.what();
          ::_exit(said.rfind("a thread cannot be started: Resource temporarily unavailable; raise", 0) == 0 ? 0 : 2);
        }
        return 1;
      }),
      0);
}

TEST(Refusals, HaveAWayOn) {
  EXPECT_EQ(
      in_a_process([] {
        const TemporaryDirectory directory;
        lowered(RLIMIT_NOFILE, 5);
        std::vector<Descriptor> all;
        while (all.emplace_back(::open("/dev/null", O_RDONLY)).fd >= 0) continue;
        const std::string said = message_of<Refused>([] { start_process({{"true"}, {}}); });
        return said == "pipe: Too many open files; raise the limit of open files (ulimit -n), or take fewer --jobs" ? 0
                                                                                                                    : 1;
      }),
      0);
}

TEST(Refusals, ADirectoryThatCannotBeSyncedIsNone) {
  EXPECT_SAYS(message_of<InputError>([] { sync_directory("/there/is/none"); }), "cannot be synced: No such file");
  sync_directory("/proc");  // EINVAL
}

TEST(Processes, SayWhyTheyDidNotStart) {
  const auto said = [](const ProcessStart& start) { return message_of<Refused>([&] { start_process(start); }); };
  const TemporaryDirectory directory;
  write_file(directory.path / "text", "no program");
  EXPECT_EQ(said({{"/there/is/no/such/program"}, {}}),
            "/there/is/no/such/program: cannot be started: No such file or directory");
  EXPECT_EQ(said({{(directory.path / "text").string()}, {}}),
            (directory.path / "text").string() + ": cannot be started: Permission denied");
  EXPECT_EQ(said({{"true"}, {}, {}, "/no/directory"}), "/no/directory: cannot be entered: No such file or directory");
  EXPECT_EQ(said({{"true"}, {}, {}, {}, [] { return errno = EPERM, false; }}),
            "true: cannot be prepared: Operation not permitted");
  EXPECT_EQ(said({{"true"}, {}, {{12345, 1}}}), "true: cannot be given its files: Bad file descriptor");
}

TEST(Processes, TheirEndsAreKeptWhoeverStartedUs) {
  EXPECT_EQ(in_a_process([] {
              ::signal(SIGCHLD, SIG_IGN);  // as after a shell's trap '' CHLD
              const int status = wait_for(start_process({{"sh", "-c", "exit 7"}, {"PATH=/usr/bin:/bin"}}));
              return WIFEXITED(status) ? WEXITSTATUS(status) : 99;
            }),
            7);
}

TEST(Processes, AFileInMemoryIsReadFromItsBeginning) {
  const Descriptor in = file_in_memory("one\ntwo\n"), out = file_in_memory();
  EXPECT_EQ(wait_for(start_process({{"cat"}, {"PATH=/usr/bin:/bin"}, {{in.fd, 0}, {out.fd, 1}}})), 0);
  EXPECT_EQ(bytes_of(out), "one\ntwo\n");
}

}  // namespace
}  // namespace lgabench
