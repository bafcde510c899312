#include <lgabench/cell/runs_below.hpp>

#include <deque>
#include <string>
#include <string_view>

#include <lgabench/core/files.hpp>
#include <lgabench/record/run_record.hpp>

namespace lgabench {
namespace {

// As cached_demonstrations() names them.
bool is_cached(const std::string& name) {
  constexpr std::string_view ending = ".hdf5", digits = "0123456789abcdef";
  constexpr std::size_t length = 32;
  return name.size() == length + ending.size() && name.compare(length, ending.size(), ending) == 0 &&
         name.find_first_not_of(digits) == length;
}

}  // namespace

std::vector<fs::path> runs_below(const fs::path& directory) {
  constexpr std::size_t most = 100000;
  std::vector<fs::path> found;
  std::size_t entries = 0;
  for (std::deque<fs::path> waiting{directory}; !waiting.empty(); waiting.pop_front()) {
    const fs::path here = waiting.front();
    std::vector<fs::path> below;
    bool hides = entries > most || is_run(here), is_venv = false;
    std::error_code unreadable, gone;
    fs::directory_iterator entry(here, unreadable);
    for (; !hides && !unreadable && entry != fs::directory_iterator(); entry.increment(unreadable)) {
      const std::string name = entry->path().filename();
      hides = is_cached(name) || ++entries > most;
      is_venv |= name == "pyvenv.cfg";
      if (!entry->is_symlink(gone) && entry->is_directory(gone)) below.push_back(entry->path());
    }
    if (hides)
      found.push_back(here);
    else if (!is_venv)
      waiting.insert(waiting.end(), below.begin(), below.end());
  }
  return found;
}

}  // namespace lgabench
