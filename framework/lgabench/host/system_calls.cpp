#include <lgabench/host/system_calls.hpp>

#include <asm/termbits.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/prctl.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sched.h>
#include <seccomp.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include <lgabench/core/terminal.hpp>

namespace lgabench {
namespace {

// A number below 0 is a call that this architecture lacks.
constexpr int always[] = {
    // Descriptors, and files, which Landlock guards. No call changes a mode, an owner, a time or an attribute.
    SCMP_SYS(read), SCMP_SYS(write), SCMP_SYS(readv), SCMP_SYS(writev), SCMP_SYS(pread64), SCMP_SYS(pwrite64),
    SCMP_SYS(preadv), SCMP_SYS(pwritev), SCMP_SYS(lseek), SCMP_SYS(close), SCMP_SYS(close_range), SCMP_SYS(dup),
    SCMP_SYS(dup2), SCMP_SYS(dup3), SCMP_SYS(open), SCMP_SYS(openat), SCMP_SYS(creat), SCMP_SYS(access),
    SCMP_SYS(faccessat), SCMP_SYS(faccessat2), SCMP_SYS(stat), SCMP_SYS(lstat), SCMP_SYS(fstat), SCMP_SYS(newfstatat),
    SCMP_SYS(statx), SCMP_SYS(statfs), SCMP_SYS(fstatfs), SCMP_SYS(getdents), SCMP_SYS(getdents64), SCMP_SYS(readlink),
    SCMP_SYS(readlinkat), SCMP_SYS(getcwd), SCMP_SYS(chdir), SCMP_SYS(fchdir), SCMP_SYS(mkdir), SCMP_SYS(mkdirat),
    SCMP_SYS(rmdir), SCMP_SYS(unlink), SCMP_SYS(unlinkat), SCMP_SYS(rename), SCMP_SYS(renameat), SCMP_SYS(renameat2),
    SCMP_SYS(link), SCMP_SYS(linkat), SCMP_SYS(symlink), SCMP_SYS(symlinkat), SCMP_SYS(truncate), SCMP_SYS(ftruncate),
    SCMP_SYS(fsync), SCMP_SYS(fdatasync), SCMP_SYS(umask), SCMP_SYS(sendfile),
    // Memory of its own.
    SCMP_SYS(brk), SCMP_SYS(mmap), SCMP_SYS(munmap), SCMP_SYS(mprotect), SCMP_SYS(mremap), SCMP_SYS(msync),
    SCMP_SYS(mlock), SCMP_SYS(munlock), SCMP_SYS(membarrier), SCMP_SYS(set_mempolicy),
    // Itself, and waiting for what it starts.
    SCMP_SYS(execve), SCMP_SYS(exit), SCMP_SYS(exit_group), SCMP_SYS(wait4), SCMP_SYS(waitid), SCMP_SYS(getpid),
    SCMP_SYS(getppid), SCMP_SYS(gettid), SCMP_SYS(getpgrp), SCMP_SYS(setsid), SCMP_SYS(getuid), SCMP_SYS(geteuid),
    SCMP_SYS(getgid), SCMP_SYS(getegid), SCMP_SYS(getresuid), SCMP_SYS(getresgid), SCMP_SYS(getgroups),
    SCMP_SYS(getrusage), SCMP_SYS(times), SCMP_SYS(uname), SCMP_SYS(sysinfo), SCMP_SYS(getrlimit), SCMP_SYS(setrlimit),
    SCMP_SYS(arch_prctl), SCMP_SYS(set_tid_address), SCMP_SYS(set_robust_list), SCMP_SYS(rseq), SCMP_SYS(futex),
    SCMP_SYS(futex_waitv), SCMP_SYS(sched_yield), SCMP_SYS(sched_get_priority_max), SCMP_SYS(sched_get_priority_min),
    SCMP_SYS(getcpu), SCMP_SYS(getrandom), SCMP_SYS(restart_syscall),
    // Signals, clocks, events.
    SCMP_SYS(rt_sigaction), SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn), SCMP_SYS(rt_sigpending),
    SCMP_SYS(rt_sigsuspend), SCMP_SYS(rt_sigtimedwait), SCMP_SYS(sigaltstack), SCMP_SYS(signalfd), SCMP_SYS(signalfd4),
    SCMP_SYS(pause), SCMP_SYS(nanosleep), SCMP_SYS(gettimeofday), SCMP_SYS(time), SCMP_SYS(alarm), SCMP_SYS(getitimer),
    SCMP_SYS(setitimer), SCMP_SYS(timer_delete), SCMP_SYS(timer_getoverrun), SCMP_SYS(timer_gettime),
    SCMP_SYS(timer_settime), SCMP_SYS(timerfd_create), SCMP_SYS(timerfd_gettime), SCMP_SYS(timerfd_settime),
    SCMP_SYS(poll), SCMP_SYS(ppoll), SCMP_SYS(select), SCMP_SYS(pselect6), SCMP_SYS(epoll_create),
    SCMP_SYS(epoll_create1), SCMP_SYS(epoll_ctl), SCMP_SYS(epoll_wait), SCMP_SYS(epoll_pwait), SCMP_SYS(epoll_pwait2),
    SCMP_SYS(eventfd), SCMP_SYS(eventfd2), SCMP_SYS(pipe), SCMP_SYS(pipe2),
    // Sockets that it has.
    SCMP_SYS(sendmsg), SCMP_SYS(recvmsg), SCMP_SYS(recvfrom), SCMP_SYS(shutdown), SCMP_SYS(getsockopt),
    SCMP_SYS(getsockname), SCMP_SYS(getpeername)};
constexpr int with_network[] = {SCMP_SYS(connect), SCMP_SYS(bind),       SCMP_SYS(listen),   SCMP_SYS(accept),
                                SCMP_SYS(accept4), SCMP_SYS(setsockopt), SCMP_SYS(sendmmsg), SCMP_SYS(recvmmsg)};

// The argument's bits of the mask are one of the values, the others anything. Callers leave anything in the upper half
// of an int, which the kernel does not read; of a pointer it is 0 too.
struct Condition {
  unsigned argument;
  std::vector<std::uint32_t> values;
  std::uint32_t mask = ~0u;
  bool pointer = false;
};

// BPF, assembled by hand. libseccomp 2.5 has one verdict for every call without a rule, no rule for a range of numbers,
// and no rule with two comparisons of one argument. So a call newer than the list could not get ENOSYS where a refused
// one waits for the listener, nor could sched_getaffinity of another thread; and it kills a process that calls by
// x86-64's other numbering. Every jump is a short one forwards.
class Filter {
 public:
  explicit Filter(std::uint32_t refusal) : refusal_(refusal) {
    load(offsetof(seccomp_data, arch));
    emit(BPF_JMP | BPF_JEQ | BPF_K, seccomp_arch_native(), 1, 0);
    give(SECCOMP_RET_KILL_PROCESS);
    load(offsetof(seccomp_data, nr));
  }

