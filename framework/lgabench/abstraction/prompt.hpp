// What a language model is asked.
#pragma once
#include <string>

#include <lgabench/core/language_model.hpp>

namespace lgabench {

/// A chat's first two messages.
struct Prompt {
  std::string system, user;
};

/// The template prompts/selection.txt of the data directory: what the paper's prompt asks (appendix, "Full Prompt"), in
/// other words, and of the second set that the task has. Its version is the file's SHA-256.
class PromptTemplate {
 public:
  /// @throws InputError where the file is missing or lacks a part.
  PromptTemplate();

  /// The messages that ask this question about the command. The feature space is told in full.
  Prompt fill(const Command& command, const FeatureSpace& space, const Question& question) const;
  /// SHA-256 of the file; owned by the template.
  const std::string& version() const { return version_; }

 private:
  Prompt text_;
  std::string version_;
};

}  // namespace lgabench
