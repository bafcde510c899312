// Tries, in the way that its option names, to do harm beyond its own cell. Where it survives that, it is StayPolicy.
// hostile.py is the same in Python; hostile_test.py runs both.
#include <dlfcn.h>
#include <pthread.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cfenv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <lgabench/core/error.hpp>

#include "../fixture.hpp"

namespace {

using namespace lgabench;
namespace fs = std::filesystem;

void tell(const char* what, bool reached) { std::printf("%s: %s\n", what, reached ? "reached" : "refused"); }

// Other cells, and the demonstrations that other methods will learn from.
void damage(const fs::path& run, const fs::path& cache) {
  std::error_code error;
  tell("run.json", std::ofstream(run / "run.json").is_open());
  fs::remove_all(run / "cells", error);
  tell("cells", !error);
  fs::create_symlink("/etc/hostname", run / "leak.txt", error);
  tell("a link", !error);
  tell("the cache", std::ofstream(cache / "planted.hdf5").is_open());
}

void leave_a_daemon() {
  if (::fork() != 0) return;
  ::setsid();
  if (::fork() == 0)
    for (;;) ::pause();
  ::_exit(0);
}

void fill_shared_memory() {
  constexpr std::size_t bytes = std::size_t{1} << 30;
  void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return;
  std::memset(memory, 1, bytes);
  ::sleep(2);
}

// 4,000 of a program that lies beside the plugin.
void start_processes() {
  Dl_info own{};
  ::dladdr(reinterpret_cast<void*>(&start_processes), &own);
  const std::string program = fs::path(own.dli_fname).replace_filename("many");
  if (::fork() == 0) {
    ::execl(program.c_str(), program.c_str(), "4000", nullptr);
    ::_exit(1);
  }
  ::sleep(20);  // far longer than a look takes, also on a busy machine
}

void start_threads() {
  pthread_attr_t small;
  ::pthread_attr_init(&small);
  ::pthread_attr_setstacksize(&small, 1 << 16);
  pthread_t thread{};
  for (int i = 0; i < 4000; ++i)
    ::pthread_create(
        &thread, &small, [](void*) -> void* { return ::pause(), nullptr; }, nullptr);
  ::sleep(20);  // far longer than a look takes, also on a busy machine
}

void do_harm(const std::string& how, const Services& services) {
  const auto path = [&](const char* option) { return fs::path(services.options.at(option).get<std::string>()); };
  if (how == "rounding") std::fesetround(FE_TOWARDZERO);
  if (how == "others") damage(path("run"), path("cache"));
  if (how == "link") fs::create_symlink("/etc/passwd", services.files / "leak.txt");
  if (how == "directory_link") {  // which leads to what its worker may read
    fs::remove(services.files);
    fs::create_directory_symlink("/etc", services.files);
  }
  if (how == "epoch") services.log.epoch(0, 1, 0);
  if (how == "shared_memory") fill_shared_memory();
  if (how == "processes") start_processes();
  if (how == "threads") start_threads();
  if (how == "daemon") leave_a_daemon();
  if (how == "fork" && ::fork() < 0) throw std::runtime_error("no process");  // both go on
  if (how == "kill" || (how == "game" && services.seed != 1)) ::kill(::getpid(), SIGKILL);
  if (how == "spoof") {
    constexpr char line[] = "{\"reason\": \"the disk is full\", \"fault\": \"host\"}\n";
    [[maybe_unused]] const ssize_t written = ::write(3, line, sizeof line - 1);
  }
  if (how == "input_error") throw InputError("run.json: the disk is full");
  if (how == "descriptors") {
    const rlimit one{1, 1};
    ::setrlimit(RLIMIT_NOFILE, &one);
  }
  if (how == "flood")
    for (int i = 0; i < 200000; ++i) std::puts("the fixture prints a line of fifty bytes, over and over");
  if (how == "exit_4") ::_exit(4);
}

class Hostile : public fixture::FixtureMethod<fixture::StayPolicy> {
 public:
  Selection select(const Command& command, const FeatureSpace&, Services& services) override {
    return services.options.at("how") == "people" ? services.human.specify(command) : Selection();
  }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    const std::string how = services.options.at("how");
    if (how == "loss") {  // so large that adding 1 changes nothing
      services.log.epoch(1, 1, 1.8e19);
      return std::make_unique<fixture::StayPolicy>();
    }
    do_harm(how, services);
    return FixtureMethod::learn(demonstrations, services);
  }
};

}  // namespace

LGABENCH_METHOD("fixture_hostile", "0.1", "tries to do harm beyond its own cell", Hostile, R"({
  "how": {"default": "", "help": "what it tries", "source": "test fixture"},
  "run": {"default": "", "help": "the run's directory", "source": "test fixture"},
  "cache": {"default": "", "help": "the directory of demonstrations", "source": "test fixture"}
})")
