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
/// For the job's cell; `server`, borrowed, is asked where the cell asks a model; `in_line` as in ChatOptions. @throws
/// InputError for a file that is missing or has other bytes.
Answers answers_for(const CellJob& job, const Scenario& scenario, ChatClient* server,
                    const std::function<void(bool begins)>& in_line);

}  // namespace lgabench
