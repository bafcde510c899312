#include <lgabench/host/reach.hpp>

#include <algorithm>
#include <cstdlib>
#include <string>

#include <lgabench/core/files.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench {

Reach system_reach() {
  const fs::path bin = program_directory();
  return {{"/lib", "/lib64", "/usr/lib", "/usr/lib64", "/usr/local/lib", "/etc/ld.so.cache", "/etc/ssl/openssl.cnf",
           "/etc/localtime", "/usr/share/zoneinfo", "/usr/share/locale", "/proc/cpuinfo", "/proc/meminfo",
           "/sys/devices/system/cpu", "/sys/kernel/mm/transparent_hugepage", "/dev/urandom", bin / "lgabench-method",
           bin.parent_path() / "lib"},
          {"/dev/null", "/dev/zero"},
          {}};
}

fs::path python_package() { return fs::canonical(data_directory() / "python"); }

std::optional<fs::path> home_in(const fs::path& folder) {
  const char* named = std::getenv("HOME");
  std::error_code home_gone, folder_gone;
  const fs::path home = fs::canonical(named ? named : "", home_gone), outer = fs::canonical(folder, folder_gone);
  if (home_gone || folder_gone) return std::nullopt;
  const bool is_in = std::mismatch(outer.begin(), outer.end(), home.begin(), home.end()).first == outer.end();
  return is_in ? std::optional(home) : std::nullopt;
}

void warn_of_home(const fs::path& folder) {
  if (const std::optional<fs::path> home = home_in(folder))
    to_stderr(
        "{}: your home directory {}: a plugin there can read all in it that has no dot before its name; put the plugin "
        "in a folder of its own (docs/trust.md)\n",
        folder.string(), fs::equivalent(folder, *home) ? "is this folder" : "lies below it");
}

void add_python(Reach& reach, const Json& python) {
  reach.reads.push_back(python_package());
  reach.reads.push_back(python.at("interpreter").get<std::string>());
  for (const Json& path : python.at("reads")) reach.reads.push_back(path.get<std::string>());
}

}  // namespace lgabench
