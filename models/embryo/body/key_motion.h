#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "models/embryo/motion/key_path.h"
#include "models/embryo/motion/monotone.h"
#include "models/embryo/ontology/ontology.h"
#include "models/embryo/shape/shape.h"

namespace geoprior::embryo {

/// A structure between its key frames, before it is put into a body: sizes as logarithms, the place
/// along a path, directions as vectors that are made a rotation again.
///
/// Sizes that are 0 at a key, the egg and the branchings are interpolated as they are; so are all
/// where motion is linear. Directions between two keys that differ by more than 150 degrees would
/// be undecided: that is an Error.
class KeyMotion {
 public:
  /// @param keys  one or more, by day
  /// @throws Error  naming the keys: another primitive, another frame, a turn that is too wide
  KeyMotion(const std::vector<Key>& keys, const std::string& structure,
            Interpolation interpolation);

  /// Primitive, radii, egg, branchings of a day.
  [[nodiscard]] Shape sizes(double day) const;
  /// In ratios of the crown-rump length, from the centre of the frame.
  [[nodiscard]] Eigen::Vector3d place(double day) const { return path_.at(day); }
  [[nodiscard]] Eigen::Matrix3d axes(double day) const;
  /// What places are relative to; absent: the body.
  [[nodiscard]] std::optional<int> frame() const { return frame_; }
  [[nodiscard]] Primitive primitive() const { return primitive_; }

 private:
  void add_sizes(const std::vector<Key>& keys, Interpolation interpolation);
  void add_directions(const std::vector<Key>& keys, const std::string& structure,
                      Interpolation interpolation);

  Primitive primitive_ = Primitive::point;
  std::optional<int> frame_;
  MonotoneCurve sizes_;            ///< radii, radius, end radius, egg, branchings
  std::vector<bool> logarithmic_;  ///< of these
  MonotoneCurve directions_;       ///< axis, up
  KeyPath path_;
};

}  // namespace geoprior::embryo
