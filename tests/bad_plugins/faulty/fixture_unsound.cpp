// Works, but not as a method should: in the way that its option names. For `lgabench check-plugin`.
#include <fcntl.h>
#include <unistd.h>

#include <cfenv>
#include <chrono>
#include <limits>
#include <set>
#include <thread>

#include "../fixture.hpp"

namespace {

using namespace lgabench;

Action at_place(double share) {
  const double x = .3 + .4 * share;
  return fixture::from_to(x, 0, x, 0);
}

class Unsound : public Policy {
 public:
  Unsound(std::string how, std::set<std::string> seen) : how_(std::move(how)), seen_(std::move(seen)) {}
  Action act(const Observation& observation, const Instruction& instruction) override {
    if (how_ == "unseen" && seen_.count(instruction.utterance) == 0) throw MethodError("never heard of");
    if (how_ == "clock") {
      const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
      return at_place(static_cast<double>(now % 1000) / 1000);
    }
    if (how_ == "remembers") return at_place(.01 * (++calls_ % 100));
    if (how_ == "address")
      return at_place(static_cast<double>(reinterpret_cast<std::uintptr_t>(this) % 1000003) / 1000003);
    if (how_ == "rounding") std::fesetround(FE_UPWARD);
    if (how_ == "far") return fixture::from_to(1e6, 0, .5, 0);
    if (how_ == "leak") kept_.push_back(observation);
    return at_place(how_ == "restored" ? .25 : .5);
  }
  std::optional<std::string> saved() const override {
    return how_ == "forgets" ? std::optional<std::string>("nothing of use") : std::nullopt;
  }

 private:
  std::string how_;
  std::set<std::string> seen_;
  int calls_ = 0;
  std::vector<Observation> kept_;
};

class UnsoundMethod : public fixture::FixtureMethod<fixture::StayPolicy> {
 public:
  Needs needs(const Json& options) const override {
    return {options.at("how") == "unshowable" ? Needs::Targets::selected : Needs::Targets::truth};
  }
  Selection select(const Command&, const FeatureSpace& space, Services& services) override {
    const std::string how = services.options.at("how");
    Selection selection;
    if (how == "outside") selection.target = {{"unicorn"}, space.textures};
    if (how == "unshowable") selection.target = {{"pallet"}, space.textures};
    if (how == "clock") selection.target = {{space.object_types.back()}, space.textures};
    if (how == "outside" || how == "clock") selection.provenance = Provenance::rule;
    return selection;
  }
  std::unique_ptr<Policy> learn(const std::vector<Demonstration>& demonstrations, Services& services) override {
    std::set<std::string> seen;
    for (const Demonstration& demonstration : demonstrations) seen.insert(demonstration.instruction.utterance);
    const std::string how = services.options.at("how");
    services.log.epoch(1, 1, 0.0);
    if (how == "process" && ::fork() == 0)
      while (true) ::pause();
    if (how == "nan_loss") services.log.epoch(2, 2, std::numeric_limits<double>::quiet_NaN());
    if (how == "undeclared") static_cast<void>(services.options.at("hiden"));
    if (how == "thread") std::thread([] { std::this_thread::sleep_for(std::chrono::hours(1)); }).detach();
    if (how == "descriptor") static_cast<void>(::open("/dev/null", O_RDONLY));
    return std::make_unique<Unsound>(how, std::move(seen));
  }
  std::unique_ptr<Policy> restore(const std::string&, Services&) override {
    return std::make_unique<Unsound>("restored", std::set<std::string>());
  }
};

}  // namespace

LGABENCH_METHOD("fixture_unsound", "0.1", "works, but not as a method should", UnsoundMethod, R"({
  "how": {"default": "sound", "help": "what it does", "source": "test fixture", "values": ["sound", "clock", "remembers",
    "address", "leak", "outside", "unshowable", "thread", "descriptor", "unseen", "process", "undeclared", "forgets", "far", "rounding", "nan_loss"]}
})")
