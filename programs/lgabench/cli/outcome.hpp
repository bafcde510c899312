// How the verbs end that fill a run's directory: what they print, and the commands that go on from there.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/files.hpp>
#include <lgabench/report/report.hpp>

namespace lgabench::cli {

using Words = std::vector<std::string>;

/// The words of this program's command line, as typed.
Words command_line();

/// @throws InputError for what is no run's directory; it names runs that are near, or `status` where `cluster` wrote.
void expect_run(const fs::path& directory);

/// The script of a job array that `cluster` writes into a run's directory, and how many elements the one there has; 0
/// where there is none.
inline constexpr const char* array_script_name = "array.sbatch";
int array_elements(const fs::path& directory);

/// Says on stderr which version made a run, if another one than this.
void name_other_version(const statistics::RunResults& run);

/// The tables of a report on stdout; on a terminal its marks have a colour.
void print_tables(const report::Report& report);

/// What print_report() prints on stdout: the headline, the table of means and notes; that table alone; every table; or
/// summary.json.
enum class Printed { end, table, tables, json };

/// The claims below a title.
void print_claims_section(const std::vector<statistics::Claim>& claims, const std::string& title);

/// Names on stderr the cells that could not be read or were not played. @returns the exit status of a command that
/// prints the other cells' numbers: `otherwise`, unless a cell cannot be read or none finished
int exit_of(const statistics::RunResults& results, int otherwise);

/// The exit status where claims are tested: `regression` if one is reversed.
int verdict_of(const statistics::RunResults& results, const std::vector<statistics::Claim>& claims);

/// Tests rows[0] against rows[1] and prints that; @returns the exit status
int print_difference(const statistics::RunResults& run, const std::vector<std::string>& rows, bool json);

/// Writes the run's report, and prints it. Notes of the table alone go to stderr.
void print_report(const fs::path& run, Printed what);

/// A command's last line: the run's report.html.
void print_page(const fs::path& run);

}  // namespace lgabench::cli
