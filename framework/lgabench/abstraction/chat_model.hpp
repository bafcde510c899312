// A language model that is asked now, or was: one chat request a question.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <lgabench/abstraction/cassette.hpp>
#include <lgabench/abstraction/prompt.hpp>
#include <lgabench/core/language_model.hpp>

namespace lgabench {

/// A server of chat completions. complete() may be called from several threads at once.
class ChatClient {
 public:
  virtual ~ChatClient() = default;
  /// `request`: {"model", "messages", "temperature"}. @throws MethodError for a reply that is missing or cut off, or a
  /// server that refuses; the message holds no secret.
  virtual ChatReply complete(const Json& request) = 0;
};

/// Which model is asked, and how hard.
struct ChatOptions {
  std::string model;                                      // as the server names it
  int concurrency = 4;                                    // requests under way at once
  int max_queries = -1;                                   // to the server, in the model's life; -1: no limit
  std::function<void(int asked, int all)> progress = {};  // called from answer()'s thread alone, every 10 s at least
  std::function<void(const std::string&)> waiting = {};   // told in a line what it waits for; likewise
};

/// Asks what the cassette does not hold, if there is a client; provenance live once a reply came from it, else
/// cassette.
class ChatLanguageModel : public LanguageModel {
 public:
  /// Both are borrowed and must outlive the model; `client` may be nullptr: then the cassette must hold every reply.
  ChatLanguageModel(Cassette& cassette, ChatClient* client, ChatOptions options);

  /// A reply without a final answer is asked for three times. @throws MethodError where the server fails, or, once all
  /// are asked, for questions without an answer: they are never a no. The replies that came are in the cassette.
  /// InputError without a client where the cassette lacks a reply (names the command line that asks), or where
  /// `max_queries` does not suffice.
  std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                           const std::vector<Question>& questions) override;
  /// As in ChatOptions.
  std::string model() const override { return options_.model; }
  /// live once this object had a reply from the server, else cassette.
  Provenance provenance() const override { return asked_ > 0 ? Provenance::live : Provenance::cassette; }
  SelectionCost cost() const override { return cost_; }

 private:
  struct Request {
    std::string key, candidate;
    Json json;
  };
  void ask(const std::vector<Request>& requests);

  Cassette& cassette_;
  ChatClient* client_;
  ChatOptions options_;
  PromptTemplate template_;
  int asked_ = 0;
  SelectionCost cost_;
};

}  // namespace lgabench
