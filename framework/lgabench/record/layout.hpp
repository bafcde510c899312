// Names of what a run's directory holds.
#pragma once
#include <array>
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

/// What a cell does, one after the other; timing.json has the seconds of each, as "select_s".
extern const std::vector<std::string> cell_phases;

/// Names of a cell's files. What a method leaves is in a directory `files` beside them.
namespace cell_file {
inline constexpr const char *configuration = "cell.json", *selections = "selection.json", *training = "training.jsonl",
                            *episodes = "episodes.jsonl", *timing = "timing.json",
                            *shown = "shown.json",       // may lack, like `files`: no checksum, no result depends on it
                                *policy = "policy.bin",  // likewise, where a run keeps policies
                                    *perturbed = "perturbed.jsonl",  // where arms have perturbations
                                        *log = "log.txt",  // may hold anything: status.json has no checksum of it
                                            *status = "status.json";  // written last
}  // namespace cell_file
/// All but the status.
inline constexpr std::array cell_files{cell_file::configuration, cell_file::selections, cell_file::training,
                                       cell_file::episodes,      cell_file::timing,     cell_file::log};
/// The files without times: the cell's results, which its configuration decides bit by bit.
inline constexpr std::array result_files{cell_file::selections, cell_file::training, cell_file::episodes};

/// Names of what `report` writes beside run.json.
namespace report_file {
inline constexpr const char *summary = "summary.json", *summary_table = "summary.csv", *claims = "claims.json",
                            *episodes = "episodes.csv", *markdown = "report.md", *page = "report.html",
                            *figures = "figures", *tables = "tables";
}  // namespace report_file
/// Names of files that any document has, a study's too.
inline constexpr std::array document_entries{report_file::markdown, report_file::page, report_file::figures,
                                             report_file::tables};
/// What `run` and `report` write into a run's directory, and `run --fresh` deletes.
inline constexpr std::array run_entries{"cells",
                                        "answers",
                                        report_file::summary,
                                        report_file::summary_table,
                                        report_file::claims,
                                        report_file::markdown,
                                        report_file::page,
                                        report_file::figures,
                                        report_file::tables,
                                        report_file::episodes,
                                        "run.json"};
/// Its directories, but for the cells.
inline constexpr std::array run_directories{"answers", report_file::figures, report_file::tables};

/// Expects a line of training.jsonl: epoch, steps, loss, and curves, whose values lie within 1e100 of 0, so that means
/// over cells are finite. The line's writer and its readers ask here. @throws InputError
void expect_training_line(const JsonReader &line);

/// 16 hexadecimal digits: the name of a cell's directory.
bool is_cell_key(const std::string &text);

/// run.json's "cells". @throws InputError where one of them is no key.
std::vector<std::string> read_cell_keys(const JsonReader &run);

/// Expects run directories to hold regular files and directories, and no symbolic link: neither beside run.json nor in
/// cells/, answers/, figures/ and tables/. A cell's own entries are checked where the cell is read.
/// @throws InputError naming the first other entry.
void expect_plain_run(const fs::path &run);

}  // namespace lgabench
