#include <lgabench/abstraction/completion.hpp>

#include <fmt/format.h>

#include <cmath>

namespace lgabench {
namespace {

// A message's content: a text, or a list of parts.
std::string content_of(const JsonReader& message) {
  const JsonReader content = message.at("content");
  std::string text;
  if (content.json().is_array()) {
    for (const JsonReader& part : content.elements())
      if (part.has("text")) text += part.at("text").string();
  } else if (!content.json().is_null()) {
    text = content.string();
  }
  return text;
}

// Servers count in ways of their own; no answer depends on it.
long long tokens_of(const Json& body) {
  const Json usage = body.value("usage", Json());
  const Json total = usage.is_object() ? usage.value("total_tokens", Json()) : Json();
  constexpr double most = 1e12;
  const double tokens = total.is_number() ? total.get<double>() : 0;
  return tokens >= 0 && tokens <= most ? std::llround(tokens) : 0;
}

}  // namespace

std::string completion_error(const Json& body) {
  const Json error = body.is_object() ? body.value("error", Json()) : Json();
  const Json message = error.is_object() ? error.value("message", Json()) : error;
  return message.is_string() ? message.get<std::string>() : "";
}

// Words for a finish_reason differ from server to server: those are refused that say that the content is not whole.
ChatReply read_completion(const std::string& body) {
  const Json json = parse_json(body, "language model's reply");
  const JsonReader reader(json, "language model's reply");
  if (!reader.has("choices"))
    if (const std::string says = completion_error(json); !says.empty()) throw NoAnswer("the server says: " + says);
  const auto choices = reader.at("choices").elements();
  if (choices.size() != 1) reader.at("choices").fail("one choice");
  const Json reason = choices[0].has("finish_reason") ? choices[0].at("finish_reason").json() : Json();
  for (const char* cut : {"length", "content_filter"})
    if (reason == cut) throw NoAnswer(fmt::format("the reply was cut off: finish_reason is {}", cut));
  for (const char* call : {"tool_calls", "function_call"})
    if (reason == call)
      throw NoAnswer(fmt::format("the model called a tool, and none was offered: finish_reason is {}", call));
  const JsonReader message = choices[0].at("message");
  const std::string text = content_of(message);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) {
    const bool says = message.has("refusal") && message.at("refusal").json().is_string();
    if (says) throw NoAnswer("the model refused: " + message.at("refusal").string());
    for (const char* thoughts : {"reasoning_content", "reasoning"})
      if (message.has(thoughts) && message.at(thoughts).json().is_string() && !message.at(thoughts).string().empty())
        throw NoAnswer(fmt::format("the reply is empty: the model only thought, in {}", thoughts));
    throw NoAnswer("the reply is empty");
  }
  return {text, tokens_of(json), 0};
}

}  // namespace lgabench
