#include "baselines/details/lloyd.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "baselines/details/naive_stretch.h"
#include "baselines/details/shared/voronoi_cell.h"
#include "tests/details/baselines/baseline_runs.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;

struct Box {
  double left, right, low, high;
  explicit Box(const Eigen::MatrixX3d& V)
      : left(V.col(0).minCoeff()),
        right(V.col(0).maxCoeff()),
        low(V.col(1).minCoeff()),
        high(V.col(1).maxCoeff()) {}
  [[nodiscard]] double to_border(const Eigen::Vector3d& p) const {
    return std::min({p.x() - left, right - p.x(), p.y() - low, high - p.y()});
  }
};

/// Equilateral lattice of `columns` points along x, half an edge and more inside the borders.
std::vector<Detail> details_on_lattice(const TriMesh& mesh, int columns) {
  const Box box(mesh.V);
  const double edge = (box.right - box.left) / columns;
  const SurfaceTopology surface(mesh);
  std::vector<Eigen::Vector3d> vertices;
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) vertices.push_back(mesh.V.row(v).transpose());
  std::vector<Detail> details;
  for (int row = 0;; ++row) {
    const double y = box.low + edge / 2 + row * edge * std::sqrt(0.75);
    if (y > box.high - edge / 2) return details;
    for (int k = 0; k < columns; ++k) {
      const double x = box.left + edge * (k + (row % 2 == 0 ? 0.3 : 0.8));
      if (x > box.right - edge / 10) continue;
      Detail d;
      d.at = walk_to_nearest(d.at, {x, y, mesh.V(0, 2)}, surface, vertices);
      details.push_back(d);
    }
  }
}

TEST(VoronoiCell, OfALatticeIsItsHexagon) {
  // Area sqrt(3) / 2 edge^2, corners edge / sqrt(3) away, centroid at the detail.
  const TriMesh mesh = shapes::square(20);
  const DetailMesh d = build_detail_mesh(mesh, details_on_lattice(mesh, 9));
  const std::vector<double> spacing = spacing_of_sites(d, RestDensity(d));
  const Box box(mesh.V);
  const double edge = (box.right - box.left) / 9;
  CellChart chart;
  int inside = 0;
  for (int i = 0; i < d.site_slots(); ++i) {
    if (!d.is_detail(i) || box.to_border(d.position[i]) < 1.6 * edge) continue;
    ++inside;
    chart.lay_out(d, i);
    const VoronoiCell cell = chart.cell(d, std::vector<double>(spacing.size(), spacing[0]));
    EXPECT_NEAR(cell.area, std::sqrt(0.75) * edge * edge, 1e-9 * edge * edge);
    EXPECT_NEAR(cell.reach, edge / std::sqrt(3), 1e-9 * edge);
    EXPECT_NEAR(cell.centroid.norm(), 0, 1e-9 * edge);
    EXPECT_NEAR(chart.least_height(), std::sqrt(0.75) * edge, 1e-9 * edge);
  }
  EXPECT_GT(inside, 20);
}

TEST(VoronoiCell, CentroidLeansToTheDenserSide) {
  // Half the spacing on the right is four times the density and sixteen times the weight.
  const TriMesh mesh = shapes::square(20);
  const DetailMesh d = build_detail_mesh(mesh, details_on_lattice(mesh, 9));
  const Box box(mesh.V);
  const double edge = (box.right - box.left) / 9;
  CellChart chart;
  for (int i = 0; i < d.site_slots(); ++i) {
    const Eigen::Vector3d& p = d.position[i];
    if (!d.is_detail(i) || box.to_border(p) < 1.6 * edge) continue;
    std::vector<double> spacing;
    for (const Eigen::Vector3d& q : d.position)
      spacing.push_back(q.x() > p.x() + edge / 4 ? edge / 2 : edge);
    chart.lay_out(d, i);
    const Eigen::Vector2d centroid = chart.cell(d, spacing).centroid;
    const auto place = chart.point_at(centroid);
    ASSERT_TRUE(place);
    Eigen::Vector3d there = Eigen::Vector3d::Zero();
    for (Eigen::Index k = 0; k < 3; ++k)
      there += place->barycentric[k] *
               d.position[d.mesh.origin(3 * place->triangle + static_cast<int>(k))];
    EXPECT_NEAR((there - p).norm(), centroid.norm(), 1e-9 * edge);
    EXPECT_GT(there.x() - p.x(), 0.1 * edge);
    EXPECT_NEAR(there.y(), p.y(), 1e-9 * edge);
  }
}

