#include "solvers/sketch/pattern/cut_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <queue>
#include <span>
#include <utility>

#include "core/geometry/topology.h"
#include "core/geometry/triangle_tree.h"
#include "models/sketch/surface/shortest_cut.h"
#include "solvers/sketch/pattern/conformal_scale.h"
#include "solvers/sketch/pattern/level_lines.h"
#include "solvers/sketch/pattern/slope_parts.h"

namespace geoprior::sketch {
namespace {

constexpr std::array<int, 6> kStars{1, 2, 3, 4, 6, 8};
constexpr std::array<int, 2> kDarts{1, 2};  ///< from places that are not the highest
constexpr int kFurtherPlaces = 3;
constexpr double kLeastFurther = 0.25;  ///< of the height of the first
constexpr double kPlacesApart = 6;      ///< edges
constexpr double kCrease = 0.3;  ///< how much cheaper closed cuts are along concentrated curvature
constexpr double kMostDensity = 20;    ///< of |defect|, over its mean
constexpr double kPlateau = 0.98;      ///< of an extreme: what is as high counts as the same place
constexpr double kLeastExtreme = 0.2;  ///< of the largest scale, below which a place is none

constexpr double kFairCut = 4;       ///< scale at which cuts are fair (edges)
constexpr double kShortestLine = 8;  ///< of a cut around a part (edges)
constexpr int kMostSlopeParts = 5;   ///< of constant slope

/// Bands between two values of the scale, over its extreme.
constexpr std::array<std::array<double, 2>, 3> kBands{{{0.05, 0.4}, {0.4, 0.75}, {0.75, 0.99}}};

/// Bands of distance from the border: so many where most curvature lies, so wide (edges).
constexpr int kDistanceBands = 5;
constexpr double kBandHalfWidth = 2.5;

double mean_edge(const TriMesh& mesh) { return mean_edge_length(mesh.V, EdgeConnectivity(mesh.F)); }

/// Length of the shortest path of edges from each vertex to a border (m).
Eigen::VectorXd border_distance(const TriMesh& mesh, const std::vector<int>& border) {
  using Reached = std::pair<double, int>;
  Eigen::VectorXd distance =
      Eigen::VectorXd::Constant(mesh.vertex_count(), std::numeric_limits<double>::infinity());
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> queue;
  for (const int v : border) {
    distance(v) = 0;
    queue.emplace(0.0, v);
  }
  const VertexGraph rings = one_rings(mesh.F, mesh.vertex_count());
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance(v)) continue;
    for (const int w : rings.of(v)) {
      const double sum = d + (mesh.V.row(v) - mesh.V.row(w)).norm();
      if (sum >= distance(w)) continue;
      distance(w) = sum;
      queue.emplace(sum, w);
    }
  }
  return distance;
}

/// Distances about which most |defect| lies: local maxima of its histogram over bins of a width,
/// the highest first.
std::vector<double> curved_distances(const Eigen::VectorXd& distance, const Eigen::VectorXd& defect,
                                     double width) {
  const auto bin_of = [&](double d) { return static_cast<std::size_t>(d / width); };
  std::vector<double> sum(bin_of(distance.maxCoeff()) + 1, 0.0);
  for (Eigen::Index v = 0; v < distance.size(); ++v) sum[bin_of(distance(v))] += defect(v);
  const auto at = [&](std::size_t i) { return i < sum.size() ? sum[i] : 0.0; };
  std::vector<double> mass(sum.size());
  for (std::size_t i = 0; i < sum.size(); ++i)
    mass[i] = (i > 0 ? sum[i - 1] : 0) + 2 * sum[i] + at(i + 1);
  std::vector<std::size_t> peaks;
  for (std::size_t i = 2; i + 1 < mass.size(); ++i) {
    if (mass[i] > mass[i - 1] && mass[i] >= mass[i + 1]) peaks.push_back(i);
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [&](std::size_t a, std::size_t b) { return mass[a] > mass[b]; });
  if (peaks.size() > kDistanceBands) peaks.resize(kDistanceBands);
  std::vector<double> distances;
  for (const std::size_t i : peaks) distances.push_back((static_cast<double>(i) + 0.5) * width);
  return distances;
}

