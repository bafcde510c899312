#include <lgabench/core/shipped.hpp>

#include <algorithm>
#include <system_error>

#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>

namespace lgabench {

bool is_shipped(const fs::path& file) {
  const fs::path data = data_directory();
  const auto end = std::mismatch(data.begin(), data.end(), file.begin(), file.end());
  return end.first == data.end() && std::find(end.second, file.end(), "..") == file.end();
}

Json read_shipped_json(const fs::path& file) {
  static MadeOnce<Json> all;
  return is_shipped(file) ? all.of(file.string(), [&] { return read_json(file); }) : read_json(file);
}

const std::string& shipped_sha256(const fs::path& file) {
  static MadeOnce<std::string> all;
  return all.of(file.string(), [&] { return sha256_file(file); });
}

const std::vector<std::string>& shipped_names(const std::string& folder) {
  static MadeOnce<std::vector<std::string>> all;
  const fs::path directory = data_directory() / folder;
  return all.of(directory.string(), [&] {
    std::error_code none_to_list;
    return json_names(directory, none_to_list);
  });
}

const std::vector<std::string>& shipped_answers() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names = shipped_names("answers"), folders;
    for (const auto& entry : fs::directory_iterator(data_directory() / "answers"))
      if (entry.is_directory()) folders.push_back(entry.path().filename().string());
    std::sort(folders.begin(), folders.end());
    for (const std::string& folder : folders)
      for (const std::string& name : shipped_names("answers/" + folder)) names.push_back(folder + "/" + name);
    return names;
  }();
  return all;
}

}  // namespace lgabench
