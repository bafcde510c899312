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
  for (const Json& names : one.value("brought", Json::array())) scene.brought.push_back({names.at(0), names.at(1)});
  return scene;
}

TEST(Meaning, IsGroundedAsTheGoldenCasesSay) {
  const Json golden = read_json(std::filesystem::path(LGABENCH_GOLDEN) / "grounded.json");
  ASSERT_GE(golden.at("cases").size(), 29u);
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
       R"({"sets":[{"object_types":["mug"],"textures":["red"]}],"which":{"order":["red","orange"],"rule":"first_in"}})",
       R"({"turns":[{"sets":[{"object_types":["apple"],"textures":["green"]}],"take":"all"}]})",
       R"({"turns":[{"different":["texture"],"same":["object_type"],"sets":[{"object_types":["mug"],"textures":["blue","red"]}],"take":2},{"only_if_nothing":true,"sets":[{"object_types":["bowl"],"textures":["red"]}],"take":1}]})"}) {
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

TEST(Meaning, OfTurnsHoldsEachSetOnce) {
  const std::string apples = R"({"object_types": ["apple"], "textures": "ALL"})",
                    bowls = R"({"object_types": ["bowl"], "textures": ["red"]})";
  const Meaning meaning = read(R"({"turns": [{"sets": [)" + apples + R"(], "take": 2}, {"sets": [)" + bowls + ", " +
                               apples + R"(], "take": "all"}]})");
  EXPECT_EQ(meaning.sets.size(), 2u);
  EXPECT_TRUE(meaning.belongs("bowl", "red"));
  EXPECT_FALSE(meaning.belongs("bowl", "blue"));
  EXPECT_FALSE(read(R"({"turns": [{"sets": [)" + apples + R"(], "take": 2}]})").is_product());
  EXPECT_EQ(meaning.turns.front().take, 2);
  EXPECT_EQ(meaning.turns.back().take, std::nullopt);
  Meaning flat = meaning, other = meaning;
  flat.turns.clear();
  other.turns.back().take = 1;
  EXPECT_FALSE(flat == meaning);
  EXPECT_FALSE(other == meaning);
}

TEST(Meaning, RefusesTurnsThatAskForMoreThanThereCanBe) {
  const auto complaint_of = [](const std::string& turn) {
    const Json document = Json::parse(
        R"({"turns": [{"sets": [{"object_types": ["heart"], "textures": "ALL"}], "take": 1}, )" + turn + "]}");
    try {
      expect_possible(read_meaning(JsonReader(document, "meaning.json"), space()),
                      JsonReader(document, "meaning.json"));
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string fruit = R"("sets": [{"object_types": ["apple", "banana"], "textures": ["red"]},
                                        {"object_types": ["apple", "pallet"], "textures": ["blue", "red"]}])";
  EXPECT_EQ(complaint_of("{" + fruit + R"(, "take": 3})"), "");
  EXPECT_EQ(complaint_of("{" + fruit + R"(, "take": 2, "different": ["object_type", "texture"]})"), "");
  EXPECT_EQ(complaint_of("{" + fruit + R"(, "take": "all", "different": ["texture"]})"), "");
  EXPECT_EQ(complaint_of("{" + fruit + R"(, "take": 3, "different": ["object_type"]})"),
            "meaning.json: /turns/1/take: expected at most 2: its sets have no more object types, got 3");
  EXPECT_EQ(complaint_of("{" + fruit + R"(, "take": 3, "different": ["texture"]})"),
            "meaning.json: /turns/1/take: expected at most 2: its sets have no more textures, got 3");
}

TEST(Meaning, RefusesWhatIsHostileWithItsPlace) {
  const std::string set = R"({"object_types": ["heart"], "textures": "ALL"})";
  const auto with = [&set](const std::string& which) {
    return R"({"sets": [)" + set + R"(], "which": )" + which + "}";
  };
  const auto turn = [&set](const std::string& more) { return R"({"turns": [{"sets": [)" + set + "]" + more + "}]}"; };
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
           {R"({"turns": []})", "turns: expected 1 to 10 turns"},
           {R"({"turns": [)" + set + "]}", "/turns/0: unknown member \"object_types\""},
           {R"({"turns": [{"sets": [], "take": 1}]})", "turns/0/sets: expected 1 to 100 sets"},
           {R"({"sets": [)" + set + R"(], "turns": []})", "sets"},
           {turn(""), "take"},
           {turn(R"(, "take": 0)"), "turns/0/take"},
           {turn(R"(, "take": -1)"), "turns/0/take"},
           {turn(R"(, "take": 1.5)"), "turns/0/take"},
           {turn(R"(, "take": "most")"), "turns/0/take"},
           {turn(R"(, "take": 2, "same": ["colour"])"), "turns/0/same/0: expected object_type or texture"},
           {turn(R"(, "take": 2, "same": [])"), "turns/0/same"},
           {turn(R"(, "take": 2, "same": ["texture", "texture"])"), "each part once"},
           {turn(R"(, "take": 2, "same": ["texture"], "different": ["texture"])"), "turns/0/different"},
           {turn(R"(, "take": 1, "only_if_nothing": true)"), "turns/0/only_if_nothing: expected a turn before it"},
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
