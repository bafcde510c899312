// The document that a run's report is: everything that any of its writers shows.
#pragma once
#include <string>
#include <vector>

#include <lgabench/document/document.hpp>
#include <lgabench/report/pictures.hpp>
#include <lgabench/statistics/about_suite.hpp>
#include <lgabench/statistics/claims.hpp>
#include <lgabench/statistics/engines.hpp>
#include <lgabench/statistics/paper.hpp>
#include <lgabench/statistics/summary.hpp>

namespace lgabench::report {
using namespace document;
using namespace statistics;

/// Styles of a run's rows.
MethodStyles styles_of(const Summary& summary, const RunResults& run);

/// What a report is made of; refers to its parts, which must outlive it.
struct Material {
  const RunResults& run;
  const Summary& summary;
  const std::vector<Claim>& claims;
  const std::vector<EngineAgreement>& agreements;
  const PaperValues& paper;
  const Pictures& pictures;
  MethodStyles styles = styles_of(summary, run);
  AboutSuite about = about_suite(run.suite, run.record.about);
};

/// A report has the same sections in every form. The same material gives the same document.
Document report_document(const Material& material);

/// The section on claims, which a terminal shows by itself.
Section claims_section(const std::vector<Claim>& claims, const MethodStyles& styles, const std::string& title,
                       const AboutSuite& about = {});

/// What the page's script shows of a row: its episodes, and the pictures of those that failed (docs/formats).
Json page_data(const Material& material);

}  // namespace lgabench::report
