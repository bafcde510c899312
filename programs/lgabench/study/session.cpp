#include <lgabench/study/session.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <lgabench/core/contains.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/study/withdrawal.hpp>

namespace lgabench::study {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();
constexpr std::size_t longest_text = 4000;
constexpr double clocks_apart_s = 60;  // more than the server's seconds no trial took
const std::vector<std::string> pair_answers{"yes", "no", "can't tell"};
const std::vector<std::string> scales{"mental", "physical", "temporal", "performance", "effort", "frustration"};

Json names_of(const FeatureSet& set) { return {{"object_types", set.object_types}, {"textures", set.textures}}; }

// {"sets", "which"}, also of one product; which: null where any object will do.
Json whole(const Meaning& meaning) {
  Json json{{"sets", Json::array()}, {"which", nullptr}};
  for (const FeatureSet& set : meaning.sets) json["sets"].push_back(names_of(set));
  if (meaning.which) json["which"] = to_json(meaning).at("which");
  return json;
}

FeatureSet& set_of(Selection& selection, const std::string& role) {
  return role == "target" || !selection.second ? selection.target.product() : *selection.second;
}

// Length of [from, to] without the intervals, which may overlap.
double without(double from, double to, std::vector<std::pair<double, double>> intervals) {
  std::sort(intervals.begin(), intervals.end());
  double left = to - from, covered = from;
  for (const auto& [begin, end] : intervals) {
    const double b = std::clamp(begin, covered, to), e = std::clamp(end, covered, to);
    left -= e - b;
    covered = e;
  }
  return left;
}

// Whether the page is to show something else; what is sent again must not: the page would begin its trial anew.
bool turns_the_page(const Json& event) {
  const auto within = {"shown", "edit", "meant", "blur", "focus", "idle", "active"};
  const Json kind = event.value("kind", Json());
  return std::none_of(within.begin(), within.end(), [&kind](const char* one) { return kind == one; });
}

double page_ms(const Json& event) { return event.at("page_ms").get<double>(); }

}  // namespace

Selection first_selection(const Item& item, Condition condition) {
  if (condition == Condition::lga_hill) return item.proposal;
  Selection empty;
  if (item.command.second) empty.second = SecondSet{{}, item.command.second->id};
  return empty;
}

Session::Session(const Protocol& protocol, EventLog log) : protocol_(&protocol), log_(std::move(log)) {
  const std::string file = log_.file().string();
  try {
    begin(log_.events().at(0));
    for (std::size_t i = 1; i < log_.events().size(); ++i) apply(log_.events()[i]);
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{}: no session of this study: {}", file, e.what()));
  } catch (const std::out_of_range&) {
    throw InputError(file + ": no session of this study");
  }
}

void Session::begin(const Json& event) {
  slot_ = event.at("slot").get<int>();
  key_ = event.at("key").get<std::string>();
  simulated_ = event.value("simulated", false);
  assignment_ = assign(*protocol_, slot_);
  for (const int period : {0, 1})
    if (period == 0 || !protocol_->of_pairs())
      trials_.push_back(
          {&protocol_->practice, assignment_.conditions[static_cast<std::size_t>(period)], period, -1, true});
  for (const int period : {0, 1}) {
    const auto p = static_cast<std::size_t>(period);
    const auto& set = protocol_->sets[static_cast<std::size_t>(assignment_.sets[p])];
    for (const int i : assignment_.order[p])
      trials_.push_back({&set[static_cast<std::size_t>(i)], assignment_.conditions[p], period, assignment_.sets[p]});
  }
}

Session::Step Session::step() const {
  if (!familiar_) return familiarisation;
  if (!example_seen_ && !protocol_->of_pairs()) return example;
  if (next_ < trials_.size()) return between_parts() ? questionnaire : trials;
  return answers_.is_null() && (protocol_->tlx != Tlx::never || protocol_->free_text) ? questionnaire : debriefing;
}

bool Session::between_parts() const {
  return protocol_->tlx == Tlx::by_condition && next_ < trials_.size() && !now().practice && now().period == 1 &&
         tlx(assignment_.conditions[0]).is_null();
}

bool Session::running() const {
  return step() == trials && (now().state == Trial::started || now().state == Trial::shown);
}

