// Random numbers, JSON, scenarios, actions: values that everything else stands on.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include <lgabench/core/action.hpp>
#include <lgabench/core/descriptor.hpp>
#include <lgabench/core/files.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/plain_directory.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/scenario.hpp>
#include <lgabench/core/terminal.hpp>
#include <lgabench/core/tree.hpp>
#include <tabletop/content.hpp>
#include <tabletop/two_poses.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

// Known answers of Random123's philox4x32_R 10.
TEST(Random, PhiloxKnownAnswers) {
  using Block = std::array<std::uint32_t, 4>;
  constexpr std::uint32_t ones = 0xffffffff;
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}), (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({ones, ones, ones, ones}, {ones, ones}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, StreamsAreNamed) {
  RandomStream a("a"), again("a"), b("b");
  std::vector<std::uint32_t> first, second, other;
  for (int i = 0; i < 9; ++i) {
    first.push_back(a.next());
    second.push_back(again.next());
    other.push_back(b.next());
  }
  EXPECT_EQ(first, second);
  EXPECT_NE(first, other);
  EXPECT_EQ(std::set<std::uint32_t>(first.begin(), first.end()).size(), 9u);  // blocks advance
}

TEST(Random, BelowIsUniform) {
  RandomStream random("below");
  std::array<int, 7> count{};
  constexpr int n = 70000;
  for (int i = 0; i < n; ++i) ++count.at(random.below(7));
  double chi2 = 0;
  for (const int c : count) chi2 += (c - n / 7.0) * (c - n / 7.0) / (n / 7.0);
  EXPECT_LT(chi2, 22.5);  // 6 degrees of freedom, p = .001
}

TEST(Random, UniformAndGaussianMoments) {
  RandomStream random("moments");
  double u = 0, g = 0, g2 = 0, g4 = 0;
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform(), z = random.gaussian();
    ASSERT_TRUE(x >= 0 && x < 1);
    u += x / n, g += z / n, g2 += z * z / n, g4 += z * z * z * z / n;
  }
  EXPECT_NEAR(u, .5, .003);
  EXPECT_NEAR(g, 0, .01);
  EXPECT_NEAR(g2, 1, .015);
  EXPECT_NEAR(g4, 3, .1);
}

TEST(Random, PermutationsAreAllAndEvenlyFrequent) {
  RandomStream random("permutation");
  std::map<std::vector<int>, int> count;
  for (int i = 0; i < 24000; ++i) ++count[random.permutation(4)];
  ASSERT_EQ(count.size(), 24u);
  for (const auto& [order, c] : count) EXPECT_NEAR(c, 1000, 150);
}

TEST(Hash, NeverChanges) {
  EXPECT_EQ(hex(hash64("")), "f52a15e9a9b5e89b");
  EXPECT_EQ(hex(hash64("heart")), "5a9382ed8c3c0810");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(JsonReader, NamesFileAndPlace) {
  const Json json = Json::parse(R"({"a": {"b": [1, "two", 3.5]}})");
  const JsonReader reader(json, "suite.json");
  const auto elements = reader.at("a").at("b").elements();
  EXPECT_EQ(elements[0].integer(0, 5), 1);
  const std::string wrong = message_of<Error>([&] { elements[1].integer(0, 5); });
  EXPECT_SAYS(wrong, "suite.json: /a/b/1: expected a whole number from 0 to 5, got \"two\"");
  EXPECT_SAYS(message_of<Error>([&] { elements[0].integer(2, 5); }), "from 2 to 5, got 1");
  EXPECT_SAYS(message_of<Error>([&] { elements[2].integer(0, 5); }), "got 3.5");
  EXPECT_SAYS(message_of<Error>([&] { reader.at("z"); }), "suite.json: /: expected a member \"z\"");
  EXPECT_SAYS(message_of<Error>([&] { reader.at("a").only({"c"}); }), "suite.json: /a: unknown member \"b\"");
  EXPECT_SAYS(message_of<Error>([&] { reader.at("a").string(); }), "expected a string");
  EXPECT_SAYS(message_of<Error>([&] { reader.elements(); }), "expected an array");
}

TEST(JsonReader, MalformedFileIsNamedWithItsLine) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path / "malformed.json";
  write_file(file, "{\n \"a\": 1,\n oops\n}\n");
  const std::string said = message_of<Error>([&] { read_json(file); });
  EXPECT_SAYS(said, file.string() + ": line 3");
  fs::remove(file);
  EXPECT_SAYS(message_of<Error>([&] { read_json(file); }), file.string() + ": cannot be read");
}

