#include <lgabench/abstraction/prompt.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/filled.hpp>
#include <lgabench/core/hash.hpp>

namespace lgabench {
namespace {

const std::vector<std::string> placeholders{"{object_types}", "{textures}", "{command}",
                                            "{about}",        "{group}",    "{candidate}"};

// What stands in braces like a placeholder, with its line; JSON in braces does not.
std::vector<std::pair<std::string, int>> words_in_braces(const std::string& text) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
  std::vector<std::pair<std::string, int>> all;
  for (std::size_t at = text.find('{'); at != text.npos; at = text.find('{', at + 1)) {
    const std::size_t end = text.find_first_not_of(letters, at + 1);
    if (end != text.npos && end > at + 1 && text[end] == '}')
      all.emplace_back(text.substr(at, end + 1 - at),
                       1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<long>(at), '\n')));
  }
  return all;
}

}  // namespace

PromptTemplate::PromptTemplate(const std::string& text, const std::string& place) {
  const std::string rule = "\n---\n";
  const std::size_t at = text.find(rule);
  if (at == std::string::npos) throw InputError(place + ": expected a line --- between system and user prompt");
  text_ = {text.substr(0, at), text.substr(at + rule.size())};
  version_ = sha256(text);
}

PromptTemplate::PromptTemplate(const std::string& name)
    : PromptTemplate(read_file(data_directory() / "prompts" / name), (data_directory() / "prompts" / name).string()) {}

PromptTemplate PromptTemplate::of_text(const std::string& text, const std::string& place) {
  return text.empty() ? PromptTemplate() : PromptTemplate(text, place);
}

std::string read_prompt(const fs::path& file) {
  if (file.empty()) return "";
  constexpr std::uintmax_t most = std::uintmax_t{64} << 10;
  const std::string place = file.string(), text = read_file(file, Links::followed, most);
  if (text.find_first_not_of(" \t\r\n") == text.npos)
    throw InputError(
        fmt::format("{}: expected a prompt with {}, the file is empty", place, fmt::join(placeholders, ", ")));
  std::vector<std::string> missing = placeholders;
  for (const auto& [word, line] : words_in_braces(text)) {
    if (!contains(placeholders, word))
      throw InputError(
          fmt::format("{}: line {}: expected {}, got {}", place, line, fmt::join(placeholders, ", "), word));
    missing.erase(std::remove(missing.begin(), missing.end(), word), missing.end());
  }
  if (!missing.empty()) throw InputError(fmt::format("{}: expected {} in it too", place, fmt::join(missing, ", ")));
  try {
    canonical(text);
  } catch (const InputError&) {
    throw InputError(place + ": expected UTF-8");
  }
  PromptTemplate::of_text(text, place);
  return text;
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
