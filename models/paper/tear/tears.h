#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/state_bytes.h"
#include "models/paper/sheet/pattern.h"

namespace geoprior::paper {

/// A tear: the way that a tip has gone through the pattern.
struct Tear {
  std::vector<Eigen::Vector2d> path;  ///< every place of the tip, the start first (m)
  std::vector<double> times;          ///< of each (s)
  /// Of the step to each place: how far the left lip was pulled up and the right one down, -1 … 1.
  std::vector<double> shear;
  std::vector<int> knots;           ///< of the path: what the cut keeps of it
  Eigen::Vector2d last_pull{0, 0};  ///< direction that the last step was asked to take
  double last_step = 0;             ///< its length (m)
  bool ended = false;               ///< at a border or another tear, or given up
  bool joined = false;              ///< another tear ends on the edge that leads to the tip

  [[nodiscard]] const Eigen::Vector2d& tip() const { return path.back(); }
  [[nodiscard]] double length() const;  ///< m
  /// Direction of the edge of the cut that leads to the tip; zero for a tear without length.
  [[nodiscard]] Eigen::Vector2d heading() const;
  /// First place of the path from which on the sheet has torn: the end of the cut, if it had one.
  [[nodiscard]] int torn_from() const;
};

/// All tears of a sheet.
class Tears {
 public:
  /// @param whole      the pattern with the cuts that it begins with: each is a tear
  /// @param tolerance  farthest that a path may lie from its cut (m)
  Tears(const Pattern& whole, double tolerance);

  [[nodiscard]] const std::vector<Tear>& all() const { return tears_; }
  /// The pattern, cut along the tears.
  [[nodiscard]] const Pattern& torn() const { return torn_; }
  [[nodiscard]] double length() const;  ///< of all (m)

  /// Starts a tear at a point of the sheet; it has no length yet. @return its number
  int start(const Eigen::Vector2d& p, double time);
  /// Takes the tip one step further.
  void advance(int tear, const Eigen::Vector2d& p, double time);
  /// What the last step was taken by; `shear` as `TipPull::shear`.
  void note_pull(int tear, const Eigen::Vector2d& direction, double step, double shear);
  /// Where it ends on another, that keeps the edge it ends on.
  void end(int tear);
  /// Where a tip that is to go to `to` would leave the ground or meet a lip first, or come nearer
  /// than `margin` (m) to a border or another tear.
  [[nodiscard]] std::optional<Eigen::Vector2d> obstruction(int tear, const Eigen::Vector2d& to,
                                                           double margin) const;

  void save(StateWriter& out) const;
  void load(StateReader& in);

 private:
  void join(int tear, const Eigen::Vector2d& end);
  void update(int tear);
  void set_knots(Tear& tear, int from, int to) const;
  [[nodiscard]] Pattern torn_without(int tear) const;
  void rebuild();

  Pattern whole_;
  double tolerance_;
  std::vector<Tear> tears_;
  Pattern torn_;
};

}  // namespace geoprior::paper