std::string json_refusal(const std::string& text) {
  return message_of<InputError>([&] { parse_json(text, "f.json"); });
}

TEST(ParseJson, RefusesWhatNoReaderCouldBear) {
  EXPECT_EQ(parse_json(R"({"a": [1, -2, 3.5, "x", null, true, {"b": {}}, []]})", "f").dump(),
            R"({"a":[1,-2,3.5,"x",null,true,{"b":{}},[]]})");
  EXPECT_EQ(parse_json("7", "f"), 7);
  const auto nested = [](std::size_t levels) { return std::string(levels, '[') + std::string(levels, ']'); };
  EXPECT_EQ(parse_json(nested(100), "f").dump(), nested(100));
  EXPECT_SAYS(json_refusal(nested(101)), "f.json: /0/0/0");
  EXPECT_SAYS(json_refusal(nested(101)), ": expected no more than 100 levels");
  EXPECT_SAYS(json_refusal(std::string(1000000, '[')), "no more than 100 levels");
  EXPECT_EQ(json_refusal(R"({"a": [0, {"b": 1, "c": 2, "b": 3}]})"),
            "f.json: /a/1: expected each member once, got a second \"b\"");
  EXPECT_EQ(json_refusal(R"({"a": 1e999})"), "f.json: /: expected a number within the range of a double");
  EXPECT_SAYS(json_refusal(std::string(400, '9')), "within the range of a double");
  EXPECT_SAYS(json_refusal("[1,\n2"), "f.json: line 2 (byte ");
  EXPECT_EQ(json_refusal(""), "f.json: byte 1: expected valid JSON");
  EXPECT_SAYS(json_refusal("[1] 2"), "expected valid JSON");
  EXPECT_EQ(json_or_null("[1"), Json());
  EXPECT_EQ(message_of<InputError>([] { parse_json_lines("{}\n[\n", "f.jsonl"); }),
            "f.jsonl: line 2: byte 2: expected valid JSON");
}

TEST(ReadFile, ReadsRegularFilesAlone) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path / "file", link = directory.path / "link", pipe = directory.path / "pipe";
  write_file(file, "bytes");
  fs::create_symlink(file, link);
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(read_file(link), "bytes");
  EXPECT_SAYS(message_of<InputError>([&] { read_file(link, Links::refused); }), "link: a symbolic link");
  EXPECT_SAYS(message_of<InputError>([&] { read_file(pipe); }), "pipe: cannot be read: not a regular file");
  EXPECT_SAYS(message_of<InputError>([] { read_file("/dev/zero"); }), "not a regular file");
  EXPECT_SAYS(message_of<InputError>([&] { read_file(directory.path); }), "not a regular file");
  EXPECT_SAYS(message_of<InputError>([&] { read_file(file, Links::followed, 4); }), "expected at most 4");
  fs::remove(link);
  EXPECT_SAYS(message_of<InputError>([&] { expect_plain_entries(directory.path); }), "pipe: expected a regular file");
  fs::remove(pipe);
  fs::create_symlink(file, link);
  EXPECT_SAYS(message_of<InputError>([&] { expect_plain_entries(directory.path); }),
              "link: a symbolic link, which a run may not hold");
}

