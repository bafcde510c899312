#include <lgabench/record/perturbed.hpp>

#include <limits>

#include <lgabench/core/fields.hpp>

namespace lgabench {

void fields(PerturbedEpisode& e, Fields& field) {
  constexpr long long most = std::numeric_limits<int>::max();
  field("arm", e.arm);
  field("index", e.index);
  field("axis", e.axis, or_null(e.axis.empty()));
  const bool control = field.reading() && e.axis.empty();
  field("level", e.level, within(e.axis.empty() ? 0 : 1, control ? 0 : most));
  for (std::size_t part = 0; part < parts; ++part)
    field(part_names[part], e.hashes[part], or_null(e.hashes[part].empty()));
  field("read", e.read, or_null(e.read.empty()));
  field("names", e.names, or_null(false, when(!e.names.empty())));
  field("target_scale", e.target_scale, may_lack());
}

Json to_json(const PerturbedEpisode& episode) { return json_of(episode); }

PerturbedEpisode read_perturbed_episode(const JsonReader& reader) { return value_of<PerturbedEpisode>(reader, false); }

}  // namespace lgabench
