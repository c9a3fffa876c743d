#include "solvers/fluid/lift/maps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/limits.h"
#include "core/parallel.h"
#include "solvers/fluid/lift/displacement_map.h"
#include "solvers/fluid/lift/exponential_map.h"

namespace geoprior::fluid {
namespace {

constexpr double kSteep = 0.2;             ///< n.z of a bed that is no graph over its plane
constexpr double kSteepShare = 0.01;       ///< of the area, that is let pass
constexpr int kDistance = 3, kHeight = 4;  ///< channels after the displacement

/// A patch in the axes of its moving frame.
struct PlacedPatch {
  std::vector<Eigen::Vector3d> surface, bed;
  std::vector<Eigen::Vector2d> uv;            ///< of the bed
  std::vector<Eigen::Vector3d> displacement;  ///< surface from bed, in the map's axes
};

PlacedPatch place(const LiftPatch& patch, const Eigen::Isometry3d& frame) {
  PlacedPatch placed;
  const Eigen::Matrix3d turn = frame.linear().transpose();
  const Eigen::Vector3d shift = turn * (patch.sample.centre - frame.translation());
  for (std::size_t v = 0; v < patch.bed.size(); ++v) {
    placed.surface.push_back(turn * patch.surface[v].cast<double>() + shift);
    placed.bed.push_back(turn * patch.bed[v].cast<double>() + shift);
    placed.uv.push_back(placed.bed.back().head<2>());
    // Difference before rounding grows with the distance from the centre: exactly 0 outside.
    placed.displacement.push_back(turn * (patch.surface[v] - patch.bed[v]).cast<double>());
  }
  return placed;
}

/// Share of the bed's area steeper than is let pass against the frame's plane.
double steep_share(const LiftPatch& patch, const Eigen::Vector3d& z) {
  double all = 0, steep = 0;
  for (const auto& f : patch.triangles) {
    const auto corner = [&](std::size_t k) { return patch.bed[f[k]].cast<double>().eval(); };
    const Eigen::Vector3d n = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    all += n.norm();
    if (n.dot(z) <= kSteep * n.norm()) steep += n.norm();
  }
  return all > 0 ? steep / all : 0;
}

/// Triangle whose middle is nearest to the origin of the frame.
int nearest_triangle(const LiftPatch& patch, const PlacedPatch& placed) {
  int best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int t = 0; t < std::ssize(patch.triangles); ++t) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int v : patch.triangles[t]) middle += placed.bed[v] / 3;
    if (middle.squaredNorm() >= least) continue;
    least = middle.squaredNorm();
    best = t;
  }
  return best;
}

/// Coordinates by geodesics, displacements in transported axes.
void unroll(const LiftPatch& patch, PlacedPatch& placed) {
  const int triangle = nearest_triangle(patch, placed);
  const auto& f = patch.triangles[triangle];
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();
  for (const int v : f) anchor += placed.bed[v] / 3;
  const ExponentialMap map =
      exponential_map(placed.bed, patch.triangles, triangle, anchor, Eigen::Matrix3d::Identity(),
                      std::numeric_limits<double>::max());
  std::fill(placed.uv.begin(), placed.uv.end(),
            Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (std::size_t i = 0; i < map.vertices.size(); ++i) {
    const int v = map.vertices[i];
    placed.uv[v] = map.uv[i];
    placed.displacement[v] = (map.axes[i].transpose() * placed.displacement[v]).eval();
  }
}

/// Half extents that hold the region with its margin and the whole patch.
double half_extent(const LiftPatch& patch, const PlacedPatch& placed, double margin) {
  double half = 0;
  for (std::size_t v = 0; v < placed.uv.size(); ++v) {
    const double reach = placed.uv[v].cwiseAbs().maxCoeff();
    if (std::isfinite(reach)) half = std::max(half, patch.distance[v] > 0 ? reach : margin * reach);
  }
  return half;
}

MapPatch map_patch(const LiftPatch& patch, const PlacedPatch& placed, bool by_surface) {
  MapPatch result;
  for (std::size_t v = 0; v < placed.uv.size(); ++v) {
    MapPatch::Value value = MapPatch::Value::Zero();
    value.head<3>() = placed.displacement[v].cast<float>().array();
    value[kDistance] = patch.distance[v];
    value[kHeight] = static_cast<float>(by_surface ? placed.surface[v].z() : placed.bed[v].z());
    result.value.push_back(value);
    result.uv.push_back(by_surface ? Eigen::Vector2d(placed.surface[v].head<2>()) : placed.uv[v]);
  }
  for (const auto& f : patch.triangles) {
    const bool placed_all =
        std::all_of(f.begin(), f.end(), [&](int v) { return result.uv[v].allFinite(); });
    if (placed_all) result.triangles.push_back(f);
  }
  return result;
}

double smooth_fall(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return 1 - x * x * x * (x * (6 * x - 15) + 10);
}

/// A frame's map and the bed's heights under it.
struct LiftedFrame {
  MapFrame map;
  HeightRaster bed;
};

LiftedFrame lifted(const MapRaster& raster, double border) {
  const Eigen::Index count = raster.value.size();
  LiftedFrame frame;
  frame.map.displacement.resize(count, 3);
  frame.map.alpha.resize(count);
  frame.bed = {raster.resolution, raster.extent, {}, raster.covered};
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& value = raster.value[i];
    frame.map.displacement.row(i) = value.head<3>().matrix().transpose();
    const bool outside = raster.covered[i] == 2;
    frame.map.alpha[i] =
        outside ? 0.0F
                : static_cast<float>(smooth_fall(static_cast<double>(value[kDistance]) / border));
    frame.bed.height.push_back(value[kHeight]);
  }
  return frame;
}

