// A server of chat completions on loopback that misbehaves on purpose, and whoever asks it.
#pragma once
#include <httplib.h>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <lgabench/abstraction/openai_client.hpp>
#include <lgabench/abstraction/select_features.hpp>

#include "testing.hpp"

namespace lgabench {

inline constexpr const char* key = "sk-secret-1234567890";

inline const FeatureSpace space{"small", {"heart", "star", "pan"}, {"red", "blue"}};
inline const Command command{"Bring me the red heart.", "pick_and_place"};

inline std::string completion(const std::string& text, const std::string& reason = "stop") {
  return Json{{"choices", {{{"message", {{"role", "assistant"}, {"content", text}}}, {"finish_reason", reason}}}},
              {"usage", {{"total_tokens", 7}}}}
      .dump();
}

// Answers yes where the question is about a heart or red, no otherwise, unless `misbehave` answers first.
class Server {
 public:
  using Handler = std::function<bool(int request, const httplib::Request&, httplib::Response&)>;

  explicit Server(Handler misbehave = {}) : misbehave_(std::move(misbehave)) {
    server_.Post("/v1/chat/completions", [this](const httplib::Request& request, httplib::Response& response) {
      const int number = ++requests;
      under_way(+1);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      {
        const std::lock_guard lock(mutex_);
        authorizations.insert(request.get_header_value("Authorization"));
        bodies.push_back(request.body);
      }
      if (!misbehave_ || !misbehave_(number, request, response)) {
        const bool yes = request.body.find("\\\"heart\\\"?") != std::string::npos ||
                         request.body.find("\\\"red\\\"?") != std::string::npos;
        response.set_content(completion(std::string("It depends.\n\n**Final answer:** ") + (yes ? "Yes." : "no")),
                             "application/json");
      }
      under_way(-1);
    });
    server_.new_task_queue = [] { return new httplib::ThreadPool(16); };
    port_ = server_.bind_to_any_port("127.0.0.1");
    thread_ = std::thread([this] { server_.listen_after_bind(); });
  }
  ~Server() {
    server_.stop();
    thread_.join();
  }

  OpenAiOptions options() const {
    OpenAiOptions options;
    options.base_url = "http://127.0.0.1:" + std::to_string(port_) + "/v1";
    options.api_key = key;
    options.first_wait_s = .01;
    options.timeout_s = 4;
    return options;
  }

  std::atomic<int> requests{0}, most_at_once{0};
  std::set<std::string> authorizations;
  std::vector<std::string> bodies;

 private:
  void under_way(int change) {
    const int now = at_once_ += change;
    for (int most = most_at_once; now > most && !most_at_once.compare_exchange_weak(most, now);) {
    }
  }

  httplib::Server server_;
  Handler misbehave_;
  std::mutex mutex_;
  std::atomic<int> at_once_{0};
  int port_ = 0;
  std::thread thread_;
};

class Chat : public testing::Test, public TemporaryDirectory {
 protected:
  fs::path tape() const { return path / "tape.jsonl"; }

  Selection ask(const OpenAiOptions* server, ChatOptions options = {"m"}) {
    options.model = "m";
    Cassette cassette(tape());
    std::unique_ptr<OpenAiClient> client;
    if (server) client = std::make_unique<OpenAiClient>(*server);
    ChatLanguageModel model(cassette, client.get(), options);
    return select_features(command, space, model);
  }
  // What asking this server ends with.
  std::string failure(const Server& server, int attempts = 2) {
    OpenAiOptions options = server.options();
    options.attempts = attempts;
    const std::string said = message_of<MethodError>([&] { ask(&options); });
    EXPECT_EQ(said.find(key), std::string::npos) << said;
    return said;
  }
  void expect_red_hearts(const Selection& selection) {
    EXPECT_EQ(selection.target, (FeatureSet{{"heart"}, {"red"}}));
    EXPECT_EQ(selection.source, "m");
  }
};

}  // namespace lgabench
