// Members of the board's files (core/fields.hpp).
#pragma once
#include <lgabench/leaderboard/entry.hpp>
#include <lgabench/leaderboard/scenes.hpp>
#include <lgabench/record/fields.hpp>

namespace lgabench::leaderboard {

void fields(Setting& setting, Fields& field);
void fields(Conditions& conditions, Fields& field);
void fields(Identity& identity, Fields& field);
void fields(PlayedCell& cell, Fields& field);
void fields(EntryScene& scene, Fields& field);

}  // namespace lgabench::leaderboard
