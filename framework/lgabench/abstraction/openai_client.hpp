// Chat completions over HTTP, as OpenAI's API and many servers that follow it offer them.
#pragma once
#include <memory>
#include <string>

#include <lgabench/abstraction/chat_model.hpp>

namespace lgabench {

struct OpenAiOptions {
  std::string base_url, api_key;  // as OPENAI_BASE_URL (up to /v1) and OPENAI_API_KEY; the key may be empty
  int attempts = 6;               // of a request, the first included
  double first_wait_s = 1;        // before the second attempt; doubled for each further one, a minute at most
  long timeout_s = 120;           // of an attempt; one that gets no byte for half of it is given up too
};

/// POSTs to BASE/chat/completions. An attempt that finds no server or breaks off, or is answered 408, 409, 429 or 5xx,
/// is followed by another, after the server's Retry-After where it names seconds. No message holds the key.
class OpenAiClient : public ChatClient {
 public:
  explicit OpenAiClient(OpenAiOptions options);
  /// @throws MethodError once the attempts are used up, for any other status, for a TLS certificate that this machine
  /// does not trust (the key is then not sent), for a body that is not a completion, and
  /// for a reply whose finish_reason is not "stop": it was cut off.
  ChatReply complete(const Json& request) override;

 private:
  OpenAiOptions options_;
};

/// Options from OPENAI_BASE_URL (by default OpenAI's own) and OPENAI_API_KEY.
OpenAiOptions openai_from_environment();

}  // namespace lgabench
