// Which model a server is asked for, and with which request.
#pragma once
#include <string>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// A server's model, and all that a request to it holds beside the messages. Replies of two that differ are never
/// mixed.
struct AskedModel {
  std::string name;                    // as the server names it
  Json fields = {{"temperature", 0}};  // of the request's body, beside model and messages
  std::string prompt{};                // SHA-256 of the text that asks in place of prompts/selection.txt, if any

  /// The request's body.
  Json request(const Json& messages) const;
  /// Reads who was asked from a request's body. @throws InputError where it is no object.
  static AskedModel of(const std::string& name, const JsonReader& request);
};

/// The usual request with its fields changed by a JSON merge patch (RFC 7396), as --request gives it: a null leaves a
/// field out, and "" is no patch. @throws InputError for a patch that is no object, or changes what lgabench itself
/// decides: model, messages, stream. `prompt`: as --prompt gives it, read_prompt()'s; "": lgabench's own.
AskedModel asked_model(const std::string& name, const std::string& patch, const std::string& prompt = "");
/// The smallest patch that turns the usual request into the model's, {} if they are equal.
Json patch_of(const AskedModel& model);

/// "NAME", "NAME PATCH" where there is one, and " (prompt SHA256)" behind it where a text has one's own words: what
/// Cell::answers and a Selection's source say.
std::string to_text(const AskedModel& model);
/// Reads what to_text() writes.
AskedModel read_asked_model(const std::string& text);

/// A command line's words for the model: --model NAME, and --request 'PATCH' and --prompt FILE where it has them.
std::string command_words(const AskedModel& model);

}  // namespace lgabench
