#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "models/assembly/graph/ported_graph.h"

namespace geoprior::assembly {

/// A closed poly-line in plan that the ways of an assembly are to follow, or whose inside they are
/// to fill.
struct Target {
  enum class Kind { outline, region };
  Kind kind = Kind::outline;
  std::vector<double> x, y;  ///< corners (m)
  double spacing = 0.05;     ///< m, of the points at which it is compared
};
void describe(OptionVisitor& v, Target& options);

/// What a user wants of a new assembly, beside its being valid.
struct Guide {
  std::optional<Target> target;
  std::vector<std::string> keep;  ///< labels of parts that stay as they are
  std::vector<std::string> use;   ///< labels of which a part is to be there
};
void describe(OptionVisitor& v, Guide& options);

/// @throws Error  for fewer than three corners, or as many x as y
void require_valid(const Guide& guide, const std::string& where);

/// How far assemblies are from a guide: less is better.
class Objective {
 public:
  Objective(const Guide& guide, const std::vector<PartType>& types);

  /// An outline: the mean distance (m) between it and the ways, the mean of both directions. A
  /// region: the share of it that no way comes near to, plus the share of the ways outside of it.
  /// For each label that is wanted and not there 1 is added. Points are those of the parts' ways in
  /// plan, of a part without ways its ports.
  [[nodiscard]] double operator()(const Assembly& assembly) const;
  [[nodiscard]] bool keeps(int type) const { return kept_[type] != 0; }

 private:
  [[nodiscard]] std::vector<Eigen::Vector2d> plan_points(const Assembly& assembly) const;
  [[nodiscard]] double outline_distance(const std::vector<Eigen::Vector2d>& points) const;
  [[nodiscard]] double region_miss(const std::vector<Eigen::Vector2d>& points) const;
  [[nodiscard]] bool is_inside(const Eigen::Vector2d& x) const;

  std::optional<Target> target_;
  std::vector<std::vector<int>> wanted_;  ///< types that are meant by each name
  std::vector<char> kept_;
  std::vector<std::vector<Eigen::Vector3d>> samples_;  ///< of a type
  std::vector<Eigen::Vector2d> corners_, target_points_;
};

}  // namespace geoprior::assembly
