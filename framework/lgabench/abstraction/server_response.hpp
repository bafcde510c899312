// What a server's response to a chat request is: a completion, or a reason to wait, to stop, or to go on without it.
#pragma once
#include <string>

namespace lgabench {

/// What came of one attempt.
struct ServerResponse {
  long status = 0;            // 0: none came
  std::string body, problem;  // problem: why none came
  std::string moved_to{};     // of a redirect: the other address
  double retry_after_s = 0;   // 0: the server did not say
  bool final = false;         // of `problem`: waiting will not help
};

/// What the client does about it.
struct Verdict {
  enum class Next {
    read,   // the body, which is a completion or nothing that is known
    skip,   // this question has no answer, which says nothing about others
    retry,  // the server is busy, failing or loading: it may answer later
    stop,   // neither waiting nor another question helps: key, address, model, request, credit
  } next = Next::read;
  std::string why{};  // in a line, without the key
};

/// A 200 whose body is an error counts as a response of the status that the error's code says; one without such a code
/// may pass. A Retry-After beyond `longest_retry_after_s` does not. `body` is JSON without broken characters
/// (mended_json()), if it is JSON.
Verdict verdict_of(const ServerResponse& response, const std::string& key);

constexpr double longest_retry_after_s = 600;

/// The text with "(key)" in place of the key: a server may repeat it wherever it puts words.
std::string without_key(std::string text, const std::string& key);

}  // namespace lgabench
