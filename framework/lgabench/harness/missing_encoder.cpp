#include <lgabench/harness/missing_encoder.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/shipped.hpp>

namespace lgabench {

std::string missing_encoder(const std::vector<std::string>& commands) {
  std::error_code error;
  if (has_encoder_library() && fs::exists(encoder_directory() / "model.safetensors", error)) return "";
  const fs::path directory = data_directory() / "embeddings";
  std::set<std::string> committed;
  for (const std::string& name : shipped_names("embeddings")) {
    const Json file = read_shipped_json(directory / (name + ".json"));
    for (const auto& embedding : file.at("embeddings").items()) committed.insert(embedding.key());
  }
  const auto first = std::find_if(commands.begin(), commands.end(), [&](const auto& c) { return !committed.count(c); });
  if (first == commands.end()) return "";
  return fmt::format(
      "\"{}\" has no committed embedding, and the sentence encoder is not in {}: methods that read the command fail; "
      "{}",
      *first, encoder_directory().string(), encoder_remedy());
}

}  // namespace lgabench
