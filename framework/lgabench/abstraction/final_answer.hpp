// How a language model's reply is read.
#pragma once
#include <string>

namespace lgabench {

/// The answer of the reply's last "final answer", in any case, markup and punctuation: "yes" or "no" is the word after
/// it. What a model thought aloud before "</think>" does not count. @throws MethodError for anything else: where no
/// yes or no follows, where a condition does ("yes, if it is red"), where the reply says both, on a line each or
/// after its answer, or where thoughts begin that do not end. No answer is never a no.
bool final_answer(const std::string& reply);

}  // namespace lgabench
