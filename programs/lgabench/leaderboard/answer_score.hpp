// Scores what a row's answers keep without a policy: the second score of an entry of answers.
#pragma once
#include <lgabench/leaderboard/setting.hpp>

namespace lgabench::leaderboard {

/// The score of a row of the shipped lga, acting or selecting alone: how exactly what it was answered to each command
/// keeps what is meant, in as many scenes of each arm as the table has episodes, by the suite's groups; what was wrong,
/// by scenario; all models and the price. `file`: the cassette or the file of answers, where they are not shipped. Null
/// for any other row. @throws InputError for a file whose bytes are not what its name says; MethodError too, where an
/// answer lacks.
Json score_of_answers(const Installed& installed, const Competitor& row, const AnswerSource& answers,
                      const fs::path& file);

/// Expects a score as an entry has it. @throws InputError with the place
void expect_score(const JsonReader& score, const Setting& setting);

/// Who answered, for a reader.
std::string models_of(const Json& score);
/// The score as entries had it before it listed all models: with that of the last command alone.
Json as_before_the_list(Json score);

/// The share of scenes in which exactly what is meant is kept, over all commands.
double scenes_exact(const Json& score);

}  // namespace lgabench::leaderboard
