// Reads bodies in the form of OpenAI's chat completions, from a server or from a batch's output.
#pragma once
#include <string>

#include <lgabench/abstraction/chat_model.hpp>

namespace lgabench {

/// A completion's reply, without seconds; its day is the body's `created`. @throws NoAnswer for one that was cut off,
/// refused, is empty or an error; InputError, which shows how the body begins, for what is no completion.
ChatReply read_completion(const std::string& body);

/// The server's words for what went wrong: {"error": {"message"}}, {"error": text}, {"message"} or {"detail"}, also
/// within an array; empty without.
std::string completion_error(const Json& body);

/// JSON from another program, with U+FFFD in place of what no JSON text may hold: each byte that is no UTF-8, and each
/// escaped half of a surrogate pair.
std::string mended_json(const std::string& text);

/// The text's first bytes, `most` or a few less, so that no character is cut.
std::string beginning(const std::string& text, std::size_t most);

}  // namespace lgabench
