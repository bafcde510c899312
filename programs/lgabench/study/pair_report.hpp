// What a study of disputed pairs found, in words, tables and JSON.
#pragma once
#include <lgabench/document/document.hpp>
#include <lgabench/study/results.hpp>

namespace lgabench::study {

/// How many pairs people settle, and how far they agree.
std::string agreement_words(const StudyResults& results);
document::Section pairs_section(const StudyResults& results);
/// "agreement" of results.json.
Json pairs_json(const StudyResults& results);

}  // namespace lgabench::study
