#include "solvers/fluid/features/segmentation.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "solvers/fluid/features/morphology.h"
#include "solvers/fluid/features/regions.h"
#include "solvers/fluid/features/segmentation_roles.h"
#include "solvers/fluid/features/segmentation_thresholds.h"

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

namespace {

/// One frame on its way: the graph, its shape, and what of it may be in a differential region.
struct Canvas {
  SurfaceGraph graph;
  SurfaceShape shape;
  SurfaceComponents components;
  ComponentRoles roles;
  std::vector<char> active;  ///< bed, unmasked
};

std::vector<char> hysteresis(const Canvas& c, double high, double low) {
  std::vector<char> set(c.active.size(), 0);
  std::vector<int> queue;
  for (int v = 0; v < std::ssize(set); ++v) {
    if (c.active[v] == 0 || set[v] != 0 || std::abs(c.shape.curvature[v]) <= high) continue;
    set[v] = 1;
    queue.assign(1, v);
    while (!queue.empty()) {
      const int from = queue.back();
      queue.pop_back();
      for (const int n : c.graph.neighbours(from)) {
        if (c.active[n] == 0 || set[n] != 0 || std::abs(c.shape.curvature[n]) <= low) continue;
        set[n] = 1;
        queue.push_back(n);
      }
    }
  }
  return set;
}

/// Labels the connected parts of `set` from `next` on, in the order of their first vertices; parts
/// below `smallest` (m^2) keep 0.
int label_parts(const Canvas& c, const std::vector<char>& set, double smallest, int next,
                std::vector<int>& label) {
  std::vector<char> seen(set.size(), 0);
  std::vector<int> part;
  for (int s = 0; s < std::ssize(set); ++s) {
    if (set[s] == 0 || seen[s] != 0) continue;
    part.assign(1, s);
    seen[s] = 1;
    double area = 0;
    for (std::size_t i = 0; i < part.size(); ++i) {
      area += c.shape.area[part[i]];
      for (const int n : c.graph.neighbours(part[i])) {
        if (set[n] == 0 || seen[n] != 0) continue;
        seen[n] = 1;
        part.push_back(n);
      }
    }
    if (area < smallest) continue;
    for (const int v : part) label[v] = next;
    ++next;
  }
  return next;
}

void turn_over(SurfaceShape& shape) {
  for (double& H : shape.curvature) H = -H;
  for (Eigen::Vector3d& n : shape.normal) n = -n;
}

void warn(const Canvas& c, std::vector<std::string>& warnings) {
  if (c.roles.inside_out) warnings.emplace_back("oriented inwards: turned over");
  if (std::any_of(c.roles.role.begin(), c.roles.role.end(),
                  [](ComponentRole r) { return r == ComponentRole::bubble; }))
    warnings.emplace_back("closed components oriented inwards: bubbles, left out");
}

/// Share of a component's vertices that walls mask.
std::vector<double> masked_shares(const Canvas& c, const std::vector<char>& masked) {
  std::vector<double> share(c.components.list.size(), 0.0);
  for (std::size_t v = 0; v < masked.size(); ++v) {
    if (masked[v] != 0) share[c.components.of_vertex[v]] += 1;
  }
  for (std::size_t i = 0; i < share.size(); ++i) share[i] /= c.components.list[i].vertices;
  return share;
}

/// Drops become regions whole, unless they are tiny or stick to a wall.
/// @return  component of each of the labels, which start at `next`
std::vector<int> label_drops(const Canvas& c, const std::vector<char>& masked, double smallest,
                             int next, std::vector<int>& label) {
  const std::vector<double> share = masked_shares(c, masked);
  std::vector<int> label_of(c.components.list.size(), 0), drops;
  for (int i = 0; i < std::ssize(label_of); ++i) {
    if (c.roles.role[i] != ComponentRole::drop || c.components.list[i].area < smallest) continue;
    if (share[i] > 0.5) continue;
    label_of[i] = next++;
    drops.push_back(i);
  }
  for (std::size_t v = 0; v < label.size(); ++v) {
    const int l = label_of[c.components.of_vertex[v]];
    if (l > 0) label[v] = l;
  }
  return drops;
}

/// Vertices of the bed that waves hold: thresholds, then closing, opening and holes.
std::vector<char> waves_of(const Canvas& c, const Thresholds& thresholds,
                           const SegmentationOptions& options, double cell) {
  std::vector<char> set = hysteresis(c, thresholds.high / cell, thresholds.low / cell);
  Morphology morphology(c.graph, c.active);
  morphology.dilate(set, options.close_radius * cell);
  morphology.erode(set, options.close_radius * cell);
  morphology.erode(set, options.open_radius * cell);
  morphology.dilate(set, options.open_radius * cell);
  morphology.fill_holes(set, c.shape.area, options.largest_hole * cell * cell);
  return set;
}

void require_frame(const SurfaceFrame& frame, int frame_index) {
  if (frame.velocity.rows() != 0 && frame.velocity.rows() != frame.mesh.V.rows()) {
    throw Error(std::to_string(frame.velocity.rows()) + " velocities for " +
                    std::to_string(frame.mesh.V.rows()) + " vertices",
                "frame " + std::to_string(frame_index), "one a vertex, or none");
  }
}

}  // namespace

SegmentedFrame Segmenter::segment(const SurfaceFrame& frame, int frame_index) const {
  SegmentedFrame result;
  require_frame(frame, frame_index);
  const std::size_t n = frame.mesh.vertex_count();
  result.label.assign(n, 0);
  result.masked.assign(n, 0);
  if (frame.mesh.triangle_count() == 0) {
    result.curvature.setZero(n);
    result.warnings.emplace_back("empty");
    return result;
  }
  Canvas c;
  c.graph = surface_graph(frame.mesh);
  c.shape = surface_shape(c.graph, curvature_);
  c.components = surface_components(c.graph);
  c.roles = component_roles(c.components, options_);
  if (c.roles.inside_out) turn_over(c.shape);
  warn(c, result.warnings);
  c.active.resize(n);
  for (std::size_t v = 0; v < n; ++v) {
    result.masked[v] =
        is_masked(walls_, c.graph.x[v], c.shape.normal[v], options_.mask.band * cell_, cell_);
    const auto role = c.roles.role[c.components.of_vertex[v]];
    c.active[v] = role == ComponentRole::bed && result.masked[v] == 0;
  }

  const std::vector<char> set = waves_of(c, thresholds_, options_, cell_);
  const double smallest = options_.smallest_area * cell_ * cell_;
  const int waves = label_parts(c, set, smallest, 1, result.label) - 1;
  const std::vector<int> drops = label_drops(c, result.masked, smallest, waves + 1, result.label);
  const int count = waves + static_cast<int>(drops.size());
  result.regions = region_attributes(c.graph, c.shape, result.label, count, frame.velocity, cell_);
  for (Region& region : result.regions) region.frame = frame_index;
  for (std::size_t i = 0; i < drops.size(); ++i) {
    Region& region = result.regions[waves + i];
    const SurfaceComponent& drop = c.components.list[drops[i]];
    region.kind = RegionKind::isolated;
    region.volume = std::abs(drop.volume);
    region.centre = drop.centre;
  }
  result.curvature = Eigen::Map<const Eigen::VectorXd>(c.shape.curvature.data(), n);
  return result;
}

}  // namespace geoprior::fluid