/// Heights of the surface over the bed along z: the ablation. The highest sheet counts.
void use_heights(const LiftPatch& patch, const PlacedPatch& placed, MapRaster& raster) {
  MapRaster top =
      rasterise(map_patch(patch, placed, true), raster.resolution, raster.extent, {kHeight});
  for (std::size_t i = 0; i < raster.value.size(); ++i) {
    const bool both = top.covered[i] == 1 && raster.covered[i] == 1;
    raster.value[i].head<2>() = 0;
    raster.value[i][2] = both ? top.value[i][kHeight] - raster.value[i][kHeight] : 0;
    if (both) raster.value[i][kDistance] = top.value[i][kDistance];
  }
}

LiftedFrame rasterised(const LiftPatch& patch, const PlacedPatch& placed, int resolution,
                       double extent, double border, bool vectors) {
  MapRaster raster = rasterise(map_patch(patch, placed, false), resolution, extent);
  if (!vectors) use_heights(patch, placed, raster);
  mark_outside(raster);
  fill_uncovered(raster);
  return lifted(raster, border);
}

/// How far the bed of another frame lies above a point of this one, along that frame's z.
std::optional<double> height_above(const LiftedFrame& other, const Eigen::Isometry3d& frame,
                                   const Eigen::Vector3d& point) {
  const Eigen::Vector3d local = frame.inverse() * point;
  const std::optional<double> height = height_at(other.bed, local.head<2>());
  if (!height) return {};
  return *height - local.z();
}

double alpha_near(const LiftedFrame& other, const Eigen::Isometry3d& frame,
                  const Eigen::Vector3d& point) {
  const Eigen::Vector3d local = frame.inverse() * point;
  const int n = other.bed.resolution;
  const Eigen::Array2d g = (local.head<2>().array() / other.bed.extent + 0.5) * n;
  if (!(g >= 0).all() || !(g < n).all()) return 0;
  return other.map.alpha[static_cast<int>(g.y()) * n + static_cast<int>(g.x())];
}

/// What the low-pass of the bed in time takes from the z displacements of a frame.
Eigen::VectorXf bed_correction(const LiftedFrame& before, const LiftedFrame& frame,
                               const LiftedFrame& after, const Eigen::Isometry3d& frame_before,
                               const Eigen::Isometry3d& own, const Eigen::Isometry3d& frame_after,
                               double weight) {
  const int n = frame.bed.resolution;
  Eigen::VectorXf result = Eigen::VectorXf::Zero(frame.map.alpha.size());
  for (int k = 0; k < n * n; ++k) {
    if (frame.map.alpha[k] <= 0 || frame.bed.known[k] != 1) continue;
    const double texel = frame.bed.extent / n;
    const Eigen::Vector3d point =
        own * Eigen::Vector3d((k % n + 0.5) * texel - 0.5 * frame.bed.extent,
                              (k / n + 0.5) * texel - 0.5 * frame.bed.extent,
                              static_cast<double>(frame.bed.height[k]));
    const auto low = height_above(before, frame_before, point);
    const auto high = height_above(after, frame_after, point);
    if (!low || !high) continue;
    const double share = static_cast<double>(frame.map.alpha[k]) *
                         alpha_near(before, frame_before, point) *
                         alpha_near(after, frame_after, point);
    result[k] = static_cast<float>(weight * share * 0.5 * (*low + *high));
  }
  return result;
}

void smooth_beds(std::vector<LiftedFrame>& frames,
                 const std::vector<Eigen::Isometry3d>& placement) {
  /// Of the frames before and after in the mean that smooths a bed in time: ours, as much as its
  /// own.
  constexpr double kNeighbours = 0.5;
  if (frames.size() < 3) return;
  std::vector<Eigen::VectorXf> corrections(frames.size());
  parallel_blocks(frames.size() - 2, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin + 1; i < end + 1; ++i) {
      corrections[i] = bed_correction(frames[i - 1], frames[i], frames[i + 1], placement[i - 1],
                                      placement[i], placement[i + 1], kNeighbours);
    }
  });
  for (std::size_t i = 1; i + 1 < frames.size(); ++i) {
    frames[i].map.displacement.col(2) -= corrections[i];
  }
}

