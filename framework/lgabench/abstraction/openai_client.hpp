// Chat completions over HTTP, as OpenAI's API and many servers that follow it offer them.
#pragma once
#include <memory>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/abstraction/openai_options.hpp>

namespace lgabench {

/// POSTs to BASE/chat/completions, to this machine's own addresses past any proxy. What verdict_of() says may pass, an
/// attempt that finds no server where there was one and one that breaks off are followed by another, after the server's
/// Retry-After where it names one; an attempt whose reply takes too long is not. Connections are kept for the next
/// request. No message and no reply holds the key.
class OpenAiClient : public ChatClient {
 public:
  /// Longest reply; a longer one ends the request.
  static constexpr std::size_t most_bytes = std::size_t{1} << 22;

  /// Connects to nothing yet.
  explicit OpenAiClient(OpenAiOptions options);
  ~OpenAiClient() override;
  OpenAiClient(const OpenAiClient&) = delete;
  OpenAiClient& operator=(const OpenAiClient&) = delete;
  /// @throws MethodError once the attempts are used up, where nobody listens, where verdict_of() says to stop, for a
  /// TLS certificate that this machine does not trust (the key is then not sent), and for a body that is too long.
  /// NoAnswer for a body that is no completion, a reply that is late, empty or a refusal, and one whose finish_reason
  /// says that it is not whole.
  ChatReply complete(const Json& request) override;

 private:
  struct Connections;
  OpenAiOptions options_;
  std::unique_ptr<Connections> connections_;
};

}  // namespace lgabench
