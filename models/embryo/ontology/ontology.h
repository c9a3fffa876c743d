#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/embryo/shape/shape.h"

namespace geoprior::embryo {

/// A temporal entity: days post fertilization.
struct Stage {
  std::string name, label;
  int order = 0;
  double start_day = 0, end_day = 0;
  [[nodiscard]] double middle() const { return (start_day + end_day) / 2; }
};

/// Where an end of a duct is: at `at` in the local coordinates of a structure, or, without one, at
/// a position in the frame of the duct's geometry (ratios of the crown-rump length).
struct Anchor {
  std::optional<int> structure;
  Eigen::Vector3d at{0, 0, 0};
};

/// Parameters of a geometrical component. Sizes are in metres; positions are ratios of the
/// crown-rump length, relative to the centre of `frame` or to the origin of the body.
struct Geometry {
  Primitive primitive = Primitive::point;
  std::optional<int> frame;
  Eigen::Vector3d position{0, 0, 0};
  Eigen::Vector3d axis{0, 0, 1};   ///< local z; unit; a plane's normal
  Eigen::Vector3d up{1, 0, 0};     ///< local x; unit, perpendicular to `axis`
  Eigen::Vector3d radii{0, 0, 0};  ///< as those of a Shape (m)
  double egg = 0;
  Anchor start, end;                  ///< of a duct
  std::vector<Eigen::Vector3d> via;   ///< control points between them (ratios)
  double radius = 0, end_radius = 0;  ///< of a duct or a cylinder (m)
  double branchings = 0;
};

/// A spatio-temporal entity: a structure's geometry at the middle of a stage.
struct Key {
  int stage = 0;
  double day = 0;
  Geometry geometry;
  std::string name;
  bool of_set = false;  ///< it belongs to the chosen parameter set only
};

/// An embryological entity. Numbers of structures are places in `Ontology::structures`.
struct Structure {
  std::string name, label, side, kind;
  std::vector<Key> keys;  ///< by day; those common to all sets and those of the chosen one
  std::optional<int> from_stage, until_stage;
  std::vector<int> part_of, develops_from, touches, fused_with;
  double blend = 0;  ///< with what it is fused with (m)
  std::optional<int> mirror_of;
  bool crown_rump = false;  ///< the line whose length is the crown-rump length
  bool regresses = false;   ///< it shrinks at the end of its life
};

enum class ProcessKind { growth, migration, rotation, interaction, division, fixation };

/// A process: which of the fields have a meaning depends on its kind (see the vocabulary).
struct ProcessEntry {
  std::string name, label;
  ProcessKind kind = ProcessKind::growth;
  std::vector<int> acts_on, produces, fuses;
  std::vector<int> requires_;  ///< processes
  int from_stage = 0, to_stage = 0;
  bool dormant = false;
  bool of_set = false;             ///< it belongs to the chosen parameter set only
  Eigen::Vector3d about{0, 0, 1};  ///< unit, in the body's frame
  double angle = 0;                ///< rad
  std::optional<int> inducer, target;
  double within = 0;                                   ///< m
  Eigen::Vector3d normal{1, 0, 0}, descent{0, 0, -1};  ///< unit, in the body's frame
  double thickness = 0;                                ///< m
  std::optional<int> positive;                         ///< product on the side of the normal
  std::optional<int> septum;
  std::optional<int> stops_at;
  double blend = 0;  ///< m
};

struct Disease {
  std::string name, label, side;
  std::vector<int> disables, enables;  ///< processes
};

/// A number of the literature, in SI units and days.
struct Measurement {
  std::string name, quantity;
  std::optional<int> structure;
  int stage = 0;
  double low = 0, high = 0;        ///< mean -+ deviation where the file gives these
  double mean = 0, deviation = 0;  ///< the middle and half of the range where the file gives that
  std::string unit;                ///< "m", "rad" or "1"
  std::string source;
  std::vector<std::string> input_of;  ///< parameter sets that were authored from it
};

/// What a graph says in our vocabulary, for one parameter set.
struct Ontology {
  std::vector<Stage> stages;            ///< by order
  std::vector<Structure> structures;    ///< by name
  std::vector<ProcessEntry> processes;  ///< by name
  std::vector<Disease> diseases;        ///< by name
  std::vector<std::string> parameter_sets;
  std::vector<Measurement> measurements;                     ///< by name
  std::vector<std::pair<double, double>> crown_rump_length;  ///< day, metres; by day

  [[nodiscard]] std::optional<int> find_structure(const std::string& name) const;
  [[nodiscard]] std::optional<int> find_stage(const std::string& name) const;
  [[nodiscard]] std::optional<int> find_process(const std::string& name) const;
  [[nodiscard]] std::optional<int> find_disease(const std::string& name) const;
};

}  // namespace geoprior::embryo
