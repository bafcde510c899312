// What the data directory says of the things on the table (mobile/*.json).
#pragma once
#include <map>
#include <string>
#include <vector>

namespace lgabench::mobile {

/// Textures that a type has in life, of each type that scenes can show.
const std::map<std::string, std::vector<std::string>>& natural_textures();

/// Likewise in scenes of the task fetch: of objects, and of receivers.
const std::map<std::string, std::vector<std::string>>& fetch_textures();
const std::map<std::string, std::vector<std::string>>& receiver_textures();

/// What a captioner may take a type for when it errs.
const std::map<std::string, std::vector<std::string>>& confusions();

/// Likewise in scenes of the task fetch, across classes too: of types, and of textures.
const std::map<std::string, std::vector<std::string>>& fetch_confusions();
const std::map<std::string, std::vector<std::string>>& texture_confusions();

/// What it says of something that it does not know: in no feature space.
constexpr const char* an_object = "an object";

}  // namespace lgabench::mobile
