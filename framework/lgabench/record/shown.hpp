// shown.json of a cell: what its policy read of some scenes, as pictures for a report's page. No result depends on it,
// so status.json has no checksum of it, and a cell may lack it.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/core/json.hpp>

namespace lgabench {

struct ShownScene {
  std::string arm;
  int index = 0;
  std::vector<std::pair<std::string, std::string>> pictures;  // caption, PNG in base64
  std::vector<std::string> texts, unread;                     // as in Shown
};

/// The file's text.
std::string to_text(const std::vector<ShownScene>& scenes);
/// The scenes that a cell's policy showed; none where the cell has no such file. No link is followed. @throws
/// InputError
std::vector<ShownScene> read_shown_scenes(const std::filesystem::path& cell);

}  // namespace lgabench
