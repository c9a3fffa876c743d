#include "experiments/skinning/scene/hole_caps.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "testbed/runner/number_text.h"

namespace geoprior::skinning {
namespace {

constexpr std::size_t kShown = 6;  // holes that a line describes

/// Name of the joint that holds most of the vertices.
std::string holder_of(const std::vector<int>& loop, const RiggedMesh& rig) {
  Eigen::VectorXd held = Eigen::VectorXd::Zero(rig.skeleton.size());
  for (const int v : loop)
    for (SkinWeights::InnerIterator it(rig.weights, v); it; ++it) held[it.col()] += it.value();
  Eigen::Index most = 0;
  held.maxCoeff(&most);
  return rig.skeleton.joints[most].name;
}

/// "18 edges at joint 'neck', 0.21 m across, about (0, 1.5, 0.02)".
std::string place_of(const std::vector<int>& loop, const RiggedMesh& rig) {
  Eigen::AlignedBox3d box;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int v : loop) {
    const Eigen::Vector3d position = rig.mesh.V.row(v);
    box.extend(position);
    mean += position / static_cast<double>(loop.size());
  }
  const double size = box.diagonal().norm();
  const auto number = [&](double x) { return rounded_text(std::abs(x) < 1e-6 * size ? 0 : x); };
  return std::to_string(loop.size()) + " edges at joint '" + holder_of(loop, rig) + "', " +
         number(size) + " m across, about (" + number(mean.x()) + ", " + number(mean.y()) + ", " +
         number(mean.z()) + ")";
}

/// ": " and the first few, of those with most edges first.
std::string list_of(std::vector<std::pair<std::size_t, std::string>> holes) {
  std::stable_sort(holes.begin(), holes.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (std::size_t i = 0; i < std::min(holes.size(), kShown); ++i)
    text += (i == 0 ? ": " : "; ") + holes[i].second;
  if (holes.size() > kShown) text += "; and " + std::to_string(holes.size() - kShown) + " more";
  return text;
}

std::string counted(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string capped_note(const HoleCaps& caps, const RiggedMesh& rig) {
  std::vector<std::pair<std::size_t, std::string>> holes;
  std::size_t edges = 0;
  for (const std::vector<int>& loop : caps.capped) {
    edges += loop.size();
    holes.emplace_back(loop.size(), place_of(loop, rig));
  }
  return counted(holes.size(), "hole", "holes") + " of the skin with " +
         counted(edges, "boundary edge", "boundary edges") + (holes.size() == 1 ? " is" : " are") +
         " closed by caps, for weights, methods and metrics, not in what is written back (holes = "
         "\"keep\" leaves them open)" +
         list_of(holes);
}

std::string open_note(const HoleCaps& caps, const RiggedMesh& rig) {
  std::vector<std::pair<std::size_t, std::string>> holes;
  std::size_t edges = caps.stray_edges;
  for (const HoleCaps::OpenLoop& open : caps.open) {
    edges += open.loop.size();
    holes.emplace_back(
        open.loop.size(),
        place_of(open.loop, rig) + (open.is_sheet ? " (the outline of a sheet)"
                                                  : " (no cap on its vertices has an area)"));
  }
  const std::string stray = caps.stray_edges == 0 ? std::string()
                                                  : ", " + std::to_string(caps.stray_edges) +
                                                        " of them in no loop (edges of more than "
                                                        "two triangles beside them)";
  return counted(edges, "boundary edge", "boundary edges") + " of the skin in " +
         counted(holes.size(), "loop", "loops") + (edges == 1 ? " stays" : " stay") + " open" +
         stray + ": what needs an inside is refused or absent (mesh = \"…\" reads one mesh alone)" +
         list_of(holes);
}

}  // namespace

HoleCaps put_caps_on(TriMesh& mesh) {
  HoleCaps caps = cap_holes(mesh);
  const Eigen::Index first = mesh.F.rows();
  mesh.F.conservativeResize(first + std::ssize(caps.triangles), 3);
  for (std::size_t t = 0; t < caps.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      mesh.F(first + static_cast<Eigen::Index>(t), k) = caps.triangles[t][k];
  }
  return caps;
}

void take_caps_off(TriMesh& mesh, int count) {
  mesh.F.conservativeResize(mesh.F.rows() - count, 3);
}

std::vector<std::string> hole_notes(const HoleCaps& caps, const RiggedMesh& rig) {
  std::vector<std::string> notes;
  if (!caps.has_inside && caps.capped.empty()) return notes;
  if (!caps.capped.empty()) notes.push_back(capped_note(caps, rig));
  if (!caps.open.empty() || caps.stray_edges > 0) notes.push_back(open_note(caps, rig));
  return notes;
}

}  // namespace geoprior::skinning
