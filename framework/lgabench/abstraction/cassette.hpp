// A file of a language model's replies, to be replayed.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// Seconds that a reply took, from a file. @throws InputError for less than 0 or more than 1e9.
double read_reply_seconds(const JsonReader& reader);

/// What a server said to one request.
struct ChatReply {
  std::string text;
  long long tokens = 0;                           // of prompt and reply, as the server counts both together
  double seconds = 0;                             // from the first attempt to the reply
  long long prompt_tokens = 0, reply_tokens = 0;  // 0 where the server does not tell them apart
  std::string served{};  // who answered, in the server's words: an alias stands for another model at another time
  std::string day{};     // of the reply, in UTC: "2026-11-28"

  /// Takes the place of what was said before, at the cost of both.
  void add(const ChatReply& later);
};

/// A line of a cassette's file.
struct CassetteLine {
  std::string key, model;
  Json request;
  ChatReply reply;
  std::string prompt{};  // of the first line: the text that asked in place of prompts/selection.txt, "" for none
};

/// A server's name for its model, or a day: at most 200 bytes in a line. @throws InputError
std::string read_word(const JsonReader& reader);

/// A file with a CassetteLine for each reply, which is on the disk before add() returns, so that an interrupted series
/// of questions goes on where it stopped. May be used by several threads, and by several
/// processes that take turns to ask.
class Cassette {
 public:
  /// While a Turn lives, its process alone, of all with this file, asks: no question is paid for twice.
  class Turn {
   public:
    /// Waits until no other process has the turn, which `waiting` is told of, then reads the replies that came
    /// meanwhile. Makes the file if need be, and removes a last line that was cut off. @throws InputError
    Turn(Cassette& cassette, const std::function<void(const std::string&)>& waiting);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    int lock_;
  };

  /// Reads the file; a missing one counts as empty. A last line that was cut off is no reply, which stderr says.
  /// @throws InputError with file and line for anything else that is not a reply.
  explicit Cassette(const std::filesystem::path& file);

  /// Hash of the whole request (model, messages, parameters) and of the prompt template's version.
  static std::string key(const Json& request, const std::string& template_version);

  /// The reply to the request of this key(), if it was ever given.
  std::optional<ChatReply> find(const std::string& key) const;
  /// @pre in a Turn. @throws InputError if the file cannot be written, MethodError where the reply names another served
  /// model than those before to this model and request, unless `any_served`.
  void add(const std::string& key, const Json& request, const ChatReply& reply, bool any_served = false);

  /// The text that asked its replies, as read_prompt() has it; "" where it was lgabench's own or there are none yet.
  std::string prompt() const;
  /// Says which text asks those to come: the first of them keeps it. @throws InputError where another one asked those
  /// that are there.
  void expect_prompt(const std::string& text);

  /// Where it lies.
  const std::filesystem::path& file() const { return file_; }
  /// Seconds that a reply took, on the mean; 0 where there is none.
  double mean_seconds() const;
  /// Who was asked and replied: to_text() of each model and request, sorted.
  std::set<std::string> models() const;
  /// @throws InputError where it is not exactly one.
  std::string only_model() const;

 private:
  // These expect the lock.
  std::string asked_text(const std::string& model, const JsonReader& request) const;
  void expect_same_prompt() const;

  bool read();  // reads lines that were added since; whether all of them are whole

  std::filesystem::path file_;
  std::size_t size_ = 0;  // of what was read
  int lines_ = 0;
  std::string prompt_, expected_prompt_;  // of the first line; of those to come
  mutable std::mutex mutex_;
  std::map<std::string, ChatReply> replies_;
  std::map<std::string, std::set<std::string>> served_;  // by who was asked: to_text()
};

}  // namespace lgabench