TEST(Tree, IsMeasuredWithoutFollowingLinks) {
  const Scratch scratch("tree");
  fs::create_directories(scratch.path / "of/many/levels");
  write_file(scratch.path / "of/many/file", std::string(10000, 'x'));
  fs::create_directory_symlink("/usr", scratch.path / "link");
  const Descriptor opened(::open(scratch.path.c_str(), O_RDONLY | O_DIRECTORY));
  const TreeSize size = tree_size(opened.fd, 1000);
  EXPECT_EQ(size.files, 5u);
  EXPECT_GE(size.bytes, 10000u);
  EXPECT_LT(size.bytes, 100000u);
  EXPECT_EQ(tree_size(opened.fd, 3).files, 4u);
  fs::path deep = scratch.path;
  for (int i = 0; i < 100; ++i) fs::create_directory(deep /= "d");
  EXPECT_GT(tree_size(opened.fd, 1000).files, 1000u);
}

TEST(Tree, IsRemovedHoweverDeepAndShut) {
  const Scratch scratch("tree");
  const fs::path top = scratch.path / "top";
  fs::create_directory(top);
  write_file(scratch.path / "kept", "x");
  fs::create_symlink(scratch.path / "kept", top / "link");
  fs::create_directory(top / "0.up");  // a name that moving takes
  write_file(top / "0.up/file", "x");
  const std::string name(200, 'n');
  int at = ::open(top.c_str(), O_RDONLY | O_DIRECTORY);  // more than a path can name
  for (int i = 0; i < 300; ++i) {
    ASSERT_EQ(::mkdirat(at, name.c_str(), 0700), 0);
    const int below = ::openat(at, name.c_str(), O_RDONLY | O_DIRECTORY);
    ::close(::openat(below, "file", O_CREAT | O_WRONLY, 0600));
    ::mkdirat(below, "shut", 0300);
    ::close(::openat(below, "shut/file", O_CREAT | O_WRONLY, 0600));
    ::mkdirat(below, "closed", 0);
    ::close(at);
    at = below;
  }
  ::close(at);
  remove_tree(top);
  EXPECT_FALSE(fs::exists(fs::symlink_status(top)));
  EXPECT_EQ(read_file(scratch.path / "kept"), "x");
  remove_tree(top);  // which is not there
}

TEST(PlainDirectory, IsReadByNoWayThatLeadsOutOfIt) {
  const TemporaryDirectory directory;
  const fs::path files = directory.path / "files", secret = directory.path / "secret";
  fs::create_directory(files);
  fs::create_directory(secret);
  write_file(secret / "key", "secret");
  write_file(files / "own", "bytes");
  fs::create_directory(files / "below");
  fs::create_symlink(secret / "key", files / "link");
  ASSERT_EQ(::mkfifo((files / "pipe").c_str(), 0600), 0);
  const PlainDirectory before(files);
  EXPECT_EQ(before.kept_names(), std::vector<std::string>{"own"});
  EXPECT_EQ(before.kept_names(), std::vector<std::string>{"own"}) << "a second time";
  EXPECT_EQ(before.read_file("own"), "bytes");
  EXPECT_SAYS(message_of<InputError>([&] { before.read_file("link"); }), "files/link: a symbolic link");
  EXPECT_SAYS(message_of<InputError>([&] { before.read_file("own", 4); }), "expected at most 4");

  // A link takes its place: what was opened stays what it is, and what is opened now holds nothing.
  fs::rename(files, directory.path / "away");
  fs::create_directory_symlink(secret, files);
  EXPECT_EQ(before.read_file("own"), "bytes");
  for (const fs::path& nothing : {files, secret / "key", directory.path / "none"}) {
    const PlainDirectory now(nothing);
    EXPECT_TRUE(now.kept_names().empty()) << nothing;
    EXPECT_THROW(now.read_file("key"), InputError) << nothing;
  }
}

TEST(Printable, LeavesNoControlSequence) {
  EXPECT_EQ(printable("plain, φ̂ – \U0001F600\n\ttext"), "plain, φ̂ – \U0001F600\n\ttext");
  EXPECT_EQ(printable("\x1b[31m\r\x07\x7f"), "\\x1b[31m\\x0d\\x07\\u007f");
  EXPECT_EQ(printable("\xc2\x9b"
                      "31m\xe2\x80\xae"
                      "abc\xe2\x81\xa6"),
            "\\u009b31m\\u202eabc\\u2066");
  EXPECT_EQ(printable("\xff\xc3(\xed\xa0\x80\xc0\x80\xe2\x82"), "\\xff\\xc3(\\xed\\xa0\\x80\\xc0\\x80\\xe2\\x82");
  EXPECT_EQ(one_line("a\nb\tc"), "a\\nb\\x09c");
}

