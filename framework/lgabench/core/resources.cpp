#include <lgabench/core/resources.hpp>

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace lgabench {
namespace {

constexpr double no_limit = std::numeric_limits<double>::infinity();

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream text(line);
  std::vector<std::string> words;
  for (std::string word; text >> word;) words.push_back(word);
  return words;
}

std::vector<std::string> parts_of(const std::string& text, char at) {
  std::istringstream all(text);
  std::vector<std::string> parts;
  for (std::string part; std::getline(all, part, at);) parts.push_back(part);
  return parts;
}

bool lists(const std::string& text, const std::string& wanted) {
  const std::vector<std::string> all = parts_of(text, ',');
  return std::count(all.begin(), all.end(), wanted) > 0;
}

// A tree of control groups: one for all controllers in version 2 ("": unified), some for one or two in version 1.
struct Tree {
  std::string root;   // the group that is mounted
  std::string where;  // it is mounted there
};

Tree tree_of(const fs::path& root, const std::string& controller) {
  std::ifstream file(root / "proc/self/mountinfo");
  for (std::string line; std::getline(file, line);) {
    const std::vector<std::string> words = words_of(line);
    const auto dash = std::find(words.begin(), words.end(), "-");
    if (words.size() < 5 || words.end() - dash < 4) continue;
    const bool wanted = controller.empty() ? dash[1] == "cgroup2" : dash[1] == "cgroup" && lists(dash[3], controller);
    if (wanted) return {words[3], words[4]};
  }
  return {};
}

// The process's group and those above it, as directories; none where the controller has no tree.
std::vector<fs::path> groups(const fs::path& root, const std::string& controller) {
  const Tree tree = tree_of(root, controller);
  if (tree.where.empty()) return {};
  std::string path;  // HIERARCHY:CONTROLLERS:GROUP
  std::ifstream file(root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const std::vector<std::string> parts = parts_of(line, ':');
    if (parts.size() >= 3 && (controller.empty() ? parts[1].empty() : lists(parts[1], controller)))
      path = line.substr(parts[0].size() + parts[1].size() + 2);
  }
  if (tree.root != "/" && path.rfind(tree.root, 0) == 0) path = path.substr(tree.root.size());
  const fs::path top = root / fs::path(tree.where).relative_path();
  fs::path group = top / fs::path(path).relative_path();
  std::error_code not_there;
  if (!fs::is_directory(group, not_there)) group = top;  // a container may name the group as the machine does
  std::vector<fs::path> all{group};
  while (all.back() != top && all.back().has_relative_path()) all.push_back(all.back().parent_path());
  return all;
}

// The numbers of a file of a group; "max" is none, and so is a file that is not there.
std::vector<double> numbers_in(const fs::path& file) {
  std::ifstream text(file);
  std::vector<double> numbers;
  for (std::string word; text >> word && word != "max";) numbers.push_back(std::strtod(word.c_str(), nullptr));
  return numbers;
}

double number_in(const fs::path& file) {
  const std::vector<double> numbers = numbers_in(file);
  return numbers.empty() ? no_limit : numbers.front();
}

// A variable's number; none where it is not set, or is none.
double number_of(const char* name) {
  const char* const text = std::getenv(name);
  const double value = text ? std::strtod(text, nullptr) : 0;
  return value > 0 ? value : no_limit;
}

// The processors that the scheduler gives this thread.
double affinity() {
  for (std::size_t most = CPU_SETSIZE; most <= std::size_t{1} << 20; most *= 2) {
    cpu_set_t* const set = CPU_ALLOC(most);
    if (!set) break;
    const std::size_t bytes = CPU_ALLOC_SIZE(most);
    const bool known = ::sched_getaffinity(0, bytes, set) == 0;
    const int reason = errno, count = known ? CPU_COUNT_S(bytes, set) : 0;
    CPU_FREE(set);
    if (known) return count;
    if (reason != EINVAL) break;  // EINVAL: the machine has more processors than the set has room for
  }
  return std::max(1u, std::thread::hardware_concurrency());
}

}  // namespace

JobLimits cgroup_limits(const fs::path& root) {
  JobLimits limits;
  for (const fs::path& group : groups(root, "")) {
    if (const std::vector<double> quota = numbers_in(group / "cpu.max"); quota.size() == 2 && quota[1] > 0)
      limits.cores = std::min(limits.cores, quota[0] / quota[1]);
    limits.bytes = std::min(limits.bytes, number_in(group / "memory.max"));
  }
  for (const fs::path& group : groups(root, "cpu")) {
    const double quota = number_in(group / "cpu.cfs_quota_us"), period = number_in(group / "cpu.cfs_period_us");
    if (quota > 0 && quota < no_limit && period > 0) limits.cores = std::min(limits.cores, quota / period);  // -1: none
  }
  for (const fs::path& group : groups(root, "memory"))
    limits.bytes = std::min(limits.bytes, number_in(group / "memory.limit_in_bytes"));
  return limits;
}

JobLimits slurm_limits() {
  constexpr double mib = 1 << 20;
  if (!std::getenv("SLURM_JOB_ID")) return {};
  const double of_node = number_of("SLURM_CPUS_ON_NODE");
  JobLimits limits{std::min(number_of("SLURM_CPUS_PER_TASK"), of_node), number_of("SLURM_MEM_PER_NODE") * mib};
  if (of_node < no_limit) limits.bytes = std::min(limits.bytes, number_of("SLURM_MEM_PER_CPU") * mib * of_node);
  return limits;
}

int usable_cores() {
  static const int cores = [] {
    const double least = std::min({affinity(), cgroup_limits().cores, slurm_limits().cores});
    return static_cast<int>(std::max(1.0, std::ceil(least)));
  }();
  return cores;
}

double usable_bytes() {
  static const double bytes = [] {
    const double machine =
        static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGE_SIZE));
    return std::min({machine, cgroup_limits().bytes, slurm_limits().bytes});
  }();
  return bytes;
}

}  // namespace lgabench
