#include <lgabench/perturbations/axes.hpp>

const std::vector<lgabench::PerturbationAxis>* lgabench_perturbations() {
  using namespace lgabench::perturbations;
  // In the order in which `all` applies them: the light, the surfaces, the sensor, what is made of its picture.
  static const std::vector<lgabench::PerturbationAxis> axes{light_intensity(), light_colour(), texture_noise(),
                                                            sensor_noise(),    segmentation(), selection_errors()};
  return &axes;
}
