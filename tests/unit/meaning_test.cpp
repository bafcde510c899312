// Meanings that are more than one product: what is read, what is refused, and which objects are meant in a scene.
#include <lgabench/core/meaning.hpp>

#include <gtest/gtest.h>

#include <lgabench/core/error.hpp>
#include <lgabench/core/files.hpp>

namespace lgabench {
namespace {

const FeatureSpace& space() {
  static const FeatureSpace all{
      "test",
      {"apple", "banana", "bowl", "heart", "letter G", "letter R", "mug", "orange", "pallet", "plate"},
      {"blue", "green", "orange", "red", "yellow"}};
  return all;
}

Meaning read(const std::string& json) {
  const Json document = Json::parse(json);
  return read_meaning(JsonReader(document, "meaning.json"), space());
}

std::string complaint(const std::string& json) {
  try {
    read(json);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

// The objects of a case of golden/grounded.json, drawn.
Observation drawn(const Json& golden, const Json& one) {
  Observation scene;
  scene.size = {golden.at("rows"), golden.at("columns")};
  scene.ids.assign(scene.size.pixels(), 0);
  for (const Json& object : one.at("objects")) {
    Instance instance{object.at("id"), object.at("object_type"), object.at("texture"), 0};
    if (const Json& at = object.at("pixels"); !at.is_null())
      for (int row = at[0]; row < at[0].get<int>() + at[2].get<int>(); ++row)
        for (int column = at[1]; column < at[1].get<int>() + at[3].get<int>(); ++column) {
          scene.ids[static_cast<std::size_t>(row * scene.size.columns + column)] = instance.id;
          ++instance.pixels;
        }
    scene.instances.push_back(instance);
  }
  return scene;
}

TEST(Meaning, IsGroundedAsTheGoldenCasesSay) {
  const Json golden = read_json(std::filesystem::path(LGABENCH_GOLDEN) / "grounded.json");
  ASSERT_GE(golden.at("cases").size(), 26u);
  for (const Json& one : golden.at("cases")) {
    const Meaning meaning = read_meaning(JsonReader(one.at("target"), "grounded.json"), space());
    EXPECT_EQ(Json(grounded(meaning, drawn(golden, one))), one.at("meant")) << one.at("name");
  }
}

TEST(Meaning, OfOneProductIsWrittenAsItAlwaysWas) {
  const std::string product = R"({"object_types":["heart"],"textures":["red"]})";
  EXPECT_EQ(to_json(read(product)).dump(), product);
  EXPECT_EQ(to_json(read(R"({"sets": [)" + product + R"(], "which": null})")).dump(), product);
}

TEST(Meaning, ComesBackFromWhatIsWritten) {
  for (
      const char* json :
      {R"({"sets":[{"object_types":["apple"],"textures":["green"]},{"object_types":["banana"],"textures":["yellow"]}]})",
       R"({"sets":[{"object_types":["heart"],"textures":["red"]}],"which":{"of":{"object_types":["bowl"],"textures":["blue"]},"rule":"left_of"}})",
       R"({"sets":[{"object_types":["mug"],"textures":["red"]}],"which":{"order":["red","orange"],"rule":"first_in"}})"}) {
    const Meaning meaning = read(json);
    EXPECT_EQ(to_json(meaning).dump(), json);
    const Json document = Json::parse(json);
    EXPECT_EQ(read_unchecked_meaning(JsonReader(document, "frame")), meaning);
  }
}

TEST(Meaning, ReadsExceptions) {
  const Meaning meaning = read(R"({"object_types": {"except": ["pallet", "heart"]}, "textures": "ALL"})");
  EXPECT_FALSE(meaning.belongs("heart", "red"));
  EXPECT_TRUE(meaning.belongs("plate", "red"));
  EXPECT_EQ(meaning.product().object_types.size(), 8u);
}

TEST(Meaning, KeepsUnionsUncrossed) {
  const Meaning meaning = read(
      R"({"sets": [{"object_types": ["apple"], "textures": ["green"]}, {"object_types": ["banana"], "textures": ["yellow"]}]})");
  EXPECT_TRUE(meaning.belongs("apple", "green"));
  EXPECT_FALSE(meaning.belongs("apple", "yellow"));
  EXPECT_FALSE(meaning.is_product());
  EXPECT_THROW(meaning.product(), MethodError);
}

TEST(Meaning, RefusesWhatIsHostileWithItsPlace) {
  const std::string set = R"({"object_types": ["heart"], "textures": "ALL"})";
  const auto with = [&set](const std::string& which) {
    return R"({"sets": [)" + set + R"(], "which": )" + which + "}";
  };
  std::string many = R"({"sets": [)" + set;
  for (int i = 1; i < 10000; ++i) many += ", " + set;
  for (const auto& [json, words] : std::vector<std::pair<std::string, std::string>>{
           {with(R"({"rule": "above"})"), "rule"},
           {with(R"({"rule": "left_of"})"), "of"},
           {with(R"({"rule": "left_of", "of": {"object_types": [], "textures": "ALL"}})"), "which/of"},
           {with(R"({"rule": "leftmost", "of": )" + set + "}"), "of"},
           {with(R"({"rule": "first_in", "order": []})"), "which/order"},
           {with(R"({"rule": "first_in", "order": ["heart", "heart"]})"), "each name once"},
           {with(R"({"rule": "first_in", "order": ["heart", "red"]})"), "textures alone"},
           {R"({"sets": []})", "1 to 100 sets"},
           {many + "]}", "1 to 100 sets"},
           {R"({"sets": [)" + set + R"(], "object_types": ["heart"]})", "object_types"},
           {R"({"object_types": {"but": ["heart"]}, "textures": "ALL"})", "but"},
           {R"({"object_types": ["heart", "heart"], "textures": "ALL"})", "each name once"}}) {
    const std::string said = complaint(json);
    EXPECT_EQ(said.rfind("meaning.json", 0), 0u) << said << " for " << json.substr(0, 200);
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace lgabench
