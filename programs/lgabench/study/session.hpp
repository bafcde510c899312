// One person's session: a state machine over the events of their file. Nothing else is kept, so a server that was
// killed goes on where it was.
#pragma once
#include <array>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <lgabench/study/assignment.hpp>
#include <lgabench/study/event_log.hpp>

namespace lgabench::study {

/// Why an event is not taken. conflict: the session is open in another page; later: too many people begin at once.
class Refused : public Error {
 public:
  enum Why { bad, conflict, later };
  Refused(Why why, const std::string& what) : Error(what), why_(why) {}
  Why why() const { return why_; }

 private:
  Why why_;
};

/// One command, from its announcement to the answer.
struct Trial {
  enum State { waiting, started, shown, finished, interrupted };
  const Item* item = nullptr;  // belongs to the protocol
  Condition condition{};
  int period = 0, set = 0;  // from 0; set -1: a spare
  bool practice = false;
  State state = waiting;
  std::string why{};  // interrupted
  Selection selection{};
  std::vector<int> answers{};  // of its item's pairs: 0 yes, 1 no, 2 can't tell
  int edits = 0;
  bool edits_agree = true;  // the proposal, edited as was logged, is what was submitted
  double raw_s = 0;         // by the page's clock, from the second frame after the command was painted to submit
  double active_s = 0;      // raw, less times out of focus and times without any input longer than idle_after_s
  double server_s = 0;      // between the arrivals of both at the server
};

constexpr double idle_after_s = 30;
/// A trial in which an event waited longer for its acknowledgement is interrupted: the page says so by then.
constexpr double longest_wait_s = 5;

class Session {
 public:
  /// Reads the file's events. @p protocol must outlive it. @throws InputError for a file that is no session.
  Session(const Protocol& protocol, EventLog log);

  enum Step { familiarisation, example, trials, questionnaire, debriefing };

  int slot() const { return slot_; }
  const std::string& key() const { return key_; }  // of the consent, against counting it twice
  bool simulated() const { return simulated_; }
  const Assignment& assignment() const { return assignment_; }
  Step step() const;
  /// No command is left; a questionnaire may be.
  bool answered() const { return next_ == trials_.size(); }
  const std::vector<Trial>& all() const { return trials_; }
  const Json& answers() const { return answers_; }  // of the questionnaire at the end; null before
  /// NASA-TLX about one condition, by scale; null where it was not asked, or not yet.
  const Json& tlx(Condition condition) const { return tlx_[index(condition)]; }
  const EventLog& log() const { return log_; }
  const Json& consent() const { return log_.events().front().at("consent"); }

  /// What the page is to show.
  Json state() const;
  /// Takes an event of the page, {"key", "page", "kind", "page_ms", ...}, that arrived at `now_ms`: it is on the disk
  /// when this returns. One with the key of an earlier one changes nothing. Returns whether state() is another step.
  /// @throws Refused, or InputError where the disk takes nothing.
  bool post(const Json& event, std::int64_t now_ms);

 private:
  void begin(const Json& event);
  struct Expected {
    std::vector<std::string> members;  // beside those of every event
    bool fits;                         // where the session is
  };
  Expected expected(const JsonReader& kind) const;
  void check(const JsonReader& event, std::int64_t now_ms) const;
  void check_edit(const JsonReader& event) const;
  void check_submit(const JsonReader& event, std::int64_t now_ms) const;
  void check_questionnaire(const JsonReader& event) const;
  Meaning meant(const JsonReader& event) const;
  Selection submitted(const JsonReader& event) const;
  void apply(const Json& event);
  void submit(const Json& event);
  void edit(const Json& event);
  void mean(const Json& event);
  void interrupt(const std::string& why);
  bool running() const;
  bool between_parts() const;  // the first part is over, and is to be rated
  Trial& now() { return trials_[next_]; }
  const Trial& now() const { return trials_[next_]; }
  Json trial_state() const;
  std::vector<int> order_of_pairs() const;  // in which this person sees those of the trial

  const Protocol* protocol_;
  EventLog log_;
  int slot_ = 0;
  std::string key_, page_;
  bool simulated_ = false, familiar_ = false, example_seen_ = false;
  Assignment assignment_;
  std::vector<Trial> trials_;
  std::size_t next_ = 0, spares_used_ = 0;
  Json answers_;
  std::array<Json, 2> tlx_;  // by condition
  std::set<std::string> keys_;
  // The trial that is running:
  double shown_ms_ = 0;
  std::int64_t shown_at_ = 0;
  Selection edited_;
  using Intervals = std::vector<std::pair<double, double>>;  // by the page's clock; an open end is infinite
  Intervals unfocused_, idle_;
};

/// The empty Selection, or in lga_hill the proposal.
Selection first_selection(const Item& item, Condition condition);

}  // namespace lgabench::study
