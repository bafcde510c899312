// A method that tries to reach out of its process, in the way that its options name, and fails with what came of it:
// "reached" or the name of the error. For confine_test.py.
#pragma once
#include <arpa/inet.h>
#include <dirent.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string>

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
  ::sleep(2);
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
  if (how == "shared_memory") return share_memory(std::size_t{2} << 30);
  if (how == "human") return services.human.specify(command).target.object_types.at(0);
  if (how == "truth") return services.truth(command).target.object_types.at(0);
  return "no such way";
}

class Probe : public fixture::FixtureMethod<fixture::StayPolicy> {
 public:
  Selection select(const Command& command, const FeatureSpace&, Services& services) override {
    const std::string how = services.options.at("how");
    const std::string found = probe(how, services.options.at("path"), command, services);
    if (how == "own_files" || how == "daemon" || how == "ask_in_learn") return {};  // the cell goes on
    throw std::runtime_error(how + ": " + found);
  }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    const Command heart{"Bring me the heart.", "pick_and_place"};
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