tabletop::Content content(const std::string& id, Truth truth) {
  return tabletop::content_of(*load_scenario(id, truth).train);
}

Json heart() { return load_scenario("heart").json; }

std::string refusal(const Json& json) {
  return message_of<Error>([&] { read_scenario(json, "mine.json"); });
}

TEST(Scenario, AllShippedOnesAreRead) {
  int pick_and_place = 0;
  for (const std::string& id : scenario_ids()) pick_and_place += load_scenario(id).task == "pick_and_place";
  EXPECT_EQ(pick_and_place,
            208);  // drawn has 100, words 56, q1 9 and as many paraphrased, persons 17, clutter 6, many_commands 8, q2
                   // two, ...
  const Scenario s = load_scenario("heart");
  EXPECT_EQ(s.commands[0].truth.target.product().object_types, std::vector<std::string>{"heart"});
  EXPECT_EQ(s.commands[0].truth.target.product().textures.size(), 83u);  // ALL
  EXPECT_EQ(s.commands[0].truth.provenance, Provenance::truth);
}

TEST(Scenario, DemonstrationsCountForEachSeenCommand) {
  EXPECT_EQ(load_scenario("heart").training_scenes(50), 50);
  EXPECT_EQ(load_scenario("q2_block").training_scenes(50), 50);
  for (const char* id : {"q3_fruit", "q3_food", "q3_utensil"}) {
    const Scenario s = load_scenario(id);
    EXPECT_EQ(s.training_scenes(50), 100) << id;
    EXPECT_EQ(s.commands_of("train"), (std::vector<int>{0, 1})) << "in turn";
  }
}

TEST(Scenario, ACommandMayNameTheArmThatGivesIt) {
  const Scenario s = load_scenario("paraphrase_red_heart");
  EXPECT_EQ(s.commands_of("train"), std::vector<int>{0});
  EXPECT_EQ(s.commands_of("original"), std::vector<int>{0});
  for (int i = 1; i < 5; ++i) {
    const std::string& arm = s.tests[static_cast<std::size_t>(i)].id;
    EXPECT_EQ(s.commands_of(arm), std::vector<int>{i}) << arm;
    EXPECT_EQ(s.is_ambiguous(arm), arm == "implied") << arm;
  }
  EXPECT_FALSE(s.is_ambiguous("train"));
  EXPECT_FALSE(s.is_ambiguous("original"));

  Json json = s.json;
  json["commands"][1].erase("arm");
  EXPECT_EQ(read_scenario(json, "mine.json").commands_of("polite"), (std::vector<int>{1, 2})) << "it names none";
  json["commands"].push_back(json["commands"][1]);
  json["commands"][5]["arm"] = "original";
  EXPECT_SAYS(refusal(json), "mine.json: /commands/5/arm: expected an arm with \"unseen\": true (synonym, polite, ");
  json["commands"][1]["arm"] = "synonym";
  json["commands"][1]["seen"] = true;
  EXPECT_SAYS(refusal(json), "mine.json: /commands/1/arm: expected \"seen\": false beside it");
  json = s.json;
  json["commands"][4].erase("arm");
  EXPECT_SAYS(refusal(json), "mine.json: /commands/4/ambiguous: expected \"arm\" or \"wording\" beside it");
  json = s.json;
  json["commands"][1]["arm"] = "polite";
  EXPECT_SAYS(refusal(json), "mine.json: /tests/1: expected a scenario with commands for this arm");
}