/// Times of the animation from the first to the last patch, and which of them have one.
struct Timeline {
  std::vector<FrameTime> times;
  std::vector<int> patch;  ///< -1: gap
};

Timeline timeline_of(const std::vector<LiftPatch>& patches, const std::vector<double>& times) {
  Timeline line;
  std::size_t next = 0;
  for (int f = patches.front().sample.frame; f <= patches.back().sample.frame; ++f) {
    line.times.push_back({f, times[f]});
    const bool has = patches[next].sample.frame == f;
    line.patch.push_back(has ? static_cast<int>(next) : -1);
    if (has) ++next;
  }
  return line;
}

/// Linear between the frames beside a gap.
void fill_gaps(const Timeline& line, Feature& feature) {
  std::size_t before = 0;
  for (std::size_t i = 0; i < line.patch.size(); ++i) {
    if (line.patch[i] >= 0) {
      before = i;
      continue;
    }
    std::size_t after = i;
    while (line.patch[after] < 0) ++after;
    const double s = (line.times[i].time - line.times[before].time) /
                     (line.times[after].time - line.times[before].time);
    const auto w = static_cast<float>(s);
    const MapFrame &a = feature.maps[before], &b = feature.maps[after];
    feature.maps[i].displacement = (1 - w) * a.displacement + w * b.displacement;
    feature.maps[i].alpha = (1 - w) * a.alpha + w * b.alpha;
    feature.area[i] = (1 - s) * feature.area[before] + s * feature.area[after];
  }
}

/// @param wish  texels along an edge that `texel` asks for
int resolution_of(const MapOptions& options, double wish) {
  const double most = std::max(options.min_resolution, options.max_resolution);
  return static_cast<int>(std::clamp<double>(std::ceil(wish) + 4, options.min_resolution, most));
}

/// Displacement, alpha, bed and what is covered, of all texels of all frames.
void require_maps(const Feature& feature) {
  constexpr double kBytesPerTexel = 4 * sizeof(float) + 4 * sizeof(float);
  const auto frames = static_cast<double>(feature.times.size());
  const double texels = static_cast<double>(feature.resolution) * feature.resolution * frames;
  require_memory(texels * kBytesPerTexel, texels, "texels of a feature's maps",
                 "options.extraction.map.max_resolution");
}

}  // namespace

Feature feature_of_patches(std::vector<LiftPatch> patches, const std::vector<double>& times,
                           double cell, const MapOptions& options) {
  const Timeline line = timeline_of(patches, times);
  std::vector<FrameSample> samples;
  for (const LiftPatch& p : patches) samples.push_back(p.sample);
  Feature feature;
  feature.cell = cell;
  feature.placement = moving_frames(samples, line.times, options.smoothing_window);
  std::vector<Eigen::Isometry3d> own;  // of the patches
  for (std::size_t i = 0; i < line.patch.size(); ++i) {
    feature.times.push_back(line.times[i].time);
    if (line.patch[i] >= 0) own.push_back(feature.placement[i]);
  }
  double steep = 0;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    steep = std::max(steep, steep_share(patches[p], own[p].linear().col(2)));
  }
  const bool unrolled = steep > kSteepShare;
  const auto placed = [&](std::size_t p) {
    PlacedPatch result = place(patches[p], own[p]);
    if (unrolled) unroll(patches[p], result);
    return result;
  };
  double half = 0;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    half = std::max(half, half_extent(patches[p], placed(p), options.margin));
  }
  feature.resolution = resolution_of(options, 2 * half / (options.texel * cell));
  require_maps(feature);
  // Two texels around the patch: interpolation never looks over the map's edge.
  feature.extent = 2 * half * feature.resolution / (feature.resolution - 4);
  std::vector<LiftedFrame> frames(patches.size());
  parallel_blocks(patches.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      frames[p] = rasterised(patches[p], placed(p), feature.resolution, feature.extent,
                             options.border * cell, options.vector_map);
    }
  });
  if (!unrolled) smooth_beds(frames, own);
  feature.maps.resize(feature.times.size());
  feature.area.assign(feature.times.size(), 0);
  feature.volume.assign(feature.times.size(), 0);
  for (std::size_t i = 0; i < line.patch.size(); ++i) {
    if (line.patch[i] < 0) continue;
    const int p = line.patch[i];
    feature.maps[i] = std::move(frames[p].map);
    feature.area[i] = patches[p].sample.area;
  }
  fill_gaps(line, feature);
  return feature;
}

}  // namespace geoprior::fluid