TEST(VoronoiCell, CellsTileTheSurface) {
  // Cells end at the border of an open surface. On the sphere the tangent plane's cell is larger
  // than that on the surface or smaller by the order of (edge / radius)^2, some per cent here.
  for (const TriMesh& mesh : {shapes::square(40), shapes::sphere(4)}) {
    const DetailMesh d = build_detail_mesh(mesh, even_details(mesh, 500, 1));
    const std::vector<double> spacing = spacing_of_sites(d, RestDensity(d));
    CellChart chart;
    double area = 0;
    for (int i = 0; i < d.site_slots(); ++i) {
      if (!d.is_detail(i)) continue;
      chart.lay_out(d, i);
      area += chart.cell(d, spacing).area;
    }
    EXPECT_NEAR(area / triangle_areas(mesh.V, mesh.F).sum(), 1, 0.03);
  }
}

TEST(Lloyd, EvensThePatternOfAPlaneThatIsStretched) {
  // A lattice has edges of 1.075 / sqrt(density); the original, drawn at random, longer ones: the
  // mean edge falls by some per cent at equal density, while the variation falls to less than half.
  const TriMesh mesh = shapes::square(30);
  const auto s = scene(mesh, even_details(mesh, 600, 1), stretch(mesh, 60, 2));
  const auto method = make_lloyd(s, {});
  const auto naive = make_naive_stretch(s, {});
  EXPECT_GT(spacing_over_motion(*naive, s).all, 0.35);
  const double before = spacing_in(detail_frame(method->details(), 0), "detail_mesh").variation;
  const SpacingOverMotion change = spacing_over_motion(*method, s);
  EXPECT_LT(std::abs(change.all), 0.07);
  EXPECT_LT(std::abs(change.visible), 0.07);
  EXPECT_LT(spacing_in(detail_frame(method->details(), 0), "detail_mesh").variation, before / 2);
  EXPECT_NEAR(method->details().detail_count(), 1200, 40);
  expect_sound(method->details());
}

TEST(Lloyd, NoTriangleTurnsOver) {
  // M_d knows lengths alone, so that only its drawing tells: in a plane all triangles turn left and
  // tile it, whatever the slides, from a pattern with details close together and a sudden stretch.
  const TriMesh mesh = shapes::square(20);
  const auto s = scene(mesh, random_details(mesh, 400, 1), stretch(mesh, 4, 3));
  LloydOptions options;
  options.iterations = 20;
  const auto method = make_lloyd(s, options);
  RunContext context;
  for (int frame = 1; frame <= 4; ++frame) {
    method->step(s.motion->positions(frame), context);
    const DetailMesh& d = method->details();
    double area = 0;
    for (const auto& t : d.mesh.triangles()) {
      const auto at = [&](std::size_t k) { return d.position[t[k]]; };
      const double twice = (at(1) - at(0)).cross(at(2) - at(0)).z();
      EXPECT_GT(twice, -1e-12);
      area += twice / 2;
    }
    EXPECT_NEAR(area, triangle_areas(s.motion->positions(frame), mesh.F).sum(), 1e-9);
    expect_sound(d);
  }
}

TEST(Lloyd, KeepsDetailsAtTheBorder) {
  // A strip along the border as wide as the spacing holds its share of the details: a border that
  // repelled like a detail would leave a third of it empty.
  const TriMesh mesh = shapes::square(40);
  const auto s = scene(mesh, even_details(mesh, 900, 1), stretch(mesh, 40, 1.2));
  const auto method = make_lloyd(s, {});
  run_through(*method, s);
  const DetailMesh& d = method->details();
  const Box box(s.motion->positions(40));
  const double width = box.right - box.left, height = box.high - box.low;
  const double strip = std::sqrt(width * height / d.detail_count());
  const double share = 1 - (1 - 2 * strip / width) * (1 - 2 * strip / height);
  int within = 0;
  for (int i = 0; i < d.site_slots(); ++i)
    if (d.is_detail(i) && box.to_border(d.position[i]) < strip) ++within;
  EXPECT_NEAR(within / (share * d.detail_count()), 1, 0.15);
}

