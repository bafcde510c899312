// The source of a run's answers, as a value and as the word that the command line, run.json, cells and entries have.
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
/// A file of recorded answers that somebody wrote: "file:" and the file, in cells and entries by the SHA-256 of its
/// bytes; on the command line its name, which ends in .json.
struct FileAnswers {
  std::string file;
};
/// A server's model, asked while cells run: "openai:" and the model; on the command line, which names it elsewhere,
/// "openai" alone.
struct LiveAnswers {
  std::string model;
};
/// "none": nobody is asked, and a method that asks fails its cell.
struct NoAnswers {};

using AnswerSource = std::variant<RecordedAnswers, CassetteAnswers, FileAnswers, LiveAnswers, NoAnswers>;

std::string to_string(const AnswerSource& source);
/// Reads a word. Every word is valid: one that is none of the others names recorded answers.
AnswerSource read_answer_source(const std::string& word);
/// The ending of the file that is kept with a run or a board for it, SHA256 before it: ".jsonl" of a cassette, which a
/// server's replies have too; "" where there is none.
std::string kept_ending(const AnswerSource& source);

/// The words that --answers takes: "recorded", recorded_sources(), "openai", and with `none` "none"; beside them any
/// cassette:FILE and any FILE.json.
std::vector<std::string> answer_words(bool none);
/// "" for one of them, else what is expected.
std::string answers_complaint(const std::string& word, bool none);

}  // namespace lgabench