/// Price of a metre in each triangle, from the defects within two rings of its corners.
Eigen::VectorXd crease_price(const TriMesh& mesh) {
  Eigen::VectorXd defect = angle_defects(mesh).cwiseAbs();
  Eigen::VectorXd area = Eigen::VectorXd::Zero(mesh.vertex_count());
  const Eigen::VectorXd areas = triangle_areas(mesh.V, mesh.F);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) area(mesh.F(t, k)) += areas(t) / 3;
  }
  const double mean = defect.sum() / area.sum();
  if (!(mean > 0)) return Eigen::VectorXd::Ones(mesh.triangle_count());
  const VertexGraph rings = one_rings(mesh.F, mesh.vertex_count());
  for (int pass = 0; pass < 2; ++pass) {
    const Eigen::VectorXd d = defect, a = area;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      for (const int w : rings.of(v)) {
        defect(v) += d(w);
        area(v) += a(w);
      }
    }
  }
  Eigen::VectorXd price(mesh.triangle_count());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    double density = 0;
    for (int k = 0; k < 3; ++k)
      density += defect(mesh.F(t, k)) / (3 * mean * std::max(area(mesh.F(t, k)), 1e-300));
    price(t) = 1 / (1 + kCrease * std::min(density, kMostDensity));
  }
  return price;
}

class CandidateFinder {
 public:
  CandidateFinder(const CutPiece& piece, const CutCandidateOptions& options)
      : piece_(piece),
        mesh_(piece.mesh),
        options_(options),
        edge_(mean_edge(piece.mesh)),
        scale_(conformal_scale(piece.mesh)),
        price_(crease_price(piece.mesh)),
        paths_(piece.mesh, Eigen::VectorXd::Ones(piece.mesh.triangle_count())) {}

  std::vector<std::vector<SurfacePath>> find() {
    const double largest = scale_.cwiseAbs().maxCoeff();
    for (const double sign : {1.0, -1.0}) {
      const Eigen::VectorXd height = sign * scale_;
      if (!(height.maxCoeff() > kLeastExtreme * largest)) continue;
      const int first = place_of(height);
      add_stars(height, first, kStars);
      for (const int place : further_places(height, first)) add_stars(height, place, kDarts);
      const double top = height.maxCoeff();
      for (const auto& band : kBands) add_loops(height, band[0] * top, band[1] * top);
    }
    add_parallel_loops();
    add_parts();
    add_planes();
    return std::move(found_);
  }

 private:
  [[nodiscard]] int nearest_vertex(const Eigen::RowVector3d& x,
                                   const std::vector<int>& among) const;
  [[nodiscard]] int place_of(const Eigen::VectorXd& height) const;
  [[nodiscard]] std::vector<int> further_places(const Eigen::VectorXd& height, int first) const;
  void add_stars(const Eigen::VectorXd& height, int from, std::span<const int> counts);
  void add_loops(const Eigen::VectorXd& value, double low, double high);
  void add_parallel_loops();
  void add_parts();
  void add_planes();
  [[nodiscard]] SurfacePath shortest_loop(const CutPiece& ring, const Eigen::VectorXd& price) const;
  [[nodiscard]] int border_start(int from, bool on_plane) const;
  [[nodiscard]] std::vector<int> dividing(int start, int count) const;
  [[nodiscard]] SurfacePath to_vertex(int from, int to) const;
  [[nodiscard]] std::vector<SurfacePath> star(int from, int start, int count) const;
  void add(std::vector<SurfacePath> paths);
  void add_level(const Eigen::VectorXd& value);

  const CutPiece& piece_;
  const TriMesh& mesh_;
  CutCandidateOptions options_;
  double edge_;  ///< mean length (m)
  Eigen::VectorXd scale_, price_;
  SurfacePaths paths_;
  std::vector<std::vector<SurfacePath>> found_;
};

int CandidateFinder::nearest_vertex(const Eigen::RowVector3d& x,
                                    const std::vector<int>& among) const {
  return *std::min_element(among.begin(), among.end(), [&](int a, int b) {
    return (mesh_.V.row(a) - x).squaredNorm() < (mesh_.V.row(b) - x).squaredNorm();
  });
}

