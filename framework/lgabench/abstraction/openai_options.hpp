// Where a server of chat completions is, and how patient its client is.
#pragma once
#include <functional>
#include <string>

namespace lgabench {

/// How one server is asked.
struct OpenAiOptions {
  std::string base_url, api_key;  // as OPENAI_BASE_URL (up to /v1) and OPENAI_API_KEY; the key may be empty
  int attempts = 6;               // of a request, the first included
  double first_wait_s = 1;        // before the second attempt; doubled for each further one, a minute at most
  long timeout_s = 600;           // for a whole reply: a server that does not stream sends no byte before it is done
  // Told, in a line, why and how long it waits before another attempt; from several threads.
  std::function<void(const std::string&)> waiting{};
  std::string ca_file{};   // certificates of authorities to trust, PEM, in place of this machine's: SSL_CERT_FILE
  bool was_there = false;  // it answered lately: a connection that it refuses may succeed later
};

/// OpenAI's own server, which answers nobody without a key.
constexpr const char* openai_server = "https://api.openai.com/v1";

/// Options from OPENAI_BASE_URL (by default OpenAI's own), OPENAI_API_KEY and SSL_CERT_FILE.
OpenAiOptions openai_from_environment();

/// The server's address, for a record: without the name and password that may stand before an '@'.
std::string provider(const OpenAiOptions& options);

}  // namespace lgabench
