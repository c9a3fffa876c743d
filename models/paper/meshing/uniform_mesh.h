#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "models/paper/sheet/pattern.h"
#include "models/paper/sheet/sheet.h"
#include "models/paper/shell/state.h"

namespace geoprior::paper {

enum class UniformLayout { automatic, structured, equilateral, delaunay };

/// Uniform triangulation of a pattern that has all `anchors` among its vertices.
/// automatic: structured for an upright rectangle, equilateral for all else;
/// structured: a grid of squares, each with a diagonal, alternating; equilateral: a hexagonal
/// lattice cut by the border; delaunay: jittered points, seeded. Border vertices lie on the border.
/// The mesh is open along the pattern's cuts.
/// @throws Error  on a pattern that is not simple, an anchor outside it, fewer than two triangles,
///                structured layout of anything but an upright rectangle
ShellMesh uniform_mesh(const Pattern& pattern, int triangles, UniformLayout layout,
                       const std::vector<Eigen::Vector2d>& anchors, std::uint64_t seed);

/// The same for edges of a given length, of a pattern that is simple: equilateral, or delaunay.
/// @param finer_at  places about which edges are half as long
ShellMesh lattice_mesh(const Pattern& pattern, double edge, UniformLayout layout,
                       const std::vector<Eigen::Vector2d>& anchors, std::uint64_t seed,
                       const std::vector<Eigen::Vector2d>& finer_at = {});

/// Edge length (m) with which `lattice_mesh` makes about so many triangles of the pattern without
/// its cuts.
double uniform_edge(const Pattern& pattern, int triangles, UniformLayout layout,
                    const std::vector<Eigen::Vector2d>& anchors, std::uint64_t seed);

/// Edge length (m) of so many equilateral triangles that cover an area (m^2).
double equilateral_edge(double area, double triangles);

/// Refuses edges so short that the lattice over the pattern's box, or its border, has more points
/// than a sheet can: before any is made.
/// @throws Error  naming the pattern and the number of points
void require_lattice(const Pattern& pattern, double edge);

/// Places where a mesh of this edge length needs a vertex for the sheet's handles: their anchors,
/// and points along the segments that cross the inside. (Border vertices of a segment on the
/// border are held as they come.)
std::vector<Eigen::Vector2d> handle_points(const Sheet& sheet, double edge);

/// The sheet at t = 0 on this mesh: at rest in its place, imperfection included, without creases.
ShellState resting_state(const Sheet& sheet, ShellMesh mesh, std::uint64_t seed);

}  // namespace geoprior::paper
