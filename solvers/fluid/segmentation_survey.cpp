#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "solvers/fluid/segmentation_roles.h"
#include "solvers/fluid/segmentation_thresholds.h"

namespace geoprior::fluid {
namespace {

constexpr int kMostFrames = 16;
constexpr int kMostPasses = 200;
constexpr double kFlatRadius = 0.25;  // of the scene's diagonal: larger radii of curvature are flat
constexpr std::size_t kMostSamples = 20'000;  // of |H| h in a frame

/// What is kept of the frames looked at: a point a vertex.
struct Survey {
  std::vector<std::vector<WallSample>> samples;
  std::vector<std::vector<float>> curvature;  ///< |H|; negative: no free surface of the bed
  Eigen::AlignedBox3d box;
};

void survey_frame(const SurfaceFrame& frame, const SegmentationOptions& options,
                  const CurvatureOptions& curvature_options, Survey& survey) {
  const SurfaceGraph graph = surface_graph(frame.mesh);
  const SurfaceShape shape = surface_shape(graph, curvature_options);
  const SurfaceComponents components = surface_components(graph);
  const ComponentRoles roles = component_roles(components, options);
  const float outward = roles.inside_out ? -1 : 1;
  auto& samples = survey.samples.emplace_back(graph.x.size());
  auto& curvature = survey.curvature.emplace_back(graph.x.size());
  for (std::size_t v = 0; v < graph.x.size(); ++v) {
    survey.box.extend(graph.x[v]);
    samples[v] = {graph.x[v].cast<float>(), outward * shape.normal[v].cast<float>(),
                  static_cast<float>(shape.area[v])};
    const auto role = roles.role[components.of_vertex[v]];
    const bool bed = role == ComponentRole::bed && graph.border[v] == 0;
    curvature[v] = bed ? static_cast<float>(std::abs(shape.curvature[v])) : -1.0F;
  }
}

double mean_edge(const TriMesh& mesh) {
  double sum = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k)
      sum += (mesh.V.row(mesh.F(t, (k + 1) % 3)) - mesh.V.row(mesh.F(t, k))).norm();
  }
  return sum / (3 * static_cast<double>(mesh.F.rows()));
}

/// Passes that smooth over the same distance when edges are `ratio` times shorter: it grows with
/// the square root of the passes. Coarser meshes are smoothed no less than asked for.
int passes_for(int passes, double ratio) {
  const double needed = passes * std::max(1.0, ratio * ratio);
  return static_cast<int>(std::lround(std::min<double>(needed, std::max(passes, kMostPasses))));
}

Eigen::AlignedBox3d box_of(const MaskBox& given) {
  return {Eigen::Vector3d(given.low.data()), Eigen::Vector3d(given.high.data())};
}

Walls walls_of(const Survey& survey, const MaskOptions& options, double cell) {
  Walls walls;
  for (const MaskBox& tank : options.containers)
    walls.tanks.push_back({box_of(tank), {true, true, true, true, true}});
  for (const MaskBox& solid : options.solids) walls.solids.push_back(box_of(solid));
  if (options.infer_walls) walls.tanks.push_back(infer_walls(survey.samples, cell));
  return walls;
}

/// |H| h of the unmasked bed, at most `kMostSamples` a frame.
std::vector<std::vector<float>> free_surface(const Survey& survey, const Walls& walls, double band,
                                             double cell) {
  std::vector<std::vector<float>> result;
  for (std::size_t f = 0; f < survey.samples.size(); ++f) {
    std::vector<float>& s = result.emplace_back();
    const std::size_t n = survey.samples[f].size();
    const std::size_t stride = n / kMostSamples + 1;
    for (std::size_t v = 0; v < n; v += stride) {
      const WallSample& at = survey.samples[f][v];
      const float H = survey.curvature[f][v];
      if (H < 0 ||
          is_masked(walls, at.x.cast<double>(), at.normal.cast<double>(), band * cell, cell))
        continue;
      s.push_back(H * static_cast<float>(cell));
    }
  }
  return result;
}

}  // namespace

Segmenter::Segmenter(const SurfaceSequence& sequence, const SegmentationOptions& options)
    : options_(options), curvature_(options.curvature) {
  Survey survey;
  const int count = sequence.frame_count();
  const int looked_at = std::min(count, kMostFrames);
  for (int i = 0; i < looked_at; ++i) {
    // Evenly, first and last included.
    const int f =
        looked_at == 1 ? 0 : static_cast<int>(static_cast<long>(i) * (count - 1) / (looked_at - 1));
    const SurfaceFrame frame = sequence.frame(f);
    if (frame.mesh.triangle_count() == 0) continue;
    if (survey.samples.empty()) {
      const double edge = mean_edge(frame.mesh);
      cell_ = options.cell.value_or(edge);
      if (!(cell_ > 0 && edge > 0))
        throw Error("edges have no length", sequence.name(), "a mesh of positive size");
      curvature_.smoothing = passes_for(options.curvature.smoothing, cell_ / edge);
    }
    survey_frame(frame, options, curvature_, survey);
  }
  if (survey.samples.empty()) {
    throw Error("all " + std::to_string(looked_at) + " frames looked at are empty", sequence.name(),
                "a frame with triangles");
  }
  walls_ = walls_of(survey, options.mask, cell_);
  if (options.thresholds == ThresholdKind::given) {
    thresholds_ = {options.high, options.low};
    return;
  }
  thresholds_ = automatic_thresholds(free_surface(survey, walls_, options.mask.band, cell_),
                                     cell_ / (kFlatRadius * survey.box.diagonal().norm()), options,
                                     warnings_);
}

}  // namespace geoprior::fluid
