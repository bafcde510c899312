#include <lgabench/cli/own_names.hpp>

#include <fmt/format.h>

#include <algorithm>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/scenario_files.hpp>
#include <lgabench/core/shell.hpp>
#include <lgabench/core/shipped.hpp>

namespace lgabench::cli {

void expect_plain_name(std::string_view verb, const std::string& name) {
  constexpr std::size_t longest = 63;
  const auto allowed = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  if (name.empty() || name.size() > longest || name[0] < 'a' || name[0] > 'z' ||
      !std::all_of(name.begin(), name.end(), allowed))
    throw InputError(
        fmt::format("{}: \"{}\": expected at most {} lower-case letters, digits and underscores, a letter "
                    "first",
                    verb, name, longest));
}

void expect_free_scenario(std::string_view verb, const std::string& id) {
  if (const fs::path file = scenario_file(id); !file.empty())
    throw InputError(
        fmt::format("{}: expected another id than {}, which {} has; nothing was written", verb, id, file.string()));
}

void expect_free_suite(std::string_view verb, const std::string& id) {
  if (contains(shipped_names("suites"), id))
    throw InputError(
        fmt::format("{}: expected another id than {}, which a shipped suite has; nothing was written", verb, id));
}

std::string path_word(const fs::path& path) {
  const std::string text = path.string();
  return shell_line({text.rfind('-', 0) == 0 ? "./" + text : text});
}

}  // namespace lgabench::cli
