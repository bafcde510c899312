// Misbehaves once, in a way and a place that its options name. Where it survives that, it is StayPolicy.
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <list>
#include <locale>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "../fixture.hpp"

namespace {

using namespace lgabench;
namespace fs = std::filesystem;

[[noreturn]] void spin() {
  for (volatile int i = 0;; i = i + 1) {
  }
}

[[noreturn]] void allocate_without_end() {
  for (std::list<std::vector<char>> held;;) held.emplace_back(std::size_t{1} << 24, 'x');
}

std::string run;  // its directory, as an option tells

// The directory that its cell is written into: the one hidden entry among the run's cells.
fs::path scratch() {
  for (const auto& entry : fs::directory_iterator(fs::path(run) / "cells"))
    if (entry.path().filename().string()[0] == '.') return entry.path();
  throw std::runtime_error("no cell is being written");
}

// What it does to the files of its run.
void vandalise(const std::string& how) {
  const fs::path own = scratch();
  if (how == "scratch_file" || how == "scratch_gone") fs::remove_all(own);
  if (how == "scratch_file") std::ofstream(own) << "a file";
  if (how == "cells_gone")
    for (const auto& cell : fs::directory_iterator(own.parent_path()))
      if (cell.path() != own) fs::remove_all(cell.path());
  if (how == "link") fs::create_symlink("/etc/hostname", own / "leak.txt");
  if (how == "log_pipe") {
    fs::remove(own / "log.txt");
    ::mkfifo((own / "log.txt").c_str(), 0600);
  }
}

struct Commas : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\1"; }
};

int deeper(int depth) {
  volatile char frame[4096];
  if (depth < 0) return 0;
  frame[depth % 4096] = 'x';
  return deeper(depth + 1) + frame[0];
}

// Of the process, which lgabench's part of it has to bear.
void change_surroundings(const std::string& how) {
  if (how == "chdir" && ::chdir("/") != 0) throw std::runtime_error("chdir");
  if (how == "locale") std::locale::global(std::locale(std::locale::classic(), new Commas));
  if (how == "handlers")
    for (int signal = 1; signal < 32; ++signal) std::signal(signal, SIG_IGN);
}

void fail_inside() { throw std::runtime_error("inside noexcept"); }

void misbehave(const std::string& how) {
  change_surroundings(how);
  if (how == "at_quick_exit") std::quick_exit(3);
  if (how == "noexcept") []() noexcept { fail_inside(); }();
  if (how == "recursion") std::printf("%d", deeper(0));
  if (how == "kill") ::kill(::getpid(), SIGKILL);
  if (how == "close_socket") ::close(3);
  if (how == "replace_socket") ::dup2(1, 3);
  if (how == "scratch_file" || how == "scratch_gone" || how == "cells_gone" || how == "link" || how == "log_pipe")
    vandalise(how);
  if (how == "exit_4") ::_exit(4);
  if (how == "throw_huge") throw std::runtime_error(std::string(std::size_t{48} << 20, 'x'));
  if (how == "flood")
    for (int i = 0; i < 200000; ++i) std::puts("the fixture prints a line of fifty bytes, over and over");
  if (how == "environment")
    for (char** variable = environ; *variable; ++variable) std::puts(*variable);
  if (how == "abort") std::abort();
  if (how == "exit") std::exit(0);
  if (how == "quick_exit") ::_exit(0);
  if (how == "throw") throw std::runtime_error("the fixture's own failure");
  if (how == "throw_int") throw 7;
  if (how == "segfault") {
    volatile char* nowhere = nullptr;
    *nowhere = 'x';
  }
  if (how == "spin") spin();
  if (how == "sleep") ::sleep(600);
  if (how == "allocate") allocate_without_end();
  if (how == "print") {
    std::puts("{\"phase\": \"the fixture's own line\"}");
    for (int i = 0; i < 100000; ++i) std::puts("the fixture prints and prints");
  }
  if (how == "messages") {  // on the worker's own channel: one before anything else is said, then more and more
    static constexpr char line[] = "{\"phase\": \"the fixture's own\"}\n";
    const auto write_line = [] { return ::write(3, line, std::strlen(line)) >= 0; };
    if (write_line())
      std::thread([write_line] {
        while (write_line()) continue;
      }).detach();
  }
  if (how == "fork") {
    [[maybe_unused]] const pid_t both_go_on = ::fork();
  }
  if (how == "fork_and_spin" && ::fork() == 0) spin();
  if (how == "close")
    for (int fd = 0; fd < 1024; ++fd) ::close(fd);
  if (how == "thread") std::thread(spin).detach();
}

class Once : public fixture::StayPolicy {
 public:
  explicit Once(std::string how) : how_(std::move(how)) {}
  Action act(const Observation& observation, const Instruction& instruction) override {
    const std::string how = std::exchange(how_, "");
    misbehave(how);
    Action action = StayPolicy::act(observation, instruction);
    if (how == "nan") action[7] = std::numeric_limits<double>::quiet_NaN();
    return action;
  }

 private:
  std::string how_;
};

class Faulty : public fixture::FixtureMethod<fixture::StayPolicy> {
 public:
  ~Faulty() override { misbehave(at_end_); }
  Selection select(const Command&, const FeatureSpace&, Services& services) override {
    const std::string so = how(services, "select");
    run = services.options.at("run");
    misbehave(so);
    Selection selection;
    if (so == "log") services.log.epoch(1, 1, 0.0);
    if (so == "cost") selection.cost.lm_queries = -5;
    if (so == "cost_nan") selection.cost.human_seconds = std::numeric_limits<double>::quiet_NaN();
    if (so == "long_source") selection.source.assign(std::size_t{20} << 20, 'x');
    if (so == "escape_source") selection.source = "\x1b[31m";
    return selection;
  }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    misbehave(how(services, "learn"));
    at_end_ = how(services, "destroy");
    services.log.epoch(1, static_cast<long long>(demonstrations.size()), 0.0);
    return std::make_unique<Once>(how(services, "act"));
  }

 private:
  static std::string how(const Services& services, const char* place) {
    return services.options.at("where") == place ? services.options.at("how").get<std::string>() : "";
  }

  std::string at_end_;
};

}  // namespace

LGABENCH_METHOD("fixture_faulty", "0.1", "misbehaves once", Faulty, R"({
  "run": {"default": "", "help": "directory of the run that it damages", "source": "test fixture"},
  "where": {"default": "act", "help": "in which call", "source": "test fixture", "values": ["select", "learn", "act",
            "destroy"]},
  "how": {"default": "not", "help": "what it does", "source": "test fixture", "values": ["not", "abort", "exit",
    "quick_exit", "at_quick_exit", "noexcept", "recursion", "kill", "close_socket", "replace_socket", "chdir", "locale",
    "handlers", "throw", "throw_int", "segfault", "spin", "sleep", "allocate", "print", "messages", "fork", "fork_and_spin",
    "close", "thread", "nan", "exit_4", "throw_huge", "flood", "environment", "scratch_file", "scratch_gone",
    "cells_gone", "link", "log_pipe", "log", "cost", "cost_nan", "long_source", "escape_source"]}
})")
