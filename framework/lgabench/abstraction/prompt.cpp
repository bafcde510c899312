#include <lgabench/abstraction/prompt.hpp>

#include <fmt/format.h>

#include <lgabench/core/files.hpp>
#include <lgabench/core/filled.hpp>
#include <lgabench/core/hash.hpp>

namespace lgabench {

PromptTemplate::PromptTemplate(const std::string& name) {
  const fs::path file = data_directory() / "prompts" / name;
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

Prompt PromptTemplate::fill(const Command& command, const FeatureSpace& space) const {
  return fill(command, space, {});
}

}  // namespace lgabench
