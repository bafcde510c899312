// What a run asks a server's model before its cells: the questions that their methods declare.
#pragma once
#include <string>
#include <vector>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/harness/worker_pool.hpp>

namespace lgabench {

/// Questions to a server, of all commands that they are about, once each.
struct Questions {
  int all = 0, open = 0;  // open: without a reply in the cassette
  int at_once = 1;
  double reply_s = 0;  // a reply's seconds, mean of those in the cassette; 0 where there is none

  /// Adds select_features()'s about the command.
  void add(const ChatLanguageModel& model, const Command& command, const FeatureSpace& space);

  /// "1680 questions, 448 answered already, 4 at once: about 5 min", the time where a reply's is known.
  std::string text() const;
};

/// Counts the questions of select_features() about the scenarios' commands. @throws InputError for what is no cassette.
Questions count_questions(const LiveModel& live, const std::string& model, const std::vector<Json>& scenarios);

/// Asks what the cassette lacks, in a worker, and says on stderr how far it is unless `quiet`. What stays without an
/// answer is said there too, and is left for the cells to ask again. @returns false if a signal came, as run_workers().
bool ask_beforehand(const AskJob& job, const Questions& questions, bool quiet);

}  // namespace lgabench
