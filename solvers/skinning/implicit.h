#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>

#include "core/context.h"
#include "core/options.h"
#include "core/rig.h"

namespace geoprior {

struct ImplicitOptions;  // every choice the two published sources differ in, or leave open, is an
                         // option
void describe(OptionVisitor& v, ImplicitOptions& options);

/// Implicit skinning (Vaillant et al. 2013; thesis 3.1).
class ImplicitSkinning {
 public:
  /// Samples, HRBF fields, caches and rest iso-values. Throws Error for an open or non-manifold
  /// mesh.
  ImplicitSkinning(const RiggedMesh& rig, const ImplicitOptions& options, RunContext& context);
  ~ImplicitSkinning();
  void deform(const Pose& pose, Eigen::MatrixX3d& posed, RunContext& context);
  /// Of the last deform: field evaluations per vertex, iterations, residual field error of free
  /// vertices, contact gap…
  [[nodiscard]] std::map<std::string, double> diagnostics() const;
};

}  // namespace geoprior
