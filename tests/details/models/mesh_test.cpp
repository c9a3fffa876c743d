#include "models/details/mesh.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>

#include "core/geometry/procedural.h"
#include "tests/details/detail_scenes.h"

namespace geoprior::details {
namespace {

using namespace detail_scenes;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vertices =
    CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>>;
using Edges = std::set<std::pair<int, int>>;

Edges edges_of(const DetailMesh& d) {
  Edges edges;
  for (const auto& t : d.mesh.triangles())
    for (std::size_t k = 0; k < 3; ++k) edges.insert(std::minmax(t[k], t[(k + 1) % 3]));
  return edges;
}

/// The edges of CGAL's triangulation of the sites, ghosts included.
Edges cgal_edges(const DetailMesh& d) {
  CGAL::Delaunay_triangulation_2<Kernel, Vertices> delaunay;
  for (int i = 0; i < d.site_slots(); ++i) {
    if (d.kind[i] == SiteKind::empty) continue;
    const Eigen::Vector3d& p = d.position[i];
    delaunay.insert({p.x(), p.y()})->info() = i;
  }
  Edges edges;
  for (auto e = delaunay.finite_edges_begin(); e != delaunay.finite_edges_end(); ++e) {
    const int a = e->first->vertex((e->second + 1) % 3)->info();
    const int b = e->first->vertex((e->second + 2) % 3)->info();
    edges.insert(std::minmax(a, b));
  }
  return edges;
}

void expect_sound(const DetailMesh& d) {
  const TriangulationReport report = d.mesh.check();
  EXPECT_TRUE(report.manifold());
  EXPECT_EQ(report.not_delaunay, 0) << report.worst_angle_sum;
  EXPECT_EQ(report.blocked, 0);
  EXPECT_EQ(report.euler, d.surface->euler);
}

TEST(DetailMesh, InThePlaneItIsCgalsDelaunayTriangulation) {
  for (const int cells : {1, 7, 40}) {
    const TriMesh mesh = shapes::square(cells);
    const DetailMesh d = build_detail_mesh(mesh, random_details(mesh, 400, 3));
    expect_sound(d);
    EXPECT_EQ(d.detail_count(), 400);
    EXPECT_EQ(d.ghost_count(), 4 * cells);  // the border, and nothing else
    EXPECT_EQ(edges_of(d), cgal_edges(d)) << cells;
  }
}

TEST(DetailMesh, StretchedInThePlaneItStaysCgals) {
  const TriMesh mesh = shapes::square(10);
  DetailMesh d = build_detail_mesh(mesh, random_details(mesh, 300, 4));
  const auto motion = stretch(mesh, 10, 3);
  for (int frame = 1; frame <= 10; ++frame) {
    EXPECT_GT(move_surface(d, motion->positions(frame), LengthRule::chord), 0);
    expect_sound(d);
    EXPECT_EQ(edges_of(d), cgal_edges(d)) << frame;
  }
}

TEST(DetailMesh, InsertionAndRemovalInThePlaneStayCgals) {
  const TriMesh mesh = shapes::square(10);
  DetailMesh d = build_detail_mesh(mesh, random_details(mesh, 200, 5));
  RandomStream random(5, "changes");
  for (int i = 0; i < 400; ++i) {
    if (random.uniform() < 0.5) {
      int t = 0;
      do {
        t = static_cast<int>(random.below(static_cast<std::uint32_t>(d.mesh.triangle_slots())));
      } while (!d.mesh.triangle_alive(t));
      Eigen::Vector3d b(0.1 + random.uniform(), 0.1 + random.uniform(), 0.1 + random.uniform());
      insert_detail(d, t, b / b.sum(), Detail{});
    } else {
      int site = 0;
      do {
        site = static_cast<int>(random.below(static_cast<std::uint32_t>(d.site_slots())));
      } while (!d.is_detail(site));
      remove_detail(d, site);
    }
  }
  expect_sound(d);
  EXPECT_EQ(edges_of(d), cgal_edges(d));
}

TEST(DetailMesh, ASphereIsCoveredWithoutGhosts) {
  const TriMesh mesh = shapes::sphere(5);
  const DetailMesh d = build_detail_mesh(mesh, even_details(mesh, 300, 1));
  expect_sound(d);
  EXPECT_EQ(d.ghost_count(), 0);
  // Closed and of genus 0: 2 n - 4 triangles, 3 n - 6 edges.
  EXPECT_EQ(d.mesh.triangle_count(), 596);
  EXPECT_EQ(edges_of(d).size(), 894u);
}

/// Torus of radii 1 and 0.3 with 3 n x n vertices.
TriMesh torus(int n) {
  TriMesh mesh;
  mesh.V.resize(3 * n * n, 3);
  mesh.F.resize(6 * n * n, 3);
  const double turn = 6.283185307179586;
  for (int i = 0; i < 3 * n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double u = turn * i / (3 * n), v = turn * j / n, r = 1 + 0.3 * std::cos(v);
      mesh.V.row(i * n + j) << r * std::cos(u), r * std::sin(u), 0.3 * std::sin(v);
      const int a = i * n + j, b = (i + 1) % (3 * n) * n + j, c = i * n + (j + 1) % n;
      const int d = (i + 1) % (3 * n) * n + (j + 1) % n;
      mesh.F.row(2 * a) << a, b, d;
      mesh.F.row(2 * a + 1) << a, d, c;
    }
  }
  return mesh;
}

TEST(DetailMesh, TooFewDetailsForTheTopologyAreHeldByGhosts) {
  // A closed triangulation without repeated edges needs 4 vertices on a sphere (Euler), 7 on a
  // torus (Moebius 1886); where the cells of the details are no discs, ghosts make up for it.
  for (const int count : {3, 5, 12}) {
    const DetailMesh tube = build_detail_mesh(two_bone_cylinder({}).mesh,
                                              random_details(two_bone_cylinder({}).mesh, count, 2));
    const DetailMesh ring = build_detail_mesh(torus(16), random_details(torus(16), count, 2));
    for (const DetailMesh* d : {&tube, &ring}) {
      const TriangulationReport report = d->mesh.check();
      EXPECT_TRUE(report.manifold());
      EXPECT_EQ(report.euler, d == &tube ? 2 : 0);
      EXPECT_EQ(d->detail_count(), count);
      EXPECT_GE(d->detail_count() + d->ghost_count(), d == &tube ? 4 : 7);
      EXPECT_LT(d->ghost_count(), 16);
    }
  }
}

TEST(DetailMesh, VisibleTrianglesAreThoseOfTheVisibleDetails) {
  const TriMesh mesh = shapes::square(10);
  auto details = random_details(mesh, 200, 6), visible = details;
  for (std::size_t i = 0; i < details.size(); i += 3) details[i].weight = 0.2;
  visible.clear();
  for (const Detail& d : details)
    if (d.weight > 0.5) visible.push_back(d);
  const DetailMesh all = build_detail_mesh(mesh, details), few = build_detail_mesh(mesh, visible);
  // Compared by place, since the numbers differ.
  const auto places = [](const DetailMesh& d, const std::vector<std::array<int, 3>>& triangles) {
    std::set<std::array<double, 4>> edges;
    for (const auto& t : triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        Eigen::Vector3d p = d.position[t[k]];
        Eigen::Vector3d q = d.position[t[(k + 1) % 3]];
        if (std::pair(q.x(), q.y()) < std::pair(p.x(), p.y())) std::swap(p, q);
        edges.insert({p.x(), p.y(), q.x(), q.y()});
      }
    }
    return edges;
  };
  EXPECT_EQ(places(all, visible_triangles(all, 0.5)), places(few, few.mesh.triangles()));
}

TEST(DetailMesh, SectionsMeasureAlongTheSurface) {
  // On a unit sphere the geodesic of a chord c is 2 asin(c / 2).
  const TriMesh mesh = shapes::sphere(6);
  DetailMesh d = build_detail_mesh(mesh, even_details(mesh, 60, 1));
  measure_sections(d);
  for (int h = 0; h < 3 * d.mesh.triangle_slots(); ++h) {
    if (!d.mesh.triangle_alive(h / 3)) continue;
    const double chord = (d.position[d.mesh.origin(h)] - d.position[d.mesh.tip(h)]).norm();
    // The facets of the sphere lie up to 2e-4 inside.
    EXPECT_NEAR(d.mesh.length(h), 2 * std::asin(chord / 2), 1e-3);
  }
}

}  // namespace
}  // namespace geoprior::details
