// How a language model's reply is read.
#pragma once
#include <string>
#include <vector>

namespace lgabench {

/// The answer of the reply's last "final answer", in any case, markup and punctuation: "yes" or "no" is the word after
/// it. Thoughts aloud do not count (without_thoughts()). @throws MethodError for anything else: where no yes or no
/// follows, where a condition does ("yes, if it is red"), where the reply says both, on a line each or after its answer
/// in the same line, and where a later line takes the answer back ("Wait: no."). No answer is never a no.
bool final_answer(const std::string& reply);

/// The numbers of the reply's last "final answer", sorted, each once; "none" is none. They stand in one line, with
/// nothing but "and", "mark" or "marks" between. @throws MethodError for anything else: where none follows, for a
/// number above `most` or 0, for lines that say different numbers, and for thoughts that do not end.
std::vector<int> final_marks(const std::string& reply, int most);

/// What stands after the thoughts that a model marks, as with "<think>" and "</think>". @throws MethodError where
/// thoughts begin that do not end.
std::string without_thoughts(const std::string& reply);

}  // namespace lgabench
