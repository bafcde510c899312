// A test tool: rehearse PROTOCOL OUT PEOPLE. Simulated people take part in a study over HTTP, as browsers do. They are
// invented: no number of theirs is a result. They need no real time: the times that they report are drawn, slower in
// the condition human, and their answers are the truth with slips.
#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <thread>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/study/server.hpp>
#include <lgabench/study/session.hpp>
#include <lgabench/study/withdrawal.hpp>

namespace lgabench::study {
namespace {

constexpr double human_s = 120, edit_s = 45;           // median seconds
constexpr double spread_of_people = .25, spread = .3;  // of log seconds

// One session from consent to debriefing, on the pages that people get; `number` seeds the person.
class Person {
 public:
  Person(const Protocol& protocol, int port, int number)
      : protocol_(protocol),
        http_("127.0.0.1", port),
        random_(fmt::format("study rehearsal/{}/{}", protocol.seed, number)),
        first_(number == 0),
        slowness_(spread_of_people * random_.gaussian()) {}

  void take_part() {
    for (const char* path : {"/", "/study.css", "/study.js", "/object_types.png", "/textures.png"}) get(path);
    const Json about = parse_json(get("/study.json"), "/study.json");
    const Json begun =
        post("/begin", {{"key", random_id()}, {"consent", about.at("consent_sha256")}, {"simulated", true}});
    address_ = "/p/" + begun.at("id").get<std::string>();
    get(address_);
    Json state = say("opened");
    while (state.at("step") != "debriefing") state = next(state);
  }

 private:
  std::string get(const std::string& path) {
    const auto answer = http_.Get(path);
    if (!answer || answer->status != 200) fail(path, answer ? answer->status : 0);
    return answer->body;
  }

  Json post(const std::string& path, const Json& body) {
    const auto answer = http_.Post(path, canonical(body), "application/json");
    if (!answer || answer->status != 200) fail(path + " " + canonical(body), answer ? answer->status : 0);
    return parse_json(answer->body, path);
  }

  [[noreturn]] static void fail(const std::string& what, int status) {
    throw InputError(fmt::format("rehearsal: {}: status {}", what, status));
  }

  Json say(const std::string& kind, Json event = Json::object()) {
    event.update({{"key", random_id()}, {"page", "simulated"}, {"kind", kind}, {"page_ms", ms_}});
    return post(address_ + "/events", {{"events", {event}}});
  }

  Json next(const Json& state) {
    const std::string step = state.at("step");
    ms_ += 1000 * random_.uniform(2, 40);
    if (step == "familiarisation") return say("familiarised");
    if (step == "example") return say("example_seen");
    if (step == "trial") return answer(say("start").at("trial"));
    Json tlx;
    for (const char* scale : {"mental", "physical", "temporal", "performance", "effort", "frustration"})
      tlx[scale] = 5 * random_.below(21);
    // Words that a report must not interpret, once.
    const bool talks = first_ && state.at("free_text").get<bool>();
    return say("questionnaire", {{"tlx", tlx}, {"free_text", talks ? "simulated <b>words</b> | of *nobody*" : ""}});
  }

  // The words of a list that are chosen: what is right, with a slip here and there.
  Json chosen(const std::vector<std::string>& right, const Json& known) {
    constexpr double missed = .03, added = .01;
    Json words = Json::array();
    for (const Json& word : known) {
      const bool is_right = contains(right, word.get<std::string>());
      if (is_right ? random_.uniform() > missed : random_.uniform() < added) words.push_back(word);
    }
    if (words.empty()) words.push_back(right.empty() ? known.front() : Json(right.front()));
    return words;
  }

  const Item& item(const std::string& asked_as) const {
    for (const auto* items : {&protocol_.sets.front(), &protocol_.sets.back(), &protocol_.spares})
      for (const Item& one : *items)
        if (one.asked_as == asked_as) return one;
    return protocol_.practice;
  }

