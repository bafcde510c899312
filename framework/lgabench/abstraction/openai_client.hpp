// Chat completions over HTTP, as OpenAI's API and many servers that follow it offer them.
#pragma once
#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/abstraction/openai_options.hpp>

namespace lgabench {

/// POSTs to BASE/chat/completions. An attempt that finds no server or breaks off, or is answered 408, 409, 429 or 5xx,
/// is followed by another, after the server's Retry-After where it names seconds. No message and no reply holds the
/// key.
class OpenAiClient : public ChatClient {
 public:
  /// Longest reply; a longer one ends the request.
  static constexpr std::size_t most_bytes = std::size_t{1} << 22;

  /// Connects to nothing yet.
  explicit OpenAiClient(OpenAiOptions options);
  /// @throws MethodError once the attempts are used up, for any other status, for a TLS certificate that this machine
  /// does not trust (the key is then not sent), for a body that is too long or not a completion, and
  /// for a reply whose finish_reason is not "stop": it was cut off.
  ChatReply complete(const Json& request) override;

 private:
  OpenAiOptions options_;
};

}  // namespace lgabench
