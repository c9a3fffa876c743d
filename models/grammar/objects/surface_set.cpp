#include "models/grammar/objects/surface_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/triangle_tree.h"
#include "core/mesh.h"
#include "core/random.h"
#include "models/grammar/objects/spacing.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using Item = ItemParameter;

constexpr int kBlobHalvings = 4;
constexpr int kTorusAround = 84, kTorusAcross = 40;
constexpr int kBlobWaves = 5;
/// Random points of the surface a disk of the candidates' distance.
constexpr double kSurfaceTrials = 20;
constexpr int kStudSides = 12;
constexpr double kStudWidth = 0.92;  // over its radius
constexpr double kMostItems = 1e6;

int midpoint_of(int a, int b, std::vector<Vector3d>& V, std::map<std::pair<int, int>, int>& known) {
  const auto [entry, is_new] = known.try_emplace(std::minmax(a, b), static_cast<int>(V.size()));
  if (is_new) V.push_back((V[a] + V[b]).normalized());
  return entry->second;
}

/// An octahedron, halved: vertices on the unit sphere.
TriMesh halved_octahedron(int halvings) {
  std::vector<Vector3d> V{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<std::array<int, 3>> F{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int h = 0; h < halvings; ++h) {
    std::map<std::pair<int, int>, int> known;
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : F) {
      const int ab = midpoint_of(a, b, V, known), bc = midpoint_of(b, c, V, known),
                ca = midpoint_of(c, a, V, known);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    F = std::move(finer);
  }
  TriMesh out;
  out.V.resize(static_cast<int>(V.size()), 3);
  out.F.resize(static_cast<int>(F.size()), 3);
  for (int v = 0; v < out.vertex_count(); ++v) out.V.row(v) = V[v];
  for (int f = 0; f < out.triangle_count(); ++f) out.F.row(f) << F[f][0], F[f][1], F[f][2];
  return out;
}

/// A sphere whose radius is a sum of plane waves.
TriMesh blob_surface(RandomStream& random) {
  struct Wave {
    Vector3d direction;
    double phase, height;
  };
  std::vector<Wave> waves;
  for (int k = 0; k < kBlobWaves; ++k) {
    const double z = 2 * random.uniform() - 1, turn = kFullTurn * random.uniform();
    const double r = std::sqrt(1 - z * z), phase = kFullTurn * random.uniform();
    const double frequency = 1.6 + 0.5 * k;
    waves.push_back(
        {frequency * Vector3d(r * std::cos(turn), r * std::sin(turn), z), phase, 0.3 / frequency});
  }
  TriMesh out = halved_octahedron(kBlobHalvings + 1);
  for (int v = 0; v < out.vertex_count(); ++v) {
    const Vector3d n = out.V.row(v);
    double radius = 1;
    for (const Wave& w : waves) radius += w.height * std::sin(w.direction.dot(n) + w.phase);
    out.V.row(v) *= radius;
  }
  return out;
}

/// A ring whose tube swells and whose middle line rises and falls.
TriMesh torus_surface(RandomStream& random) {
  const double swell = kFullTurn * random.uniform(), rise = kFullTurn * random.uniform();
  TriMesh out;
  out.V.resize(kTorusAround * kTorusAcross, 3);
  out.F.resize(2 * kTorusAround * kTorusAcross, 3);
  const auto vertex = [](int i, int j) {
    return (i % kTorusAround) * kTorusAcross + j % kTorusAcross;
  };
  for (int i = 0; i < kTorusAround; ++i) {
    const double u = kFullTurn * i / kTorusAround;
    const double tube = 0.34 + 0.07 * std::sin(2 * u + swell);
    const Vector3d outward(std::cos(u), std::sin(u), 0);
    for (int j = 0; j < kTorusAcross; ++j) {
      const double v = kFullTurn * j / kTorusAcross;
      const Vector3d x = (1 + tube * std::cos(v)) * outward +
                         (tube * std::sin(v) + 0.16 * std::sin(2 * u + rise)) * Vector3d::UnitZ();
      out.V.row(vertex(i, j)) = x;
      const int f = 2 * vertex(i, j);
      out.F.row(f) << vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1);
      out.F.row(f + 1) << vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1);
    }
  }
  return out;
}

void fit_into_box(TriMesh& mesh, const Vector3d& sides) {
  const Eigen::RowVector3d low = mesh.V.colwise().minCoeff(), high = mesh.V.colwise().maxCoeff();
  const Eigen::RowVector3d scale = sides.transpose().cwiseQuotient(high - low);
  mesh.V = ((mesh.V.rowwise() - (low + high) / 2).array().rowwise() * scale.array()).matrix();
}

