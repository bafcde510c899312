#include <lgabench/core/run_layout.hpp>

#include <algorithm>

namespace lgabench {

const std::vector<std::string> cell_files{"cell.json",      "selection.json", "training.jsonl",
                                          "episodes.jsonl", "timing.json",    "log.txt"};

bool is_cell_key(const std::string& text) {
  return text.size() == 16 &&
         std::all_of(text.begin(), text.end(), [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

std::vector<std::string> read_cell_keys(const JsonReader& run) {
  std::vector<std::string> keys;
  for (const JsonReader& key : run.at("cells").elements()) {
    keys.push_back(key.string());
    if (!is_cell_key(keys.back())) key.fail("a cell's key, 16 hexadecimal digits");
  }
  return keys;
}

void expect_plain_run(const fs::path& run) {
  for (const fs::path& directory : {run, run / "cells", run / "answers", run / "figures"})
    expect_plain_entries(directory);
}

}  // namespace lgabench
