#include <lgabench/abstraction/meaning_reply.hpp>

#include <algorithm>
#include <cctype>
#include <optional>

#include <lgabench/abstraction/final_answer.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

// One past the object's closing brace, for a text with its opening brace at `begin`; nothing if it does not end.
std::optional<std::size_t> end_of_object(const std::string& text, std::size_t begin) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = begin; i < text.size(); ++i) {
    if (quoted && text[i] == '\\') {
      ++i;
    } else if (text[i] == '"') {
      quoted = !quoted;
    } else if (!quoted && text[i] == '{') {
      ++depth;
    } else if (!quoted && text[i] == '}' && --depth == 0) {
      return i + 1;
    }
  }
  return std::nullopt;
}

// The outermost object that begins first from `from` on, or last of all where that is wanted.
std::optional<std::string> object_in(const std::string& text, std::size_t from, bool last) {
  std::optional<std::string> found;
  for (std::size_t begin = text.find('{', from); begin != std::string::npos; begin = text.find('{', begin + 1)) {
    const auto end = end_of_object(text, begin);
    if (!end) continue;
    found = text.substr(begin, *end - begin);
    if (!last) return found;
    begin = *end - 1;
  }
  return found;
}

// What `read` makes of the reply's answer.
template <class Read>
auto read_answer(const std::string& reply, Read&& read) {
  const std::string said = without_thoughts(reply), answer = "final answer";
  std::string lower = said;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::size_t at = lower.rfind(answer);
  std::optional<std::string> object;
  if (at != std::string::npos) object = object_in(said, at, false);
  if (!object) object = object_in(said, 0, true);
  if (!object) throw MethodError("expected a JSON object after \"Final answer:\"");
  try {
    const Json document = parse_json(*object, "the answer");
    return read(JsonReader(document, "the answer"));
  } catch (const InputError& e) {
    throw MethodError(e.what());
  }
}

}  // namespace

Meaning meaning_in(const std::string& reply, const FeatureSpace& space) {
  return read_answer(reply, [&space](const JsonReader& answer) { return read_meaning(answer, space); });
}

std::vector<Hypothesis> hypotheses_in(const std::string& reply, const FeatureSpace& space) {
  return read_answer(reply, [&space](const JsonReader& answer) {
    answer.only({"hypotheses"});
    return read_hypotheses(answer.at("hypotheses"), space);
  });
}

}  // namespace lgabench
