// Reads names and segments from the picture, in place of the simulator's (docs/protocol.md, section 3).
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <lgabench/core/feature_space.hpp>
#include <lgabench/core/json.hpp>
#include <lgabench/core/perceiver.hpp>
#include <lgabench/core/random.hpp>
#include <lgabench/core/scene.hpp>

namespace lgabench {

struct Scenario;

/// Where the names and the segments of a method's observations come from.
struct Reading {
  static constexpr const char *simulator = "simulator", *difference = "difference";
  std::string names = simulator;     // or one of names_read(), or a perceiver plugin's id
  std::string segments = simulator;  // or difference: from the empty place

  bool none() const { return names == simulator && segments == simulator; }
  /// The id of the plugin that reads names; "" for none.
  std::string plugin() const;
  /// Whether the library that reads pictures (seeing_library) takes part.
  bool needs_library() const { return !none() && (plugin().empty() || segments == difference); }
  /// The end of a row's name: "+names=read+segments=difference", without parts that are the simulator's.
  std::string suffix() const;
};
bool operator==(const Reading& a, const Reading& b);
/// @throws InputError for neither of the two.
std::string read_segments(const JsonReader& reader);

/// "read", "read_balanced", "read_drawn", "read_robust": the shipped readers.
const std::vector<std::string>& names_read();

/// The shipped reader's file for that environment; "" where no file reads the names. @throws InputError where the
/// environment has none.
std::filesystem::path reader_file(const std::string& environment, const Reading& reading);

/// Why the scenario's pictures cannot be read like that, in a few words; "" where they can.
std::string why_not_read(const Scenario& scenario, const Reading& reading);

/// A policy's observation, with ids and names as they were read.
using ReadPicture = std::function<Observation(const Observation& seen, const Scene& scene)>;

/// What a policy is given in place of what it would see of a scene, after the axis's changes. Null where nothing is
/// read. `perceiver` is the plugin's. The scene tells in which order segments are numbered, and nothing else. @throws
/// InputError where the library or the file is not there.
ReadPicture reading_of(const Scenario& scenario, const Reading& reading,
                       std::shared_ptr<Perceiver> perceiver = nullptr);

/// The picture, enlarged, with the number 1, 2, ... beside the segment of each of `ids`; ids and names are left out.
/// For a model that is shown it (ChatLanguageModel::look). @throws InputError where the library is not there.
Observation marked(const Observation& seen, const std::vector<std::uint8_t>& ids);

/// The file that finds segments and reads names; opened where a cell asks for either.
inline constexpr const char* seeing_library = "liblgabench_seeing.so";

/// The functions of that library.
struct SeeingLibrary {
  /// `ids` as segments by difference from the `empty` place, in the light that `balances` takes out or as it is.
  Observation (*segments)(Observation seen, const Observation& empty, bool balances, RandomStream random);
  std::unique_ptr<Perceiver> (*reader)(const std::filesystem::path& file, bool balances, const Observation& empty,
                                       const FeatureSpace& space);
  Observation (*marked)(const Observation& seen, const std::vector<std::uint8_t>& ids);
};

}  // namespace lgabench

extern "C" const lgabench::SeeingLibrary* lgabench_seeing();
