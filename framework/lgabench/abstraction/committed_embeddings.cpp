#include <lgabench/abstraction/committed_embeddings.hpp>

#include <fmt/format.h>

#include <utility>

#include <lgabench/core/files.hpp>
#include <lgabench/core/json.hpp>

namespace lgabench {

std::map<std::string, std::vector<float>> committed_embeddings() {
  const fs::path directory = data_directory() / "embeddings";
  std::error_code error;
  const std::vector<std::string> names = json_names(directory, error);
  if (error) throw InputError(fmt::format("{}: cannot be read: {}", directory.string(), error.message()));

  std::map<std::string, std::vector<float>> all;
  for (const std::string& name : names) {
    const fs::path file = directory / (name + ".json");
    const Json document = read_json(file);
    const JsonReader embeddings = JsonReader(document, file.string()).at("embeddings");
    for (const auto& item : embeddings.json().items()) {
      std::vector<float> vector;
      for (const JsonReader& number : embeddings.at(item.key()).elements())
        vector.push_back(static_cast<float>(number.number()));
      if (vector.size() != embedding_size)
        embeddings.at(item.key()).fail(fmt::format("{} numbers ({} were read)", embedding_size, vector.size()));
      all.emplace(item.key(), std::move(vector));
    }
  }
  return all;
}

}  // namespace lgabench
