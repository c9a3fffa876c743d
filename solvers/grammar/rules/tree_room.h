#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/grammar/hierarchy/hierarchy.h"
#include "models/grammar/objects/crossing.h"

namespace geoprior::grammar {

/// Branches keep this far apart, and a little further than violations are counted (m).
inline constexpr double kTreeClearance = 1e-7;

/// A direction (unit) and a length (m).
struct BranchReach {
  Eigen::Vector3d direction;
  double length;
};

/// Where a branch of a tree has room, while one after the other takes its place.
///
/// A branch that would cross another one is turned about its base, away from it, by as much as is
/// needed: this is continuous in what is asked for. Where that does not help, the nearest free one
/// of fixed directions is taken, then of a shorter branch.
///
/// What it cannot do: move a branch that has its place already.
class TreeRoom {
 public:
  void begin(int tree, double mean_length, int branches, int elements);
  /// @param planned  it is expected there, but has not taken its place yet
  void place(int branch, const Capsule& capsule, bool planned);

  /// The direction and the length nearest to `wanted` for which there is room.
  /// @param low  least length (m); that of `wanted`, where it must not be shortened
  [[nodiscard]] std::optional<BranchReach> find(const Hierarchy& h, int branch,
                                                const Eigen::Vector3d& base,
                                                const BranchReach& wanted, double low) const;

 private:
  /// Which branches are in the way.
  enum class Way {
    all,    ///< those that have their place, and thicker ones where they are planned to be
    placed  ///< those that have their place
  };
  [[nodiscard]] std::optional<Crossing> worst(const Hierarchy& h, int e, const Capsule& capsule,
                                              Way way) const;
  [[nodiscard]] std::optional<BranchReach> push_clear(const Hierarchy& h, int e,
                                                      const Eigen::Vector3d& base, BranchReach s,
                                                      double low, Way way) const;
  [[nodiscard]] std::optional<BranchReach> fan_out(const Hierarchy& h, int e,
                                                   const Eigen::Vector3d& base,
                                                   const BranchReach& s, double low, Way way) const;

  int tree_ = -1;
  CapsuleGrid grid_{1, 0};
  std::vector<char> placed_;  ///< by element
};

}  // namespace geoprior::grammar