TEST(Scenario, TheReleasedTruthIsThePaperAuthorsAnnotations) {
  const auto textures = [](const char* id, Truth truth) {
    return load_scenario(id, truth).commands[0].truth.target.product().textures.size();
  };
  const struct {
    const char* id;
    std::size_t released, printed;
  } truths[] = {{"red_heart", 5, 4}, {"consonant_with_a_warm_color", 48, 37}, {"vowel_with_multiple_colors", 65, 62}};
  for (const auto& t : truths) {
    EXPECT_EQ(textures(t.id, Truth::released), t.released) << t.id;
    EXPECT_EQ(textures(t.id, Truth::printed), t.printed) << t.id;
    EXPECT_EQ(load_scenario(t.id, Truth::printed).json.at("truth"), "printed") << "a cell says so";
    EXPECT_FALSE(load_scenario(t.id, Truth::printed).json.contains("printed"));
    EXPECT_FALSE(load_scenario(t.id).json.contains("truth"));
  }
  EXPECT_EQ(load_scenario("heart", Truth::printed).json, load_scenario("heart").json) << "nothing differs";
  EXPECT_FALSE(content("consonant_with_a_warm_color", Truth::released).never_distractor)
      << "the list holds plain warm colours";
  EXPECT_EQ(read_truth("printed"), Truth::printed);
  EXPECT_SAYS(message_of<InputError>([] { read_truth("true"); }), "expected released or printed, got \"true\"");
}

TEST(Scenario, WarmColoursAreNeverDistractorsOfThePrintedTruth) {
  const Scenario s = load_scenario("consonant_with_a_warm_color", Truth::printed);
  const auto never = content("consonant_with_a_warm_color", Truth::printed).never_distractor;
  ASSERT_TRUE(never);
  EXPECT_EQ(never->object_types, s.space.object_types);
  for (const std::string& texture : s.space.textures) {
    bool warm = false;
    for (const char* word : {"red", "yellow", "orange", "pink"}) warm = warm || texture.find(word) != std::string::npos;
    EXPECT_EQ(never->contains("bowl", texture), warm) << texture;
  }
}

