// What a language model is asked.
#pragma once
#include <filesystem>
#include <string>

#include <lgabench/core/language_model.hpp>

namespace lgabench {

/// A chat's first two messages.
struct Prompt {
  std::string system, user;
};

/// A template of the data directory's prompts/, whose version is the file's SHA-256. selection.txt: what the paper's
/// prompt asks (appendix, "Full Prompt"), in other words, and of the second set that the task has. meaning.txt: what a
/// command means, in one question; turns.txt: the same where objects are used in turn. hypotheses.txt: which unstated
/// preferences there may be, likewise.
class PromptTemplate {
 public:
  /// @throws InputError where the file is missing or lacks a part.
  explicit PromptTemplate(const std::string& file = "selection.txt");
  /// Of a text, as read_prompt() returns it, from `place`; its version is the text's SHA-256. Of "": selection.txt.
  /// @throws InputError likewise
  static PromptTemplate of_text(const std::string& text, const std::string& place = "--prompt");

  /// The messages that ask this question about the command. The feature space is told in full.
  Prompt fill(const Command& command, const FeatureSpace& space, const Question& question) const;
  /// Those that ask about the whole command.
  Prompt fill(const Command& command, const FeatureSpace& space) const;
  /// SHA-256 of the file; owned by the template.
  const std::string& version() const { return version_; }

 private:
  PromptTemplate(const std::string& text, const std::string& place);

  Prompt text_;
  std::string version_;
};

/// A text of one's own in place of selection.txt: it has a line --- between system and user prompt, and each of
/// selection.txt's six placeholders. "" where no file is given. @throws InputError, with file and line, for another
/// text, an empty one, and one above 64 KiB.
std::string read_prompt(const std::filesystem::path& file);

}  // namespace lgabench
