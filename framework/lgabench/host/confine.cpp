#include <lgabench/host/confine.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/landlock.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <iterator>

#include <lgabench/core/error.hpp>
#include <lgabench/host/reach.hpp>
#include <lgabench/host/system_calls.hpp>

namespace lgabench {
namespace {

namespace fs = std::filesystem;

// The kernel's interface, whose headers may be older than the kernel (include/uapi/linux/landlock.h).
struct Ruleset {
  std::uint64_t handled_access_fs, handled_access_net, scoped;
};
constexpr std::uint64_t execute = 1 << 0, write_file = 1 << 1, read_file = 1 << 2, read_dir = 1 << 3,
                        truncate = 1 << 14, ioctl_dev = 1 << 15;
constexpr std::uint64_t reading = execute | read_file | read_dir;
constexpr std::uint64_t of_files = execute | write_file | read_file | truncate | ioctl_dev;  // what a file can have

constexpr std::uint64_t devices_and_sockets = 1 << 6 | 1 << 9 | 1 << 10 | 1 << 11;  // that mknod and bind make

std::uint64_t handled_by(int version) {
  const int bits = version >= 5 ? 16 : version >= 3 ? 15 : version >= 2 ? 14 : 13;
  return (std::uint64_t{1} << bits) - 1;
}

std::size_t ruleset_bytes(int version) { return version >= 6 ? 24 : version >= 4 ? 16 : 8; }

bool is_below(const fs::path& path, const fs::path& directory) {
  const auto [end, ignored] = std::mismatch(directory.begin(), directory.end(), path.begin(), path.end());
  return end == directory.end();
}

// For what is there, and not for a link unless it is followed. False where the kernel refuses.
bool add_rule(int rules, const fs::path& path, std::uint64_t access, bool follow = true) {
  const Descriptor opened(::open(path.c_str(), O_PATH | O_CLOEXEC | (follow ? 0 : O_NOFOLLOW)));
  struct stat status {};
  if (opened.fd < 0 || ::fstat(opened.fd, &status) != 0 || S_ISLNK(status.st_mode)) return true;
  const landlock_path_beneath_attr rule{S_ISDIR(status.st_mode) ? access : access & of_files, opened.fd};
  return ::syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
}

class Rules {
 public:
  Rules(int version, bool network) : handled_(handled_by(version)) {
    constexpr std::uint64_t bind_and_connect_tcp = 3, signals_and_abstract_sockets = 3;
    const Ruleset ruleset{handled_, version >= 4 && !network ? bind_and_connect_tcp : 0,
                          version >= 6 ? signals_and_abstract_sockets : 0};
    file = Descriptor(static_cast<int>(::syscall(SYS_landlock_create_ruleset, &ruleset, ruleset_bytes(version), 0)));
    if (file.fd < 0) throw EngineError(fmt::format("Landlock: {}", std::strerror(errno)));
  }

  void add(const fs::path& path, std::uint64_t access, bool follow = true) const {
    if (!add_rule(file.fd, path, access & handled_, follow))
      throw EngineError(fmt::format("Landlock: {}: {}", path.string(), std::strerror(errno)));
  }

  // All of the directory but what is hidden or unread: then its entries one by one, since a rule cannot take back
  // another. It can still be listed where nothing below is hidden: Python finds no module in a directory otherwise.
  void add_visible(const fs::path& path, const std::vector<fs::path>& hidden,
                   const std::vector<fs::path>& unread) const {
    const auto is_within = [&path](const fs::path& one) { return is_below(path, one); };
    const auto lies_below = [&path](const fs::path& one) { return is_below(one, path); };
    const auto any = [](const std::vector<fs::path>& all, const auto& what) {
      return std::any_of(all.begin(), all.end(), what);
    };
    if (any(hidden, is_within) || any(unread, is_within)) return;
    const bool hides = any(hidden, lies_below);
    if (!hides && !any(unread, lies_below)) return add(path, reading, false);
    if (!hides) add(path, read_dir, false);
    std::error_code unreadable;
    for (const auto& entry : fs::directory_iterator(path, unreadable)) add_visible(entry.path(), hidden, unread);
  }

