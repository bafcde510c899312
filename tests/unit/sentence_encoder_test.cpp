// The sentence encoder against golden values of the reference implementation
// (tests/reference/make_sentence_encoder.py).
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include <lgabench/abstraction/recorded.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/abstraction/selection_text.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/learning/safetensors.hpp>
#include <lgabench/learning/sentence_embeddings.hpp>
#include <lgabench/learning/sentence_encoder.hpp>
#include <lgabench/learning/word_pieces.hpp>

#include "testing.hpp"

namespace lgabench {
namespace {

const Json& golden() {
  static const Json json = read_json(fs::path(LGABENCH_TEST_REFERENCE) / "sentence_encoder.json");
  return json;
}

const SentenceEncoder& encoder() {
  static const SentenceEncoder shared(encoder_directory());
  return shared;
}

double farthest(const std::vector<float>& a, const std::vector<float>& b) {
  double most = a.size() == b.size() ? 0 : 1e9;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) most = std::max(most, std::abs(double{a[i]} - b[i]));
  return most;
}

TEST(WordPieces, AreThoseOfTheReference) {
  const WordPieces tokenizer(encoder_directory() / "vocab.txt");
  EXPECT_GE(golden().size(), 50u);
  for (const Json& row : golden())
    EXPECT_EQ(tokenizer.ids(row.at("sentence"), 256), row.at("ids").get<std::vector<std::int64_t>>())
        << row.at("sentence");
}

TEST(WordPieces, RefuseWhatIsNotText) {
  const WordPieces tokenizer(encoder_directory() / "vocab.txt");
  for (const char* bad : {"\xff", "a\xc3", "\xed\xa0\x80"})
    EXPECT_SAYS(message_of<InputError>([&] { tokenizer.ids(bad, 256); }), "expected UTF-8");
  const TemporaryDirectory directory;
  write_file(directory.path / "vocab.txt", "[CLS]\n[SEP]\na\n");
  EXPECT_SAYS(message_of<InputError>([&] { WordPieces(directory.path / "vocab.txt"); }), "expected a line \"[UNK]\"");
}

TEST(SentenceEncoder, GivesTheReferencesEmbeddings) {
  for (const Json& row : golden()) {
    const auto embedding = encoder().encode(row.at("sentence"));
    EXPECT_LT(farthest(embedding, row.at("embedding").get<std::vector<float>>()), 1e-5) << row.at("sentence");
    double norm = 0;
    for (const float v : embedding) norm += double{v} * v;
    EXPECT_NEAR(norm, 1, 1e-5);
  }
}

TEST(SentenceEncoder, AgreesWithTheCommittedEmbeddings) {
  SentenceEmbeddings committed;
  for (const char* utterance : {"Bring me the red heart.", "Rotate the block."})
    EXPECT_LT(farthest(encoder().encode(utterance), committed.of(utterance)), 1e-5) << utterance;
}

TEST(SentenceEncoder, RefusesOtherWeightsAndSaysWhichItWants) {
  const TemporaryDirectory directory;
  fs::copy_file(encoder_directory() / "vocab.txt", directory.path / "vocab.txt");
  write_file(directory.path / "model.safetensors", "nothing of the kind");
  EXPECT_SAYS(message_of<InputError>([&] { SentenceEncoder encoder(directory.path); }),
              "expected the weights with SHA-256 53aa");
}

// Without the encoder's weights, as on most machines.
class WithoutWeights : public testing::Test, public TemporaryDirectory {
 protected:
  WithoutWeights() { setenv("LGABENCH_ENCODER", path.c_str(), 1); }
  ~WithoutWeights() override { unsetenv("LGABENCH_ENCODER"); }
};

TEST_F(WithoutWeights, TheShippedCommandsAndSelectionsHaveEmbeddings) {
  SentenceEmbeddings embeddings;
  const auto dot = [&](const std::string& a, const std::string& b) {
    double sum = 0;
    for (std::size_t i = 0; i < 384; ++i) sum += double{embeddings.of(a)[i]} * embeddings.of(b)[i];
    return sum;
  };
  for (const std::string& id : scenario_ids()) {
    const Scenario s = load_scenario(id);
    if (!s.json.contains("answers")) continue;  // an example: nobody was asked about it
    if (s.task == "errands") continue;          // none of its rows reads sentences
    for (std::size_t c = 0; c < s.commands.size(); ++c) {
      std::vector<std::string> sentences{s.commands[c].utterance, selection_text(s.commands[c].truth, s.space)};
      for (const std::string& source : recorded_sources()) {
        RecordedLanguageModel model(s, source);
        if (!model.knows(s.command(static_cast<int>(c)))) continue;
        const Selection selection = select_features(s.command(static_cast<int>(c)), s.space, model);
        sentences.push_back(selection_text(selection, s.space));
      }
      for (const std::string& sentence : sentences) EXPECT_NEAR(dot(sentence, sentence), 1, 1e-6) << sentence;
    }
  }
  EXPECT_GT(dot("Bring me the heart.", "Bring me the red heart."), dot("Bring me the heart.", "Rotate the block."));
  EXPECT_SAYS(message_of<InputError>([&] { embeddings.of("Bring me the moon."); }), "lgabench encoder fetch");
}

TEST(SentenceEmbeddings, OfOtherSentencesComeFromTheEncoder) {
  SentenceEmbeddings embeddings;
  const std::vector<float> moon = embeddings.of("Bring me the moon.");
  EXPECT_EQ(moon, SentenceEncoder(encoder_directory()).encode("Bring me the moon."));
  EXPECT_EQ(moon, embeddings.of("Bring me the moon."));
}

// A header of JSON and the numbers 1, 2, 3, 4.
std::string file_of(const Json& header, std::uint64_t stated = 0) {
  const std::string text = header.dump();
  const std::uint64_t size = stated ? stated : text.size();
  const float numbers[] = {1, 2, 3, 4};
  return std::string(reinterpret_cast<const char*>(&size), 8) + text +
         std::string(reinterpret_cast<const char*>(numbers), 16);
}

TEST(Safetensors, AreReadAndChecked) {
  const TemporaryDirectory directory;
  const fs::path file = directory.path / "w.safetensors";
  const auto entry = [](const Json& shape, const Json& offsets, const char* type = "F32") {
    return Json{{"__metadata__", {{"format", "pt"}}},
                {"w", {{"dtype", type}, {"shape", shape}, {"data_offsets", offsets}}}};
  };
  write_file(file, file_of(entry({3, 1}, {4, 16})));
  const Safetensors read(file);
  EXPECT_EQ(read.get("w", {3, 1})[0], 2);
  EXPECT_EQ(read.get("w", {3, 1})[2], 4);
  EXPECT_SAYS(message_of<InputError>([&] { read.get("w", {1, 3}); }), "\"w\" of type F32 and shape [1, 3]");
  EXPECT_THROW(read.get("v", {3, 1}), InputError);
  const auto refusal = [&](const std::string& bytes) {
    write_file(file, bytes);
    return message_of<InputError>([&] { Safetensors(file).get("w", {3, 1}); });
  };
  EXPECT_SAYS(refusal("short"), "fewer than 8 bytes");
  EXPECT_SAYS(refusal(file_of(entry({3, 1}, {4, 16}), 1000000)), "header of 1000000 bytes");
  EXPECT_SAYS(refusal(file_of(entry({3, 1}, {4, 16}), 5)), "header in JSON");
  EXPECT_SAYS(refusal(file_of(entry({3, 1}, {8, 20}))), "/w/data_offsets: expected 12 bytes within");
  EXPECT_SAYS(refusal(file_of(entry({3, 1}, {4, 12}))), "/w/data_offsets: expected 12 bytes within");
  EXPECT_SAYS(refusal(file_of(entry({3, 1}, {16, 4}))), "/w/data_offsets");
  EXPECT_SAYS(refusal(file_of(entry({1000000000, 1000000000}, {0, 16}))), "/w/shape");
  // 2^64 numbers, which 64 bits count as none.
  EXPECT_SAYS(refusal(file_of(entry({1 << 24, 1LL << 40}, {0, 0})) + std::string(1 << 24, '\0')), "/w/shape");
  EXPECT_SAYS(refusal(file_of(entry({3, 1}, {4, 16}, "F16"))), "of type F32");
}

}  // namespace
}  // namespace lgabench
