// The body of a language model's reply.
#include <cstdlib>

#include <lgabench/abstraction/final_answer.hpp>
#include <lgabench/abstraction/openai_client.hpp>

#include "fuzz.hpp"
#include "server.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  static auto& server = *new fuzz::Server;
  static const std::string key = "sk-secret";
  static OpenAiClient client({server.url(), key, 1, 0, 10});
  server.give("HTTP/1.1 200 OK\r\nConnection: close\r\n\r\n" + std::string(fuzz::text_of(data, size)));
  try {
    const ChatReply reply = client.complete({{"model", "a model"}});
    if (reply.text.find(key) != std::string::npos || reply.tokens < 0) std::abort();
    final_answer(reply.text);
  } catch (const MethodError& e) {
    if (std::string_view(e.what()).find(key) != std::string_view::npos) std::abort();
  }
  return 0;
}