TEST(Scenario, RefusesBadInput) {
  Json json = heart();
  json["colour"] = "red";
  EXPECT_SAYS(refusal(json), "mine.json: /: unknown member \"colour\"");
  json = heart();
  json["commands"][0]["truth"]["target"]["textures"] = {"red", "reddish"};
  EXPECT_SAYS(refusal(json),
              "mine.json: /commands/0/truth/target/textures/1: expected a name of the feature space, got \"reddish\"");
  json["commands"][0]["truth"]["target"]["textures"] = {"red", "red"};
  EXPECT_SAYS(refusal(json), "expected each name once");
  json = heart();
  json["answers"] = {{"recorded", "gpt4"}};
  EXPECT_SAYS(
      refusal(json),
      "mine.json: /answers/recorded: expected one of: claude, claude_clutter, claude_drawn, claude_fetch, "
      "claude_instruction, claude_paraphrases, claude_track, claude_unheard, claude_words, gpt4_released, gpt4_study");
  json = heart();
  json["printed"] = {{"task", "rotate"}};
  EXPECT_SAYS(refusal(json), "mine.json: /printed: unknown member \"task\"");
  json = heart();
  json["task"] = "juggle";
  EXPECT_SAYS(refusal(json), "mine.json: /task: no task \"juggle\", expected one of: pick_and_place, rotate");
  json = heart();
  for (const char* name : {"", "a/../../b", "a\n", "a b", "=1"}) {
    Json named = heart();
    named["tests"][0]["arm"] = name;
    EXPECT_SAYS(refusal(named), "/tests/0/arm: expected a name of at most 64 letters");
  }
  json["tests"] = Json::array();
  EXPECT_SAYS(refusal(json), "mine.json: /tests: expected at least one arm");
  json = heart();
  json["commands"][0].erase("utterance");
  EXPECT_SAYS(refusal(json), "expected a member \"utterance\"");
  json = heart();
  json["commands"][0]["truth"]["avoid"] = json["commands"][0]["truth"]["target"];
  EXPECT_SAYS(refusal(json), "mine.json: /commands/0/truth: unknown member \"avoid\"");
  json = load_scenario("sweep_block_without_touching_pan").json;
  json["commands"][0]["truth"].erase("avoid");
  EXPECT_SAYS(refusal(json), "mine.json: /commands/0/truth: expected \"avoid\" for sweep");
  json = heart();
  json["environment"] = "kitchen";
  EXPECT_SAYS(refusal(json), "mine.json: /environment: no environment \"kitchen\", expected one of: mobile, tabletop");
  json = heart();
  json["commands"][0]["seen"] = false;
  EXPECT_SAYS(refusal(json), "mine.json: /commands: expected at least one seen command");
  json["commands"] = Json::array();
  EXPECT_SAYS(refusal(json), "mine.json: /commands: expected at least one seen command");
  json = heart();
  json["tests"].push_back({{"arm", "test"}});
  EXPECT_SAYS(refusal(json), "mine.json: /tests/1/arm: expected each arm once");
  json["tests"][1] = {{"arm", "second"}, {"unseen", true}};
  EXPECT_SAYS(refusal(json), "mine.json: /tests/1: expected a scenario with commands for this arm");
  json["tests"][1] = {{"arm", "second"}, {"distractors", {2, 1}}};
  EXPECT_SAYS(refusal(json), "mine.json: /tests/1/distractors/1: expected");
  json["tests"][1] = {{"arm", "second"}, {"label_noise", 1.5}};
  EXPECT_SAYS(refusal(json), "mine.json: /tests/1/label_noise: expected a probability");
  json["tests"][1] = {{"arm", "second"}, {"choice", {"heart", "hart"}}};
  EXPECT_SAYS(refusal(json), "mine.json: /tests/1/choice/1: expected an object type");
  json["tests"][1]["choice"] = std::vector<std::string>(6, "heart");
  EXPECT_SAYS(refusal(json), "mine.json: /tests/1/choice: expected at most 5 object types");
  json["tests"][1]["choice"] = {"heart", "star", "heart"};
  EXPECT_SAYS(refusal(json), "mine.json: /tests/1/choice/0: expected each object type once");
  json["tests"][1]["choice"] = Json::array();
  EXPECT_SAYS(refusal(json), "mine.json: /tests/1/choice: expected at least one object type");
  const Json set = json["commands"][0]["truth"]["target"];
  for (const auto& [member, value] : {std::pair<const char*, Json>{"target", set},
                                      {"distractors", {1, 1}},
                                      {"hard", true},
                                      {"later_letters", true},
                                      {"outside_all_commands", true}}) {
    json["tests"][1] = {{"arm", "second"}, {"choice", {"heart", "star"}}, {member, value}};
    EXPECT_SAYS(refusal(json), std::string("mine.json: /tests/1/") + member + ": expected no such member beside");
  }
  Json sweep = load_scenario("sweep_block_without_touching_pan").json;  // its choice is of what is to be avoided
  const Json truth = sweep["commands"][0]["truth"];
  sweep["tests"][0] = {{"arm", "test"}, {"choice", {"pan", "bowl"}}, {"target", truth["target"]}};
  EXPECT_NO_THROW(read_scenario(sweep, "mine.json"));
  sweep["tests"][0]["avoid"] = truth["avoid"];
  EXPECT_SAYS(refusal(sweep), "mine.json: /tests/0/avoid: expected no such member beside \"choice\"");
  sweep["tests"][0] = {{"arm", "test"}, {"choice", {"pan", "bowl", "ring"}}};
  EXPECT_SAYS(refusal(sweep), "mine.json: /tests/0/choice: expected at most 2 object types for sweep");
  json["tests"][1] = {{"arm", "train"}};
  EXPECT_SAYS(refusal(json), "mine.json: /tests/1/arm: expected another name");
  json = heart();
  json["train"] = {{"target", json["commands"][0]["truth"]["target"]}};
  EXPECT_SAYS(refusal(json), "mine.json: /train: expected \"as_method_asks\": false");
  json["train"] = {{"barrier_distances_m", {.21}}};
  EXPECT_SAYS(refusal(json), "mine.json: /train: unknown member \"barrier_distances_m\"");
  json = load_scenario("sweep_block_without_touching_pan").json;
  json["train"] = {{"barrier_distances_m", {.21, .05}}};
  EXPECT_SAYS(refusal(json), "mine.json: /train/barrier_distances_m/1: expected 0.15 to 0.3, got 0.05");
  json["train"] = {{"barrier_distances_m", Json::array()}};
  EXPECT_SAYS(refusal(json), "mine.json: /train/barrier_distances_m: expected at least one");
  json = heart();
  json["direction"] = "clockwise";
  EXPECT_SAYS(refusal(json), "mine.json: /: unknown member \"direction\"");
  json = load_scenario("rotate_block").json;
  json["direction"] = "left";
  EXPECT_SAYS(refusal(json), "mine.json: /direction: expected clockwise or counter_clockwise, got \"left\"");
  json["direction"] = "clockwise";
  json["angle_deg"] = -120;
  EXPECT_SAYS(refusal(json), "mine.json: /angle_deg: expected above 15, at most 180, got -120");
  json["angle_deg"] = 15;  // within the tolerance of no turn at all
  EXPECT_SAYS(refusal(json), "mine.json: /angle_deg: expected above 15, at most 180, got 15");
  EXPECT_SAYS(message_of<Error>([] { load_scenario("hart"); }), "no scenario \"hart\" (did you mean \"heart\"?)");
}

