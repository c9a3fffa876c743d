#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "solvers/fluid/morphology.h"
#include "solvers/fluid/regions.h"
#include "solvers/fluid/regions_attributes.h"
#include "solvers/fluid/segmentation_roles.h"

namespace geoprior::fluid {
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
  for (std::size_t v = 0; v < set.size(); ++v) {
    if (c.active[v] == 0 || set[v] != 0 || std::abs(c.shape.curvature[v]) <= high) continue;
    set[v] = 1;
    queue.assign(1, static_cast<int>(v));
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
  for (std::size_t s = 0; s < set.size(); ++s) {
    if (set[s] == 0 || seen[s] != 0) continue;
    part.assign(1, static_cast<int>(s));
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
  for (std::size_t i = 0; i < label_of.size(); ++i) {
    if (c.roles.role[i] != ComponentRole::drop || c.components.list[i].area < smallest) continue;
    if (share[i] > 0.5) continue;
    label_of[i] = next++;
    drops.push_back(static_cast<int>(i));
  }
  for (std::size_t v = 0; v < label.size(); ++v) {
    const int l = label_of[c.components.of_vertex[v]];
    if (l > 0) label[v] = l;
  }
  return drops;
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
  const auto n = static_cast<std::size_t>(frame.mesh.vertex_count());
  result.label.assign(n, 0);
  result.masked.assign(n, 0);
  if (frame.mesh.triangle_count() == 0) {
    result.curvature.setZero(static_cast<Eigen::Index>(n));
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

  std::vector<char> set = hysteresis(c, thresholds_.high / cell_, thresholds_.low / cell_);
  Morphology morphology(c.graph, c.active);
  morphology.dilate(set, options_.close_radius * cell_);
  morphology.erode(set, options_.close_radius * cell_);
  morphology.erode(set, options_.open_radius * cell_);
  morphology.dilate(set, options_.open_radius * cell_);
  morphology.fill_holes(set, c.shape.area, options_.largest_hole * cell_ * cell_);

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
  result.curvature =
      Eigen::Map<const Eigen::VectorXd>(c.shape.curvature.data(), static_cast<Eigen::Index>(n));
  return result;
}

}  // namespace geoprior::fluid
