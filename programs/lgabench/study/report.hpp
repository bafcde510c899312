// A study's results as a document, files and JSON.
#pragma once
#include <lgabench/document/document.hpp>
#include <lgabench/study/results.hpp>

namespace lgabench::study {

document::Document document_of(const StudyResults& results);
/// All numbers of the document (docs/formats: a study's results).
Json to_json(const StudyResults& results);
/// A line for each trial of every person, practice and interrupted ones included.
std::string trials_csv(const StudyResults& results);

struct Report {
  document::Document document;
  std::size_t damaged = 0;  // people whose file cannot be read; stderr names them
  int used = 0;             // people who count
};
/// Writes DIR/report.html, report.md, results.json, trials.csv, figures/ and tables/. @throws InputError where there is
/// no study.
Report write_report(const fs::path& directory);

}  // namespace lgabench::study
