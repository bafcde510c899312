// The answers that a run uses: recorded ones, files that people bring along, or those of a model that is asked now. A
// run keeps files and replies beside its cells, named by their SHA-256, so that it can be checked anywhere.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/abstraction/nobody.hpp>
#include <lgabench/abstraction/participant.hpp>
#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/plugin/loader.hpp>
#include <lgabench/record/answer_source.hpp>
#include <lgabench/record/cell.hpp>

namespace lgabench {

/// A file of answers on its way into a run directory's answers/.
struct AnswerFile {
  std::string name;            // there: the SHA-256 of its bytes, with an ending
  std::filesystem::path path;  // where it lies now
  Json about;                  // {"model"} or {"participant"}: who answered
};

/// Files of answers that a run keeps.
std::vector<AnswerFile> kept_answers(const std::filesystem::path& run);
/// Writes what is not there yet. @throws InputError for a file that is not what its name says.
void keep_answers(const std::vector<AnswerFile>& files, const std::filesystem::path& run);

/// @throws InputError where the cassette does not hold the replies of exactly one model to every command of the
/// scenarios: names the first that is missing, and the command line that asks it.
AnswerFile check_cassette(const std::filesystem::path& cassette, const std::vector<std::string>& scenarios);

/// The file of replies that a run with a live model keeps, if any. Of several that a killed run left, it is the
/// longest.
std::optional<AnswerFile> kept_replies(const std::filesystem::path& run);
/// Whether every line of one file stands in the other. @throws InputError where one cannot be read.
bool holds_lines(const std::filesystem::path& all, const std::filesystem::path& some);
/// Copies the whole lines of the cassette into the run's answers/. The older ones are to be dropped once run.json names
/// the new ones. None where nothing was asked yet.
std::optional<AnswerFile> keep_replies(const std::filesystem::path& cassette, const Json& about,
                                       const std::filesystem::path& run);
void drop_other_replies(const std::string& but, const std::filesystem::path& run);

/// @throws InputError where `answers` (recorded, or one of recorded_sources()) has none for a command of the scenarios:
/// names those scenarios.
void check_recorded(const RecordedAnswers& answers, const std::vector<std::string>& scenarios);
/// Checks a file that somebody wrote, as check_recorded(). @throws InputError as read_recorded(), too.
AnswerFile check_written(const std::filesystem::path& answers, const std::vector<std::string>& scenarios);

/// Whoever answers for a scenario's commands; a cassette answers for all of them.
class Answerer {
 public:
  /// `file`: the cassette or the file of answers; recorded ones need none.
  Answerer(const AnswerSource& source, const std::filesystem::path& file);
  /// Until the next call. `to_edit`: as of recorded_source().
  LanguageModel& of(const Scenario& scenario, bool to_edit = false);

 private:
  AnswerSource source_;
  std::filesystem::path file_;
  std::optional<Cassette> cassette_;
  std::unique_ptr<ChatLanguageModel> replies_;
  std::optional<RecordedLanguageModel> recorded_;
  Nobody nobody_;
};

/// Rows, and scenarios, each once, for which an answer lacks, its form, or that to the task's second set; why the
/// first.
struct LackingAnswers {
  std::vector<std::string> rows, scenarios;
  std::string reason;
};
/// Asks what the cells' methods declare that they ask, in the form of their option `meaning`. `file`: as Answerer's.
LackingAnswers lacking_answers(const std::vector<Cell>& cells, const Catalogue& catalogue, const AnswerSource& answers,
                               const std::filesystem::path& file);

/// Every .json of a directory. @throws InputError as read_participant, for a directory without one, and for two files
/// of one participant. A file of a rehearsal is refused unless `rehearsal`, which marks all of them.
std::vector<AnswerFile> read_participants(const std::filesystem::path& directory, bool rehearsal,
                                          std::vector<Participant>& all);

}  // namespace lgabench
