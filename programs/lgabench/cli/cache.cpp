// lgabench cache: how large the cache of demonstrations is, and how to empty it.
#include <lgabench/cli/cache.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>

#include <lgabench/cli/verbs.hpp>
#include <lgabench/core/directories.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/harness/forecast.hpp>

namespace lgabench::cli {
namespace {

// A file that a cell wrote: 32 hexadecimal digits and .hdf5, or what is left of a killed one's.
bool is_ours(const fs::directory_entry& entry) {
  constexpr std::size_t digits = 32;
  const std::string name = entry.path().filename().string();
  const std::string ending = name.substr(std::min(digits, name.size()));
  return entry.symlink_status().type() == fs::file_type::regular &&
         name.find_first_not_of("0123456789abcdef") == digits &&
         (ending == ".hdf5" || (ending.rfind(".hdf5.", 0) == 0 && is_temporary(entry.path())));
}

int cache(const fs::path& directory, bool clear, bool json) {
  std::size_t files = 0, others = 0;
  std::uintmax_t bytes = 0;
  std::error_code error;
  for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error)) {
    if (!is_ours(*it)) {
      ++others;
      continue;
    }
    std::error_code gone;  // another process may clear it, too
    const std::uintmax_t size = it->file_size(gone);
    if (gone || (clear && !fs::remove(it->path(), gone))) continue;
    bytes += size;
    ++files;
  }
  if (error && error != std::errc::no_such_file_or_directory)
    throw InputError(fmt::format("{}: cannot be read: {}", directory.string(), error.message()));
  if (json)
    to_stdout("{}\n",
              canonical({{"directory", directory.string()}, {"files", files}, {"bytes", bytes}, {"cleared", clear}}));
  else
    to_stdout("{}: {} file{} of demonstrations, {}{}\n", directory.string(), files, files == 1 ? "" : "s",
              size_text(static_cast<double>(bytes)), clear ? ", removed" : "");
  if (others > 0) to_stderr("{} other file{} in it: left alone\n", others, others == 1 ? "" : "s");
  return ok;
}

}  // namespace

fs::path default_cache() {
  for (const auto& [variable, below] :
       {std::pair{"LGABENCH_CACHE", ""}, {"XDG_CACHE_HOME", "lgabench"}, {"HOME", ".cache/lgabench"}})
    if (const char* base = std::getenv(variable); base && *base)
      return *below ? fs::path(base) / below : fs::path(base);
  return temporary_directory() / "lgabench-cache";
}

void add_cache(CLI::App& app, int& exit) {
  struct CacheArguments {
    std::string what = "size", directory;
    bool json = false;
  };
  auto a = std::make_shared<CacheArguments>();
  Verb verb(app, "cache", "Show how large the cache of demonstrations is, or empty it");
  verb.option("what size|clear", a->what, "size: print the cache's size; clear: remove its files",
              one_of("action", {"size", "clear"}));
  verb.option("--cache DIR", a->directory, "The cache's directory (default: $LGABENCH_CACHE, else ~/.cache/lgabench)");
  verb.option("--json", a->json, "Print one JSON object");
  verb->footer(
      "A run makes removed demonstrations again when it needs them. A cell that is running at the time loses nothing "
      "but time.\nExample: lgabench cache clear");
  verb->callback([a, &exit] {
    exit = cache(a->directory.empty() ? default_cache() : fs::path(a->directory), a->what == "clear", a->json);
  });
}

}  // namespace lgabench::cli
