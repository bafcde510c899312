// What a run directory that somebody sent may hold: names that lead nowhere else.
#pragma once
#include <string>
#include <vector>

#include <lgabench/core/json.hpp>
#include <lgabench/core/plain_directory.hpp>

namespace lgabench {

/// What a cell does, one after the other; timing.json has the seconds of each, as "select_s".
extern const std::vector<std::string> cell_phases;

/// The files of a finished cell, status.json, which is written last, excepted.
extern const std::vector<std::string> cell_files;
/// The one of them that is no result: it may hold anything, and status.json has no checksum of it.
constexpr const char* log_file = "log.txt";

/// What a method may leave beside them: names in the cell's files/, sorted, of at most 100 regular files whose names
/// are letters, digits, "_", "-" and ".", the last not first. What else is there is passed over.
std::vector<std::string> artefact_names(const PlainDirectory& files);

/// Expects a line of training.jsonl: epoch, steps, loss, and curves, whose values lie within 1e100 of 0, so that means
/// over cells are finite. The line's writer and its readers ask here. @throws InputError
void expect_training_line(const JsonReader& line);

/// 16 hexadecimal digits: the name of a cell's directory.
bool is_cell_key(const std::string& text);

/// run.json's "cells". @throws InputError where one of them is no key.
std::vector<std::string> read_cell_keys(const JsonReader& run);

/// Expects run directories to hold regular files and directories, and no symbolic link: neither beside run.json nor in
/// cells/, answers/, figures/ and tables/. A cell's own entries are checked where the cell is read.
/// @throws InputError naming the first other entry.
void expect_plain_run(const fs::path& run);

}  // namespace lgabench
