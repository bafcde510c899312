// A language model's replies on file, to be replayed.
#pragma once
#include <filesystem>
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

/// A file of JSON lines {"key", "model", "request", "reply", "tokens", "seconds"}; grows a line a reply, each on the
/// disk before add() returns, so that an interrupted series of questions goes on where it stopped. May be used by
/// several threads; by one process at a time.
class Cassette {
 public:
  /// Reads what is there; a file that does not exist is empty. A last line that was cut off is dropped, and said on
  /// stderr. @throws InputError with file and line for anything else that is not a reply.
  explicit Cassette(const std::filesystem::path& file);

  /// Hash of the whole request (model, messages, parameters) and of the prompt template's version.
  static std::string key(const Json& request, const std::string& template_version);

  /// The reply to the request of this key(), if it was ever given.
  std::optional<ChatReply> find(const std::string& key) const;
  /// @throws InputError if the file cannot be written.
  void add(const std::string& key, const Json& request, const ChatReply& reply);

  /// Where it lies.
  const std::filesystem::path& file() const { return file_; }
  /// Of all replies, sorted.
  std::set<std::string> models() const;

 private:
  std::filesystem::path file_;
  mutable std::mutex mutex_;
  std::map<std::string, ChatReply> replies_;
  std::set<std::string> models_;
};

}  // namespace lgabench