/// The vertex in the middle of where the scale is highest; on the mirror plane when it is near.
int CandidateFinder::place_of(const Eigen::VectorXd& height) const {
  std::vector<int> plateau;
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
  for (int v = 0; v < mesh_.vertex_count(); ++v) {
    if (height(v) < kPlateau * height.maxCoeff()) continue;
    plateau.push_back(v);
    centre += mesh_.V.row(v);
  }
  centre /= static_cast<double>(plateau.size());
  if (options_.mirror && std::abs(centre[options_.mirror->axis] - options_.mirror->at) < 2 * edge_)
    centre[options_.mirror->axis] = options_.mirror->at;
  return nearest_vertex(centre, plateau);
}

SurfacePath CandidateFinder::to_vertex(int from, int to) const {
  std::vector<char> targets(mesh_.vertex_count(), 0);
  targets[to] = 1;
  return paths_.shortest(from, targets);
}

/// Where on the longest border a star begins: nearest to its place, or nearest to that of the
/// points on the mirror plane that lies at the back.
int CandidateFinder::border_start(int from, bool on_plane) const {
  std::vector<char> targets(mesh_.vertex_count(), 0);
  if (!on_plane) {
    for (const std::vector<int>& border : piece_.borders) {
      for (const int v : border) targets[v] = 1;
    }
    const SurfacePath path = paths_.shortest(from, targets);
    return path.empty() ? -1 : path.back().edge[0];
  }
  const auto& [axis, at] = *options_.mirror;
  int best = -1;
  for (const int v : piece_.borders.front()) {
    if (std::abs(mesh_.V(v, axis) - at) > 0.75 * edge_) continue;
    if (best < 0 || mesh_.V(v, 2) < mesh_.V(best, 2)) best = v;
  }
  return best;
}

/// Vertices that divide the border of `start` into `count` equal parts.
std::vector<int> CandidateFinder::dividing(int start, int count) const {
  for (const std::vector<int>& border : piece_.borders) {
    const auto first = std::find(border.begin(), border.end(), start);
    if (first == border.end()) continue;
    std::vector<double> along{0};
    std::vector<int> vertices;
    for (std::size_t i = 0; i < border.size(); ++i) {
      const auto at = (first - border.begin()) + i;
      vertices.push_back(border[at % border.size()]);
      along.push_back(
          along.back() +
          (mesh_.V.row(vertices.back()) - mesh_.V.row(border[(at + 1) % border.size()])).norm());
    }
    std::vector<int> result;
    for (int i = 0; i < count; ++i) {
      const double want = along.back() * i / count;
      std::size_t k = 0;
      while (k + 1 < vertices.size() && std::abs(along[k + 1] - want) <= std::abs(along[k] - want))
        ++k;
      result.push_back(vertices[k]);
    }
    return result;
  }
  return {};
}

std::vector<SurfacePath> CandidateFinder::star(int from, int start, int count) const {
  std::vector<SurfacePath> paths;
  for (const int to : dividing(start, count)) {
    SurfacePath path = to_vertex(from, to);
    if (path.empty()) return {};
    paths.push_back(std::move(path));
  }
  return paths;
}

/// A cut that parts the piece in two is made fair as well; what follows a sharp edge is better as
/// it was found.
void CandidateFinder::add(std::vector<SurfacePath> paths) {
  if (paths.empty()) return;
  std::vector<SurfacePath> fair;
  if (options_.fair) fair = faired_cut(mesh_, paths, kFairCut * edge_);
  if (!fair.empty()) found_.push_back(std::move(fair));
  found_.push_back(std::move(paths));
}

/// Around every part of constant slope, of several divisions: all its borders together, and the
/// longest alone.
void CandidateFinder::add_parts() {
  for (const std::vector<int>& division : slope_parts(mesh_, kMostSlopeParts)) {
    const int parts = 1 + *std::max_element(division.begin(), division.end());
    for (int p = 0; p < (parts == 2 ? 1 : parts); ++p) {
      Eigen::VectorXd value = Eigen::VectorXd::Zero(mesh_.vertex_count()), count = value;
      for (int t = 0; t < mesh_.triangle_count(); ++t) {
        for (int k = 0; k < 3; ++k) {
          value(mesh_.F(t, k)) += division[t] == p ? 1 : -1;
          count(mesh_.F(t, k)) += 1;
        }
      }
      const Eigen::VectorXd mean = value.cwiseQuotient(count.cwiseMax(1.0));
      if (options_.fair) add_level(smoothed_over(mesh_, mean, kFairCut * edge_));
      add_level(mean);
    }
  }
}