bool Session::post(const Json& event, std::int64_t now_ms) {
  const JsonReader reader(event, "event");
  try {
    if (reader.at("key").string().empty() || reader.at("page").string().empty()) reader.fail("key and page");
    if (keys_.count(reader.at("key").string()) != 0) return turns_the_page(event);
    if (reader.at("kind").string() != "opened" && reader.at("page").string() != page_)
      throw Refused(Refused::conflict, "this session is open in another page");
    check(reader, now_ms);
  } catch (const InputError& e) {
    throw Refused(Refused::bad, e.what());
  }
  Json stored = event;
  stored["at"] = now_ms;
  log_.append(stored);
  apply(stored);
  return turns_the_page(event);
}

Session::Expected Session::expected(const JsonReader& kind) const {
  const auto trial_is = [this](Trial::State state) { return step() == trials && now().state == state; };
  const bool in_trial = trial_is(Trial::shown), of_pairs = in_trial && !now().item->pairs.empty();
  const std::map<std::string, Expected> of_kind{
      {"opened", {{}, true}},
      {"familiarised", {{}, step() == familiarisation}},
      {"example_seen", {{}, step() == example}},
      {"start", {{}, trial_is(Trial::waiting)}},
      {"shown", {{}, trial_is(Trial::started)}},
      {"blur", {{}, in_trial}},
      {"focus", {{}, in_trial}},
      {"active", {{}, in_trial}},
      {"idle", {{"since_ms"}, in_trial}},
      {"edit", {{"role", "feature", "values", "on"}, in_trial && !of_pairs}},
      {"meant", {{"target"}, in_trial && protocol_->meanings}},
      {"submit", {{of_pairs ? "answers" : "selection", "longest_wait_ms"}, in_trial}},
      {"questionnaire", {{"tlx", "free_text"}, step() == questionnaire}}};
  const auto found = of_kind.find(kind.string());
  if (found == of_kind.end()) kind.fail("a kind of event");
  return found->second;
}

void Session::check(const JsonReader& event, std::int64_t now_ms) const {
  const double at = event.at("page_ms").number();
  if (!std::isfinite(at) || at < 0) event.at("page_ms").fail("milliseconds");
  auto [members, fits] = expected(event.at("kind"));
  members.insert(members.end(), {"key", "page", "kind", "page_ms"});
  event.only(members);
  if (!fits) event.at("kind").fail("an event that fits where the session is");
  const std::string kind = event.at("kind").string();
  if (kind == "idle" && event.at("since_ms").number() > at) event.at("since_ms").fail("a time before it");
  if (kind == "edit") check_edit(event);
  if (kind == "meant") meant(event);
  if (kind == "submit") check_submit(event, now_ms);
  if (kind == "questionnaire") check_questionnaire(event);
}

void Session::check_submit(const JsonReader& event, std::int64_t now_ms) const {
  const double at = event.at("page_ms").number();
  if (at <= shown_ms_) event.at("page_ms").fail("a time after the command was shown");
  if (!simulated_ && at - shown_ms_ > static_cast<double>(now_ms - shown_at_) + 1000 * clocks_apart_s)
    event.at("page_ms").fail("a time that has passed here too");
  event.at("longest_wait_ms").number();
  const auto& pairs = now().item->pairs;
  if (pairs.empty()) {
    submitted(event);
    return;
  }
  const std::vector<JsonReader> answers = event.at("answers").elements();
  if (answers.size() != pairs.size()) event.at("answers").fail("one for each pair");
  for (const JsonReader& one : answers)
    if (!contains(pair_answers, one.string())) one.fail("yes, no or can't tell");
}

void Session::check_questionnaire(const JsonReader& event) const {
  for (const std::string& scale : scales)
    if (!event.at("tlx").at(scale).json().is_null()) event.at("tlx").at(scale).integer(0, 100);
  event.at("tlx").only(scales);
  const std::string text = event.at("free_text").string();
  if (between_parts() && !text.empty()) event.at("free_text").fail("nothing before the end");
  if (text.size() > longest_text) event.at("free_text").fail(fmt::format("at most {} bytes", longest_text));
}

void Session::check_edit(const JsonReader& event) const {
  const Item& item = *now().item;
  const std::string role = event.at("role").string(), feature = event.at("feature").string();
  if (role != "target" && !(item.command.second && role == item.command.second->id))
    event.at("role").fail("a set of this command's");
  if (feature != "object_types" && feature != "textures") event.at("feature").fail("object_types or textures");
  const auto& known = feature == "textures" ? item.space.textures : item.space.object_types;
  for (const std::string& value : event.at("values").strings())
    if (!contains(known, value)) event.at("values").fail("words of the space");
  event.at("on").boolean();
}

