#include <lgabench/host/hosted_perturbation.hpp>

#include <fmt/format.h>

#include <optional>
#include <utility>

#include <lgabench/core/shadows.hpp>

namespace lgabench {

HostedPerturbation::HostedPerturbation(const HostJob& job) : session_(std::make_unique<HostSession>(job)) {}
HostedPerturbation::~HostedPerturbation() = default;

Observation HostedPerturbation::perceive(Observation seen, int level, RandomStream stream) {
  const std::vector<std::uint16_t> shadows = std::exchange(seen.shadows, {});  // of no picture: they stay
  protocol::write(seen, session_->observation());
  std::optional<Frame> ids;
  const auto takes_ids = [&ids](const Frame& frame, Channel&) {
    if (frame.type() != "ids" || ids) return false;
    ids = Frame{frame.header, frame.payload};
    return true;
  };
  const std::uint64_t first = stream.next(), second = stream.next();  // a stream of its own, whose name tells nothing
  const Frame frame = session_->call({{"type", "perceive"},
                                      {"level", level},
                                      {"stream", fmt::format("{:08x}{:08x}", first, second)},
                                      {"instances", protocol::instances_json(seen)}},
                                     "perceived", takes_ids);
  Observation perceived = session_->read([&] {
    if (!ids) throw InputError("\"perceived\", expected \"ids\" before it");
    return protocol::read_perceived(*ids, frame, session_->layout().picture);
  });
  perceived.shadows = shadows_of(shadows, seen.instances, perceived.instances);
  return perceived;
}

std::vector<std::string> HostedPerturbation::refused_calls() const { return session_->refused_calls(); }

void HostedPerturbation::drop() { session_->call({{"type", "drop"}, {"what", "perturbation"}}, "dropped"); }

ProcessState HostedPerturbation::state() const { return session_->state(); }

}  // namespace lgabench