/// Uniform by area.
struct SurfaceTrials {
  std::vector<TrianglePlace> places;
  std::vector<Vector3d> points;
};

SurfaceTrials surface_trials(const TriMesh& mesh, std::span<const Vector3d> vertices, int count,
                             RandomStream& random) {
  const Eigen::VectorXd area = triangle_areas(mesh.V, mesh.F);
  std::vector<double> sum(area.size());
  double total = 0;
  for (int f = 0; f < mesh.triangle_count(); ++f) sum[f] = total += area[f];
  SurfaceTrials out;
  for (int i = 0; i < count; ++i) {
    const double at = total * random.uniform();
    const auto found = std::upper_bound(sum.begin(), sum.end() - 1, at);
    const double root = std::sqrt(random.uniform()), part = random.uniform();
    out.places.push_back({static_cast<int>(found - sum.begin()), 1 - root, root * (1 - part)});
    out.points.push_back(on_triangle(vertices, mesh.F, out.places.back()));
  }
  return out;
}

/// Half an ellipsoid that goes on a little below the surface.
TriMesh stud_mesh(std::span<const double> p) {
  const double scale = p[Item::kSize] * p[Item::kRadius];
  constexpr std::array<std::array<double, 2>, 5> kProfile{
      {{0.96, -0.25}, {1, 0}, {0.87, 0.5}, {0.62, 0.78}, {0.3, 0.954}}};  // radius, height
  constexpr int kRings = static_cast<int>(kProfile.size());
  TriMesh m;
  m.V.resize(kRings * kStudSides + 1, 3);
  m.F.resize((2 * kRings - 1) * kStudSides, 3);
  const int top = kRings * kStudSides;
  m.V.row(top) << 0, 0, kItemHeight * scale;
  int f = 0;
  for (int r = 0; r < kRings; ++r) {
    for (int side = 0; side < kStudSides; ++side) {
      const double angle = kFullTurn * side / kStudSides;
      const double radius = kStudWidth * scale * kProfile[r][0];
      const int here = r * kStudSides + side, beside = r * kStudSides + (side + 1) % kStudSides;
      m.V.row(here) << radius * std::cos(angle), radius * std::sin(angle),
          kItemHeight * scale * kProfile[r][1];
      if (r + 1 == kRings) {
        m.F.row(f++) << here, beside, top;
        continue;
      }
      m.F.row(f++) << here, beside, beside + kStudSides;
      m.F.row(f++) << here, beside + kStudSides, here + kStudSides;
    }
  }
  return m;
}

ElementType item_type() {
  ElementType out;
  out.name = "item";
  out.parameters = {{"size", "1", 0, 1}, {"radius", "m", 1e-6, 1e3}, {"triangle", "1", 0, 1e9},
                    {"b0", "1", 0, 1},   {"b1", "1", 0, 1},          {"candidate", "1", 0, 1}};
  out.keys = [](std::span<const double> p, std::vector<Vector3d>& keys) {
    keys.push_back(Vector3d::Zero());
    keys.emplace_back(0, 0, kItemHeight * p[Item::kSize] * p[Item::kRadius]);
  };
  out.mesh = stud_mesh;
  return out;
}

void require_surface_options(const SurfaceSetOptions& o) {
  const auto require = [](bool holds, const char* name, const char* allowed) {
    if (!holds)
      throw Error(std::string("'") + name + "' is out of its range", "make_surface_set", allowed);
  };
  const double least = std::min({o.width, o.depth, o.height});
  require(least >= 1e-3 && std::max({o.width, o.depth, o.height}) <= 1e3, "width, depth or height",
          "1e-3 to 1e3 m");
  require(o.spacing > 0 && o.spacing <= least / 4, "spacing",
          "above 0, to a fourth of the shortest side");
}

/// Where an item is on the surface, its z axis along the smooth normal, turned at random.
Pose pose_on_surface(const TriMesh& mesh, const Eigen::MatrixX3d& normals,
                     const TrianglePlace& place, const Vector3d& x, RandomStream& random) {
  const auto corner = [&](int k) -> Vector3d { return normals.row(mesh.F(place.triangle, k)); };
  const Vector3d n =
      place.b0 * corner(0) + place.b1 * corner(1) + (1 - place.b0 - place.b1) * corner(2);
  const Eigen::AngleAxisd spin(kFullTurn * random.uniform(), Vector3d::UnitZ());
  return {x, (Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), n) * spin).normalized()};
}

}  // namespace