TEST(Lloyd, KeepsAnUnevenDensity) {
  // Four fifths of the details on the left half: as many after the relaxation.
  const TriMesh mesh = shapes::square(32);
  const Box box(mesh.V);
  const double middle = (box.left + box.right) / 2;
  std::vector<Detail> details;
  for (const bool left : {true, false})
    for (const Detail& d : even_details(mesh, left ? 1600 : 400, left ? 1 : 2))
      if ((position_of(d.at, mesh.V, mesh.F).x() < middle) == left) details.push_back(d);
  const auto s = scene(mesh, details, stretch(mesh, 40, 1.5));
  const auto method = make_lloyd(s, {});
  run_through(*method, s);
  const DetailMesh& d = method->details();
  const double now =
      0.5 * (s.motion->positions(40).col(0).minCoeff() + s.motion->positions(40).col(0).maxCoeff());
  int left = 0;
  for (int i = 0; i < d.site_slots(); ++i)
    if (d.is_detail(i) && d.position[i].x() < now) ++left;
  EXPECT_NEAR(static_cast<double>(left) / d.detail_count(), 0.8, 0.03);
}

TEST(Lloyd, FadesDetailsWhenSqueezed) {
  const TriMesh mesh = shapes::sphere(4);
  const auto s = scene(mesh, even_details(mesh, 600, 1), inflate(mesh, 60, 0.5));
  EXPECT_LT(spacing_over_motion(*make_naive_stretch(s, {}), s).all, -0.25);
  const auto method = make_lloyd(s, {});
  const SpacingOverMotion change = spacing_over_motion(*method, s);
  EXPECT_LT(std::abs(change.all), 0.08);
  EXPECT_LT(std::abs(change.visible), 0.08);
  RunContext context;
  for (int frame = 0; frame < 25; ++frame)  // no look ahead any more; those that fade leave
    method->step(s.motion->positions(60), context);
  EXPECT_NEAR(method->details().detail_count(), 300, 15);
  expect_sound(method->details());
}

TEST(Lloyd, RestsWithTheSurface) {
  const TriMesh mesh = shapes::sphere(4);
  const auto s = scene(mesh, random_details(mesh, 500, 1), inflate(mesh, 1, 1.1));
  const auto method = make_lloyd(s, {});
  RunContext context;
  method->step(s.motion->positions(0), context);
  EXPECT_EQ(diagnostic(*method, "max_slide"), 0);
  method->step(s.motion->positions(1), context);
  EXPECT_GT(diagnostic(*method, "max_slide"), diagnostic(*method, "mean_slide"));
  EXPECT_GT(diagnostic(*method, "mean_slide"), 0);
  // Numbers and weights settle; nothing slides any more.
  for (int frame = 0; frame < 20; ++frame) {
    method->step(s.motion->positions(1), context);
    EXPECT_EQ(diagnostic(*method, "max_slide"), 0);
  }
  const auto before = method->details().position;
  method->step(s.motion->positions(1), context);
  EXPECT_EQ(method->details().position, before);
  EXPECT_EQ(diagnostic(*method, "max_weight_change"), 0);
  EXPECT_EQ(method->details().frame, 23);
}

TEST(Lloyd, SameForAnyThreadCountAndAfterAStop) {
  const TriMesh mesh = shapes::sphere(4);
  const auto s = scene(mesh, even_details(mesh, 1500, 1), inflate(mesh, 8, 2));
  expect_same_bytes_for_any_thread_count([&] { return make_lloyd(s, {}); }, s);
  for (const double factor : {2.0, 0.5}) {
    const auto small = scene(mesh, even_details(mesh, 300, 1), inflate(mesh, 16, factor));
    expect_resumed_run_is_the_same([&] { return make_lloyd_process(small, {}); }, 6);
  }
}

}  // namespace
}  // namespace geoprior::details
