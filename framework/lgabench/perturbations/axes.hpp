// The axes, one file each.
#pragma once
#include <lgabench/core/perturbations.hpp>

namespace lgabench::perturbations {

PerturbationAxis distractors();
PerturbationAxis object_size();
PerturbationAxis friction_mass();
PerturbationAxis paraphrase();
PerturbationAxis instruction();
PerturbationAxis light_intensity();
PerturbationAxis light_direction();
PerturbationAxis light_colour();
PerturbationAxis camera_shift();
PerturbationAxis camera_turn();
PerturbationAxis field_of_view();
PerturbationAxis table();
PerturbationAxis texture_noise();
PerturbationAxis sensor_noise();
PerturbationAxis segmentation();
PerturbationAxis selection_errors();

}  // namespace lgabench::perturbations
