// A method that tries to reach out of its process, in the way that its options name, and fails with what came of it:
// "reached" or the name of the error. For confine_test.py.
#pragma once
#include <arpa/inet.h>
#include <dirent.h>
#include <fcntl.h>
#include <linux/fs.h>
#include <pthread.h>
#include <sched.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>

#include "fixture.hpp"

namespace {

using namespace lgabench;

std::string outcome(long result) { return result < 0 ? ::strerrorname_np(errno) : "reached"; }

std::string list_descriptors() {
  std::string open;
  for (int fd = 0; fd < 256; ++fd)
    if (::fcntl(fd, F_GETFD) >= 0) open += std::to_string(fd) + " ";
  return open;
}

std::string variables() {
  std::string names;
  for (char** variable = environ; *variable; ++variable)
    names += std::string(*variable, std::strcspn(*variable, "=")) + " ";
  return names;
}

// A process that nobody waits for, in a session of its own.
std::string leave_a_daemon() {
  if (::fork() == 0) {
    ::setsid();
    if (::fork() == 0)
      for (;;) ::pause();
    ::_exit(0);
  }
  return "left";
}

std::string share_memory(std::size_t bytes) {
  void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return outcome(-1);
  std::memset(memory, 1, bytes);
  ::sleep(20);  // far longer than a look takes, also on a busy machine
  return "reached";
}

// 600 MiB in files, with a name or without one.
std::string fill_disk(bool deleted) {
  const std::string block(1 << 20, 'x');
  for (int i = 0; i < 3; ++i) {
    const std::string name = "file" + std::to_string(i);
    const int file = ::open(name.c_str(), O_WRONLY | O_CREAT, 0600);
    for (int mib = 0; mib < 200; ++mib)
      if (::write(file, block.data(), block.size()) < 0) return outcome(-1);
    if (deleted) ::unlink(name.c_str());
  }
  ::sleep(20);  // far longer than a look takes, also on a busy machine
  return "reached";
}

std::string make_files(int count) {
  for (int i = 0; i < count; ++i) ::close(::open(("file" + std::to_string(i)).c_str(), O_WRONLY | O_CREAT, 0600));
  ::sleep(20);  // far longer than a look takes, also on a busy machine
  return "reached";
}

std::string fill_pipes() {
  const std::string block(1 << 16, 'x');
  int ends[2];
  for (int i = 0; i < 9000; ++i)
    if (::pipe(ends) < 0 || ::write(ends[1], block.data(), block.size()) < 0) return "no more descriptors";
  ::sleep(20);  // far longer than a look takes, also on a busy machine
  return "reached";
}

// What is hard to remove: deep, shut, and moved about.
std::string leave_a_tree(const std::filesystem::path& files) {
  ::mkdir("shut", 0300);
  std::ofstream("shut/file") << "x";
  ::mkdir("closed", 0);
  std::string path = "deep";
  for (int i = 0; i < 40; ++i, path += "/deep") ::mkdir(path.c_str(), 0700);
  std::ofstream(path.substr(0, path.rfind('/')) + "/file") << "x";
  for (int i = 0; i < 2000; ++i) std::ofstream(files / ("file" + std::to_string(i) + ".txt")) << i;
  return "left";
}

// 1.5 GiB of tables for pages that hold nothing.
std::string fill_page_tables() {
  constexpr std::size_t bytes = std::size_t{3} << 38, one_table = 1 << 21;
  void* memory = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (memory == MAP_FAILED) return outcome(-1);
  for (std::size_t at = 0; at < bytes; at += one_table) static_cast<void>(static_cast<volatile char*>(memory)[at]);
  ::sleep(20);  // far longer than a look takes, also on a busy machine
  return "reached";
}

std::string connect_to(int port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = ::htonl(INADDR_LOOPBACK);
  address.sin_port = ::htons(static_cast<std::uint16_t>(port));
  return outcome(socket < 0 ? socket : ::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address));
}