/// Along the planes through the middle of the piece's box.
void CandidateFinder::add_planes() {
  const Eigen::RowVector3d middle =
      (mesh_.V.colwise().minCoeff() + mesh_.V.colwise().maxCoeff()) / 2;
  for (int axis = 0; axis < 3; ++axis) {
    const bool mirror = options_.mirror && options_.mirror->axis == axis;
    const double at = mirror ? options_.mirror->at : middle[axis];
    add_level(mesh_.V.col(axis).array() - at);
  }
}

void CandidateFinder::add_level(const Eigen::VectorXd& value) {
  std::vector<SurfacePath> lines = level_lines(mesh_, value, kShortestLine * edge_);
  if (lines.empty()) return;
  if (lines.size() > 1) {
    found_.push_back({*std::max_element(lines.begin(), lines.end(),
                                        [&](const SurfacePath& a, const SurfacePath& b) {
                                          return length(a, mesh_.V) < length(b, mesh_.V);
                                        })});
  }
  found_.push_back(std::move(lines));
}

/// Other local maxima, the highest first, apart from each other and from the first.
std::vector<int> CandidateFinder::further_places(const Eigen::VectorXd& height, int first) const {
  const VertexGraph rings = one_rings(mesh_.F, mesh_.vertex_count());
  std::vector<int> tops;
  for (int v = 0; v < mesh_.vertex_count(); ++v) {
    if (height(v) < kLeastFurther * height(first)) continue;
    bool is_top = true;
    for (const int w : rings.of(v)) is_top = is_top && height(w) <= height(v);
    if (is_top) tops.push_back(v);
  }
  std::stable_sort(tops.begin(), tops.end(), [&](int a, int b) { return height(a) > height(b); });
  std::vector<int> places{first};
  for (const int v : tops) {
    const bool apart = std::all_of(places.begin(), places.end(), [&](int other) {
      return (mesh_.V.row(v) - mesh_.V.row(other)).norm() > kPlacesApart * edge_;
    });
    if (apart && std::ssize(places) <= kFurtherPlaces) places.push_back(v);
  }
  places.erase(places.begin());
  return places;
}

void CandidateFinder::add_stars(const Eigen::VectorXd& height, int from,
                                std::span<const int> counts) {
  const bool on_plane = options_.mirror && std::abs(mesh_.V(from, options_.mirror->axis) -
                                                    options_.mirror->at) < 1.5 * edge_;
  int twin = -1;
  if (options_.mirror && !on_plane) {
    std::vector<int> as_high;
    for (int v = 0; v < mesh_.vertex_count(); ++v) {
      if (height(v) > 0.8 * height(from)) as_high.push_back(v);
    }
    twin = nearest_vertex(options_.mirror->mirrored(mesh_.V.row(from)), as_high);
    if ((mesh_.V.row(twin) - options_.mirror->mirrored(mesh_.V.row(from))).norm() > 4 * edge_)
      twin = -1;
  }
  const int nearest = border_start(from, false);
  int start = on_plane ? border_start(from, true) : nearest;
  if (start < 0) start = nearest;
  if (start < 0) return;
  for (const int count : counts) {
    std::vector<SurfacePath> paths = star(from, start, count);
    if (twin >= 0 && !paths.empty()) {
      const std::vector<SurfacePath> other = star(twin, border_start(twin, false), count);
      paths.insert(paths.end(), other.begin(), other.end());
    }
    add(std::move(paths));
  }
  if (start != nearest) add(star(from, nearest, 1));
}

/// The shortest closed path around a ring. A path across the ring opens it; from one copy of a
/// vertex of that path to the other one leads what goes around once.
SurfacePath CandidateFinder::shortest_loop(const CutPiece& ring,
                                           const Eigen::VectorXd& price) const {
  std::vector<SeamEdge> across;
  for (const Edge& e : shortest_cut(ring.mesh)) across.push_back({e, 0});
  const std::vector<CutPiece> opened = cut_surface(ring.mesh, across);
  if (opened.size() != 1) return {};
  const CutPiece& disc = opened.front();
  Eigen::VectorXd disc_price(disc.mesh.triangle_count());
  for (int t = 0; t < disc.mesh.triangle_count(); ++t)
    disc_price(t) = price(disc.surface_triangle[t]);
  const SurfacePaths paths(disc.mesh, disc_price);
  std::vector<std::vector<int>> copies(ring.mesh.vertex_count());
  for (int v = 0; v < std::ssize(disc.surface_vertex); ++v)
    copies[disc.surface_vertex[v]].push_back(v);
  SurfacePath best;
  double least = std::numeric_limits<double>::infinity();
  for (const std::vector<int>& both : copies) {
    if (both.size() != 2) continue;
    std::vector<char> targets(disc.mesh.vertex_count(), 0);
    targets[both[1]] = 1;
    SurfacePath path = paths.shortest(both[0], targets);
    if (path.empty()) continue;
    const double cost = paths.cost(path);
    if (cost >= least) continue;
    least = cost;
    best = renumbered(path, disc.surface_vertex);
  }
  return best;
}