  void allow(int call, const std::vector<Condition>& all = {}) { allow(call, all, refusal_); }
  /// Where a condition does not hold, the verdict is `otherwise`.
  void allow(int call, const std::vector<Condition>& all, std::uint32_t otherwise) {
    if (call < 0) return;
    const std::size_t head = code_.size();
    emit(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 0);
    for (const auto& [argument, values, mask, pointer] : all) {
      if (pointer) {
        load(offsetof(seccomp_data, args) + 8 * argument + 4);
        emit(BPF_JMP | BPF_JEQ | BPF_K, 0, 1, 0);
        give(otherwise);
      }
      load(offsetof(seccomp_data, args) + 8 * argument);
      emit(BPF_ALU | BPF_AND | BPF_K, mask, 0, 0);
      for (std::size_t i = 0; i < values.size(); ++i) emit(BPF_JMP | BPF_JEQ | BPF_K, values[i], values.size() - i, 0);
      give(otherwise);
    }
    give(SECCOMP_RET_ALLOW);
    code_[head].jf = static_cast<std::uint8_t>(code_.size() - head - 1);
  }
  void answer(int call, int error) {
    emit(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call), 0, 1);
    give(SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error));
  }
  /// Of x86-64's other numbering, too. Returns as seccomp() does.
  int install(int last_known, unsigned flags) {
    emit(BPF_JMP | BPF_JGT | BPF_K, static_cast<std::uint32_t>(last_known), 0, 1);
    give(SECCOMP_RET_ERRNO | ENOSYS);
    give(refusal_);
    const sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
    return static_cast<int>(::syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, flags, &program));
  }

 private:
  void emit(int code, std::uint32_t k, std::size_t if_true, std::size_t if_false) {
    code_.push_back(
        {static_cast<std::uint16_t>(code), static_cast<std::uint8_t>(if_true), static_cast<std::uint8_t>(if_false), k});
  }
  void load(std::size_t offset) { emit(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset), 0, 0); }
  void give(std::uint32_t verdict) { emit(BPF_RET | BPF_K, verdict, 0, 0); }

  std::uint32_t refusal_;
  std::vector<sock_filter> code_;
};

