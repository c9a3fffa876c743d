#include "solvers/paper/sheet/invariants.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/geometry/planar.h"
#include "solvers/paper/meshing/ruling_mesh.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Areas, and distances over the pattern's width, that count as nothing.
constexpr double kAreaTolerance = 1e-9;
constexpr double kSame = 1e-9;

bool share_end(const Ruling& r, const Ruling& s, double same) {
  for (const Vector2d& p : {r.a, r.b}) {
    if ((p - s.a).norm() <= same || (p - s.b).norm() <= same) return true;
  }
  return false;
}

void check_crossings(const PaperStructure& structure, double same,
                     std::vector<std::string>& broken) {
  for (std::size_t i = 0; i < structure.rulings.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Ruling& r = structure.rulings[i];
      const Ruling& s = structure.rulings[j];
      if (share_end(r, s, same) || !segments_meet(r.a, r.b, s.a, s.b)) continue;
      broken.push_back("rulings " + std::to_string(j) + " and " + std::to_string(i) + " cross");
    }
  }
}

void check_ends(const PaperStructure& structure, const Pattern& pattern, double same,
                std::vector<std::string>& broken) {
  for (std::size_t i = 0; i < structure.rulings.size(); ++i) {
    const Ruling& r = structure.rulings[i];
    for (const auto& [end, singular] :
         {std::pair(r.a, r.singular_a), std::pair(r.b, r.singular_b)}) {
      const bool anchored =
          singular ? (end - structure.singular_points[*singular].position).norm() <= same
                   : nearest_on_border(pattern, end).distance <= same;
      if (!anchored) {
        broken.push_back("ruling " + std::to_string(i) + " ends neither on the border nor at its " +
                         "singular point");
      }
    }
  }
}

void check_cover(const Pattern& pattern, const ShellMesh& mesh, std::vector<std::string>& broken) {
  double sum = 0;
  const double whole = signed_area(pattern);
  for (int f = 0; f < mesh.triangle_count(); ++f) {
    const Vector2d a = mesh.pattern.row(mesh.triangles(f, 0));
    const Vector2d b = mesh.pattern.row(mesh.triangles(f, 1));
    const Vector2d c = mesh.pattern.row(mesh.triangles(f, 2));
    const double area = cross(b - a, c - a) / 2;
    if (!(area > kAreaTolerance * whole)) {
      broken.push_back("triangle " + std::to_string(f) + " has no area or is turned over");
    }
    sum += area;
  }
  if (!(std::abs(sum - whole) <= kAreaTolerance * whole)) {
    broken.push_back("triangles cover " + std::to_string(sum) + " of " + std::to_string(whole) +
                     " m^2");
  }
}

void check_in_mesh(const PaperStructure& structure, const ShellMesh& mesh, double same,
                   std::vector<std::string>& broken) {
  for (std::size_t i = 0; i < structure.rulings.size(); ++i) {
    const Ruling& r = structure.rulings[i];
    if (edge_path(mesh, r.a, r.b, same).empty()) {
      broken.push_back("ruling " + std::to_string(i) + " is no path of mesh edges");
    }
  }
  for (std::size_t s = 0; s < structure.singular_points.size(); ++s) {
    const Eigen::RowVector2d p = structure.singular_points[s].position;
    if (!((mesh.pattern.rowwise() - p).rowwise().norm().minCoeff() <= same)) {
      broken.push_back("singular point " + std::to_string(s) + " is no vertex");
    }
  }
}

}  // namespace

std::vector<std::string> broken_invariants(const PaperStructure& structure, const Pattern& pattern,
                                           const ShellMesh& mesh) {
  std::vector<std::string> broken;
  const double same = 2 * kSame * width(pattern);
  check_crossings(structure, same, broken);
  check_ends(structure, pattern, same, broken);
  check_cover(pattern, mesh, broken);
  check_in_mesh(structure, mesh, same, broken);
  return broken;
}

}  // namespace geoprior::paper
