// A language model that is asked now, or was earlier: one chat request for each question.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <lgabench/abstraction/asked_model.hpp>
#include <lgabench/abstraction/cassette.hpp>
#include <lgabench/abstraction/prompt.hpp>
#include <lgabench/core/language_model.hpp>

namespace lgabench {

/// One question has no answer: its reply is late, cut off, refused, empty or no completion. Other questions are not
/// concerned.
struct NoAnswer : MethodError {
  using MethodError::MethodError;
};

/// Questions about a command that have no answer, once all others were asked and their replies kept.
struct Unanswered : MethodError {
  /// what() names all candidates without an answer, and the first reason.
  Unanswered(const std::string& in_a_line, std::vector<std::string> which)
      : MethodError(in_a_line), questions(std::move(which)) {}
  std::vector<std::string> questions;  // a line each: the candidate, and why
};

/// None of a question's replies can be read.
struct Unread : MethodError {
  using MethodError::MethodError;
};

/// None of the first 20 replies to questions of one form can be read, and no more such questions go to the server.
struct Hopeless : MethodError {
  using MethodError::MethodError;
};

/// A server of chat completions. complete() may be called from several threads at once.
class ChatClient {
 public:
  virtual ~ChatClient() = default;
  /// `request`: the body, as AskedModel makes it. @throws NoAnswer for a reply that is none to this question,
  /// MethodError for a server that fails or refuses to serve; the message holds no secret.
  virtual ChatReply complete(const Json& request) = 0;
};

/// Which model is asked, and how much at once.
struct ChatOptions {
  std::string model;                                      // to_text() of an AskedModel
  int concurrency = 4;                                    // requests under way at once
  int max_queries = -1;                                   // queries to the server, in this object's life; -1: no limit
  std::function<void(int asked, int all)> progress = {};  // called from answer()'s thread alone, every 10 s at least
  std::function<void(const std::string&)> waiting = {};   // told, in a line, what it waits for or cannot read; likewise
  std::function<void(bool begins)> in_line = {};          // told where the model waits for another process that asks
  bool any_served = false;                                // as of Cassette::add()
  std::string prompt{};       // read_prompt()'s, in place of selection.txt; "": the cassette's, where the model has one
  bool expects_read = false;  // mean() and hypotheses() throw Unread or Hopeless where they would be empty otherwise
};

/// The messages of a request, made of a prompt.
Json messages_of(const Prompt& prompt);

/// Asks the client, if there is one, what the cassette does not hold. Its provenance is live once a reply came from the
/// client, else cassette.
class ChatLanguageModel : public LanguageModel {
 public:
  /// Both are borrowed and must outlive the model; `client` may be nullptr: then the cassette must hold every reply.
  /// @throws InputError where another prompt asked the cassette's replies.
  ChatLanguageModel(Cassette& cassette, ChatClient* client, ChatOptions options);

  /// A question whose reply has no final answer is asked up to three times, until the reply repeats itself; one whose
  /// reply is cut off, refused or empty is asked once. @throws MethodError where the server fails and where none of the
  /// first 20 questions of an empty cassette has an answer, Unanswered for questions without an answer: they are never
  /// a no. The replies
  /// that came are in the cassette.
  /// InputError without a client where the cassette lacks a reply (names the command line that asks), or where
  /// `max_queries` does not suffice.
  std::vector<bool> answer(const Command& command, const FeatureSpace& space,
                           const std::vector<Question>& questions) override;
  /// Asks one question. If the reply's meaning cannot be read, the model is told why and asked again, twice at most;
  /// each asking is a query. @throws as answer(), and Unread or Hopeless if the options expect that replies are read.
  Meaning mean(const Command& command, const FeatureSpace& space) override;
  /// Asks for hypotheses as mean() asks for one meaning. Empty, at no cost, where nobody can be asked: there is no
  /// client, and the cassette lacks the reply.
  std::vector<Hypothesis> hypotheses(const Command& command, const FeatureSpace& space) override;
  /// Which of the numbers 1 to `marks` in a picture, PNG, the command could mean, in one question (marked()). The
  /// server gets the picture; key and cassette hold its SHA-256. @throws as mean(), and always Unread where no reply
  /// names marks that there are.
  std::vector<int> look(const Command& command, const std::string& png, int marks);
  /// How many of these questions would go to a server: those without a reply in the cassette.
  int open_questions(const Command& command, const FeatureSpace& space, const std::vector<Question>& questions) const;
  /// As in ChatOptions: what is not the usual request belongs to the name. Where the server called the model otherwise
  /// in the replies until now: "NAME (served: OTHER, ...)".
  std::string model() const override;
  /// live once this object had a reply from the server, else cassette.
  Provenance provenance() const override { return asked_ > 0 ? Provenance::live : Provenance::cassette; }
  SelectionCost cost() const override { return cost_; }

 private:
  struct Request {
    std::string key, candidate;
    Json json;  // with the picture's SHA-256
    bool yes_or_no = true;
    std::string picture{};
    Json sent() const;
  };
  std::vector<Request> requests_of(const Command& command, const FeatureSpace& space,
                                   const std::vector<Question>& questions) const;
  void ask(const std::vector<Request>& requests, const std::string& utterance);
  /// `asks`: a command line's words before --answers that ask for these.
  void expect_replies(const std::vector<Request>& requests, const Command& command, const std::string& asks);
  ChatReply counted(const Request& request);
  /// A question whose reply `read` reads; told what is wrong and asked again where it throws, to give `wanted`. @throws
  /// Unread after the last try, Hopeless.
  template <class Read>
  auto asked_until_read(Request request, const PromptTemplate& prompt, const Command& command, const std::string& asks,
                        const std::string& wanted, Read&& read) -> decltype(read(std::string()));
  /// What `ask` returns; nothing in place of Unread, unless the options expect that replies are read.
  template <class Ask>
  auto read_or_empty(Ask&& ask) const -> decltype(ask());
  Request request_in_one(const PromptTemplate& prompt, const Json& messages, const std::string& about) const;

  Cassette& cassette_;
  ChatClient* client_;
  ChatOptions options_;
  AskedModel asked_model_;
  PromptTemplate template_, of_meaning_{"meaning.txt"}, of_turns_{"turns.txt"}, of_hypotheses_{"hypotheses.txt"};
  int asked_ = 0, without_answer_ = 0;
  struct Reading {
    bool any = false;
    int unread = 0;  // replies
  };
  std::map<std::string, Reading> reading_;  // by the version of the form's prompt
  SelectionCost cost_;
  std::set<std::string> served_;  // names of whose replies were counted
};

}  // namespace lgabench