// The target after a change, which may have empty lists.
Meaning Session::meant(const JsonReader& event) const { return read_meaning(event.at("target"), now().item->space); }

Selection Session::submitted(const JsonReader& event) const {
  const Item& item = *now().item;
  const Selection selection = read_distribution(event.at("selection"), item.space, item.command.second);
  if (selection.empty() || (item.command.second && !selection.second))
    event.at("selection").fail("at least one object type and one texture in each set");
  if (!protocol_->meanings && !selection.target.is_product())
    event.at("selection").fail("one set, as the page asks for");
  return selection;
}

void Session::apply(const Json& event) {
  const std::string kind = event.at("kind").get<std::string>();
  keys_.insert(event.at("key").get<std::string>());
  if (kind == "opened") {
    page_ = event.at("page").get<std::string>();
    if (running()) interrupt("the page was opened again");
  } else if (kind == "familiarised") {
    familiar_ = true;
  } else if (kind == "example_seen") {
    example_seen_ = true;
  } else if (kind == "start") {
    now().state = Trial::started;
    edited_ = first_selection(*now().item, now().condition);
    unfocused_.clear();
    idle_.clear();
  } else if (kind == "shown") {
    now().state = Trial::shown;
    shown_ms_ = page_ms(event);
    shown_at_ = event.at("at").get<std::int64_t>();
  } else if (kind == "edit") {
    edit(event);
  } else if (kind == "meant") {
    mean(event);
  } else if (kind == "blur") {
    unfocused_.emplace_back(page_ms(event), never);
  } else if (kind == "idle") {
    idle_.emplace_back(event.at("since_ms").get<double>(), never);
  } else if (kind == "focus" || kind == "active") {
    for (auto& interval : kind == "focus" ? unfocused_ : idle_)
      interval.second = std::min(interval.second, page_ms(event));
  } else if (kind == "submit") {
    submit(event);
  } else if (kind == "questionnaire") {
    const bool first = between_parts();
    if (protocol_->tlx == Tlx::by_condition) tlx_[index(assignment_.conditions[first ? 0 : 1])] = event.at("tlx");
    if (!first) answers_ = {{"tlx", event.at("tlx")}, {"free_text", event.at("free_text")}};
  }
}

void Session::edit(const Json& event) {
  ++now().edits;
  FeatureSet& set = set_of(edited_, event.at("role").get<std::string>());
  auto& names = event.at("feature") == "textures" ? set.textures : set.object_types;
  for (const auto& value : event.at("values")) {
    const auto found = std::find(names.begin(), names.end(), value.get<std::string>());
    if (!event.at("on").get<bool>() && found != names.end()) names.erase(found);
    if (event.at("on").get<bool>() && found == names.end()) names.push_back(value);
  }
}

void Session::mean(const Json& event) {
  ++now().edits;
  edited_.target = meant(JsonReader(event, log_.file().string()));
}

