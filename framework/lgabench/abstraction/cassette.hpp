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

/// What a server said to one request.
struct ChatReply {
  std::string text;
  long long tokens = 0;  // of prompt and reply
  double seconds = 0;    // from the first attempt to the reply
};

/// Seconds of waiting for a reply. @throws InputError for a number that no wait takes.
double read_seconds(const JsonReader& reader);

/// A file of JSON lines {"key", "model", "request", "reply", "tokens", "seconds"}; each reply adds a line, which is on
/// the disk before add() returns, so that an interrupted series of questions goes on where it stopped. May be used by
/// several threads, and by several processes that take turns to ask.
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
  /// @pre in a Turn. @throws InputError if the file cannot be written.
  void add(const std::string& key, const Json& request, const ChatReply& reply);

  /// Where it lies.
  const std::filesystem::path& file() const { return file_; }
  /// Of a reply; 0 where there is none.
  double mean_seconds() const;
  /// Who replied: to_text() of each model and request, sorted.
  std::set<std::string> models() const;
  /// @throws InputError where it is not exactly one.
  std::string only_model() const;

 private:
  bool read();  // reads lines that were added since; whether all of them are whole

  std::filesystem::path file_;
  std::size_t size_ = 0;  // of what was read
  int lines_ = 0;
  mutable std::mutex mutex_;
  std::map<std::string, ChatReply> replies_;
  std::set<std::string> models_;
};

}  // namespace lgabench
