// Where a run's answers come from, as a value and as the word that the command line, run.json, cells and entries have.
#pragma once
#include <string>
#include <variant>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// Published ones: of recorded_sources() the one named, or with "recorded" each scenario's own.
struct RecordedAnswers {
  std::string source = "recorded";
};
/// A language model's replies, kept: "cassette:" and the file, in cells and entries by the SHA-256 of its bytes.
struct CassetteAnswers {
  std::string file;
};
/// A server's model, asked while cells run: "openai:" and the model; on the command line, which names it elsewhere,
/// "openai" alone.
struct LiveAnswers {
  std::string model;
};
/// "none": nobody is asked, and a method that asks fails its cell.
struct NoAnswers {};

using AnswerSource = std::variant<RecordedAnswers, CassetteAnswers, LiveAnswers, NoAnswers>;

std::string to_string(const AnswerSource& source);
/// Every word is one: what is none of the others names recorded answers.
AnswerSource read_answer_source(const std::string& word);
/// Whether a cassette belongs to it: that of a server's replies is kept too.
inline bool has_cassette(const AnswerSource& source) {
  return std::holds_alternative<CassetteAnswers>(source) || std::holds_alternative<LiveAnswers>(source);
}

/// The words that --answers takes: "recorded", recorded_sources(), "openai", and with `none` "none"; beside them any
/// cassette:FILE.
std::vector<std::string> answer_words(bool none);
/// "" for one of them, else what is expected.
std::string answers_complaint(const std::string& word, bool none);

}  // namespace lgabench
