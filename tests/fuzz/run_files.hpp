// A run directory as one text: "=== NAME" on a line of its own begins each file.
#pragma once
#include "fuzz.hpp"

namespace lgabench::fuzz {

/// Writes the text's files into the directory, which is made anew. A name that leads out of it is passed over.
inline void write_run(const fs::path& run, std::string_view text) {
  std::error_code nothing_there;
  fs::remove_all(run, nothing_there);
  fs::create_directories(run / "cells");
  for (const std::string_view part : split(text, "=== ")) {
    const std::size_t end = part.find('\n');
    const fs::path name = fs::path(part.substr(0, end)).lexically_normal();
    const bool within = !name.empty() && name.is_relative() && *name.begin() != ".." && part.find('\0') >= end;
    if (end != part.npos && within) write(run / name, part.substr(end + 1));
  }
}

}  // namespace lgabench::fuzz