// Another descriptor's end, or the error's name: what a socket pair of that type can be made to do.
long datagrams_to(const std::string& path) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_DGRAM, 0, ends) < 0) return -1;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  return ::sendto(ends[0], "x", 1, 0, reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

long named_socket(const std::string&) {
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) < 0) return -1;
  sockaddr_un address{AF_UNIX, "own"};
  return ::bind(ends[0], reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

long thread_of_its_own(const std::string&) {
  int number = -1;
  std::thread([&number] { number = 0; }).join();
  return number;
}

// As some libraries ask, to learn where its stack lies.
long thread_attributes(const std::string&) {
  int number = -1;
  std::thread([&number] {
    pthread_attr_t attributes;
    number = ::pthread_getattr_np(::pthread_self(), &attributes) == 0 ? 0 : -1;
  }).join();
  return number;
}

// -1 may be the niceness itself.
bool niceness_is_told(pid_t process) {
  errno = 0;
  ::getpriority(PRIO_PROCESS, static_cast<id_t>(process));
  return errno == 0;
}

// Each of what is asked of others below.
long asks_of_itself(const std::string&) {
  cpu_set_t all;
  sched_param schedule{};
  timespec time{};
  char attributes[64];
  for (const pid_t itself : {0, ::getpid()})
    if (::getpgid(itself) < 0 || ::getsid(itself) < 0 || ::sched_getaffinity(itself, sizeof all, &all) != 0 ||
        ::sched_getparam(itself, &schedule) != 0 || ::sched_getscheduler(itself) < 0 ||
        ::syscall(SYS_sched_getattr, itself, attributes, sizeof attributes, 0) != 0 ||
        ::sched_rr_get_interval(itself, &time) != 0 || ::syscall(SYS_ioprio_get, 1, itself) < 0 ||
        !niceness_is_told(itself))
      return -1;
  clockid_t of_this_thread = 0;
  if (::pthread_getcpuclockid(::pthread_self(), &of_this_thread) != 0) return errno = EINVAL, -1;
  for (const clockid_t clock : {CLOCK_REALTIME, CLOCK_MONOTONIC, CLOCK_PROCESS_CPUTIME_ID, CLOCK_THREAD_CPUTIME_ID,
                                CLOCK_MONOTONIC_RAW, CLOCK_MONOTONIC_COARSE, CLOCK_BOOTTIME, of_this_thread})
    if (::syscall(SYS_clock_gettime, clock, &time) != 0) return -1;
  return 0;
}

// As OpenBLAS asks where its buffers shall lie: the upper half of an int is whatever was in the register.
long place_memory(unsigned long flags) {
  void* memory = ::mmap(nullptr, 1 << 16, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  return ::syscall(SYS_mbind, memory, 1 << 16, 1 /* MPOL_PREFERRED */, nullptr, 0, flags);
}

long program_of_its_own(const std::string&) { return std::system("exit 0") == -1 ? -1 : 0; }

long opened(const std::string& path) { return ::open(path.c_str(), O_RDONLY | O_CLOEXEC); }

long page(const std::string& path, int advice) {
  void* memory = ::mmap(nullptr, 4096, PROT_READ, MAP_SHARED, static_cast<int>(opened(path)), 0);
  unsigned char resident = 0;
  return memory == MAP_FAILED ? -1 : advice < 0 ? ::mincore(memory, 4096, &resident) : ::madvise(memory, 4096, advice);
}

// System calls, by name; `path` is a file that may be read, and is the user's.
using Try = long (*)(const std::string& path);
const std::map<std::string, Try> system_calls = {
    // State that outlives the process, on any file of the user.
    {"setxattr", [](const std::string& path) -> long { return ::setxattr(path.c_str(), "user.lgabench", "x", 1, 0); }},
    {"getxattr", [](const std::string& path) -> long { return ::getxattr(path.c_str(), "user.lgabench", nullptr, 0); }},
    {"fsetxattr", [](const std::string& p) { return ::syscall(SYS_fsetxattr, opened(p), "user.lgabench", "x", 1, 0); }},
    {"utimensat", [](const std::string& path) -> long { return ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0); }},
    {"utime", [](const std::string& path) { return ::syscall(SYS_utime, path.c_str(), nullptr); }},
    {"chmod", [](const std::string& path) -> long { return ::chmod(path.c_str(), 0644); }},
    {"fchmod", [](const std::string& p) -> long { return ::fchmod(static_cast<int>(opened(p)), 0644); }},
    {"fchmodat2", [](const std::string& p) { return ::syscall(452, AT_FDCWD, p.c_str(), 0644, 0); }},
    {"setxattrat", [](const std::string& p) { return ::syscall(463, AT_FDCWD, p.c_str(), 0, nullptr, nullptr, 0); }},
    {"chown", [](const std::string& path) -> long { return ::chown(path.c_str(), ::getuid(), ::getgid()); }},
    {"fchownat", [](const std::string& p) -> long { return ::fchownat(AT_FDCWD, p.c_str(), ::getuid(), -1, 0); }},
    {"lock", [](const std::string& p) -> long { return ::syscall(SYS_flock, opened(p), 1); }},
    {"read_lock",
     [](const std::string& p) -> long {
       struct flock all {};
       all.l_type = F_RDLCK;
       return ::fcntl(static_cast<int>(opened(p)), F_SETLK, &all);
     }},
    {"lease", [](const std::string& p) -> long { return ::fcntl(static_cast<int>(opened(p)), F_SETLEASE, F_RDLCK); }},
    {"set_flags",
     [](const std::string& p) -> long {
       long flags = 0;
       return ::ioctl(static_cast<int>(opened(p)), FS_IOC_SETFLAGS, &flags);
     }},
    // The page cache.
    {"mincore", [](const std::string& path) { return page(path, -1); }},
    {"page_out", [](const std::string& path) { return page(path, MADV_PAGEOUT); }},
    {"fadvise", [](const std::string& p) { return ::syscall(SYS_fadvise64, opened(p), 0, 0, POSIX_FADV_DONTNEED); }},
    {"readahead", [](const std::string& p) { return ::syscall(SYS_readahead, opened(p), 0, 4096); }},
    {"preadv2",
     [](const std::string& p) {
       char byte = 0;
       iovec part{&byte, 1};
       return ::syscall(SYS_preadv2, opened(p), &part, 1, 0, 0, 8 /* RWF_NOWAIT */);
     }},
    // Watching, and others' processes.
    {"inotify", [](const std::string&) -> long { return ::inotify_init1(0); }},
    {"fanotify", [](const std::string&) { return ::syscall(SYS_fanotify_init, 0, 0); }},
    {"notify", [](const std::string&) -> long { return ::fcntl(::open(".", O_RDONLY), F_NOTIFY, DN_CREATE); }},
    {"set_owner", [](const std::string&) -> long { return ::fcntl(3, F_SETOWN, ::getppid()); }},
    {"set_signal", [](const std::string&) -> long { return ::fcntl(3, F_SETSIG, SIGKILL); }},
    {"setpriority", [](const std::string&) -> long { return ::setpriority(PRIO_PROCESS, ::getppid(), 19); }},
    {"sched_setaffinity",
     [](const std::string&) -> long {
       cpu_set_t all;
       return ::sched_getaffinity(0, sizeof all, &all) | ::sched_setaffinity(::getppid(), sizeof all, &all);
     }},
    {"sched_setscheduler",
     [](const std::string&) -> long {
       const sched_param none{};
       return ::sched_setscheduler(::getppid(), SCHED_IDLE, &none);
     }},
    {"ioprio_set", [](const std::string&) { return ::syscall(SYS_ioprio_set, 1, ::getppid(), 3 << 13); }},
    {"getpgid", [](const std::string&) -> long { return ::getpgid(::getppid()); }},
    {"getsid", [](const std::string&) -> long { return ::getsid(::getppid()); }},
    {"setpgid", [](const std::string&) -> long { return ::setpgid(::getppid(), 0); }},  // says whether it is a thread's
    {"getpriority", [](const std::string&) { return ::syscall(SYS_getpriority, PRIO_PROCESS, ::getppid()); }},
    {"users_priority", [](const std::string&) { return ::syscall(SYS_getpriority, PRIO_USER, 0); }},
    {"ioprio_get", [](const std::string&) { return ::syscall(SYS_ioprio_get, 1, ::getppid()); }},
    {"groups_ioprio", [](const std::string&) { return ::syscall(SYS_ioprio_get, 2, 0); }},
    {"sched_getaffinity",
     [](const std::string&) -> long {
       cpu_set_t all;
       return ::sched_getaffinity(::getppid(), sizeof all, &all);
     }},
    {"sched_getparam",
     [](const std::string&) -> long {
       sched_param schedule{};
       return ::sched_getparam(::getppid(), &schedule);
     }},
    {"sched_getscheduler", [](const std::string&) -> long { return ::sched_getscheduler(::getppid()); }},
    {"sched_getattr",
     [](const std::string&) {
       char attributes[64];
       return ::syscall(SYS_sched_getattr, ::getppid(), attributes, sizeof attributes, 0);
     }},
    {"sched_rr_get_interval",
     [](const std::string&) -> long {
       timespec time{};
       return ::sched_rr_get_interval(::getppid(), &time);
     }},
    {"get_robust_list",
     [](const std::string&) {
       void* list = nullptr;
       std::size_t size = 0;
       return ::syscall(SYS_get_robust_list, ::getppid(), &list, &size);
     }},
    {"capget",
     [](const std::string&) {
       struct {
         unsigned version;
         int pid;
       } header{0x20080522, ::getppid()};
       unsigned sets[6] = {};
       return ::syscall(SYS_capget, &header, sets);
     }},
    {"clock_gettime",
     [](const std::string&) {
       timespec time{};
       return ::syscall(SYS_clock_gettime, static_cast<clockid_t>(~static_cast<unsigned>(::getppid()) << 3 | 2), &time);
     }},
    {"mbind", [](const std::string&) { return place_memory(4); }},  // MPOL_MF_MOVE_ALL
    {"datagrams", datagrams_to},
    {"named_socket", named_socket},
    {"pipe_size",
     [](const std::string&) -> long {
       int ends[2];
       return ::pipe(ends) | ::fcntl(ends[0], F_SETPIPE_SZ, 1 << 20);
     }},
    {"new_namespace",
     [](const std::string&) -> long {
       const long child = ::syscall(SYS_clone, CLONE_NEWUSER | SIGCHLD, nullptr, nullptr, nullptr, nullptr);
       if (child == 0) ::_exit(0);
       return child;
     }},
    {"device", [](const std::string&) -> long { return ::mknod("device", S_IFCHR | 0600, 1 << 8 | 3); }},
    // What an administrator's process could do.
    {"fspick", [](const std::string&) { return ::syscall(SYS_fspick, AT_FDCWD, ".", 0); }},
    {"quotactl", [](const std::string&) { return ::syscall(SYS_quotactl, 0x80000100, nullptr, 0, nullptr); }},
    {"acct", [](const std::string&) { return ::syscall(SYS_acct, "acct"); }},
    {"setdomainname", [](const std::string&) { return ::syscall(SYS_setdomainname, "x", 0x10000); }},
    {"swapoff", [](const std::string&) { return ::syscall(SYS_swapoff, ""); }},
    {"clock_adjtime", [](const std::string&) { return ::syscall(SYS_clock_adjtime, 100, nullptr); }},
    // What an honest method needs, and what a C library tries first.
    {"clone3", [](const std::string&) { return ::syscall(SYS_clone3, nullptr, 0); }},
    {"unknown", [](const std::string&) { return ::syscall(1000); }},
    {"thread", thread_of_its_own},
    {"thread_attributes", thread_attributes},
    {"asks_of_itself", asks_of_itself},
    {"own_memory", [](const std::string&) { return place_memory(0x7fc600000000); }},
    {"program", program_of_its_own},
};

std::string probe(const std::string& how, const std::string& path, const Command& command, Services& services) {
  char byte = 0;
  if (how == "read") return outcome(::open(path.c_str(), O_RDONLY));
  if (how == "list") return ::opendir(path.c_str()) ? "reached" : outcome(-1);
  if (how == "write") return outcome(::open(path.c_str(), O_WRONLY | O_CREAT, 0600));
  if (how == "own_files") {
    std::ofstream(services.files / "curve.txt") << "a curve";
    return outcome(::symlink("/etc/passwd", (services.files / "leak.txt").c_str()));
  }
  if (how == "stdin") return outcome(::read(0, &byte, 1) == 1 ? 0 : (errno = ENODATA, -1));
  if (how == "socket") return outcome(::socket(AF_INET, SOCK_STREAM, 0));
  if (how == "connect") return connect_to(std::stoi(path.substr(1)));
  if (how == "socket6") return outcome(::socket(AF_INET6, SOCK_DGRAM, 0));
  if (how == "packet_socket") return outcome(::socket(AF_PACKET, SOCK_RAW, 0));
  if (how == "netlink_socket") return outcome(::socket(AF_NETLINK, SOCK_RAW, 0));
  if (how == "unix_socket") return outcome(::socket(AF_UNIX, SOCK_STREAM, 0));
  int ends[2];
  if (how == "socketpair") return outcome(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends));
  if (how == "ptrace") return outcome(::ptrace(PTRACE_ATTACH, ::getppid(), nullptr, nullptr));
  if (how == "kill") return outcome(::kill(::getppid(), 0));
  if (how == "kill_all") return outcome(::kill(-1, 0));
  if (how == "raise") {
    std::signal(SIGUSR1, SIG_IGN);
    return outcome(::raise(SIGUSR1) == 0 ? 0 : -1);
  }
  if (how == "prlimit") return outcome(::prlimit(::getppid(), RLIMIT_NOFILE, nullptr, nullptr));
  if (how == "memory_of_worker") {
    iovec mine{&byte, 1}, theirs{&byte, 1};
    return outcome(::process_vm_readv(::getppid(), &mine, 1, &theirs, 1, 0));
  }
  if (how == "memfd") return outcome(::memfd_create("x", 0));
  if (how == "descriptors") return list_descriptors();
  if (how == "environment") return variables();
  if (how == "daemon") return leave_a_daemon();
  if (how == "disk") return fill_disk(false);
  if (how == "deleted") return fill_disk(true);
  if (how == "many_files") return make_files(12000);
  if (how == "pipes") return fill_pipes();
  if (how == "tree") return leave_a_tree(services.files);
  if (how == "page_tables") return fill_page_tables();
  if (how == "shared_memory") return share_memory(std::size_t{2} << 30);
  if (const auto one = system_calls.find(how); one != system_calls.end()) return outcome(one->second(path));
  if (how == "human") return services.human.specify(command).target.product().object_types.at(0);
  if (how == "truth") return services.truth(command).target.product().object_types.at(0);
  return "no such way";
}

class Probe : public fixture::FixtureMethod<fixture::StayPolicy> {
 public:
  Selection select(const Command& command, const FeatureSpace&, Services& services) override {
    const std::string how = services.options.at("how");
    const std::string found = probe(how, services.options.at("path"), command, services);
    if (how == "own_files" || how == "daemon" || how == "tree" || how == "ask_in_learn") return {};  // the cell goes on
    throw std::runtime_error(how + ": " + found);
  }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    const std::string words = services.options.at("path");
    const Command heart{words.empty() ? "Bring me the heart." : words, "pick_and_place"};
    if (services.options.at("how") == "ask_in_learn")
      services.lm.answer(heart, {"tabletop", {"heart", "star"}, {"red"}}, {{{}, {}, "heart"}, {{}, {}, "star"}});
    return FixtureMethod::learn(demonstrations, services);
  }
};

constexpr char probe_options[] = R"({
  "how": {"default": "descriptors", "help": "what it tries", "source": "test fixture"},
  "path": {"default": "", "help": "of the file, or :PORT", "source": "test fixture"}
})";

}  // namespace
