#pragma once

#include <optional>
#include <vector>

#include "models/sketch/make_pattern.h"
#include "models/sketch/suggested_seam.h"
#include "solvers/sketch/cut_candidates.h"

namespace geoprior::sketch {

/// How well something is laid flat: sums over its area on the surface (m^2).
struct FlatMeasure {
  double area = 0;
  double within = 0;  ///< stretched by less than the tolerance
  double strain = 0;  ///< of |log stretch|
  bool sound = true;  ///< no triangle is turned over, none lie on each other

  void add(const FlatMeasure& other) {
    area += other.area;
    within += other.within;
    strain += other.strain;
    sound = sound && other.sound;
  }
};

struct TrialOptions {
  PatternOptions pattern;
  double tolerance = 0.02;  ///< of stretch
  std::optional<MirrorAxis> mirror;
};

/// A piece as it is after cuts.
struct CutTrial {
  std::vector<std::vector<SurfacePath>> cuts;  ///< those that were asked for, then what opens rings
  std::vector<Eigen::MatrixX3d> lines;         ///< the same in space
  std::vector<Eigen::MatrixX3d> normals;       ///< of the piece at their points
  double length = 0;                           ///< m
  int parts = 0;
  FlatMeasure flat;
};

/// Cuts a piece, opens what cannot be laid flat then (`bridge`), and lays its parts flat.
/// @param paths  none: the piece as it is
/// @return       nothing when the mesh cannot be split along the paths
std::optional<CutTrial> try_cut(const CutPiece& piece, const std::vector<SurfacePath>& paths,
                                const TrialOptions& options);

}  // namespace geoprior::sketch
