// Demonstrations as a robomimic HDF5 file.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <lgabench/cell/demonstrations.hpp>
#include <lgabench/core/action.hpp>
#include <lgabench/core/method.hpp>

namespace lgabench {

/// What learners of other houses read beside the demonstrations: where they come from, and what they led to.
struct Circumstances {
  std::string scenario, engine, layout, split;
  std::uint64_t seed = 0;
  ActionSpace action_space;
  Outcomes outcomes;
};

/// The file's bytes: a function of the arguments alone (no time stamps).
///     data                          attributes total, env_args {"env_name", "type", "env_kwargs"}
///     data/demo_i                   attributes num_samples, utterance; trajectory_steps where these are not 1: the
///                                   first of the T rows are the episode's, the others recovery steps
///     data/demo_i/actions           T x action numbers, float32: the noiseless labels
///     data/demo_i/instances         JSON text as uint8: an instance table for each step
///     data/demo_i/obs/rgb, ids      T x rows x columns (x 3) uint8
///     data/demo_i/obs/state         T x numbers, float64, where the task has a state
///     data/demo_i/brought           JSON text as uint8: what was taken before each step, where something was
///     data/demo_i/stops             T uint8, where a label says that nothing is left to do: 1, with an action of zeros
///     mask/train                    names of all demonstrations
/// It holds what a method may see: no role, scene or Selection. With their circumstances, also
///     data                          attributes scenario, layout, split, seed, action_names, action_units, action_low,
///                                   action_high, action_rotations
///     data/demo_i/next_obs/rgb, ids as obs, after the label was carried out
///     data/demo_i/rewards, dones    T, float32 and uint8: 1 for a success; 1 where an episode is over, as it is after
///                                   one action, and for each recovery step
///     mask/train, mask/valid        the last tenth of the demonstrations is in valid and not in train
/// and env_args names the scenario's Gymnasium environment. @throws InputError if the HDF5 library fails.
std::string demonstrations_hdf5(const std::vector<Demonstration>& demonstrations, const std::string& environment_id,
                                const Circumstances* circumstances = nullptr);

/// Reads such a file's bytes; instructions come without a Selection. @throws InputError naming the file (`name`), the
/// place and what was expected.
std::vector<Demonstration> read_demonstrations(std::string bytes, const std::string& name);

}  // namespace lgabench
