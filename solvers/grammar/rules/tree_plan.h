#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "models/grammar/hierarchy/hierarchy.h"
#include "models/grammar/maps/spatial_map.h"

namespace geoprior::grammar {

/// What is asked of a branch, and what it would do about it if nothing were in its way.
struct BranchWish {
  Eigen::Vector3d base, tip;  ///< where its key points are asked to be (m)
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();  ///< rotation that is asked for
  double low = 0, high = 0;                                  ///< bounds of its length (m)
  bool moved = false;                                        ///< it may not stay as it is
  bool asked = false;                                        ///< it, or something below it, moves
  bool held = false;     ///< a tag keeps it, or something that hangs on it, where it is
  bool follows = false;  ///< a tag lets it move with its parent only
  bool fixed = false;    ///< its place is a fact: of a user's edit, or of what carries it
  bool sprouts = false;  ///< it comes into being
  Pose pose;             ///< of one that is fixed
  double length = 0;     ///< of one that is fixed (m)

  /// Its place in the plan (m).
  Eigen::Vector3d planned_base, planned_along;
  bool clamped = false;  ///< the plan would have it longer or shorter than it may be
  /// Squared deviation of it and of all below it, as 1/2 weight |base - centre|^2.
  double weight = 0;
  Eigen::Vector3d centre;
  /// Its best tip for a given base is (tip_pull - tip_share base) / tip_weight.
  double tip_weight = 1, tip_share = 0;
  Eigen::Vector3d tip_pull;
};

/// What the squared deviation below a branch adds up to, before the branch itself is looked at.
struct BranchSums {
  double w = 0, wa = 0, waa = 0;
  Eigen::Vector3d wx = Eigen::Vector3d::Zero(), wax = Eigen::Vector3d::Zero();

  void add(double weight, double attach, const Eigen::Vector3d& centre) {
    w += weight;
    wa += weight * attach;
    waa += weight * attach * attach;
    wx += weight * centre;
    wax += (weight * attach) * centre;
  }
};

/// What a derivation asks of the branches of one tree, and the answer of least squared deviation,
/// which heeds that branches hang together and the bounds of their lengths, but not what crosses.
///
/// The tip t of a branch with the base b is to minimise
///     1/2 |t - T|^2 + sum over children of 1/2 w_c |b + a_c (t - b) - x_c|^2,
/// T where the map takes the tip, a_c where a child hangs, w_c and x_c the weight and the centre of
/// the squared deviation of the child and all below. All terms are isotropic, so the best length
/// within bounds is that of the best tip without them, clamped. A branch that is clamped passes its
/// base on as a stick whose direction stays: by the envelope theorem the gradient is right where
/// passes up and down the tree no longer change it.
///
/// What it cannot do: a branch that would turn right round stays in its local minimum.
class TreePlan {
 public:
  /// Begins anew with the tree that `element` is of, every branch where it is.
  /// @throws Error  naming the element, when it is of no tree
  void begin(const Hierarchy& hierarchy, int element, int edited, std::uint64_t derivation);
  [[nodiscard]] std::uint64_t derivation() const { return derivation_; }
  [[nodiscard]] int tree() const { return tree_; }
  /// All that were there, parents before children.
  [[nodiscard]] const std::vector<int>& branches() const { return branches_; }
  [[nodiscard]] BranchWish& of(int branch) { return wishes_[branch]; }
  [[nodiscard]] const BranchWish& of(int branch) const { return wishes_[branch]; }
  /// Mean length of the branches of a level at rest; of the level before, where there is none.
  [[nodiscard]] double level_mean(int level) const;
  [[nodiscard]] double mean_length() const { return mean_length_; }

  /// Asks the branches below an element what a map asks of their key points.
  /// @throws Error  naming a branch that the map takes nowhere
  void ask(const Hierarchy& hierarchy, const SpatialMap& map, int top);
  /// Asks those that hang on moved ones to move rigidly with them, but for those that a map of an
  /// edit asked before.
  void carry(const Hierarchy& hierarchy);
  /// Finds the best places, and who has to be asked. The tree's position is `root` (m).
  void solve(const Hierarchy& hierarchy, const Eigen::Vector3d& root);
  /// The best tip of a branch for a base, less the base; not clamped.
  [[nodiscard]] Eigen::Vector3d best_along(int branch, const Eigen::Vector3d& base) const;
  /// A place for a branch that comes into being.
  BranchWish& grow(int branch);

 private:
  void limits(const Hierarchy& hierarchy, int branch);
  void pass_up(const Hierarchy& hierarchy);
  /// Returns by how much clamped branches moved since the pass before (m).
  double pass_down(const Hierarchy& hierarchy, const Eigen::Vector3d& root);

  std::uint64_t derivation_ = 0;
  int tree_ = -1;
  std::vector<int> branches_;
  std::vector<BranchWish> wishes_;  ///< by element
  std::vector<BranchSums> sums_;    ///< by element, of one pass
  std::vector<char> mapped_;        ///< by element: asked by a map
  std::vector<double> means_;       ///< by level; 0: none
  double mean_length_ = 0;
};

}  // namespace geoprior::grammar
