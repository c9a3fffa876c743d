#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "models/sketch/pattern/make_pattern.h"
#include "models/sketch/pattern/suggested_seam.h"
#include "solvers/sketch/pattern/cut_candidates.h"

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
  int most_parts = std::numeric_limits<int>::max();
};

/// Of patterns that are tried only: fewer iterations than those of the one that is made in the end.
TrialOptions trial_options(const PatternOptions& pattern, double tolerance);

/// Cuts as they lie on the surface (`CutLines`).
CutLines lines_of(const std::vector<SurfacePath>& paths, const TriMesh& mesh);

/// What opens the parts of a surface that cannot be laid flat as they are.
struct Openings {
  std::vector<std::vector<SurfacePath>> cuts;  ///< to be made one after the other
  CutLines lines;
};

/// Opens them: rings by a path across (`bridge`), others along their shortest cut.
/// @param seam  number of the new seam
/// @return      nothing when the mesh cannot be split so
std::optional<Openings> open_rings(SeamedSurface& surface, int seam, const TrialOptions& options);

/// A piece as it is after cuts.
struct CutTrial {
  std::vector<SurfacePath> cut;
  CutLines lines;             ///< the same in space
  double opening_length = 0;  ///< of what opens rings that are left (m)
  int parts = 0;
  double least_part = 0;  ///< area of the smallest piece, all cuts made (m^2)
  FlatMeasure flat;
};

/// A piece to be cut further: seams that sew it to itself are closed, so that a cut may cross them.
struct Panel {
  CutPiece piece;               ///< its vertices and triangles are those of paths
  std::vector<SeamEdge> inner;  ///< those seams
};

/// The panels of a surface, one for each of the pieces that it is cut into.
std::vector<Panel> panels_of(const SeamedSurface& surface);

/// Cuts a panel, opens what cannot be laid flat then, and lays its parts flat.
/// @param paths  none: the panel as it is
/// @return       nothing when the mesh cannot be split along the paths, or has too many parts then
std::optional<CutTrial> try_cut(const Panel& panel, const std::vector<SurfacePath>& paths,
                                const TrialOptions& options);

/// What each of the panels is laid flat as it is.
/// @throws Error  for the first that cannot be cut open
std::vector<CutTrial> measured_panels(const std::vector<Panel>& panels,
                                      const TrialOptions& options);

}  // namespace geoprior::sketch
