#include <lgabench/record/answer_source.hpp>

#include <fmt/format.h>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/core/contains.hpp>

namespace lgabench {
namespace {

constexpr std::string_view cassette = "cassette:", live = "openai", live_model = "openai:", none = "none",
                           written = "file:", ending = ".json";

}  // namespace

std::string to_string(const AnswerSource& source) {
  struct Word {
    std::string operator()(const RecordedAnswers& recorded) const { return recorded.source; }
    std::string operator()(const CassetteAnswers& kept) const { return std::string(cassette) + kept.file; }
    std::string operator()(const FileAnswers& kept) const { return std::string(written) + kept.file; }
    std::string operator()(const LiveAnswers& asked) const {
      return asked.model.empty() ? std::string(live) : std::string(live_model) + asked.model;
    }
    std::string operator()(const NoAnswers&) const { return std::string(none); }
  };
  return std::visit(Word(), source);
}

AnswerSource read_answer_source(const std::string& word) {
  const auto after = [&word](std::string_view prefix) {
    return word.rfind(prefix, 0) == 0 ? word.substr(prefix.size()) : "";
  };
  if (word == none) return NoAnswers();
  if (word == live) return LiveAnswers();
  if (const std::string model = after(live_model); !model.empty()) return LiveAnswers{model};
  if (const std::string file = after(cassette); !file.empty()) return CassetteAnswers{file};
  if (const std::string file = after(written); !file.empty()) return FileAnswers{file};
  if (word.size() > ending.size() && word.substr(word.size() - ending.size()) == ending) return FileAnswers{word};
  return RecordedAnswers{word};
}

std::string kept_ending(const AnswerSource& source) {
  if (std::holds_alternative<FileAnswers>(source)) return ".json";
  const bool replies = std::holds_alternative<CassetteAnswers>(source) || std::holds_alternative<LiveAnswers>(source);
  return replies ? ".jsonl" : "";
}

std::vector<std::string> answer_words(bool with_none) {
  std::vector<std::string> words = recorded_sources();
  words.insert(words.begin(), RecordedAnswers().source);
  words.emplace_back(live);
  if (with_none) words.emplace_back(none);
  return words;
}

std::string answers_complaint(const std::string& word, bool with_none) {
  const std::vector<std::string> words = answer_words(with_none);
  const AnswerSource source = read_answer_source(word);
  if (std::holds_alternative<CassetteAnswers>(source) || std::holds_alternative<FileAnswers>(source) ||
      contains(words, word))
    return "";
  return fmt::format("expected {}, cassette:FILE or FILE.json, got {}", fmt::join(words, ", "), word);
}

}  // namespace lgabench
