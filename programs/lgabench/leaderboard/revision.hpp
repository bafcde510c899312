// A board as a revision of git has it: what `check --against` compares files with.
#pragma once
#include <map>
#include <string>

#include <lgabench/core/files.hpp>

namespace lgabench::leaderboard {

/// The bytes of the board's files at a revision, by their place in the board. Both revision and repository are those of
/// the current directory, and git runs nowhere else: a board's files are never its repository or its configuration. Of
/// two things of one name a branch goes before a tag, which a fetch may bring.
/// @throws InputError for a revision that is not there, a current directory or a board that is in no working tree of
/// git, a board that is one, and one behind a symbolic link.
std::map<std::string, std::string> files_at(const std::string& revision, const fs::path& board);

}  // namespace lgabench::leaderboard
