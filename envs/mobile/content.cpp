#include <mobile/content.hpp>

#include <fmt/format.h>

#include <common/scene_members.hpp>
#include <mobile/mobile.hpp>
#include <mobile/tables.hpp>

#include <lgabench/core/contains.hpp>

namespace lgabench::mobile {

double read_share(const JsonReader& reader) {
  const double share = reader.number();
  if (!(share >= 0 && share <= 1)) reader.fail("a number within [0, 1]");
  return share;
}

const Content& content_of(const Scenario& scenario, const std::string& arm) {
  return dynamic_cast<const Content&>(arm == "train" ? *scenario.train : *scenario.arm(arm).scenes);
}

std::vector<std::string> scenario_members() { return {"distractor_types"}; }

std::vector<std::string> scene_members() {
  return {"distractors", "near_first", "several_right", "least_visible", "caption_error"};
}

Content read_content(const Scenario&, const JsonReader& file, const JsonReader* scenes, bool training) {
  Content content;
  if (training) content.distractors = {0, 1};
  for (const JsonReader& type : file.at("distractor_types").elements()) {
    if (natural_textures().count(type.string()) == 0) type.fail("a type of mobile/natural_textures.json");
    const auto& before = content.distractor_types;
    if (contains(before, type.string())) type.fail("each object type once");
    content.distractor_types.push_back(type.string());
  }
  if (content.distractor_types.empty()) file.at("distractor_types").fail("at least one object type");
  if (!scenes) return content;
  if (scenes->has("distractors"))
    content.distractors = common::read_distractors(scenes->at("distractors"), most_objects - 1);
  if (scenes->has("near_first")) {
    content.near_first = scenes->at("near_first").boolean();
    if (content.near_first && training) scenes->at("near_first").fail("no such member in \"train\"");
  }
  if (scenes->has("several_right")) content.several_right = scenes->at("several_right").boolean();
  if (scenes->has("least_visible")) content.least_visible = read_share(scenes->at("least_visible"));
  if (scenes->has("caption_error")) {
    if (training) scenes->at("caption_error").fail("no such member in \"train\"");
    content.caption_error = read_share(scenes->at("caption_error"));
  }
  return content;
}

}  // namespace lgabench::mobile