using tabletop::two_poses;
using tabletop::TwoPoses;

TEST(Action, IsRecordedWithOneSignOfEachQuaternion) {
  const TwoPoses action{{{.3, -.2}, {0, 0, .6, -.8}}, {{.5, .3}, {0, 0, 0, 1}}};
  const Action kept = as_stored(two_poses(), action);
  EXPECT_EQ(kept, (Action{.3f, -.2f, 0, 0, -.6f, .8f, .5f, .3f, 0, 0, 0, 1}));
  EXPECT_EQ(as_stored(two_poses(), kept), kept);
}

TEST(Action, ExecutableClipsAndNormalises) {
  const TwoPoses done = executable(two_poses(), TwoPoses{{{9, -9}, {0, 0, 3, 4}}, {{.5, .1}, {0, 0, 0, -2}}});
  EXPECT_EQ(done.pose0.position_m.x, .75);
  EXPECT_EQ(done.pose0.position_m.y, -.5);
  EXPECT_DOUBLE_EQ(done.pose0.rotation.z, .6);
  EXPECT_DOUBLE_EQ(done.pose0.rotation.w, .8);
  EXPECT_EQ(done.pose1.position_m.x, .5);
  EXPECT_DOUBLE_EQ(done.pose1.rotation.w, -1);
}

TEST(Action, RefusesWhatCannotBeCarriedOut) {
  const TwoPoses good{{{.5, 0}, {0, 0, 0, 1}}, {{.5, .3}, {0, 0, 0, 1}}};
  const auto refusal = [](const Action& action) {
    return message_of<MethodError>([&] { executable(two_poses(), action); });
  };
  EXPECT_NO_THROW(executable(two_poses(), good));
  TwoPoses bad = good;
  bad.pose1.position_m.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_SAYS(refusal(bad), "pose1.y: expected a finite number, got nan");
  bad = good;
  bad.pose0.rotation = {0, 0, 0, 1e-7};
  EXPECT_SAYS(refusal(bad), "pose0.qx: expected a rotation of norm 1e-6 or more, got 1e-07");
  bad.pose0.rotation.x = std::numeric_limits<double>::infinity();
  EXPECT_SAYS(refusal(bad), "pose0.qx: expected a finite number");
  bad = good;
  bad.pose1.position_m.x = 1e39;  // whose record would be infinite, which is no JSON
  EXPECT_SAYS(refusal(bad), "pose1.x: expected a number that a float can hold, got 1e+39");
  bad.pose1.position_m.x = -std::numeric_limits<float>::max();
  EXPECT_NO_THROW(executable(two_poses(), bad));
  EXPECT_SAYS(refusal({.5, 0}), "action: expected 12 numbers, got 2");
}

