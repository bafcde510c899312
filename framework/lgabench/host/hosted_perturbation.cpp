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
  const std::uint64_t first = stream.next(), second = stream.next();  // a stream of its own, whose name tells nothing
  Observation perceived = answer_to(seen, {{"level", level}, {"stream", fmt::format("{:08x}{:08x}", first, second)}});
  perceived.shadows = shadows_of(shadows, seen.instances, perceived.instances);
  return perceived;
}

Observation HostedPerturbation::read(Observation seen, const FeatureSpace& space) {
  seen.instances.clear();
  seen.shadows.clear();
  return answer_to(seen,
                   {{"space", {{"id", space.id}, {"object_types", space.object_types}, {"textures", space.textures}}}});
}

Observation HostedPerturbation::answer_to(const Observation& seen, Json request) {
  host::write(seen, session_->observation());
  std::optional<Frame> ids;
  const auto takes_ids = [&ids](const Frame& frame, Channel&) {
    if (frame.type() != "ids" || ids) return false;
    ids = Frame{frame.header, frame.payload};
    return true;
  };
  request.update({{"type", "perceive"}, {"instances", host::instances_json(seen)}});
  const Frame frame = session_->call(request, "perceived", takes_ids);
  Observation perceived = session_->read([&] {
    if (!ids) throw InputError("\"perceived\", expected \"ids\" before it");
    return host::read_perceived(*ids, frame, session_->layout().picture);
  });
  perceived.state = seen.state;  // it was told neither
  perceived.brought = seen.brought;
  return perceived;
}

std::vector<std::string> HostedPerturbation::refused_calls() const { return session_->refused_calls(); }

void HostedPerturbation::drop() { session_->call({{"type", "drop"}, {"what", "perturbation"}}, "dropped"); }

ProcessState HostedPerturbation::state() const { return session_->state(); }

}  // namespace lgabench
