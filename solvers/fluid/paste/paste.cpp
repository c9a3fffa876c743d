#include "solvers/fluid/paste/paste.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <tuple>
#include <utility>

#include "solvers/fluid/paste/map_paste_sum.h"
#include "solvers/fluid/paste/mesh_paste.h"

namespace geoprior::fluid {
namespace {

/// Two edits overlap where both maps are at least this opaque.
constexpr double kOverlapAlpha = 0.1;

std::string at_time(double time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g s", time);
  return text;
}

/// What is pasted at this time: a feature where an edit puts it.
struct Present {
  const Insertion* insertion;
  EditedFrame frame;
};

/// An order that does not depend on how insertions were listed: sums come out the same.
bool before(const Present& a, const Present& b) {
  const auto key = [](const Present& p) {
    return std::tie(p.insertion->feature->id, p.insertion->feature->name, p.insertion->edit.name,
                    p.frame.source_time, p.frame.fade);
  };
  if (key(a) != key(b)) return key(a) < key(b);
  const auto &m = a.frame.placement.matrix(), &n = b.frame.placement.matrix();
  return std::lexicographical_compare(m.data(), m.data() + 16, n.data(), n.data() + 16);
}

std::vector<Present> present_at(const std::vector<Insertion>& insertions, double time,
                                const Eigen::Vector3d& up) {
  std::vector<Present> result;
  for (const Insertion& insertion : insertions) {
    const auto frame = edited_frame(*insertion.feature, insertion.edit, time, up);
    if (frame && frame->fade > 0) result.push_back({&insertion, *frame});
  }
  std::sort(result.begin(), result.end(), before);
  return result;
}

std::string who(const Present& present) { return "edit '" + present.insertion->edit.name + "'"; }

/// Half a frame of the feature, on the target's clock.
double half_frame(const Insertion& insertion) {
  const auto interval = edited_interval(*insertion.feature, insertion.edit);
  const int frames = insertion.feature->frame_count();
  return frames > 1 ? 0.5 * (interval[1] - interval[0]) / (frames - 1) : 0;
}

/// The feature shortly before and after: one of them is now at the ends of its life.
std::vector<PlacedMap::Instant> instants_about(const Present& present, double time,
                                               const Eigen::Vector3d& up) {
  const Feature& feature = *present.insertion->feature;
  const double half = half_frame(*present.insertion);
  std::vector<PlacedMap::Instant> result;
  if (half <= 0) return result;
  for (const double shift : {-half, half}) {
    const auto frame = edited_frame(feature, present.insertion->edit, time + shift, up);
    const EditedFrame& used = frame ? *frame : present.frame;
    result.push_back({frame ? shift : 0.0, used, DisplacementSampler(feature, used.source_time)});
  }
  if (result[0].time == result[1].time) result.clear();
  return result;
}

/// Vertices' sums over the maps, and who moved them most.
struct Sums {
  explicit Sums(std::size_t n)
      : shift(n, Eigen::Vector3d::Zero()), largest(n, 0), feature(n, 0), edit(n, -1) {}
  std::vector<Eigen::Vector3d> shift, rate;
  std::vector<double> largest;
  std::vector<int> feature;
  std::vector<int> edit;  ///< number of the last map that is opaque there
};

void add(const PlacedMap& placed, const Displaced& displaced, int number,
         const std::vector<PlacedMap>& all, Sums& sums, std::set<std::pair<int, int>>& overlaps) {
  const std::string& name = placed.insertion->edit.name;
  for (std::size_t i = 0; i < displaced.shift.size(); ++i) {
    const int v = placed.places.vertex[i];
    sums.shift[v] += displaced.shift[i];
    const double length = displaced.shift[i].squaredNorm();
    if (length > sums.largest[v]) {
      sums.largest[v] = length;
      sums.feature[v] = placed.insertion->feature->id;
    }
    if (displaced.alpha[i] < kOverlapAlpha) continue;
    const int other = sums.edit[v];
    if (other >= 0 && all[other].insertion->edit.name != name) {
      overlaps.emplace(other, number);
    }
    sums.edit[v] = number;
  }
}

/// Places all maps on the target, refining it.
std::vector<PlacedMap> place_maps(const std::vector<Present>& present, double time,
                                  const Eigen::Vector3d& up, const PasteOptions& options,
                                  WorkMesh& mesh, PasteReport& report) {
  std::vector<PlacedMap> placed;
  for (const Present& p : present) {
    const Feature& feature = *p.insertion->feature;
    const Eigen::Vector3d scale = p.frame.placement.linear().colwise().norm().transpose();
    const double reach = 0.5 * feature.extent * scale.head<2>().maxCoeff();
    const auto anchor = find_anchor(mesh, p.frame.placement.translation(), up, reach);
    if (!anchor) {
      report.warnings.push_back(who(p) + " lies off the target at " + at_time(time));
      continue;
    }
    PlacedMap next{p.insertion, p.frame, DisplacementSampler(feature, p.frame.source_time), {}, {}};
    next.places = locate(mesh, p.frame, next.map, *anchor, options);
    std::vector<MapCoordinates*> others;
    for (PlacedMap& other : placed) others.push_back(&other.places);
    refine_under_map(mesh, next.map, options, who(p), next.places, others);
    if (!mesh.velocity.empty()) next.instants = instants_about(p, time, up);
    placed.push_back(std::move(next));
  }
  return placed;
}

void warn_of_overlaps(const std::set<std::pair<int, int>>& overlaps,
                      const std::vector<PlacedMap>& placed, double time, PasteReport& report) {
  std::set<std::pair<std::string, std::string>> names;
  for (const auto& [a, b] : overlaps) {
    names.insert(std::minmax(placed[a].insertion->edit.name, placed[b].insertion->edit.name));
  }
  for (const auto& [a, b] : names) {
    report.warnings.push_back("edits '" + a + "' and '" + b + "' overlap at " + at_time(time) +
                              ": their displacements add up");
  }
}

void displace(const std::vector<PlacedMap>& placed, double time, WorkMesh& mesh,
              PasteReport& report) {
  Sums sums(mesh.x.size());
  std::vector<Eigen::Vector3d> rate(mesh.velocity.size(), Eigen::Vector3d::Zero());
  std::set<std::pair<int, int>> overlaps;
  for (int k = 0; k < std::ssize(placed); ++k) {
    Displaced displaced = displacements(placed[k]);
    if (placed[k].insertion->edit.volume_lock) lock_volume(mesh, placed[k], displaced);
    add(placed[k], displaced, k, placed, sums, overlaps);
    const std::vector<Eigen::Vector3d> rates = displacement_rates(mesh, placed[k]);
    for (std::size_t i = 0; i < rates.size(); ++i) {
      rate[placed[k].places.vertex[i]] += rates[i];
    }
    report.min_jacobian =
        std::min(report.min_jacobian, placed[k].map.min_jacobian(placed[k].frame.fade));
  }
  warn_of_overlaps(overlaps, placed, time, report);
  report.added_volume = swept_volume(mesh, sums.shift);
  for (std::size_t v = 0; v < mesh.x.size(); ++v) {
    mesh.x[v] += sums.shift[v];
    if (!rate.empty()) mesh.velocity[v] += rate[v];
    report.displaced_vertices += sums.largest[v] > 0 ? 1 : 0;
  }
  report.vertex_feature = std::move(sums.feature);
}

/// Velocity of an isolated feature's centre in the target.
Eigen::Vector3d centre_velocity(const Present& present, double time, const Eigen::Vector3d& up) {
  const double half = half_frame(*present.insertion);
  double t[2] = {0, 0};
  Eigen::Vector3d c[2] = {present.frame.placement.translation(),
                          present.frame.placement.translation()};
  for (int k = 0; k < 2; ++k) {
    const double shift = k == 0 ? -half : half;
    const auto frame =
        edited_frame(*present.insertion->feature, present.insertion->edit, time + shift, up);
    if (!frame) continue;
    t[k] = shift;
    c[k] = frame->placement.translation();
  }
  return t[1] > t[0] ? Eigen::Vector3d((c[1] - c[0]) / (t[1] - t[0])) : Eigen::Vector3d::Zero();
}

void add_isolated(const Present& present, double time, const Eigen::Vector3d& up,
                  SurfaceFrame& result, PasteReport& report) {
  const Feature& feature = *present.insertion->feature;
  const TriMesh mesh = isolated_at(feature, present.frame);
  const Eigen::Vector3d velocity = centre_velocity(present, time, up);
  std::vector<int> of_target, of_mesh;
  if (present.insertion->edit.unite && unite_mesh(mesh, velocity, result, of_target, of_mesh)) {
    std::vector<int> ids;
    for (std::size_t v = 0; v < of_target.size(); ++v) {
      ids.push_back(of_target[v] >= 0 ? report.vertex_feature[of_target[v]] : feature.id);
    }
    report.vertex_feature = std::move(ids);
    return;
  }
  if (present.insertion->edit.unite) {
    report.warnings.push_back(who(present) + " cannot be united at " + at_time(time) +
                              ": target or feature is open or cuts itself; inserted instead");
  }
  insert_mesh(mesh, velocity, result);
  report.vertex_feature.resize(result.mesh.V.rows(), feature.id);
}

}  // namespace

SurfaceFrame paste(const SurfaceFrame& target, const std::vector<Insertion>& insertions,
                   double time, const Eigen::Vector3d& up, const PasteOptions& options,
                   PasteReport* report) {
  PasteReport own;
  for (const std::string& note : target.notes) own.warnings.push_back("target: " + note);
  std::vector<Present> present;
  if (!options.leave_out) present = present_at(insertions, time, up);
  std::vector<Present> maps, meshes;
  for (const Present& p : present) {
    (p.insertion->feature->kind == RegionKind::isolated ? meshes : maps).push_back(p);
  }
  SurfaceFrame result;
  if (maps.empty()) {
    result = target;
    own.vertex_feature.assign(target.mesh.V.rows(), 0);
  } else {
    WorkMesh mesh = work_mesh(target);
    const std::vector<PlacedMap> placed = place_maps(maps, time, up, options, mesh, own);
    displace(placed, time, mesh, own);
    own.features = static_cast<int>(placed.size());
    result = surface_frame(mesh, target.time);
  }
  result.time = time;
  result.notes.clear();
  for (const Present& p : meshes) add_isolated(p, time, up, result, own);
  own.features += static_cast<int>(meshes.size());
  own.added_triangles = result.mesh.triangle_count() - target.mesh.triangle_count();
  if (report != nullptr) *report = std::move(own);
  return result;
}

}  // namespace geoprior::fluid
