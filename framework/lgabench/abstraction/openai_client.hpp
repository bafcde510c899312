// Chat completions over HTTP, as OpenAI's API and many servers that follow it offer them.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include <lgabench/abstraction/chat_model.hpp>

namespace lgabench {

/// Where the server is and how patient its client.
struct OpenAiOptions {
  std::string base_url, api_key;  // as OPENAI_BASE_URL (up to /v1) and OPENAI_API_KEY; the key may be empty
  int attempts = 6;               // of a request, the first included
  double first_wait_s = 1;        // before the second attempt; doubled for each further one, a minute at most
  long timeout_s = 120;           // of an attempt; one that gets no byte for half of it is given up too
  // Told, in a line, why and how long it waits before another attempt; from several threads.
  std::function<void(const std::string&)> waiting{};
};

/// POSTs to BASE/chat/completions. An attempt that finds no server or breaks off, or is answered 408, 409, 429 or 5xx,
/// is followed by another, after the server's Retry-After where it names seconds. No message and no reply holds the
/// key.
class OpenAiClient : public ChatClient {
 public:
  /// Of a reply; a longer one ends the request.
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

/// Options from OPENAI_BASE_URL (by default OpenAI's own) and OPENAI_API_KEY.
OpenAiOptions openai_from_environment();

}  // namespace lgabench
