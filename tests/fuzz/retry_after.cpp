// What a busy server says after "Retry-After:", and how long that makes the client wait.
#include <cstdlib>

#include <lgabench/abstraction/openai_client.hpp>

#include "fuzz.hpp"
#include "server.hpp"

namespace {

struct Waits {};  // thrown instead of waiting

void expect_a_bearable_wait(const std::string& said) {
  constexpr std::string_view before = "; the next in ";
  const std::size_t at = said.rfind(before);
  const double seconds = at == said.npos ? -1 : std::atof(said.c_str() + at + before.size());
  if (!(seconds >= 0 && seconds <= 600)) std::abort();
  throw Waits();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lgabench;
  static auto& server = *new fuzz::Server;
  // A client says the same wait once, and waits itself the second time.
  OpenAiClient client({server.url(), "", 2, 0, 10, expect_a_bearable_wait});
  server.give("HTTP/1.1 429 Too Many Requests\r\nConnection: close\r\nRetry-After: " +
              std::string(fuzz::text_of(data, size)) + "\r\n\r\nbusy");
  try {
    client.complete({{"model", "a model"}});
  } catch (const Waits&) {
  } catch (const MethodError&) {
  }
  return 0;
}
