#pragma once

#include <string>
#include <vector>

#include "models/embryo/ontology/ontology.h"
#include "solvers/embryo/rules/effects.h"

namespace geoprior::embryo::small_body {

/// Four stages of 2, 4, 2 and 6 days from day 28 on, whose middles are 29, 32, 35 and 39, and a
/// body that grows from 4 mm to 12 mm.
inline Ontology bare() {
  Ontology ontology;
  double day = 28;
  const std::vector<double> lengths{2, 4, 2, 6}, crown_rump{4e-3, 6e-3, 8e-3, 12e-3};
  for (int i = 0; i < 4; ++i) {
    Stage stage;
    stage.name = "S" + std::to_string(i);
    stage.order = i;
    stage.start_day = day;
    stage.end_day = day += lengths[i];
    ontology.stages.push_back(stage);
    ontology.crown_rump_length.emplace_back(stage.middle(), crown_rump[i]);
  }
  return ontology;
}

/// Returns its number.
inline int add(Ontology& ontology, const std::string& name) {
  Structure structure;
  structure.name = name;
  structure.from_stage = 0;
  structure.until_stage = 3;
  ontology.structures.push_back(structure);
  return static_cast<int>(ontology.structures.size()) - 1;
}

inline Key& add_key(Ontology& ontology, int structure, int stage, Primitive primitive) {
  Key key;
  key.stage = stage;
  key.day = ontology.stages[stage].middle();
  key.name = ontology.structures[structure].name + "_S" + std::to_string(stage);
  key.geometry.primitive = primitive;
  ontology.structures[structure].keys.push_back(key);
  return ontology.structures[structure].keys.back();
}

inline Geometry& add_ovoid(Ontology& ontology, int structure, int stage,
                           const Eigen::Vector3d& position, const Eigen::Vector3d& radii) {
  Geometry& g = add_key(ontology, structure, stage, Primitive::ovoid).geometry;
  g.position = position;
  g.radii = radii;
  return g;
}

inline Geometry& add_duct(Ontology& ontology, int structure, int stage, const Anchor& start,
                          const Anchor& end, double radius) {
  Geometry& g = add_key(ontology, structure, stage, Primitive::duct).geometry;
  g.start = start;
  g.end = end;
  g.radius = g.end_radius = radius;
  return g;
}

/// Of the given span, on one structure.
inline ProcessEntry& add_process(Ontology& ontology, ProcessKind kind, int structure, int from,
                                 int to) {
  ProcessEntry process;
  process.name = "P" + std::to_string(ontology.processes.size());
  process.kind = kind;
  process.acts_on = {structure};
  process.from_stage = from;
  process.to_stage = to;
  ontology.processes.push_back(process);
  return ontology.processes.back();
}

/// Every process on, but for dormant ones; structures exist in their intervals.
inline Effects healthy(const Ontology& ontology) {
  Effects effects;
  for (const ProcessEntry& process : ontology.processes)
    effects.inactive.push_back(process.dormant);
  for (const Structure& structure : ontology.structures) {
    effects.absent.push_back(false);
    std::vector<bool> exists;
    for (int stage = 0; stage < static_cast<int>(ontology.stages.size()); ++stage)
      exists.push_back(stage >= structure.from_stage && stage <= structure.until_stage);
    effects.exists.push_back(exists);
  }
  return effects;
}

/// The same without one process.
inline Effects without(const Ontology& ontology, int process) {
  Effects effects = healthy(ontology);
  effects.inactive[process] = true;
  return effects;
}

}  // namespace geoprior::embryo::small_body
