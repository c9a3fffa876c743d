#include "models/sound/resonators/remeshing.h"

#include <algorithm>
#include <array>
#include <map>

namespace geoprior::sound {
namespace {

/// Corners in the pattern, in their order, the lowest first.
using Corners = std::array<std::array<double, 2>, 3>;

Corners corners(const ShellMesh& mesh, int triangle) {
  Corners found{};
  for (int k = 0; k < 3; ++k) {
    const int v = mesh.triangles(triangle, k);
    found[k] = {mesh.pattern(v, 0), mesh.pattern(v, 1)};
  }
  std::rotate(found.begin(), std::min_element(found.begin(), found.end()), found.end());
  return found;
}

/// The triangles on both sides of the edges that a triangle's shape operator is read from.
std::vector<int> read_from(const CurvatureFit& fit, int triangle) {
  std::vector<int> found;
  for (const CurvatureFit::Term& term : fit.terms[triangle]) {
    const CurvatureFit::Hinge& hinge = fit.hinges[term.hinge];
    found.insert(found.end(), {hinge.left, hinge.right});
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

}  // namespace

std::vector<int> kept_triangles(const FittedMesh& before, const FittedMesh& now) {
  std::map<Corners, int> lies;
  for (int t = 0; t < before.mesh.triangle_count(); ++t) lies[corners(before.mesh, t)] = t;
  std::vector<int> same(now.mesh.triangle_count(), -1);
  for (int t = 0; t < now.mesh.triangle_count(); ++t) {
    const auto found = lies.find(corners(now.mesh, t));
    if (found != lies.end()) same[t] = found->second;
  }
  std::vector<int> kept(same.size(), -1);
  for (int t = 0; t < now.mesh.triangle_count(); ++t) {
    if (same[t] < 0) continue;
    std::vector<int> around = read_from(now.fit, t);
    for (int& other : around) other = same[other];
    std::sort(around.begin(), around.end());
    if (around == read_from(before.fit, same[t])) kept[t] = same[t];
  }
  return kept;
}

}  // namespace geoprior::sound