  Descriptor file;

 private:
  std::uint64_t handled_;
};

}  // namespace

int landlock_version() {
  constexpr unsigned version_flag = 1;
  return std::max(0, static_cast<int>(::syscall(SYS_landlock_create_ruleset, nullptr, 0, version_flag)));
}

std::string confinement_text() {
  std::string text = "no Landlock (files)";
  if (const int version = landlock_version(); version > 0) {
    std::vector<std::string> without;
    if (version < 3) without.emplace_back("truncation");
    if (version < 4) without.emplace_back("TCP");
    if (version < 6) without.emplace_back("signals");
    text = fmt::format("Landlock {}", version);
    if (!without.empty()) text += fmt::format(" (without: {})", fmt::join(without, ", "));
  }
  return text + (has_seccomp() ? ", seccomp" : ", no seccomp (system calls)");
}

// What the C library, OpenSSL and Python read to find a server and to trust it, in Debian's places and Fedora's.
constexpr const char* for_network[] = {
    "/etc/resolv.conf",
    "/etc/hosts",
    "/etc/host.conf",
    "/etc/nsswitch.conf",
    "/etc/gai.conf",
    "/etc/services",
    "/etc/protocols",
    "/etc/ssl/certs",
    "/etc/ssl/cert.pem",
    "/usr/share/ca-certificates",
    "/usr/local/share/ca-certificates",
    "/etc/ca-certificates",
    "/etc/pki/tls/certs",
    "/etc/pki/tls/cert.pem",
    "/etc/pki/ca-trust/extracted",
};

Confinement::Confinement(const Reach& reach) : network_(reach.network) {
  const int version = landlock_version();
  if (version == 0) return;
  Rules rules(version, network_);
  std::vector<fs::path> hidden, unread;
  std::error_code not_there;
  for (const fs::path& path : reach.hidden) hidden.push_back(fs::weakly_canonical(path, not_there));
  for (const fs::path& path : reach.unread) unread.push_back(fs::weakly_canonical(path, not_there));
  std::vector<fs::path> reads = reach.reads;
  if (network_) reads.insert(reads.end(), std::begin(for_network), std::end(for_network));
  for (const fs::path& path : reads) {
    const fs::path real = fs::canonical(path, not_there);
    if (!not_there) rules.add_visible(real, hidden, unread);
  }
  for (const fs::path& path : reach.folders) {
    const fs::path real = fs::canonical(path, not_there);
    if (not_there) continue;
    std::vector<fs::path> unread_here = unread, with_own{real};  // folders whose dotfiles are a person's own
    if (const auto home = home_in(real); home && *home != real) with_own.push_back(*home);
    std::error_code unreadable;
    for (const fs::path& folder : with_own)
      for (const auto& entry : fs::directory_iterator(folder, unreadable))
        if (entry.path().filename().string().front() == '.') unread_here.push_back(entry.path());
    rules.add_visible(real, hidden, unread_here);
  }
  for (const fs::path& path : reach.writes) rules.add(path, ~devices_and_sockets);
  rules_ = std::move(rules.file);
}

// The process's own view of itself, without that of the network and of who else maps its pages.
constexpr const char* of_itself[] = {"auxv",   "cgroup",    "cmdline", "comm", "environ", "fd",    "fdinfo",
                                     "limits", "mountinfo", "mounts",  "maps", "stat",    "statm", "status"};

bool Confinement::apply(int socket) const {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return false;
  if (rules_.fd >= 0) {
    add_rule(rules_.fd, "/proc/self", read_dir);  // whose number is known only here
    for (const char* name : of_itself) add_rule(rules_.fd, fs::path("/proc/self") / name, reading, false);
    if (::syscall(SYS_landlock_restrict_self, rules_.fd, 0) != 0) return false;
  }
  return !has_seccomp() || allow_system_calls(network_, socket);
}

}  // namespace lgabench
