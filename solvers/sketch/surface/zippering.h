#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/connectivity.h"
#include "models/sketch/drawing/outline.h"
#include "models/sketch/surface/visual_hull.h"

namespace geoprior::sketch {

/// A stretch of a silhouette that no edge of the surface can cover (arc lengths, m).
struct CoverageGap {
  double from = 0, to = 0;
};

/// Edges that carry a silhouette.
struct ZippedSilhouette {
  std::vector<Edge> edges;        ///< in the order of the silhouette
  std::vector<CoverageGap> gaps;  ///< what they leave open
};

/// Which of the edges that cover a point of a silhouette carries it.
enum class SilhouetteChoice {
  protruding,  ///< the one that protrudes most
  planar,      ///< the one that is nearest to the middle of the silhouette's depth in the hull: to
               ///< compare with, as one that takes silhouettes for plane curves
};

/// Zippering (thesis 2.1.2, Figure 2.4): marches along the silhouette of a view and chooses, of all
/// edges whose images in the hull cover the point that was reached, the one that protrudes most.
///
/// An edge's image in the hull lies on the silhouette when both ends do; it covers the stretch
/// between them. Protuberance is the mean over its ends of the outward normal times the way from
/// the hull to the surface, in the view: the surface lies inside the hull, so the largest is the
/// one that has to move least. Neighbouring choices may lie at any depth: silhouettes need not be
/// planar, nor connected in space.
///
/// Points that no edge covers are passed and reported.
class Zippering {
 public:
  /// @param edges   of the surface, which hull and surface share
  /// @param places  of each vertex on this view's silhouette
  Zippering(const OutlinedView& view, std::vector<std::optional<SilhouettePlace>> places,
            const std::vector<Edge>& edges, SilhouetteChoice choice = SilhouetteChoice::protruding);

  /// @param hull,surface  n x 3, equal rows
  [[nodiscard]] ZippedSilhouette close(const Eigen::MatrixX3d& hull,
                                       const Eigen::MatrixX3d& surface) const;

 private:
  struct Interval {
    double from = 0, to = 0;  ///< from < to, `to` may pass the end of the outline
    Edge edge{};
  };
  /// How much an edge recommends itself.
  [[nodiscard]] double merit(const Edge& edge, const Eigen::MatrixX3d& hull,
                             const Eigen::MatrixX3d& surface, double middle) const;

  OutlinedView view_;
  std::vector<std::optional<SilhouettePlace>> places_;
  SilhouetteChoice choice_;
  std::vector<Interval> intervals_;  ///< by `from`
  double longest_ = 0;
};

}  // namespace geoprior::sketch