void CandidateFinder::add_parallel_loops() {
  const Eigen::VectorXd distance = border_distance(mesh_, piece_.borders.front());
  for (const double d : curved_distances(distance, angle_defects(mesh_).cwiseAbs(), 1.5 * edge_)) {
    add_loops(distance, std::max(d - kBandHalfWidth * edge_, 1e-3 * edge_),
              d + kBandHalfWidth * edge_);
  }
}

void CandidateFinder::add_loops(const Eigen::VectorXd& value, double low, double high) {
  std::vector<int> rows;
  for (int t = 0; t < mesh_.triangle_count(); ++t) {
    const double mean = (value(mesh_.F(t, 0)) + value(mesh_.F(t, 1)) + value(mesh_.F(t, 2))) / 3;
    if (mean > low && mean < high) rows.push_back(t);
  }
  if (rows.empty()) return;
  const TriMesh band{mesh_.V, mesh_.F(rows, Eigen::all)};
  for (const CutPiece& ring : cut_surface(band, {})) {
    if (ring.border_count() < 2 || ring.genus() != 0 || ring.mesh.triangle_count() < 24) continue;
    Eigen::VectorXd price(ring.mesh.triangle_count());
    for (int t = 0; t < ring.mesh.triangle_count(); ++t)
      price(t) = price_(rows[ring.surface_triangle[t]]);
    SurfacePath loop = shortest_loop(ring, price);
    if (!loop.empty()) add({renumbered(loop, ring.surface_vertex)});
  }
}

/// The image of a cut on a piece whose vertices and edges are the images of those of its own, to
/// round-off; empty where they are not.
std::vector<SurfacePath> vertex_by_vertex(const TriMesh& from, const TriMesh& to,
                                          const std::vector<SurfacePath>& cut,
                                          const MirrorAxis& mirror) {
  const double near = 1e-6 * mean_edge(from);
  const EdgeConnectivity edges(to.F);
  const auto image = [&](int v) {
    Eigen::Index best = 0;
    const double d =
        (to.V.rowwise() - mirror.mirrored(from.V.row(v))).rowwise().squaredNorm().minCoeff(&best);
    return d < near * near ? static_cast<int>(best) : -1;
  };
  std::vector<SurfacePath> images;
  for (const SurfacePath& path : cut) {
    SurfacePath& mirrored = images.emplace_back();
    for (const EdgePoint& point : path) {
      const int a = image(point.edge[0]), b = image(point.edge[1]);
      if (a < 0 || b < 0 || (a != b && !edges.find(a, b))) return {};
      mirrored.push_back(a <= b ? EdgePoint{{a, b}, point.share}
                                : EdgePoint{{b, a}, 1 - point.share});
    }
  }
  return images;
}

Eigen::MatrixX3d image_of(const SurfacePath& path, const Eigen::MatrixX3d& V,
                          const MirrorAxis& mirror) {
  Eigen::MatrixX3d image(path.size(), 3);
  for (std::size_t i = 0; i < path.size(); ++i) image.row(i) = mirror.mirrored(path[i].position(V));
  return image;
}

