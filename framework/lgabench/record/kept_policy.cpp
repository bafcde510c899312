#include <lgabench/record/kept_policy.hpp>

#include <fmt/format.h>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/record/layout.hpp>

namespace lgabench {

std::string to_text(const KeptPolicy& policy) {
  const Json head{{"method", policy.method}, {"version", policy.version}, {"sha256", sha256(policy.bytes)}};
  return canonical(head) + '\n' + policy.bytes;
}

KeptPolicy read_kept_policy(const std::filesystem::path& cell) {
  constexpr std::uintmax_t most = 65 << 20;
  const fs::path file = cell / cell_file::policy;
  if (!fs::exists(fs::symlink_status(file)))
    throw InputError(fmt::format("{}: not there; `lgabench run --keep-policy` keeps policies", file.string()));
  const std::string text = read_file(file, Links::refused, most);
  const std::size_t end = text.find('\n');
  const std::string damaged = file.string() + ": changed or cut off since it was written";
  if (end == std::string::npos || end > 1000) throw InputError(damaged);
  const Json head = parse_json(text.substr(0, end), file.string());
  const JsonReader reader(head, file.string());
  KeptPolicy policy{reader.at("method").string(), reader.at("version").string(), text.substr(end + 1)};
  if (sha256(policy.bytes) != reader.at("sha256").string()) throw InputError(damaged);
  return policy;
}

}  // namespace lgabench
