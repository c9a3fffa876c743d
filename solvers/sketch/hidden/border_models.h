#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

namespace geoprior::sketch {

/// A curve in the picture; a closed one does not repeat its first point.
struct PictureCurve {
  std::vector<Eigen::Vector2d> points;
  bool closed = false;
};

/// Place on a curve: number of a point with the fraction of the way to the next, and how far off.
struct CurvePlace {
  double at = 0;
  double distance = 0;  ///< m
  bool beyond = false;  ///< nearest is an end of an open curve
};
CurvePlace nearest_place(const PictureCurve& curve, const Eigen::Vector2d& p);
/// The point at a place; numbers of a closed curve go on around it.
Eigen::Vector2d point_at(const PictureCurve& curve, double at);
/// Points at even distances, about `spacing`, ends included.
PictureCurve evenly(const PictureCurve& curve, double spacing);

/// Copy of a curve on a parallel plane: p -> scale p + shift. Borders of a cone or a cylinder that
/// lie in parallel planes are such copies, in space and hence in every orthographic picture, and a
/// ruling joins a point to its copy.
struct ParallelCopy {
  double scale = 1;
  Eigen::Vector2d shift{0, 0};
  double rms = 0;  ///< distance of what is seen from the copy (m)

  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& p) const {
    return scale * p + shift;
  }
};

/// What is known of a copy beside the points that are seen of it.
struct CopyHints {
  /// Ends of drawn rulings: a point of the original, and of the copy.
  std::vector<std::array<Eigen::Vector2d, 2>> rulings;
  std::vector<Eigen::Vector2d> ends;  ///< of the copy, where it really ends
};

/// Copy of `whole` through the points of another border, by iterated closest points (distances to
/// tangents, which is linear in scale and shift), from the rulings or, without any, from several
/// places. A ruling counts as much as an eighth of the points. Borders of a cylinder are of one
/// size: so is the copy, unless the points say otherwise beyond their noise.
/// @param noise  standard deviation of a drawn coordinate (m)
/// @return nothing when the points leave scale or shift open
std::optional<ParallelCopy> fit_parallel_copy(const PictureCurve& whole,
                                              const std::vector<Eigen::Vector2d>& seen,
                                              const CopyHints& hints, double noise = 0);

/// Mirror image of a plane curve that is its own image, in the picture: p -> p + s(p) u with u the
/// image of the mirror plane's normal and s(p) = offset - 2 u.p + slope v.p, v across u.
struct PictureMirror {
  Eigen::Vector2d u{1, 0};
  double offset = 0, slope = 0;

  [[nodiscard]] Eigen::Vector2d operator()(const Eigen::Vector2d& p) const;
};

/// The reflection from middles of pairs (points of the plane are their own middles): two or more
/// that lie apart across u.
std::optional<PictureMirror> fit_picture_mirror(const Eigen::Vector2d& u,
                                                const std::vector<Eigen::Vector2d>& middles,
                                                double least_apart);

}  // namespace geoprior::sketch
