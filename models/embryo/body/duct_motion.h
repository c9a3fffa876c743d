#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "models/embryo/motion/key_path.h"
#include "models/embryo/motion/monotone.h"
#include "models/embryo/ontology/ontology.h"

namespace geoprior::embryo {

/// What a duct asks of the body that it is in, on one day.
struct DuctSurroundings {
  std::function<Eigen::Vector3d(int structure, const Eigen::Vector3d& uvw)> anchor;  ///< m
  Eigen::Vector3d frame{0, 0, 0};  ///< centre of the frame of the duct's places (m)
  double crown_rump_length = 0;    ///< m
};

/// One end of a duct between its key frames.
///
/// While the keys name one anchor, the end is the point of that structure at local coordinates
/// between those of the keys, wherever the structure has come: on it to round-off. Free ends go
/// along a path of ratios. Where the keys change from one anchor to another, the end crosses over
/// from the place on the one to that on the other, eased from key to key.
class EndMotion {
 public:
  /// @param which  `&Geometry::start` or `&Geometry::end`
  EndMotion(const std::vector<Key>& keys, Anchor Geometry::*which, Interpolation interpolation);

  [[nodiscard]] Eigen::Vector3d at(double day, const DuctSurroundings& body) const;
  /// The structure that it is on on a day and where on it, between those of the keys; without a
  /// structure where it is free (then `at` is a place in ratios) or crosses over.
  [[nodiscard]] Anchor anchor(double day) const;
  /// Structures that it hangs on at some day.
  [[nodiscard]] std::vector<int> anchors() const;

 private:
  /// Consecutive keys with one anchor.
  struct Run {
    std::optional<int> structure;
    double first = 0, last = 0;
    MonotoneCurve local;
    KeyPath free;
  };
  [[nodiscard]] static Eigen::Vector3d of_run(const Run& run, double day,
                                              const DuctSurroundings& body);
  /// The run that has begun.
  [[nodiscard]] std::size_t run_of(double day) const;

  std::vector<Run> runs_;
  Interpolation interpolation_;
};

/// The control points of a duct between its key frames: both ends, and between them points that go
/// along paths of ratios from the centre of the frame.
class DuctMotion {
 public:
  /// @throws Error  naming the keys, unless all have as many points between the ends
  DuctMotion(const std::vector<Key>& keys, const std::string& structure,
             Interpolation interpolation);

  [[nodiscard]] const EndMotion& start() const { return start_; }
  [[nodiscard]] const EndMotion& end() const { return end_; }
  /// Points between the ends: those of one number at a day.
  [[nodiscard]] std::vector<Eigen::Vector3d> between(double day,
                                                     const DuctSurroundings& body) const;
  [[nodiscard]] std::vector<int> anchors() const;

 private:
  EndMotion start_, end_;
  std::vector<KeyPath> via_;
};

}  // namespace geoprior::embryo
