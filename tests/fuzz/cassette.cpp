// A cassette's file, read, asked, and asked by a second process. "(key)" stands for the key of the question.
#include <fmt/format.h>

#include <lgabench/abstraction/chat_model.hpp>

#include "fuzz.hpp"

namespace {

using namespace lgabench;

const Command command{"Bring me the heart.", "pick_and_place"};
const FeatureSpace space{"tabletop", {"heart", "star"}, {"red"}};
const std::vector<Question> questions{{{}, {}, "heart"}};

// What a server is asked is what a cassette's key says.
std::string key_of_the_question() {
  struct Yes : ChatClient {
    ChatReply complete(const Json&) override { return {"Final answer: yes", 1, 1}; }
  } yes;
  const fs::path file = fuzz::directory() / "key.jsonl";
  Cassette cassette(file);
  ChatLanguageModel(cassette, &yes, {"a model"}).answer(command, space, questions);
  return read_json(file).at("key");
}

std::string with_key(std::string_view text) {
  static const std::string key = key_of_the_question();
  const std::vector<std::string_view> parts = fuzz::split(text, "(key)");
  return fmt::format("{}", fmt::join(parts, key));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fs::path file = fuzz::write(fuzz::directory() / "fuzzed.jsonl", with_key(fuzz::text_of(data, size)));
  try {
    Cassette cassette(file);
    cassette.models();
    const Cassette::Turn turn(cassette, {});
    ChatLanguageModel model(cassette, nullptr, {"a model"});
    model.answer(command, space, questions);
    canonical({{"tokens", model.cost().lm_tokens}, {"seconds", model.cost().lm_seconds}});
  } catch (const InputError&) {
  } catch (const MethodError&) {
  }
  return 0;
}
