// What the answers of a table's entries keep, without a policy: language models side by side.
#pragma once
#include <optional>
#include <string>

#include <lgabench/leaderboard/suite_page.hpp>

namespace lgabench::leaderboard {

/// Rows by scenes exact, a column for each group of the suite, and the price; then what each got wrong. None where no
/// entry of the table has a score of its answers.
std::optional<report::Section> answers_section(const NamedTable& table, const std::string& id);

}  // namespace lgabench::leaderboard