// What a plan of another environment may be: a place in the picture, a way to turn, a place on the floor.
TEST(Action, OfAnotherSpaceIsDataAsWell) {
  const ActionSpace plan{
      {{"u", "", 0, 1}, {"v", "", 0, 1}, {"cos", "", -1, 1}, {"sin", "", -1, 1}, {"x", "m", 0, 4}}, {{2, 3}}, {{1, 0}}};
  const Action action{.25, 1.5, -3, 4, 9};
  EXPECT_EQ(executable(plan, action), (Action{.25, 1, -.6, .8, 4}));
  EXPECT_EQ(as_stored(plan, action), action) << "an angle has no other sign";
  const Vec2 at = in_picture(plan, plan.places[0], action, {480, 640});
  EXPECT_EQ(at.x, 160);
  EXPECT_EQ(at.y, 480);
  const Json json = to_json(plan);
  EXPECT_EQ(to_json(read_action_space({json, "plan"})), json);
  Json bad = json;
  bad["rotations"][0] = {2, 5};
  EXPECT_SAYS(message_of<InputError>([&] { read_action_space({bad, "plan"}); }), "/rotations/0/1");
  bad["rotations"][0] = {2};
  EXPECT_SAYS(message_of<InputError>([&] { read_action_space({bad, "plan"}); }), "two numbers or four");
}

TEST(Action, MayLeadToStations) {
  ActionSpace plan{{{"u", "", 0, 1}, {"v", "", 0, 1}, {"x", "m", 0, 4}, {"y", "m", 0, 4}}, {}, {{1, 0}}};
  EXPECT_FALSE(to_json(plan).contains("stations")) << "files of tasks without stations are as they were";
  plan.stations = {{2, 3}, {{{.25, .5}, {1, 2}}, {{.25, .75}, {3, 4}}}};
  const Json json = to_json(plan);
  EXPECT_EQ(to_json(read_action_space({json, "plan"})), json);
  const auto refusal = [&json](const char* place, const Json& value) {
    Json bad = json;
    bad[Json::json_pointer(place)] = value;
    return message_of<InputError>([&] { read_action_space({bad, "plan"}); });
  };
  EXPECT_SAYS(refusal("/stations/numbers/1", 4), "/stations/numbers/1");
  EXPECT_SAYS(refusal("/stations/all/0/seen", {.1}), "/stations/all/0/seen: expected two numbers");
  EXPECT_SAYS(refusal("/stations/all/1/values", {.1}), "/stations/all/1/values: expected 2 numbers");
}

TEST(Scene, HashCoversEveryField) {
  Scene scene{"heart", "test", "cells", "test", "pick_and_place",
              {},      1,      2,       0,      {{"heart", "red", role::target, {.4, 0}, 0, 1}}};
  std::set<std::uint64_t> hashes{scene.hash()};
  const auto expect_new = [&](const std::function<void(Scene&)>& change) {
    Scene changed = scene;
    change(changed);
    EXPECT_TRUE(hashes.insert(changed.hash()).second) << canonical(to_json(changed));
  };
  expect_new([](Scene& s) { s.scenario = "letter"; });
  expect_new([](Scene& s) { s.arm = "hard"; });
  expect_new([](Scene& s) { s.layout = "continuous"; });
  expect_new([](Scene& s) { s.split = "dev"; });
  expect_new([](Scene& s) { s.task = "rotate"; });
  expect_new([](Scene& s) { s.parameters["angle_rad"] = 1; });
  expect_new([](Scene& s) { s.seed = 7; });
  expect_new([](Scene& s) { s.command = 1; });
  expect_new([](Scene& s) { s.index = 3; });
  expect_new([](Scene& s) { s.objects[0].object_type = "star"; });
  expect_new([](Scene& s) { s.objects[0].texture = "blue"; });
  expect_new([](Scene& s) { s.objects[0].role = role::goal; });
  expect_new([](Scene& s) { s.objects[0].position_m.x += 1e-15; });
  expect_new([](Scene& s) { s.objects[0].position_m.y += 1e-15; });
  expect_new([](Scene& s) { s.objects[0].yaw_rad = 1e-15; });
  expect_new([](Scene& s) { s.objects[0].instance_id = 2; });
  expect_new([](Scene& s) { s.objects.push_back(s.objects[0]); });
}

}  // namespace
}  // namespace lgabench
