#include "solvers/fluid/lift/lifted_frames.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "core/error.h"

namespace geoprior::fluid {
namespace {

double total_area(const Feature& feature) {
  return std::accumulate(feature.area.begin(), feature.area.end(), 0.0);
}

/// The feature's frame of this time; it has the times of its animation, bit for bit.
std::optional<std::size_t> frame_at(const Feature& feature, double time) {
  const auto found = std::lower_bound(feature.times.begin(), feature.times.end(), time);
  if (found == feature.times.end() || *found != time) return {};
  return found - feature.times.begin();
}

}  // namespace

const Feature* shown_map(const std::vector<Feature>& features, const std::optional<int>& id) {
  const Feature* shown = nullptr;
  std::string allowed;
  for (const Feature& f : features) {
    if (f.kind != RegionKind::differential) continue;
    allowed += (allowed.empty() ? "" : ", ") + std::to_string(f.id);
    const bool better = id ? f.id == *id : shown == nullptr || total_area(f) > total_area(*shown);
    if (better) shown = &f;
  }
  if (shown == nullptr && id) {
    throw Error("there is no differential feature " + std::to_string(*id), "map_feature",
                allowed.empty() ? "none: no differential feature was lifted" : allowed);
  }
  return shown;
}

Part map_part(const Feature& feature, double time) {
  const int n = feature.resolution;
  const double texel = feature.extent / n;
  const Eigen::Index texels = static_cast<Eigen::Index>(n) * n;
  Eigen::MatrixX3d displacement = Eigen::MatrixX3d::Zero(texels, 3);
  Eigen::VectorXd alpha = Eigen::VectorXd::Zero(texels);
  if (const auto frame = frame_at(feature, time)) {
    displacement = feature.maps[*frame].displacement.cast<double>();
    alpha = feature.maps[*frame].alpha.cast<double>();
  }
  Part part;
  part.kind = Part::Kind::grid;
  part.grid_size = {n, n, 1};
  part.grid_spacing.setConstant(texel);
  part.grid_origin << (texel - feature.extent) / 2, (texel - feature.extent) / 2, 0;
  const auto on = NamedArray::On::points;
  part.arrays.push_back({"height", "m", on, alpha.cwiseProduct(displacement.col(2))});
  part.arrays.push_back({"alpha", "1", on, alpha});
  part.arrays.push_back({"displacement", "m", on, displacement});
  return part;
}

double mesh_bytes(const TriMesh& mesh) {
  return static_cast<double>(mesh.V.size()) * sizeof(double) +
         static_cast<double>(mesh.F.size()) * sizeof(int);
}

FrameTable feature_table(const std::vector<Feature>& features, const std::vector<double>& times,
                         const std::vector<double>& frame_bytes) {
  FrameTable table;
  table.columns = {"feature [1]",    "kind [1]",   "begin [s]", "end [s]",           "frames [1]",
                   "resolution [1]", "extent [m]", "bytes [B]", "sequence_bytes [B]"};
  table.rows.resize(features.size(), 9);
  for (std::size_t i = 0; i < features.size(); ++i) {
    const Feature& f = features[i];
    double beside = 0;
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (times[k] >= f.times.front() && times[k] <= f.times.back()) beside += frame_bytes[k];
    }
    table.rows.row(i) << f.id, f.kind == RegionKind::isolated ? 1 : 2, f.times.front(),
        f.times.back(), f.frame_count(), f.resolution, f.extent, static_cast<double>(f.bytes()),
        beside;
  }
  return table;
}

}  // namespace geoprior::fluid
