// Who answers for a cell: recorded answers, or files that people bring along. A run keeps those files beside its cells,
// named by their SHA-256, so that it can be checked anywhere.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <lgabench/abstraction/cassette.hpp>
#include <lgabench/harness/cell.hpp>

namespace lgabench {

/// A file of answers on its way into a run directory's answers/.
struct AnswerFile {
  std::string name;            // there: the SHA-256 of its bytes, with an ending
  std::filesystem::path path;  // where it lies now
  Json about;                  // {"model"} or {"participant"}: who answered
};

/// Those that a run keeps.
std::vector<AnswerFile> kept_answers(const std::filesystem::path& run);
/// Writes what is not there yet. @throws InputError for a file that is not what its name says.
void keep_answers(const std::vector<AnswerFile>& files, const std::filesystem::path& run);

/// What Cell::answers begins with where they are a cassette's; its SHA-256 follows.
constexpr const char* cassette_prefix = "cassette:";
/// Such a cell's answers, and the file that they are in.
struct CassetteAnswers {
  std::string answers;
  AnswerFile file;
};
/// @throws InputError where the cassette does not hold the replies of exactly one model to every command of the
/// scenarios: names the first that is missing, and the command line that asks it.
CassetteAnswers check_cassette(const std::filesystem::path& cassette, const std::vector<std::string>& scenarios);

/// @throws InputError where `answers` (recorded, or one of recorded_sources()) has none for a command of the scenarios:
/// names those scenarios.
void check_recorded(const std::string& answers, const std::vector<std::string>& scenarios);

/// Every .json of a directory. @throws InputError as read_participant, for a directory without one, and for two files
/// of one participant.
std::vector<AnswerFile> read_participants(const std::filesystem::path& directory, std::vector<Participant>& all);

/// Who answers for one cell.
struct Answers {
  std::unique_ptr<Cassette> cassette;  // behind the language model
  std::unique_ptr<LanguageModel> lm;
  std::unique_ptr<HumanAnswers> human;
  std::function<Selection(const Command&)> truth;
};
/// `kept`: the run directory's answers/. @throws InputError for a file that is missing there or has other bytes.
Answers answers_for(const Cell& cell, const Scenario& scenario, const std::filesystem::path& kept);

}  // namespace lgabench
