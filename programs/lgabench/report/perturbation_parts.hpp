// The parts that tables and figures of perturbations share.
#pragma once
#include <string>
#include <vector>

#include <lgabench/report/report_document.hpp>

namespace lgabench::report {
using namespace document;
using namespace statistics;

/// Curves that are compared: of one table at one number of demonstrations, and those of reference rows that something
/// keeps from what they do in the control.
struct PerturbationPart {
  const Table* table;
  int demonstrations;
  std::vector<const PerturbationCurve*> curves;

  std::string title() const;  // "layout continuous, engine mujoco, 10 demonstrations"
  std::string file() const;   // the same for the name of a file
  std::vector<std::string> methods() const;
  std::vector<std::string> axes() const;
  /// Without curves that have no area.
  PerturbationPart with_areas() const;
  /// nullptr where there is none.
  const PerturbationCurve* find(const std::string& method, const std::string& axis) const;
};

std::vector<PerturbationPart> perturbation_parts(const Material& material);

/// Success against the levels of each axis.
Charts perturbation_charts(const Material& material, const PerturbationPart& part);
/// Areas of methods and axes.
Chart perturbation_heat_map(const Material& material, const PerturbationPart& part);
/// One scene in the control and at each level of an axis; empty where the axis changes no picture that is there.
PictureRow perturbation_pictures(const Material& material, const std::string& axis);

}  // namespace lgabench::report
