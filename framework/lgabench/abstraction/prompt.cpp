#include <lgabench/abstraction/prompt.hpp>

#include <fmt/format.h>

#include <cctype>

#include <lgabench/core/files.hpp>
#include <lgabench/core/filled.hpp>
#include <lgabench/core/hash.hpp>

namespace lgabench {

PromptTemplate::PromptTemplate() {
  const fs::path file = data_directory() / "prompts" / "selection.txt";
  const std::string text = read_file(file), rule = "\n---\n";
  const std::size_t at = text.find(rule);
  if (at == std::string::npos) throw InputError(file.string() + ": expected a line --- between system and user prompt");
  text_ = {text.substr(0, at), text.substr(at + rule.size())};
  version_ = sha256(text);
}

Prompt PromptTemplate::fill(const Command& command, const FeatureSpace& space, const Question& question) const {
  const bool type = question.group == Question::Group::object_type;
  const bool target = question.about == Question::About::target;
  const auto fill = [&](const std::string& text) {
    return filled(text, {{"{object_types}", fmt::format("{}", fmt::join(space.object_types, ", "))},
                         {"{textures}", fmt::format("{}", fmt::join(space.textures, ", "))},
                         {"{command}", command.utterance},
                         {"{about}", target || !command.second ? "the target object" : command.second->phrase},
                         {"{group}", type ? "object type" : "object color"},
                         {"{candidate}", question.candidate}});
  };
  return {fill(text_.system), fill(text_.user)};
}

bool final_answer(const std::string& reply) {
  // The last line with a letter in it, in lower case, without what decorates it.
  std::string line, last;
  for (const char c : reply + '\n') {
    if (c == '\n') {
      if (!line.empty()) last = line;
      line.clear();
    } else if (std::isalpha(static_cast<unsigned char>(c))) {
      line += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    } else if (!std::isspace(static_cast<unsigned char>(c)) &&
               std::string_view(":.*_`\"'#!").find(c) == std::string_view::npos) {
      line += c;
    }
  }
  if (last == "finalansweryes") return true;
  if (last == "finalanswerno") return false;
  constexpr std::size_t shown = 80;
  throw MethodError(fmt::format(
      "language model: expected a last line \"Final answer: yes\" or \"... no\", got a reply that ends \"{}\"",
      reply.substr(reply.size() - std::min(reply.size(), shown))));
}

}  // namespace lgabench
