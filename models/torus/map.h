#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/context.h"
#include "models/torus/input.h"

namespace geoprior::torus {

/// Points asked of a torus after so many corrugations, at parameters of the unit square, a row
/// each; they may lie outside of it, the torus is periodic.
struct TorusSamples {
  int corrugations = 0;
  Eigen::MatrixX2d at;
};

/// A method of the topic: the torus after each of its corrugations.
class TorusMap {
 public:
  virtual ~TorusMap() = default;
  /// Points along each side of the grid that it knows the torus at: all parameters asked for are
  /// whole multiples of 1 / grid. Absent: any will do.
  [[nodiscard]] virtual std::optional<int> grid() const { return std::nullopt; }
  /// Told once, before the first frame: everything that will be asked for.
  virtual void plan(std::span<const TorusSamples> /*all*/, RunContext& /*context*/) {}
  /// Points of entry `i` of the plan, a row each.
  /// @throws Error  where a corrugation cannot be made, naming which and where
  virtual Eigen::MatrixX3d points(std::size_t i, const TorusSamples& samples,
                                  RunContext& context) = 0;
  /// What only the method knows, at the places where the metric is measured.
  virtual void diagnose(const TorusSamples& /*places*/,
                        std::map<std::string, double>& /*into*/) const {}
};

using TorusMapFactory = std::function<std::unique_ptr<TorusMap>(const TorusInput&, RunContext&)>;

}  // namespace geoprior::torus
