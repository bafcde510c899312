// A study's results as a document, files and JSON.
#pragma once
#include <lgabench/document/document.hpp>
#include <lgabench/study/results.hpp>

namespace lgabench::study {

report::Document document_of(const StudyResults& results);
/// All numbers of the document (docs/formats: a study's results).
Json to_json(const StudyResults& results);
/// A line for each trial of every person, practice and interrupted ones included.
std::string trials_csv(const StudyResults& results);

/// Writes DIR/report.html, report.md, results.json, trials.csv, figures/ and tables/. Returns the document. @throws
/// InputError where there is no study.
report::Document write_report(const fs::path& directory);

}  // namespace lgabench::study
