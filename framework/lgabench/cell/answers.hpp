// Who answers for a cell: recorded answers, files that people brought along, or a model that is asked now.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/job/job.hpp>

namespace lgabench {

/// Who answers for one cell.
struct Answers {
  std::unique_ptr<Cassette> cassette;  // behind the language model
  std::unique_ptr<LanguageModel> lm;
  std::unique_ptr<HumanAnswers> human;
  std::function<Selection(const Command&)> truth;
};
/// The answers for the job's cell. `server`, borrowed, is asked where the cell asks a model; `in_line` is as in
/// ChatOptions. @throws InputError for a file that is missing or has other bytes.
Answers answers_for(const CellJob& job, const Scenario& scenario, ChatClient* server,
                    const std::function<void(bool begins)>& in_line);

/// The truth in the place of people: of a scenario with "questions" in the scenes of that layout and training seed, as
/// often as the method's option `questions` says. `scenario` is borrowed.
std::unique_ptr<HumanAnswers> people_of(const Scenario& scenario, const std::string& layout,
                                        std::uint64_t training_seed, int demonstrations, const Json& options);

}  // namespace lgabench
