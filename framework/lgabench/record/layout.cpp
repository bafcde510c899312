#include <lgabench/record/layout.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lgabench {

const std::vector<std::string> cell_phases{"load", "select", "sample", "demonstrate", "learn", "evaluate"};

void expect_training_line(const JsonReader& line) {
  constexpr double most = 1e100;
  line.at("epoch").integer(1, std::numeric_limits<long long>::max());
  line.at("steps").integer(0, std::numeric_limits<long long>::max());
  line.at("loss");
  for (const auto& item : line.json().items())
    if (const JsonReader value = line.at(item.key()); !(std::abs(value.number()) <= most))
      value.fail(fmt::format("a number from {:g} to {:g}", -most, most));
}

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
  for (const fs::path& directory : {run, run / "cells"}) expect_plain_entries(directory);
  for (const char* name : run_directories) expect_plain_entries(run / name);
}

}  // namespace lgabench
