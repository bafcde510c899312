// A study's directory: its log, a file of events for each person, what `lgabench run --humans` reads.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <lgabench/study/session.hpp>

namespace lgabench::study {

/// Whether a directory holds people's answers or a rehearsal's. One directory never holds both.
enum class Kind { people, rehearsal };

/// DIR/study.events (the study's log: what it is, every slot, withdrawals), DIR/people/ID.events,
/// DIR/participants/pNN.json, and copies of protocol and consent. Any thread.
class Study {
 public:
  /// Opens or begins the study in `directory`, for this process alone, and puts right what a kill left undone. A person
  /// whose file cannot be read is left out; all others go on.
  /// @throws InputError where another protocol, consent or kind of data is there, or another process serves it.
  Study(fs::path directory, Protocol protocol, const fs::path& protocol_file, Kind kind);
  ~Study();
  Study(const Study&) = delete;
  Study& operator=(const Study&) = delete;

  const Protocol& protocol() const { return protocol_; }
  Kind kind() const { return kind_; }
  int slots() const { return slots_; }  // given so far; while nobody begins
  /// Files of people who are left out, since they cannot be read, and why; a line each.
  const std::vector<std::string>& damaged() const { return damaged_; }
  /// Whether somebody consented with that key.
  bool knows(const std::string& key);

  /// Calls `say` with a line whenever somebody begins, finishes or withdraws, from any thread, one at a time: by
  /// pseudonym, with how many are under way and how many have finished. @p say must not throw, nor use the study.
  void tell(std::function<void(const std::string&)> say);

  /// Takes a person's consent to the text with that SHA-256; the same key gives the same person. Returns their id.
  /// @throws Refused for another text, InputError where the disk takes nothing.
  std::string begin(const std::string& key, const std::string& consent_sha256, bool simulated);
  /// Session::post() of an event that arrives at `at_ms`, by default now: what to show where that changed, {} where it
  /// did not; none for an unknown id.
  std::optional<Json> post(const std::string& id, const Json& event, std::optional<std::int64_t> at_ms = {});
  /// Deletes a person's events and participant's file; the log keeps the slot, without the id. False for an unknown
  /// code.
  bool withdraw(const std::string& code);

 private:
  void open_log(const fs::path& protocol_file);
  void open_people();
  void finish(const Session& session) const;
  void say(const std::string& what) const;

  std::mutex mutex_;
  fs::path directory_;
  Protocol protocol_;
  Kind kind_;
  int lock_ = -1;
  std::unique_ptr<EventLog> log_;
  std::map<std::string, std::unique_ptr<Session>> people_;  // by id
  std::vector<std::string> damaged_;
  int slots_ = 0;  // given so far
  std::function<void(const std::string&)> tell_;
};

/// A study as it lies in a directory, to be read.
struct Record {
  std::unique_ptr<Protocol> protocol;  // sessions point into it
  Kind kind = Kind::people;
  bool shown_as_now = true;  // people were shown what this version of lgabench would show
  int withdrawn = 0;
  std::vector<Session> people;       // by slot
  std::vector<std::string> damaged;  // files of others, which cannot be read, and why
};
/// @throws InputError where there is no study.
Record read_study(const fs::path& directory);

/// "p07", of a slot.
std::string pseudonym(int slot);
/// Control pairs that the person answered otherwise than the truth does.
int controls_failed(const Protocol& protocol, const Session& session);
/// Why the protocol leaves the person out of every test; "" for one whom it does not.
std::string why_left_out(const Protocol& protocol, const Session& session);
/// What `lgabench run --humans` reads of a person (docs/formats: a participant's file); null of one who is left out,
/// and where pairs were asked about: those answers are no Selection.
Json participant_json(const Protocol& protocol, Kind kind, const Session& session);
/// Whether the trial counts: finished, not practice, not longer than the protocol allows.
bool counts(const Protocol& protocol, const Trial& trial);

}  // namespace lgabench::study
