#include <lgabench/perturbations/axes.hpp>

const std::vector<lgabench::PerturbationAxis>* lgabench_perturbations() {
  using namespace lgabench::perturbations;
  // In the order in which `all` applies them: the things, the words; light, camera, surfaces, the sensor, what is made
  // of its picture.
  static const std::vector<lgabench::PerturbationAxis> axes{
      distractors(),     object_size(),  friction_mass(), paraphrase(),       instruction(),   light_intensity(),
      light_direction(), light_colour(), camera_shift(),  camera_turn(),      field_of_view(), table(),
      texture_noise(),   sensor_noise(), segmentation(),  selection_errors(),
  };
  return &axes;
}