constexpr std::uint32_t new_namespace_or_parent = 0x7e028000;  // CLONE_NEW*, CLONE_PARENT

// A process or a thread of the usual kind.
bool starts_task(const seccomp_data& call) {
  return call.nr == SCMP_SYS(fork) || call.nr == SCMP_SYS(vfork) ||
         (call.nr == SCMP_SYS(clone) && (call.args[0] & new_namespace_or_parent) == 0);
}

Filter filter_of(bool network, std::uint32_t refusal) {
  constexpr std::uint32_t socket_type = 0xf;
  const auto self = static_cast<std::uint32_t>(::getpid());  // stays its own over exec
  Filter filter(refusal);
  for (const int call : always) filter.allow(call);
  if (refusal != SECCOMP_RET_USER_NOTIF) {  // else each start is asked for, and counted
    for (const int call : {SCMP_SYS(fork), SCMP_SYS(vfork)}) filter.allow(call);
    filter.allow(SCMP_SYS(clone), {{0, {0}, new_namespace_or_parent}});
  }
  filter.allow(SCMP_SYS(socketpair), {{0, {AF_UNIX}}, {1, {SOCK_STREAM, SOCK_SEQPACKET}, socket_type}});
  filter.allow(SCMP_SYS(fcntl),
               {{1, {F_DUPFD, F_DUPFD_CLOEXEC, F_GETFD, F_SETFD, F_GETFL, F_SETFL}}});  // no owner, lease, lock or hint
  filter.allow(SCMP_SYS(ioctl), {{1, {FIOCLEX, FIONCLEX, FIONBIO, FIONREAD, TCGETS, TIOCGWINSZ}}});
  for (const int call : {SCMP_SYS(kill), SCMP_SYS(tgkill), SCMP_SYS(rt_sigqueueinfo), SCMP_SYS(rt_tgsigqueueinfo)})
    filter.allow(call, {{0, {self}}});
  // Of itself alone, and not by the number of one of its threads.
  for (const int call : {SCMP_SYS(getpgid), SCMP_SYS(setpgid), SCMP_SYS(getsid), SCMP_SYS(prlimit64),
                         SCMP_SYS(get_robust_list), SCMP_SYS(sched_getparam), SCMP_SYS(sched_getscheduler),
                         SCMP_SYS(sched_getattr), SCMP_SYS(sched_rr_get_interval)})
    filter.allow(call, {{0, {0, self}}});
  filter.allow(SCMP_SYS(getpriority), {{0, {PRIO_PROCESS}}, {1, {0, self}}});
  filter.allow(SCMP_SYS(ioprio_get), {{0, {1 /* IOPRIO_WHO_PROCESS */}}, {1, {0, self}}});
  // pthread_getattr_np() asks for its thread's by number, and does without where the kernel has none.
  filter.allow(SCMP_SYS(sched_getaffinity), {{0, {0, self}}}, SECCOMP_RET_ERRNO | ENOSYS);
  // A clock's number below 0 is another process's, unless it has the bit of threads, which are its own.
  constexpr std::uint32_t below_0 = 1u << 31, of_thread = 1u << 2;
  for (const int call :
       {SCMP_SYS(clock_gettime), SCMP_SYS(clock_getres), SCMP_SYS(clock_nanosleep), SCMP_SYS(timer_create)})
    filter.allow(call, {{0, {0, of_thread, below_0 | of_thread}, below_0 | of_thread}});
  filter.allow(SCMP_SYS(get_mempolicy), {{4, {0}}});
  filter.allow(SCMP_SYS(mbind), {{5, {0}}});
  filter.allow(SCMP_SYS(madvise),
               {{2,
                 {MADV_NORMAL, MADV_RANDOM, MADV_SEQUENTIAL, MADV_WILLNEED, MADV_DONTNEED, MADV_FREE, MADV_DONTFORK,
                  MADV_DOFORK, MADV_HUGEPAGE, MADV_NOHUGEPAGE, MADV_DONTDUMP, MADV_DODUMP, MADV_WIPEONFORK,
                  MADV_KEEPONFORK, MADV_POPULATE_READ, MADV_POPULATE_WRITE}}});
  filter.allow(SCMP_SYS(prctl),
               {{0,
                 {PR_SET_NAME, PR_GET_NAME, PR_SET_PDEATHSIG, PR_GET_PDEATHSIG, PR_GET_DUMPABLE, PR_SET_NO_NEW_PRIVS,
                  PR_GET_NO_NEW_PRIVS, PR_CAPBSET_READ, PR_SET_THP_DISABLE, PR_GET_THP_DISABLE, PR_SET_VMA}}});
  if (network) {
    for (const int call : with_network) filter.allow(call);
    filter.allow(SCMP_SYS(sendto));
    filter.allow(SCMP_SYS(socket), {{0, {AF_INET, AF_INET6}}, {1, {SOCK_STREAM, SOCK_DGRAM}, socket_type}});
  } else {
    filter.allow(SCMP_SYS(sendto), {{4, {0}, ~0u, true}});  // to no address
  }
  // A C library falls back to clone and to writing. Blocks that are only reserved would fill a disk at once.
  filter.answer(SCMP_SYS(clone3), ENOSYS);
  filter.answer(SCMP_SYS(fallocate), EOPNOTSUPP);
  return filter;
}

