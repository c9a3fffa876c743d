#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "models/details/scene.h"

namespace geoprior::details {

enum class DeformationKind { stretch, scale, inflate, squeeze, twist, bend };

/// Amount of a deformation at a time, linear between.
struct AmountKey {
  double t = 0;      ///< s
  double value = 1;  ///< factor, or angle (deg)
};
void describe(OptionVisitor& v, AmountKey& key);

/// One operation on the surface, in the place where those before it have left it. A tagged choice
/// by `kind`; `keys` say how much of it there is at a time:
///
/// - stretch: the part of the surface between `from` and `to` along the axis becomes `value` times
///   as long, what is beyond moves along; across the axis the surface is multiplied by value^-cross
///   (0: it stays, 1/2: a tube keeps its volume, 1: a plane its area);
/// - scale: about the centre, by the factor `value`;
/// - inflate: along the normals until the area is `value` times what it was before; the normals are
///   averaged `smooth` times over the neighbours, or hollows fold;
/// - squeeze: distances from the axis multiplied by `value`, fully in the middle of `from` … `to`;
/// - twist: about the axis, by 0 at `from` to `value` degrees at `to`;
/// - bend: the axis becomes an arc between `from` and `to`, `value` degrees towards `side`.
///
/// Without `from` and `to`: the whole surface at rest. `radius` limits an operation to a ball about
/// the centre: what it does to a vertex is multiplied by (1 - (d / radius)^2)^2, d at rest.
struct DeformationOptions {
  DeformationKind kind = DeformationKind::stretch;
  std::vector<AmountKey> keys;
  std::array<double, 3> centre{0, 0, 0};
  std::array<double, 3> axis{1, 0, 0};
  std::array<double, 3> side{0, 0, 1};
  double cross = 0;
  std::optional<double> from, to;
  int smooth = 0;
  double ramp = 0.5;
  std::optional<double> radius;
};
void describe(OptionVisitor& v, DeformationOptions& options);

/// Value of the keys at a time: constant before the first and after the last.
double amount_at(const std::vector<AmountKey>& keys, double t);

/// Operations over time on a surface that may move already.
class ScriptedMotion final : public SurfaceMotion {
 public:
  /// @param base        positions before the operations: one frame, or as many as asked for
  /// @param parameters  of the frames (s), strictly increasing
  /// @throws Error  naming the key: no keys, times that do not increase, a factor that is not
  ///                positive, an axis without direction, from beyond to
  ScriptedMotion(TriMesh rest, std::shared_ptr<const SurfaceMotion> base,
                 std::vector<DeformationOptions> operations, std::vector<double> parameters);
  [[nodiscard]] int frame_count() const override { return static_cast<int>(parameters_.size()); }
  [[nodiscard]] double parameter(int frame) const override;
  /// @throws Error  for an inflation that does not reach its area (names operation and frame)
  [[nodiscard]] Eigen::MatrixX3d positions(int frame) const override;

 private:
  TriMesh rest_;
  std::shared_ptr<const SurfaceMotion> base_;
  std::vector<DeformationOptions> operations_;
  std::vector<double> parameters_;
  std::vector<Eigen::VectorXd> falloff_;  ///< of each operation, per vertex
};

}  // namespace geoprior::details
