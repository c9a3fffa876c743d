#include "solvers/fluid/paste/refinement.h"

#include <algorithm>

namespace geoprior::fluid {
namespace {

constexpr std::uint64_t kFree = ~std::uint64_t{0};

std::uint64_t edge_key(int a, int b) {
  const std::uint64_t low = std::min(a, b);
  return (low << 32) | static_cast<std::uint64_t>(std::max(a, b));
}

/// Collects the parts of split triangles.
class Parts {
 public:
  Parts(WorkMesh& mesh, std::vector<int>& changed) : mesh_(mesh), changed_(changed) {}

  void replace(std::size_t t) { next_ = t; }
  void add(int a, int b, int c) {
    if (next_ < mesh_.triangles.size()) {
      mesh_.triangles[next_] = {a, b, c};
      changed_.push_back(static_cast<int>(next_));
      next_ = mesh_.triangles.size();
      return;
    }
    changed_.push_back(static_cast<int>(mesh_.triangles.size()));
    mesh_.triangles.push_back({a, b, c});
    next_ = mesh_.triangles.size();
  }
  /// Corners a, b, c, d of a quadrilateral, counter-clockwise.
  void add_quadrilateral(int a, int b, int c, int d) {
    const double ac = (at(a) - at(c)).squaredNorm(), bd = (at(b) - at(d)).squaredNorm();
    constexpr double kTie = 1e-9;  // round-off of a rigid motion must not decide
    const bool tie = std::abs(ac - bd) <= kTie * std::max(ac, bd);
    if (tie ? std::min(a, c) < std::min(b, d) : ac < bd) {
      add(a, b, c);
      add(a, c, d);
    } else {
      add(a, b, d);
      add(b, c, d);
    }
  }

 private:
  [[nodiscard]] const Eigen::Vector3d& at(int v) const { return mesh_.x[v]; }
  WorkMesh& mesh_;
  std::vector<int>& changed_;
  std::size_t next_ = 0;
};

/// @param m  middles of the edges after each corner, or -1
void split(const std::array<int, 3>& f, const std::array<int, 3>& m, Parts& parts) {
  const auto marked =
      static_cast<int>(std::count_if(m.begin(), m.end(), [](int v) { return v >= 0; }));
  if (marked == 3) {
    for (std::size_t k = 0; k < 3; ++k) parts.add(f[k], m[k], m[(k + 2) % 3]);
    parts.add(m[0], m[1], m[2]);
    return;
  }
  std::size_t k = 0;  // the marked edge; of two, the first before the corner they share
  while (m[k] < 0 || (marked == 2 && m[(k + 1) % 3] < 0)) ++k;
  const int a = f[k], b = f[(k + 1) % 3], c = f[(k + 2) % 3];
  if (marked == 1) {
    parts.add(a, m[k], c);
    parts.add(m[k], b, c);
    return;
  }
  parts.add(m[k], b, m[(k + 1) % 3]);
  parts.add_quadrilateral(a, m[k], m[(k + 1) % 3], c);
}

}  // namespace

WorkMesh work_mesh(const SurfaceFrame& frame) {
  WorkMesh mesh;
  const std::size_t n = frame.mesh.V.rows();
  mesh.x.resize(n);
  for (std::size_t v = 0; v < n; ++v) mesh.x[v] = frame.mesh.V.row(v);
  if (frame.velocity.rows() == frame.mesh.V.rows()) {
    mesh.velocity.resize(n);
    for (std::size_t v = 0; v < n; ++v) {
      mesh.velocity[v] = frame.velocity.row(v);
    }
  }
  mesh.triangles.resize(frame.mesh.F.rows());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.triangles[t] = {frame.mesh.F(t, 0), frame.mesh.F(t, 1), frame.mesh.F(t, 2)};
  }
  return mesh;
}

SurfaceFrame surface_frame(const WorkMesh& mesh, double time) {
  SurfaceFrame frame;
  frame.time = time;
  frame.mesh.V.resize(mesh.x.size(), 3);
  for (std::size_t v = 0; v < mesh.x.size(); ++v) {
    frame.mesh.V.row(v) = mesh.x[v].transpose();
  }
  if (!mesh.velocity.empty()) {
    frame.velocity.resize(frame.mesh.V.rows(), 3);
    for (std::size_t v = 0; v < mesh.x.size(); ++v) {
      frame.velocity.row(v) = mesh.velocity[v].transpose();
    }
  }
  frame.mesh.F.resize(mesh.triangles.size(), 3);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      frame.mesh.F(t, k) = mesh.triangles[t][k];
    }
  }
  return frame;
}

std::size_t EdgeSplitter::slot(std::uint64_t key) const {
  const std::size_t mask = keys_.size() - 1;
  std::uint64_t h = key * 0x9E3779B97F4A7C15ULL;
  std::size_t i = static_cast<std::size_t>(h ^ (h >> 32)) & mask;
  while (keys_[i] != kFree && keys_[i] != key) i = (i + 1) & mask;
  return i;
}

void EdgeSplitter::grow() {
  keys_.assign(std::max<std::size_t>(1024, 2 * keys_.size()), kFree);
  values_.assign(keys_.size(), -1);
  for (int e = 0; e < std::ssize(parents_); ++e) {
    const std::size_t i = slot(edge_key(parents_[e][0], parents_[e][1]));
    keys_[i] = edge_key(parents_[e][0], parents_[e][1]);
    values_[i] = vertex_count_ + e;
  }
}

void EdgeSplitter::mark(int a, int b) {
  if (2 * (parents_.size() + 1) > keys_.size()) grow();
  const std::uint64_t key = edge_key(a, b);
  const std::size_t i = slot(key);
  if (keys_[i] == key) return;
  keys_[i] = key;
  values_[i] = vertex_count_ + static_cast<int>(parents_.size());
  parents_.push_back({std::min(a, b), std::max(a, b)});
}

int EdgeSplitter::middle(int a, int b) const {
  const std::size_t i = slot(edge_key(a, b));
  return keys_[i] == kFree ? -1 : values_[i];
}

std::vector<int> EdgeSplitter::apply(WorkMesh& mesh) const {
  std::vector<int> changed;
  if (empty()) return changed;
  std::vector<char> touched(mesh.x.size(), 0);
  for (const auto& [a, b] : parents_) {
    touched[a] = touched[b] = 1;
    mesh.x.push_back(0.5 * (mesh.x[a] + mesh.x[b]));
    if (!mesh.velocity.empty()) {
      mesh.velocity.push_back(0.5 * (mesh.velocity[a] + mesh.velocity[b]));
    }
  }
  Parts parts(mesh, changed);
  const std::size_t count = mesh.triangles.size();
  for (std::size_t t = 0; t < count; ++t) {
    const std::array<int, 3> f = mesh.triangles[t];
    std::array<char, 3> mark{};
    for (std::size_t k = 0; k < 3; ++k) mark[k] = touched[f[k]];
    if (mark[0] + mark[1] + mark[2] < 2) continue;
    std::array<int, 3> middles{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      middles[k] = mark[k] != 0 && mark[l] != 0 ? middle(f[k], f[l]) : -1;
    }
    if (middles[0] < 0 && middles[1] < 0 && middles[2] < 0) continue;
    parts.replace(t);
    split(f, middles, parts);
  }
  return changed;
}

}  // namespace geoprior::fluid
