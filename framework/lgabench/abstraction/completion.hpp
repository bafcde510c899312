// Reads bodies in the form of OpenAI's chat completions, from a server or from a batch's output.
#pragma once
#include <string>

#include <lgabench/abstraction/chat_model.hpp>

namespace lgabench {

/// A completion's reply, without seconds. @throws NoAnswer for one that was cut off, refused, is empty or an error;
/// InputError for what is no completion.
ChatReply read_completion(const std::string& body);

/// The server's words for what went wrong, {"error": {"message"}} or {"error": text}; empty without.
std::string completion_error(const Json& body);

}  // namespace lgabench