void Session::submit(const Json& event) {
  Trial& trial = now();
  const bool of_pairs = !trial.item->pairs.empty();
  if (of_pairs) {
    const std::vector<int> order = order_of_pairs();
    trial.answers.resize(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
      trial.answers[static_cast<std::size_t>(order[i])] = static_cast<int>(
          std::find(pair_answers.begin(), pair_answers.end(), event.at("answers").at(i)) - pair_answers.begin());
  } else {
    trial.selection = submitted(JsonReader(event, log_.file().string()));
    const Json edited = distribution_json(edited_);  // the same names, in the order of the clicks
    trial.edits_agree =
        distribution_json(read_distribution(JsonReader(edited, "edits"), trial.item->space,
                                            trial.item->command.second)) == distribution_json(trial.selection);
  }
  trial.raw_s = (page_ms(event) - shown_ms_) / 1000;
  Intervals away = unfocused_;
  away.insert(away.end(), idle_.begin(), idle_.end());
  trial.active_s = without(shown_ms_, page_ms(event), std::move(away)) / 1000;
  trial.server_s = static_cast<double>(event.at("at").get<std::int64_t>() - shown_at_) / 1000;
  if (event.at("longest_wait_ms").get<double>() > 1000 * longest_wait_s && !trial.practice && !of_pairs)
    return interrupt("the connection was lost");
  trial.state = Trial::finished;
  ++next_;
}

void Session::interrupt(const std::string& why) {
  Trial& trial = now();
  trial.state = Trial::interrupted;
  trial.why = why;
  Trial instead{trial.item, trial.condition, trial.period, trial.set, trial.practice};
  ++next_;
  if (instead.practice || protocol_->of_pairs()) {  // again, at once
    trials_.insert(trials_.begin() + static_cast<std::ptrdiff_t>(next_), instead);
  } else if (spares_used_ < protocol_->spares.size()) {  // another command, last of its period
    instead.item = &protocol_->spares[spares_used_++];
    instead.set = -1;
    auto place = trials_.begin() + static_cast<std::ptrdiff_t>(next_);
    while (place != trials_.end() && place->period == instead.period) ++place;
    trials_.insert(place, instead);
  }
}

std::vector<int> Session::order_of_pairs() const {
  const Item& item = *now().item;
  return RandomStream(fmt::format("study/{}/pairs/{}/{}", protocol_->seed, slot_, item.asked_as))
      .permutation(static_cast<int>(item.pairs.size()));
}

Json Session::trial_state() const {
  const Trial& trial = now();
  const auto timed = [](const Trial& t) { return !t.practice; };
  const auto past = trials_.begin() + static_cast<std::ptrdiff_t>(next_);
  const auto done = std::count_if(trials_.begin(), past, timed);
  const auto practised =
      std::count_if(trials_.begin(), past, [](const Trial& t) { return t.state == Trial::finished; });
  const bool interrupted = next_ > 0 && trials_[next_ - 1].state == Trial::interrupted;
  Json json{{"condition", to_string(trial.condition)},
            {"practice", trial.practice},
            {"number", (trial.practice ? practised : done) + 1},
            {"of", std::count_if(trials_.begin(), trials_.end(), timed)},
            {"first_of_part", !trial.practice && (done == 0 || trials_[next_ - 1].period != trial.period)},
            {"interrupted", interrupted},
            {"proposed_by_model", !trial.item->scenario.empty()},  // else by the protocol's author
            {"of_pairs", protocol_->of_pairs()},
            {"running", running()}};
  if (!running()) return json;  // nobody reads ahead
  const Item& item = *trial.item;
  const Selection first = first_selection(item, trial.condition);
  json["command"] = item.asked_as;
  json["hint"] = item.hint;
  for (const int i : item.pairs.empty() ? std::vector<int>() : order_of_pairs()) {
    const AskedPair& pair = item.pairs[static_cast<std::size_t>(i)];
    json["pairs"].push_back({{"object_type", pair.object_type}, {"texture", pair.texture}});
  }
  if (!item.pairs.empty()) return json;
  json["object_types"] = item.space.object_types;
  json["textures"] = item.space.textures;
  json["meanings"] = protocol_->meanings;
  json["sets"] = Json::array({{{"role", "target"},
                               {"phrase", "the object to handle"},
                               {"first", protocol_->meanings ? whole(first.target) : to_json(first.target)}}});
  if (item.command.second)
    json["sets"].push_back({{"role", item.command.second->id},
                            {"phrase", item.command.second->phrase},
                            {"first", names_of(*first.second)}});
  return json;
}

Json Session::state() const {
  constexpr const char* steps[] = {"familiarisation", "example", "trial", "questionnaire", "debriefing"};
  Json json{{"step", steps[step()]}, {"withdrawal_code", withdrawal_code(log_.file().stem().string())}};
  json["of_pairs"] = protocol_->of_pairs();
  if (!protocol_->of_pairs() && (step() == familiarisation || step() == example)) {
    json["object_types"] = protocol_->example_space.object_types;
    json["textures"] = protocol_->example_space.textures;
  }
  if (step() == example) {
    json["command"] = protocol_->example_command;
    json["answer"] = names_of(protocol_->example.target.product());
  }
  if (step() == trials) json["trial"] = trial_state();
  if (step() == questionnaire) {
    const bool first = between_parts();
    json.update(
        {{"tlx", protocol_->tlx != Tlx::never}, {"free_text", protocol_->free_text && !first}, {"last", !first}});
    if (protocol_->tlx == Tlx::by_condition) json["condition"] = to_string(assignment_.conditions[first ? 0 : 1]);
  }
  return json;
}

}  // namespace lgabench::study