  // Of what is disputed each pair has its share of yes; of what is settled hardly anybody misses the truth.
  Json judge(const Json& trial) {
    const Item& asked = item(trial.at("command"));
    Json answers = Json::array();
    for (const Json& shown : trial.at("pairs")) {
      const AskedPair& pair = *std::find_if(asked.pairs.begin(), asked.pairs.end(), [&shown](const AskedPair& one) {
        return one.object_type == shown.at("object_type") && one.texture == shown.at("texture");
      });
      RandomStream own(
          fmt::format("study rehearsal/{}/{}/{}/{}", protocol_.seed, asked.asked_as, pair.object_type, pair.texture));
      const double yes = pair.settled ? (*pair.settled ? .98 : .02) : own.uniform();
      answers.push_back(random_.uniform() < .04 && !pair.settled ? "can't tell"
                        : random_.uniform() < yes                ? "yes"
                                                                 : "no");
    }
    ms_ += 1000 * random_.uniform(10, 60);
    return say("submit", {{"answers", answers}, {"longest_wait_ms", 5}});
  }

  Json answer(const Json& trial) {
    const Item& asked = item(trial.at("command"));
    const Selection right = asked.truth.value_or(asked.proposal);
    const bool edits = trial.at("condition") == "lga_hill";
    const double seconds = std::exp(std::log(edits ? edit_s : human_s) + slowness_ + spread * random_.gaussian());
    const double from = ms_;
    say("shown");
    if (trial.contains("pairs")) return judge(trial);
    Json selection;
    for (const Json& set : trial.at("sets")) {
      const std::string role = set.at("role");
      if (role == "target" && trial.at("meanings").get<bool>()) {
        ms_ = from + 1000 * seconds * .6;
        selection[role] = edits && random_.coin() ? set.at("first") : mean(right.target, trial);
        if (selection[role] != set.at("first")) say("meant", {{"target", selection[role]}});
        continue;
      }
      const FeatureSet& truth = role == "target" || !right.second ? right.target.product() : *right.second;
      const bool accepts = edits && random_.coin();
      for (const char* feature : {"object_types", "textures"}) {
        const Json before = set.at("first").at(feature);
        const bool textures = std::string(feature) == "textures";
        const Json after = accepts ? before : chosen(textures ? truth.textures : truth.object_types, trial.at(feature));
        ms_ = from + 1000 * seconds * (textures ? .8 : .4);
        change(role, feature, before, after);
        selection[role][feature] = after;
      }
    }
    ms_ = from + 1000 * seconds;
    return say("submit", {{"selection", selection}, {"longest_wait_ms", 5}});
  }

  // What is right, with a slip here and there in its lists.
  Json mean(const Meaning& right, const Json& trial) {
    Json meant{{"sets", Json::array()}, {"which", nullptr}};
    for (const FeatureSet& set : right.sets)
      meant["sets"].push_back({{"object_types", chosen(set.object_types, trial.at("object_types"))},
                               {"textures", chosen(set.textures, trial.at("textures"))}});
    if (right.which) meant["which"] = to_json(right).at("which");
    return meant;
  }

  // The clicks from one list to the other.
  void change(const std::string& role, const char* feature, const Json& before, const Json& after) {
    for (const bool on : {true, false}) {
      Json values = Json::array();
      for (const Json& value : on ? after : before)
        if (const Json& others = on ? before : after; !contains(others, value)) values.push_back(value);
      if (!values.empty()) say("edit", {{"role", role}, {"feature", feature}, {"values", values}, {"on", on}});
    }
  }

  const Protocol& protocol_;
  httplib::Client http_;
  RandomStream random_;
  bool first_;
  double slowness_, ms_ = 100;
  std::string address_;
};

void rehearse(const fs::path& protocol, const fs::path& out, int people) {
  Study study(out, read_protocol(protocol), protocol, Kind::rehearsal);
  Server server(study, load_site(study.protocol()), {});
  std::exception_ptr failure;
  std::thread serving([&server] { server.run(); });
  try {
    for (int i = 0; i < people; ++i) Person(study.protocol(), server.port(), study.slots()).take_part();
  } catch (...) {
    failure = std::current_exception();
  }
  server.stop();
  serving.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace
}  // namespace lgabench::study

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  try {
    lgabench::study::rehearse(argv[1], argv[2], std::stoi(argv[3]));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
  return 0;
}
