// Tells a method whose cell is computed at the same time a number, in the way that its option names, and fails with the
// number that it hears from that one. For training seeds 0 and 1.
#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <chrono>
#include <climits>
#include <future>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "../fixture.hpp"

namespace {

using namespace lgabench;
using Clock = std::chrono::steady_clock;

// Words of a page of the plugin's own file, which everybody may map and nobody can change.
class Page {
 public:
  explicit Page(const std::string& file)
      : words_(
            static_cast<unsigned*>(::mmap(nullptr, 4096, PROT_READ, MAP_SHARED, ::open(file.c_str(), O_RDONLY), 0))) {
    if (words_ == MAP_FAILED) throw std::runtime_error("cannot map " + file);
  }
  /// Waits there from now on.
  void stay_at(int word) const {
    std::thread([at = words_ + word] { stay(at); }).detach();
  }
  /// Waits there once what is returned is set.
  std::promise<void> stay_later_at(int word) const {
    std::promise<void> begin;
    std::thread([at = words_ + word, begun = begin.get_future()]() mutable {
      begun.wait();
      stay(at);
    }).detach();
    return begin;
  }
  bool somebody_is_at(int word) const {
    return ::syscall(SYS_futex, words_ + word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0) > 0;
  }

 private:
  static void stay(unsigned* at) {
    for (;;) ::syscall(SYS_futex, at, FUTEX_WAIT, *at, nullptr, nullptr, 0);
  }

  unsigned* words_;
};

// Three steps, at each of which one method waits for the other. All threads begin at once: nobody's number of threads
// changes while the other one counts them.
class Meetings {
 public:
  Meetings(const Page& page, int own) : page_(page), own_(own) {
    for (int step = 0; step < 3; ++step) begin_.push_back(page.stay_later_at(100 + 2 * step + own));
  }
  void next() {
    begin_[step_].set_value();
    const int other = 100 + 2 * static_cast<int>(step_++) + (1 - own_);
    for (const auto end = Clock::now() + std::chrono::seconds(60); Clock::now() < end;) {
      if (page_.somebody_is_at(other)) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    throw std::runtime_error("met nobody");
  }

 private:
  const Page& page_;
  int own_;
  std::size_t step_ = 0;
  std::vector<std::promise<void>> begin_;
};

void start_group(int members) {
  pid_t first = 0;
  for (int i = 0; i < members; ++i) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::setpgid(0, first);
      for (;;) ::pause();
    }
    if (i == 0) first = child;
  }
}

void start_threads(int count) {
  for (int i = 0; i < count; ++i)
    std::thread([] {
      for (;;) ::pause();
    }).detach();
}

// What is found of processes with numbers near one's own.
template <class Look>
void look_around(Look look) {
  for (pid_t pid = std::max(1, ::getpid() - 10000); pid < ::getpid() + 10000; ++pid)
    if (pid != ::getpid()) look(pid);
}

// The numbers are 40 and 41; 0: nothing was heard.
int hear(const std::string& how, const Page& page, int own) {
  const int first = 40;
  int heard = 0;
  if (how == "futex")
    for (int word = first; word < first + 2; ++word)
      if (word != first + own && page.somebody_is_at(word)) heard = word;
  std::map<pid_t, int> members;
  if (how == "group")
    look_around([&](pid_t pid) {
      const pid_t group = ::getpgid(pid);
      if (group > 0) ++members[group];
    });
  for (const auto& [group, size] : members)
    if (size == first + (1 - own)) heard = size;
  const auto threads_of = [](pid_t pid) {  // as the links of a directory tell
    struct stat about {};
    return ::stat(("/proc/" + std::to_string(pid) + "/task").c_str(), &about) == 0 ? static_cast<int>(about.st_nlink)
                                                                                   : 0;
  };
  const int other = threads_of(::getpid()) + (own == 0 ? 1 : -1);
  if (how == "threads") look_around([&](pid_t pid) { heard = threads_of(pid) == other ? first + (1 - own) : heard; });
  return heard;
}

class Neighbour : public fixture::FixtureMethod<fixture::StayPolicy> {
 public:
  Selection select(const Command&, const FeatureSpace&, Services& services) override {
    const std::string how = services.options.at("how");
    const Page page(services.options.at("file"));
    const int own = services.seed == 0 ? 0 : 1, number = 40 + own;
    Meetings meetings(page, own);
    meetings.next();
    if (how == "futex") page.stay_at(number);
    if (how == "group") start_group(number);
    if (how == "threads") start_threads(number);
    meetings.next();
    int heard = 0;
    const auto end = Clock::now() + std::chrono::seconds(how == "group" ? 1 : 30);  // of groups nothing is heard
    while (heard == 0 && Clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      heard = hear(how, page, own);
    }
    meetings.next();
    std::this_thread::sleep_for(std::chrono::seconds(3));  // until the other one has met this one, too
    throw std::runtime_error("heard " + std::to_string(heard));
  }
};

}  // namespace

LGABENCH_METHOD("fixture_neighbour", "0.1", "tells another cell a number", Neighbour, R"({
  "how": {"default": "futex", "help": "by what", "values": ["futex", "group", "threads"], "source": "test fixture"},
  "file": {"default": "", "help": "its own", "source": "test fixture"}
})")
