// A cassette's file, read, read by a second process, and asked. "(key)" stands for the key of the question.
#include <fmt/format.h>

#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/abstraction/final_answer.hpp>

#include "fuzz.hpp"

namespace {

using namespace lgabench;

const Command command{"Bring me the heart.", "pick_and_place"};
const FeatureSpace space{"tabletop", {"heart", "star"}, {"red"}};
const std::vector<Question> questions{{{}, {}, "heart"}};

// What a server is asked is what a cassette's key says.
std::string made_key() {
  struct Yes : ChatClient {
    ChatReply complete(const Json&) override { return {"Final answer: yes", 1, 1}; }
  } yes;
  const fs::path file = fuzz::directory() / "key.jsonl";
  Cassette cassette(file);
  ChatLanguageModel(cassette, &yes, {"a model"}).answer(command, space, questions);
  return read_json(file).at("key");
}

const std::string& key_of_the_question() {
  static const std::string key = made_key();
  return key;
}

std::string with_key(std::string_view text) {
  return fmt::format("{}", fmt::join(fuzz::split(text, "(key)"), key_of_the_question()));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fs::path file = fuzz::directory() / "fuzzed.jsonl";
  fuzz::write(file, with_key(fuzz::text_of(data, size)));
  try {
    Cassette cassette(file);
    const Cassette::Turn turn(cassette, {});
    canonical(Json(cassette.models()));
    canonical(Json(cassette.mean_seconds()));
    if (const std::optional<ChatReply> reply = cassette.find(key_of_the_question())) final_answer(reply->text);
    cassette.only_model();
  } catch (const InputError&) {
  } catch (const MethodError&) {
  }
  return 0;
}
