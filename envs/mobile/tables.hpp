// What the data directory says of the things on the table (mobile/*.json).
#pragma once
#include <map>
#include <string>
#include <vector>

namespace lgabench::mobile {

/// Textures that a type has in life, of each type that scenes can show.
const std::map<std::string, std::vector<std::string>>& natural_textures();

/// Textures that a type has in life, in scenes of the task fetch: of objects, and of receivers.
const std::map<std::string, std::vector<std::string>>& fetch_textures();
const std::map<std::string, std::vector<std::string>>& receiver_textures();

/// What a captioner may take a type for when it errs.
const std::map<std::string, std::vector<std::string>>& confusions();

/// What a captioner errs to in scenes of the task fetch, across classes too: of types, and of textures.
const std::map<std::string, std::vector<std::string>>& fetch_confusions();
const std::map<std::string, std::vector<std::string>>& texture_confusions();

/// What a captioner says of something that it does not know. No feature space has the word.
constexpr const char* an_object = "an object";

}  // namespace lgabench::mobile
