// report.html: one page with everything inside it, to be looked at. The script adds interaction only: the tables and
// charts are there without it.
#pragma once
#include <string>

#include <lgabench/report/claims.hpp>
#include <lgabench/report/paper.hpp>
#include <lgabench/report/pictures.hpp>
#include <lgabench/report/summary.hpp>

namespace lgabench::report {

/// The page, from the installed page/ (template, style sheet, script). The same values give the same bytes.
/// @throws InputError where the installed page is missing.
std::string html(const RunResults& run, const Summary& summary, const std::vector<Claim>& claims,
                 const std::vector<EngineAgreement>& agreements, const PaperValues& paper, const Pictures& pictures);

}  // namespace lgabench::report