void describe(OptionVisitor& v, SurfaceSetOptions& o) {
  constexpr std::array<std::string_view, 2> kShapes{"blob", "torus"};
  describe_choice(v, "shape", o.shape, kShapes,
                  {.doc = "surface: a lump, or a ring that swells and rises"});
  v.value("width", o.width,
          {.doc = "size of the surface along x", .unit = "m", .min = 1e-3, .max = 1e3});
  v.value("depth", o.depth,
          {.doc = "size of the surface along y", .unit = "m", .min = 1e-3, .max = 1e3});
  v.value("height", o.height,
          {.doc = "size of the surface along z", .unit = "m", .min = 1e-3, .max = 1e3});
  v.value("spacing", o.spacing,
          {.doc = "least distance of two items of full size; at most a fourth of the surface's "
                  "shortest side",
           .unit = "m",
           .min = 1e-6,
           .max = 250});
}

Vector3d on_triangle(std::span<const Vector3d> points, const Eigen::MatrixX3i& triangles,
                     const TrianglePlace& place) {
  const auto corner = triangles.row(place.triangle);
  return place.b0 * points[corner[0]] + place.b1 * points[corner[1]] +
         (1 - place.b0 - place.b1) * points[corner[2]];
}

Eigen::Quaterniond triangle_turn(std::span<const Vector3d> before, std::span<const Vector3d> now,
                                 const Eigen::MatrixX3i& triangles, int triangle) {
  const auto corner = triangles.row(triangle);
  const auto frame = [&](std::span<const Vector3d> p) {
    const Vector3d u = p[corner[1]] - p[corner[0]];
    Eigen::Matrix3d out;
    out.col(0) = u.normalized();
    out.col(2) = u.cross(p[corner[2]] - p[corner[0]]).normalized();
    out.col(1) = out.col(2).cross(out.col(0));
    return out;
  };
  const Eigen::Matrix3d turn = frame(now) * frame(before).transpose();
  if (!(turn.determinant() > 0.5)) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(turn).normalized();
}

TrianglePlace nearest_place(std::span<const Vector3d> points, const Eigen::MatrixX3i& triangles,
                            const Vector3d& x) {
  TriMesh mesh;
  mesh.V.resize(static_cast<int>(points.size()), 3);
  for (int v = 0; v < mesh.vertex_count(); ++v) mesh.V.row(v) = points[v];
  mesh.F = triangles;
  const SurfacePoint found = TriangleTree(mesh).nearest(x).point;
  const double b0 = std::clamp(found.barycentric[0], 0.0, 1.0);
  return {found.face, b0, std::clamp(found.barycentric[1], 0.0, 1 - b0)};
}

Hierarchy make_surface_set(const SurfaceSetOptions& o, std::uint64_t seed) {
  require_surface_options(o);
  RandomStream random(seed, "surface-set");
  TriMesh mesh =
      o.shape == SurfaceSetOptions::Shape::blob ? blob_surface(random) : torus_surface(random);
  fit_into_box(mesh, {o.width, o.depth, o.height});
  std::vector<Vector3d> vertices;
  for (int v = 0; v < mesh.vertex_count(); ++v) vertices.emplace_back(mesh.V.row(v));
  const double disks = triangle_areas(mesh.V, mesh.F).sum() / (o.spacing * o.spacing);
  if (disks > kMostItems)
    throw Error("asks for " + std::to_string(disks) + " items", "make_surface_set",
                "a spacing that leaves room for 1e6 at most");
  const SurfaceTrials trials =
      surface_trials(mesh, vertices, static_cast<int>(kSurfaceTrials * disks) + 1, random);
  const Vector3d half = Vector3d(o.width, o.depth, o.height) / 2;
  const DiskSampling disk = sample_disks(
      static_cast<int>(trials.points.size()), [&](int i) { return trials.points[i]; },
      {-half, half}, o.spacing);
  ElementType root;
  root.name = "surface-set";
  root.triangles = mesh.F;
  Hierarchy out({root, item_type()});
  const std::size_t count = disk.elements.size() + disk.candidates.size();
  out.reserve(count + 1, 6 * count);
  out.add(0, -1, {}, {}, vertices);
  const Eigen::MatrixX3d normals = vertex_normals(mesh);
  const auto add = [&](int number, bool is_candidate) {
    const TrianglePlace& place = trials.places[number];
    const Pose pose = pose_on_surface(mesh, normals, place, trials.points[number], random);
    const std::array values{
        is_candidate ? 0. : 1., o.spacing / 2, 1. * place.triangle, place.b0, place.b1,
        is_candidate ? 1. : 0.};
    const int e = out.add(1, 0, pose, values);
    if (is_candidate) out.set_present(e, false);
  };
  for (const int number : disk.element_number) add(number, false);
  for (const int number : disk.candidate_number) add(number, true);
  return out;
}

}  // namespace geoprior::grammar
