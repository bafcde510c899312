#include <lgabench/abstraction/final_answer.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/error.hpp>

namespace lgabench {
namespace {

struct Word {
  std::string text;
  int line = 0, sentence = 0;  // a line that ends also ends its sentence
};

// In lower case; letters and digits make words, all else parts them. Tags and LaTeX's commands are left out.
std::vector<Word> words_of(const std::string& text) {
  std::vector<Word> words;
  int line = 0, sentence = 0;
  bool parted = true, command = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    constexpr std::size_t longest_tag = 20;
    if (const std::size_t end = text[i] == '<' ? text.find('>', i) : std::string::npos; end < i + longest_tag) i = end;
    const char c = text[i];
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) == 0) {
      line += c == '\n';
      sentence += c == '\n' || c == '.' || c == '!' || c == '?';
      command = c == '\\';
      parted = true;
      continue;
    }
    if (command) continue;
    if (parted) words.push_back({"", line, sentence});
    words.back().text += static_cast<char>(std::tolower(byte));
    parted = false;
  }
  return words;
}

struct Statement {
  std::optional<bool> answer;  // none: something else follows
  bool begins_its_line = false;
  std::size_t end = 0;  // the word after it
};

std::vector<Statement> statements_of(const std::vector<Word>& words) {
  std::vector<Statement> all;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (words[i].text != "final" || words[i + 1].text != "answer") continue;
    std::size_t at = i + 2;
    if (at < words.size() && words[at].text == "is") ++at;
    Statement one{std::nullopt, i == 0 || words[i - 1].line != words[i].line, at + 1};
    if (at < words.size() && (words[at].text == "yes" || words[at].text == "no")) one.answer = words[at].text == "yes";
    all.push_back(one);
  }
  return all;
}

bool is_condition(const std::string& word) {
  constexpr std::array conditions{"if", "or", "unless", "but", "maybe", "depending", "depends"};
  return contains(conditions, word);
}

// A sentence after the answer that begins with such a word speaks of the answer; any other may be a pleasantry.
bool comes_back_to_it(const std::string& word) {
  constexpr std::array first_words{"yes",    "no",         "or",    "but", "unless", "wait",   "actually",
                                   "rather", "correction", "sorry", "hmm", "though", "however"};
  return contains(first_words, word);
}

// The reply's last bytes, from a character's beginning on.
std::string end_of(const std::string& reply) {
  constexpr std::size_t shown = 80;
  std::size_t begin = reply.size() - std::min(reply.size(), shown);
  while (begin < reply.size() && (static_cast<unsigned char>(reply[begin]) & 0xc0) == 0x80) ++begin;
  return reply.substr(begin);
}

// None where the reply has no answer, or more than one.
std::optional<bool> answer_in(const std::string& reply) {
  const std::vector<Word> words = words_of(without_thoughts(reply));
  const std::vector<Statement> statements = statements_of(words);
  if (statements.empty() || !statements.back().answer) return std::nullopt;
  const Statement& last = statements.back();
  const auto contradicts = [&last](const Statement& one) {
    return one.begins_its_line && one.answer && *one.answer != *last.answer;
  };
  if (std::any_of(statements.begin(), statements.end(), contradicts))
    throw MethodError("language model: expected one final answer, got a reply with both \"yes\" and \"no\"");
  const Word& answered = words[last.end - 1];
  int before = answered.sentence;
  bool counts = true;
  for (std::size_t i = last.end; i < words.size(); ++i) {
    const auto& [word, line, sentence] = words[i];
    if (sentence != before) counts = comes_back_to_it(word);
    before = sentence;
    if (!counts) continue;
    if (word == (*last.answer ? "no" : "yes") || (*last.answer && word == "not")) return std::nullopt;
    if (line == answered.line && is_condition(word)) return std::nullopt;
  }
  return last.answer;
}

// The marks that a line says after "final answer", from word `at` on; none where it says something else. Words after
// them ("1 (the heart)") are a remark, unless a number or a condition is among them.
std::optional<std::set<int>> marks_at(const std::vector<Word>& words, std::size_t at, int most) {
  std::set<int> marks;
  bool none = false, remarks = false;
  for (const std::size_t first = at; at < words.size() && words[at].line == words[first].line; ++at) {
    const std::string& word = words[at].text;
    const bool is_number = word.size() <= 3 && word.find_first_not_of("0123456789") == std::string::npos;
    if (word == "and" || word == "mark" || word == "marks") continue;
    if (!is_number && word != "none" && (none || !marks.empty())) {
      if (is_condition(word) || word == "not") return std::nullopt;
      remarks = true;
      continue;
    }
    if (remarks) return std::nullopt;
    none = none || word == "none";
    if (word == "none") continue;
    if (!is_number) return std::nullopt;
    const int mark = std::stoi(word);
    if (mark < 1 || mark > most)
      throw MethodError(fmt::format("language model: there is no mark {}, there are 1 to {}", word, most));
    marks.insert(mark);
  }
  if (none == !marks.empty()) return std::nullopt;  // neither, or both
  return marks;
}

}  // namespace

// The models' own marks, and those that servers pass on: of DeepSeek and Qwen, Mistral, Kimi, Seed-OSS and gpt-oss.
std::string without_thoughts(const std::string& reply) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 7> marks{
      {{"<think>", "</think>"},
       {"<thinking>", "</thinking>"},
       {"<thought>", "</thought>"},
       {"[THINK]", "[/THINK]"},
       {"\u25c1think\u25b7", "\u25c1/think\u25b7"},
       {"<seed:think>", "</seed:think>"},
       {"<|channel|>analysis", "<|channel|>final<|message|>"}}};
  std::string_view rest = reply;
  for (const auto& [begin, end] : marks) {
    if (const std::size_t ended = rest.rfind(end); ended != rest.npos) rest.remove_prefix(ended + end.size());
    if (rest.find(begin) != rest.npos)
      throw MethodError(
          fmt::format("language model: expected an answer after \"{}\", got a reply whose thoughts do not end", end));
  }
  return std::string(rest);
}

std::vector<int> final_marks(const std::string& reply, int most) {
  const std::vector<Word> words = words_of(without_thoughts(reply));
  std::optional<std::set<int>> said, stated;  // the last, and the last that begins its line
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    if (words[i].text != "final" || words[i + 1].text != "answer") continue;
    const bool is = i + 2 < words.size() && words[i + 2].text == "is";
    const std::optional<std::set<int>> marks = marks_at(words, i + (is ? 3 : 2), most);
    const bool begins_its_line = i == 0 || words[i - 1].line != words[i].line;
    if (stated && marks && begins_its_line && *marks != *stated)
      throw MethodError("language model: expected one final answer, got a reply with two");
    said = marks;
    if (begins_its_line) stated = marks;
  }
  if (!said)
    throw MethodError(fmt::format(
        "language model: expected a last line \"Final answer:\" and numbers, or none, got a reply that ends \"{}\"",
        end_of(reply)));
  return {said->begin(), said->end()};
}

bool final_answer(const std::string& reply) {
  if (const std::optional<bool> answer = answer_in(reply)) return *answer;
  throw MethodError(fmt::format(
      "language model: expected a last line \"Final answer: yes\" or \"... no\", got a reply that ends \"{}\"",
      end_of(reply)));
}

}  // namespace lgabench
