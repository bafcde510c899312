#include <lgabench/host/reach.hpp>

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

void warn_of_home(const fs::path& folder) {
  const char* home = std::getenv("HOME");
  std::error_code not_there;
  if (home == nullptr || !fs::equivalent(folder, home, not_there)) return;
  to_stderr(
      "{}: this is your home directory: a plugin in it can read all that lies there and has no dot before its name; "
      "put "
      "it in a folder of its own (docs/trust.md)\n",
      folder.string());
}

void add_python(Reach& reach, const Json& python) {
  reach.reads.push_back(python_package());
  reach.reads.push_back(python.at("interpreter").get<std::string>());
  for (const Json& path : python.at("reads")) reach.reads.push_back(path.get<std::string>());
}

}  // namespace lgabench
