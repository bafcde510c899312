#include <lgabench/study/study.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <set>

#include <lgabench/core/directories.hpp>
#include <lgabench/core/file_lock.hpp>
#include <lgabench/core/hash.hpp>
#include <lgabench/core/version.hpp>
#include <lgabench/record/layout.hpp>
#include <lgabench/study/withdrawal.hpp>

namespace lgabench::study {
namespace {

std::int64_t now_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

const char* name_of(Kind kind) { return kind == Kind::people ? "people" : "rehearsal"; }

fs::path log_file(const fs::path& directory) { return directory / "study.events"; }
fs::path people_of(const fs::path& directory) { return directory / "people"; }

// Ids of the people in a directory.
std::vector<std::string> ids_in(const fs::path& directory) {
  std::vector<std::string> ids;
  std::error_code none_there;
  for (const auto& entry : fs::directory_iterator(people_of(directory), none_there))
    if (entry.path().extension() == ".events" && is_id(entry.path().stem())) ids.push_back(entry.path().stem());
  return ids;
}

fs::path events_of(const fs::path& directory, const std::string& id) { return people_of(directory) / (id + ".events"); }
fs::path export_of(const fs::path& directory, int slot) {
  return directory / "participants" / (pseudonym(slot) + ".json");
}

// Deletes what is of one person: their export, a report, whose numbers they are part of (study report makes it anew)
// and, last, as a restart finds them by these, their events.
void forget(const fs::path& directory, const std::string& id, int slot) {
  for (const char* made : document_entries) fs::remove_all(directory / made);
  for (const char* made : {"trials.csv", "results.json"}) fs::remove(directory / made);
  fs::remove(export_of(directory, slot));
  fs::remove(events_of(directory, id));
}

// Slots that the log says were given, and withdrawn.
struct Slots {
  std::set<int> given, withdrawn;
  explicit Slots(const EventLog& log) {
    for (const Json& event : log.events()) {
      if (event.at("kind") == "assigned") given.insert(event.at("slot").get<int>());
      if (event.at("kind") == "withdrawn") withdrawn.insert(event.at("slot").get<int>());
    }
  }
};

Json assigned(const Session& session) {
  return {{"kind", "assigned"}, {"slot", session.slot()}, {"assignment", to_json(session.assignment())}};
}

}  // namespace

Study::Study(fs::path directory, Protocol protocol, const fs::path& protocol_file, Kind kind)
    : directory_(std::move(directory)), protocol_(std::move(protocol)), kind_(kind) {
  make_directories(people_of(directory_));
  fs::permissions(directory_, fs::perms::owner_all);
  const fs::path lock = directory_ / "study.lock";
  lock_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (lock_ < 0) throw InputError(fmt::format("{}: cannot be opened: {}", lock.string(), std::strerror(errno)));
  try {
    if (!try_lock(lock_, Lock::exclusive, lock))
      throw InputError(fmt::format("{}: another lgabench serves this study", directory_.string()));
    open_log(protocol_file);
    open_people();
  } catch (...) {
    ::close(lock_);
    throw;
  }
}

Study::~Study() { ::close(lock_); }

void Study::open_log(const fs::path& protocol_file) {
  log_ = std::make_unique<EventLog>(log_file(directory_), true);
  if (log_->events().empty()) {
    const std::string consent = protocol_.json.at("consent").get<std::string>();
    write_file(directory_ / "protocol.json", protocol_.bytes);
    write_file(directory_ / consent, protocol_.consent);
    log_->append({{"kind", "created"},
                  {"at", now_ms()},
                  {"of", name_of(kind_)},
                  {"study", protocol_.id},
                  {"pin", protocol_.pin},
                  {"lgabench", LGABENCH_VERSION}});
    return;
  }
  const Json& created = log_->events().front();
  if (created.at("of") != name_of(kind_))
    throw InputError(fmt::format("{}: holds a study of {}; expected another directory for one of {}",
                                 directory_.string(), created.at("of").get<std::string>(), name_of(kind_)));
  if (created.at("pin") != protocol_.pin)
    throw InputError(fmt::format("{}: holds another study than {}: protocol, consent or what people are shown changed",
                                 directory_.string(), protocol_file.string()));
}

void Study::open_people() {
  Slots slots(*log_);
  for (const std::string& id : ids_in(directory_)) {
    std::unique_ptr<Session> session;
    try {
      EventLog log(events_of(directory_, id), true);
      if (log.events().empty()) {  // nobody was told of this person
        fs::remove(log.file());
        continue;
      }
      session = std::make_unique<Session>(protocol_, std::move(log));
    } catch (const InputError& e) {
      damaged_.emplace_back(e.what());
      continue;
    }
    if (slots.withdrawn.count(session->slot()) != 0) {
      forget(directory_, id, session->slot());
      continue;
    }
    if (slots.given.insert(session->slot()).second) log_->append(assigned(*session));
    if (session->answered()) finish(*session);
    people_[id] = std::move(session);
  }
  if (!slots.given.empty()) slots_ = *slots.given.rbegin() + 1;
}

bool Study::knows(const std::string& key) {
  const std::lock_guard lock(mutex_);
  return std::any_of(people_.begin(), people_.end(), [&key](const auto& item) { return item.second->key() == key; });
}

std::string Study::begin(const std::string& key, const std::string& consent_sha256, bool simulated) {
  const std::lock_guard lock(mutex_);
  for (const auto& [id, session] : people_)
    if (session->key() == key) return id;
  if (consent_sha256 != sha256(protocol_.consent)) throw Refused(Refused::bad, "consent to another text than is shown");
  if (simulated && kind_ == Kind::people) throw Refused(Refused::bad, "simulated people take part in rehearsals alone");
  const std::string id = random_id();
  EventLog log(events_of(directory_, id));
  Json event{{"kind", "begin"},
             {"at", now_ms()},
             {"key", key},
             {"slot", slots_},
             {"assignment", to_json(assign(protocol_, slots_))},
             {"consent", {{"given", true}, {"sha256", consent_sha256}, {"at", now_ms()}}}};
  if (simulated) event["simulated"] = true;
  log.append(event);  // from here on the person is there
  auto session = std::make_unique<Session>(protocol_, std::move(log));
  ++slots_;
  const Json entry = assigned(*session);
  std::string began = pseudonym(session->slot()) + " began";
  if (!protocol_.of_pairs()) began += fmt::format(", with {} first", to_string(session->assignment().conditions[0]));
  people_[id] = std::move(session);
  log_->append(entry);
  say(began);
  return id;
}

std::optional<Json> Study::post(const std::string& id, const Json& event, std::optional<std::int64_t> at_ms) {
  const std::lock_guard lock(mutex_);
  const auto found = people_.find(id);
  if (found == people_.end()) return std::nullopt;
  Session& session = *found->second;
  const bool was_there = session.step() == Session::debriefing, changed = session.post(event, at_ms.value_or(now_ms()));
  if (changed && session.answered()) finish(session);
  if (!was_there && session.step() == Session::debriefing) say(pseudonym(session.slot()) + " finished");
  return changed ? session.state() : Json::object();
}

void Study::tell(std::function<void(const std::string&)> say) {
  const std::lock_guard lock(mutex_);
  tell_ = std::move(say);
}

void Study::say(const std::string& what) const {
  if (!tell_) return;
  const auto finished = std::count_if(people_.begin(), people_.end(),
                                      [](const auto& person) { return person.second->step() == Session::debriefing; });
  tell_(fmt::format("{}; {} under way, {} of {} finished", what, static_cast<std::ptrdiff_t>(people_.size()) - finished,
                    finished, protocol_.planned));
}

void Study::finish(const Session& session) const {
  const Json json = participant_json(protocol_, kind_, session);
  const std::string text = json.dump(1) + "\n";
  const fs::path file = export_of(directory_, session.slot());
  std::error_code error;
  if (!json.is_null() && !(fs::exists(file, error) && read_file(file) == text)) write_file(file, text);
}

bool Study::withdraw(const std::string& code) {
  const std::lock_guard lock(mutex_);
  const auto found = std::find_if(people_.begin(), people_.end(), [&code](const auto& item) {
    return plain_code(withdrawal_code(item.first)) == plain_code(code);
  });
  if (found == people_.end()) return false;
  const int slot = found->second->slot();
  log_->append({{"kind", "withdrawn"}, {"slot", slot}});  // from here on it is done, whatever happens
  const std::string id = found->first;
  people_.erase(found);
  forget(directory_, id, slot);
  sync_directory(people_of(directory_));
  say(pseudonym(slot) + " withdrew");
  return true;
}

Record read_study(const fs::path& directory) {
  const EventLog log(log_file(directory));
  if (log.events().empty()) throw InputError(directory.string() + ": expected a study's directory (study serve --out)");
  Record record;
  record.protocol = std::make_unique<Protocol>(read_protocol(directory / "protocol.json"));
  const Json& created = log.events().front();
  record.kind = created.at("of") == name_of(Kind::people) ? Kind::people : Kind::rehearsal;
  record.shown_as_now = created.at("pin") == record.protocol->pin;
  const Slots slots(log);
  record.withdrawn = static_cast<int>(slots.withdrawn.size());
  for (const std::string& id : ids_in(directory)) {
    try {
      EventLog events(events_of(directory, id));
      if (events.events().empty()) continue;
      Session session(*record.protocol, std::move(events));
      if (slots.withdrawn.count(session.slot()) == 0) record.people.push_back(std::move(session));
    } catch (const InputError& e) {
      record.damaged.emplace_back(e.what());
    }
  }
  std::sort(record.people.begin(), record.people.end(),
            [](const Session& a, const Session& b) { return a.slot() < b.slot(); });
  return record;
}

std::string pseudonym(int slot) { return fmt::format("p{:02}", slot + 1); }

bool counts(const Protocol& protocol, const Trial& trial) {
  return trial.state == Trial::finished && !trial.practice &&
         (!protocol.longest_s || trial.raw_s <= *protocol.longest_s);
}

int controls_failed(const Protocol& protocol, const Session& session) {
  int failed = 0;
  for (const Trial& trial : session.all())
    for (std::size_t i = 0; i < trial.answers.size() && counts(protocol, trial); ++i)
      if (const std::optional<bool> settled = trial.item->pairs[i].settled)
        failed += trial.answers[i] != (*settled ? 0 : 1);
  return failed;
}

std::string why_left_out(const Protocol& protocol, const Session& session) {
  if (!session.answered()) return "did not finish";
  if (const int failed = controls_failed(protocol, session); failed > protocol.most_controls_failed)
    return fmt::format("{} controls failed, {} allowed", failed, protocol.most_controls_failed);
  for (const Condition condition : {Condition::human, Condition::lga_hill}) {
    const auto n = std::count_if(session.all().begin(), session.all().end(), [&](const Trial& trial) {
      return trial.condition == condition && counts(protocol, trial);
    });
    if (n < protocol.fewest_trials && (condition == Condition::human || !protocol.of_pairs()))
      return fmt::format("{} trials of {} count, {} needed", n, to_string(condition), protocol.fewest_trials);
  }
  return "";
}

Json participant_json(const Protocol& protocol, Kind kind, const Session& session) {
  if (protocol.of_pairs() || !why_left_out(protocol, session).empty()) return nullptr;
  std::map<std::string, Json> answers;  // by scenario
  for (const Trial& trial : session.all()) {
    if (!counts(protocol, trial)) continue;
    const Item& item = *trial.item;
    Json& answer = answers[item.scenario];
    answer["scenario"] = item.scenario;
    answer["command"] = item.command.utterance;
    answer["asked_as"] = item.asked_as;
    Json made{{"selection", distribution_json(trial.selection)}, {"seconds", trial.raw_s}};
    if (trial.condition == Condition::human) {
      answer["specified"] = std::move(made);
      continue;
    }
    made["proposal"] = distribution_json(item.proposal);
    made["proposed_by"] = item.proposed_by;
    answer["edited"] = std::move(made);
  }
  Json json{{"participant", pseudonym(session.slot())},
            {"study", fmt::format("{} (protocol {})", protocol.title, protocol.sha256.substr(0, 16))},
            {"consent",
             {{"given", true},
              {"statement", "sha256 " + session.consent().at("sha256").get<std::string>()},
              {"ethics", protocol.ethics}}},
            {"license", protocol.license},
            {"answers", Json::array()}};
  if (kind == Kind::rehearsal || session.simulated()) json["rehearsal"] = true;
  for (auto& [scenario, answer] : answers) json["answers"].push_back(std::move(answer));
  return json;
}

}  // namespace lgabench::study