/// The path that follows a line at a price that grows with the distance from it, between the
/// vertices nearest to its ends; a closed line is followed in four stretches.
SurfacePath path_near(const TriMesh& mesh, const Eigen::MatrixX3d& line, Eigen::VectorXd price) {
  const double edge = mean_edge(mesh);
  const std::vector<bool> border = boundary_vertices(mesh.F, mesh.vertex_count());
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const Eigen::RowVector3d centre =
        (mesh.V.row(mesh.F(t, 0)) + mesh.V.row(mesh.F(t, 1)) + mesh.V.row(mesh.F(t, 2))) / 3;
    price(t) *= 1 + (line.rowwise() - centre).rowwise().squaredNorm().minCoeff() / (edge * edge);
  }
  const SurfacePaths paths(mesh, price);
  const bool closed = line.row(0) == line.row(line.rows() - 1);
  const int stretches = closed ? 4 : 1;
  // Only the ends of an open line may lie on the border.
  const auto nearest = [&](Eigen::Index i, bool is_end) {
    int best = -1;
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      if (border[v] && (closed || !is_end)) continue;
      if (best < 0 || (mesh.V.row(v) - line.row(i)).squaredNorm() <
                          (mesh.V.row(best) - line.row(i)).squaredNorm())
        best = v;
    }
    return best;
  };
  SurfacePath whole;
  int from = nearest(0, true);
  for (int s = 1; s <= stretches; ++s) {
    const int to = nearest((line.rows() - 1) * s / stretches, s == stretches);
    if (to == from || to < 0) continue;
    std::vector<char> targets(mesh.vertex_count(), 0);
    targets[to] = 1;
    const SurfacePath stretch = paths.shortest(from, targets);
    if (stretch.empty()) return {};
    whole.insert(whole.end(), stretch.begin() + (whole.empty() ? 0 : 1), stretch.end());
    from = to;
  }
  return whole;
}

}  // namespace

std::optional<MirrorAxis> mirror_axis(const TriMesh& surface) {
  constexpr int kSamples = 400;
  const TriangleTree tree(surface);
  const double near = 0.015 * bounding_box_diagonal(surface.V);
  const Eigen::RowVector3d middle =
      (surface.V.colwise().minCoeff() + surface.V.colwise().maxCoeff()) / 2;
  for (const int axis : {0, 2}) {
    const MirrorAxis mirror{axis, middle[axis]};
    const int stride = std::max(1, surface.vertex_count() / kSamples);
    bool same = true;
    for (int v = 0; same && v < surface.vertex_count(); v += stride)
      same = tree.nearest(mirror.mirrored(surface.V.row(v)).transpose()).distance <= near;
    if (same) return mirror;
  }
  return {};
}

std::vector<std::vector<SurfacePath>> cut_candidates(const CutPiece& piece,
                                                     const CutCandidateOptions& options) {
  return CandidateFinder(piece, options).find();
}

std::vector<SurfacePath> mirrored_cut(const CutPiece& piece, const CutPiece& other,
                                      const std::vector<SurfacePath>& cut,
                                      const CutCandidateOptions& options) {
  std::vector<SurfacePath> image = vertex_by_vertex(piece.mesh, other.mesh, cut, *options.mirror);
  if (!image.empty()) return image;
  for (const SurfacePath& path : cut) {
    SurfacePath near = path_near(other.mesh, image_of(path, piece.mesh.V, *options.mirror),
                                 crease_price(other.mesh));
    if (near.empty()) return {};
    image.push_back(std::move(near));
  }
  std::vector<SurfacePath> fair;
  if (options.fair) fair = faired_cut(other.mesh, image, kFairCut * mean_edge(other.mesh));
  return fair.empty() ? image : fair;
}

SurfacePath bridge(const CutPiece& piece, const std::optional<MirrorAxis>& mirror) {
  if (piece.borders.size() < 2) return {};
  const SurfacePaths paths(piece.mesh, Eigen::VectorXd::Ones(piece.mesh.triangle_count()));
  const double near = 0.75 * mean_edge(piece.mesh);
  const auto at_back = [&](const std::vector<int>& border) {
    int best = -1;
    for (const int v : border) {
      if (mirror && std::abs(piece.mesh.V(v, mirror->axis) - mirror->at) > near) continue;
      if (best < 0 || piece.mesh.V(v, 2) < piece.mesh.V(best, 2)) best = v;
    }
    return best;
  };
  const int from = at_back(piece.borders[1]);
  std::vector<char> targets(piece.mesh.vertex_count(), 0);
  for (const int v : piece.borders[0]) targets[v] = 1;
  const int to = mirror ? at_back(piece.borders[0]) : -1;
  if (from >= 0 && to >= 0) {
    std::fill(targets.begin(), targets.end(), static_cast<char>(0));
    targets[to] = 1;
  }
  return paths.shortest(from >= 0 ? from : piece.borders[1].front(), targets);
}

}  // namespace geoprior::sketch
