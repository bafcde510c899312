// Computes an entry's cells again in this installation, to check that its outcomes are what its method does.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <lgabench/harness/recompute.hpp>
#include <lgabench/leaderboard/entry.hpp>

namespace lgabench::leaderboard {

struct VerifyOptions {
  std::size_t cells = enough_cells;
  bool fresh = false;        // play all scenarios on other test scenes instead
  bool on_commands = false;  // score Selections for so many drawn commands instead (fresh_commands.hpp)
  int commands = 40;
  std::string by, program;  // who verifies, with what: as --version says
  PoolOptions pool;
};

/// The preset that the entry was played in, as it is installed. @throws InputError where that is another, or the engine
/// has another version; PluginError where there is no such engine.
Installed installed_as(const Entry& entry, const Catalogue& catalogue);

/// The entry's cells of these places, played here with the first `episodes` scenes of each arm; with all of them where
/// there are fewer. Of a method that is not the entry's, or has other options, none is played. None where it was
/// interrupted. @throws InputError and PluginError as verification().
std::optional<Recomputed> played_again(const fs::path& board, const Entry& entry,
                                       const std::vector<std::size_t>& places, int episodes, const Catalogue& catalogue,
                                       const VerifyOptions& options);

/// 128 bits that nobody knew before, as 32 hexadecimal digits.
std::string new_nonce();

/// A line of verifications.jsonl. Plays the cells that `nonce` chooses, confined and on a cache of their own; by
/// statistics::verdict_of() it passes unless it differs, and the same bits are owed where owe_same_bits() of the
/// entry's processor and this one. With `fresh`: fresh_cells(), on a scene seed that the nonce chooses as well; it
/// passes where none of its fresh_estimates() differs. With `on_commands`: on_fresh_commands(). None where it was
/// interrupted.
/// @throws InputError where this installation cannot play the entry: another preset, another version of method or
/// engine, a method that asks somebody else or has other options, a cell that the host failed. PluginError for a plugin
/// that is not there.
std::optional<Json> verification(const fs::path& board, const Entry& entry, const std::string& nonce,
                                 const Catalogue& catalogue, const VerifyOptions& options);

}  // namespace lgabench::leaderboard
