// A method that asks a language model now. services.lm holds recorded answers; for a model of your own choice, or for a
// command that nobody has asked about yet, connect to a server as here: any that follows OpenAI's API, named by
// OPENAI_BASE_URL, with the key in OPENAI_API_KEY. Each reply goes into the cassette, so that the next cell asks
// nothing.
#include <lgabench/abstraction/chat_model.hpp>
#include <lgabench/abstraction/openai_client.hpp>
#include <lgabench/abstraction/select_features.hpp>
#include <lgabench/learning/cloning_method.hpp>
#include <lgabench/plugin/plugin.hpp>

namespace {

using namespace lgabench;

class LiveModel : public CloningMethod {
 public:
  Selection select(const Command& command, const FeatureSpace& space, Services& services) override {
    const std::string model = services.options.at("model"), file = services.options.at("cassette");
    if (file.empty()) throw InputError("expected an option: --set live_model.cassette=FILE");
    Cassette cassette(file);
    OpenAiClient server(openai_from_environment());
    ChatLanguageModel lm(cassette, &server, {model});
    // One yes/no question a candidate; the Selection says who answered (live, or cassette) and what that cost.
    return select_features(command, space, lm);
  }
};

}  // namespace

// One process may write a cassette at a time: fill it with --jobs 1, or with `lgabench select --answers openai`.
LGABENCH_METHOD("live_model", "0.1", "LGA with a language model that is asked now", LiveModel,
                "{" LGABENCH_CLONING_OPTIONS R"(,
  "model": {"default": "gpt-4", "help": "the server's model", "source": "this example"},
  "cassette": {"default": "", "help": "file of the model's replies; grows as it is asked", "source": "this example"}})")