// The last call of Linux 6.1, which libseccomp knows by name.
constexpr int last_known = 450;

}  // namespace

bool has_seccomp() {
  const std::uint32_t action = SECCOMP_RET_ERRNO;
  return ::syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &action) == 0;
}

bool refuse_internet() {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
  scmp_filter_ctx filter = ::seccomp_init(SCMP_ACT_ALLOW);
  if (!filter) return false;
  bool is_added =
      ::seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(io_uring_setup), 0) == 0;  // it opens some
  for (const int family : {AF_INET, AF_INET6, AF_PACKET, AF_VSOCK})
    is_added = is_added && ::seccomp_rule_add(filter, SCMP_ACT_ERRNO(EACCES), SCMP_SYS(socket), 1,
                                              SCMP_A0_32(SCMP_CMP_EQ, static_cast<std::uint32_t>(family))) == 0;
  const bool is_loaded = is_added && ::seccomp_load(filter) == 0;
  ::seccomp_release(filter);
  return is_loaded;
}

bool allow_system_calls(bool network, int socket) {
  Descriptor notifier;
  if (socket >= 0)
    notifier.fd = filter_of(network, SECCOMP_RET_USER_NOTIF).install(last_known, SECCOMP_FILTER_FLAG_NEW_LISTENER);
  if (notifier.fd < 0 && filter_of(network, SECCOMP_RET_ERRNO | EPERM).install(last_known, 0) != 0) return false;
  if (socket < 0) return true;
  char byte = 0;
  iovec part{&byte, 1};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  if (notifier.fd >= 0) {
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    cmsghdr* rights = CMSG_FIRSTHDR(&message);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(rights), &notifier.fd, sizeof(int));
  }
  return ::sendmsg(socket, &message, MSG_NOSIGNAL) == 1;
}

NotedCalls::NotedCalls(int socket) {
  char byte = 0;
  iovec part{&byte, 1};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  message.msg_control = control;
  message.msg_controllen = CMSG_LEN(sizeof(int));
  ssize_t got = 0;
  while ((got = ::recvmsg(socket, &message, MSG_CMSG_CLOEXEC)) < 0 && errno == EINTR) {
  }
  if (const cmsghdr* rights = got == 1 ? CMSG_FIRSTHDR(&message) : nullptr) {
    int received = -1;
    std::memcpy(&received, CMSG_DATA(rights), sizeof received);
    notifier_ = Descriptor(received);
  } else if (got == 1) {
    to_stdout("refused system calls cannot be named: seccomp has no notifier here\n");
  }
}

void NotedCalls::take(short events) {
  constexpr std::size_t most = 64;
  if ((events & POLLIN) == 0) {  // nobody is left whose calls could be refused
    if (events != 0) notifier_.close();
    return;
  }
  seccomp_notif* call = nullptr;
  seccomp_notif_resp* answer = nullptr;
  if (::seccomp_notify_alloc(&call, &answer) != 0) return;
  if (::seccomp_notify_receive(notifier_.fd, call) == 0) {
    const bool starts = starts_task(call->data);
    started_ += starts;
    answer->id = call->id;
    answer->error = starts ? 0 : -EPERM;
    answer->flags = starts ? SECCOMP_USER_NOTIF_FLAG_CONTINUE : 0;  // all that was looked at is in registers
    ::seccomp_notify_respond(notifier_.fd, answer);
    if (!starts && seen_.size() < most && seen_.insert(call->data.nr).second) {
      char* const name = ::seccomp_syscall_resolve_num_arch(SCMP_ARCH_NATIVE, call->data.nr);
      names_.emplace_back(name ? name : "call " + std::to_string(call->data.nr));
      std::free(name);
      to_stdout("system call refused: {}\n", names_.back());
    }
  }
  ::seccomp_notify_free(call, answer);
}

}  // namespace lgabench
