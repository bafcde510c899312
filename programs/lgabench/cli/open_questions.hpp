// Questions that `select` and its scores asked, and that have no answer.
#pragma once
#include <fmt/format.h>

#include <optional>
#include <string>
#include <vector>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/core/error.hpp>
#include <lgabench/core/terminal.hpp>

namespace lgabench::cli {

class OpenQuestions {
 public:
  void add(const Unanswered& lacking, const std::string& where = "") {
    for (const std::string& question : lacking.questions) lines_.push_back(where + question);
  }

  /// What `ask` returns, or nothing where an answer lacks or cannot be read, which is noted; `where` stands before it.
  template <class Ask>
  auto answered(Ask&& ask, const std::string& where = "") -> std::optional<decltype(ask())> {
    try {
      return ask();
    } catch (const Unanswered& e) {
      add(e, where);
    } catch (const Unread& e) {
      lines_.push_back(where + e.what());
    }
    return std::nullopt;
  }

  void add(const OpenQuestions& more) { lines_.insert(lines_.end(), more.lines_.begin(), more.lines_.end()); }

  /// Names each on stderr. @throws MethodError, "3 " and these words, where there is one
  void expect_none(const std::string& words) const {
    if (lines_.empty()) return;
    for (const std::string& line : lines_) to_stderr("no answer: {}\n", one_line(line));
    throw MethodError(fmt::format("{} {}", lines_.size(), words));
  }

 private:
  std::vector<std::string> lines_;
};

}  // namespace lgabench::cli
