// Demonstrations as a robomimic HDF5 file.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <lgabench/core/method.hpp>

namespace lgabench {

/// The file's bytes: a function of the demonstrations and the environment's id alone (no time stamps).
///     data                          attributes total, env_args {"env_name", "type", "env_kwargs"}
///     data/demo_i                   attributes num_samples, utterance
///     data/demo_i/actions           T x action numbers, float32: the noiseless labels
///     data/demo_i/instances         JSON text as uint8: an instance table for each step
///     data/demo_i/obs/rgb, ids      T x rows x columns (x 3) uint8
///     mask/train                    names of all demonstrations
/// It holds what a method may see: no role, scene, seed or Selection.
/// @throws InputError if the HDF5 library fails.
std::string demonstrations_hdf5(const std::vector<Demonstration>& demonstrations, const std::string& environment_id);

/// Reads such a file's bytes; instructions come without a Selection. @throws InputError naming the file (`name`), the
/// place and what was expected.
std::vector<Demonstration> read_demonstrations(std::string bytes, const std::string& name);

}  // namespace lgabench
