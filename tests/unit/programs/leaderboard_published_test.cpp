// The published entries: what names an entry and its cells, and what its options are, is what it was when it was
// played.
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <utility>

#include <lgabench/leaderboard/entry.hpp>
#include <lgabench/plugin/loader.hpp>

#include "../../conformance/amount.hpp"
#include "../testing.hpp"

namespace lgabench::leaderboard {
namespace {

TEST(LeaderboardPublished, EveryEntryAndCellHasTheNameThatItHad) {
  const fs::path board = LGABENCH_BOARD;
  const Catalogue catalogue = scan_plugins(plugin_directories());
  std::map<std::pair<std::string, std::string>, Installed> presets;
  int entries = 0;
  const int every = amount(5, 1);  // by default each fifth, which is of every suite and preset
  for (const fs::path& directory : entry_directories(board)) {
    if (entries++ % every != 0) continue;
    const Entry entry = read_entry(board, directory);
    EXPECT_EQ(entry.place(), directory);
    const Competitor& row = entry.identity.row;
    // A later version of a method may have other options; its older entries keep their name.
    if (!row.is_reference() && catalogue.find("method", row.id).version == row.version) {
      EXPECT_EQ(resolve_options(catalogue.find("method", row.id), row.options), row.options) << directory;
    }

    const std::pair preset{entry.setting.suite, entry.setting.preset};
    if (presets.count(preset) == 0) presets.emplace(preset, installed_setting(preset.first, preset.second));
    const Installed& installed = presets.at(preset);
    EXPECT_EQ(hash(installed.setting), entry.identity.preset_sha256) << directory;
    const std::vector<Cell> cells =
        cells_of_row(installed, row, entry.identity.engine, entry.identity.answers, entry.identity.conditions);
    ASSERT_EQ(cells.size(), entry.cells.size()) << directory;
    for (std::size_t i = 0; i < cells.size(); i += 10) {
      Cell cell = cells[i];
      const Json own_space = cell.data.at("feature_space");
      cell.data = entry.evidence.front().at("data");  // further answers are other data, and another cell
      // Evidence names one feature space; a suite may have two.
      if (key(cell) != entry.cells[i].key) cell.data["feature_space"] = own_space;
      ASSERT_EQ(key(cell), entry.cells[i].key) << directory << " " << cell.title();
    }
  }
  EXPECT_GE(entries, 100);
  EXPECT_GE(presets.size(), 12u);
}

}  // namespace
}  // namespace lgabench::leaderboard
