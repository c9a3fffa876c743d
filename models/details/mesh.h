#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/options.h"
#include "core/state_bytes.h"
#include "models/details/intrinsic_triangulation.h"
#include "models/details/scene.h"
#include "models/details/surface_walk.h"

namespace geoprior::details {

enum class SiteKind : std::uint8_t { empty, detail, ghost };

/// Details on a moving surface with their mesh M_d, kept up to date: what every method of the topic
/// holds and changes.
///
/// Vertices of `mesh` are numbered as the sites. A *ghost* is a vertex of the smooth surface that
/// stays in M_d with weight 0: those along borders (M_d then covers an open surface), and those
/// that hold the topology where the details are too few for the cells of their Voronoi diagram to
/// be discs (around a thin neck). Ghosts are never drawn, counted or measured.
struct DetailMesh {
  std::shared_ptr<const SurfaceTopology> surface;
  std::vector<Eigen::Vector3d> x;  ///< vertices of the surface now (m)
  std::vector<Detail> site;        ///< details and ghosts by number
  std::vector<SiteKind> kind;
  std::vector<Eigen::Vector3d> position;  ///< of the sites now (m)
  IntrinsicTriangulation mesh;            ///< M_d
  std::int64_t births = 0;                ///< identities given so far
  int frame = 0;                          ///< of the motion

  [[nodiscard]] int site_slots() const { return static_cast<int>(site.size()); }
  [[nodiscard]] bool is_detail(int i) const { return kind[i] == SiteKind::detail; }
  [[nodiscard]] int detail_count() const;
  [[nodiscard]] int ghost_count() const;

  void save(StateWriter& out) const;  ///< all but `surface`
  void load(StateReader& in);
};

/// M_d of details on a surface: its intrinsic Delaunay triangulation with the details inserted as
/// vertices, from which the surface's own vertices are then removed one by one. What remains joins
/// details whose cells in the geodesic Voronoi diagram touch; in the plane it is the Delaunay
/// triangulation. A vertex whose removal would change the topology stays as a ghost, so that the
/// result is a manifold that covers the surface whatever the number of details. Lengths are chords
/// at rest; the density of each triangle is `details_of` it / area.
///
/// @param details  valid (`require_valid`), not two in one place
/// @throws Error   when triangles become degenerate (names the detail)
DetailMesh build_detail_mesh(const TriMesh& rest, std::span<const Detail> details);
/// Builds M_d on the surface as it stands, with births and frame as given: for methods that start
/// from scratch every frame. `details` keep their birth and generation.
DetailMesh build_detail_mesh(std::shared_ptr<const SurfaceTopology> surface,
                             std::span<const Eigen::Vector3d> x, std::span<const Detail> details);

/// How the edges of M_d are measured, once a step.
enum class LengthRule {
  chord,    ///< distance of the end points
  geodesic  ///< length of the section of the surface by the plane of the chord and the mean normal
};
/// The option `lengths` of the methods.
void describe_lengths(OptionVisitor& v, LengthRule& rule);

/// Measures the edges of M_d along the surface; where a section does not arrive (at a border, over
/// a fold), by its chord. The lengths of three sections may violate the triangle inequality on a
/// strongly curved surface; such a triangle counts as one of no area.
void measure_sections(DetailMesh& details);
/// Measures the edges of M_d by the rule.
void measure_edges(DetailMesh& details, LengthRule rule);

/// False when the surface stands at `V` already.
bool surface_differs(const DetailMesh& details, const Eigen::MatrixX3d& V);

/// Moves the surface to `V`, and its details with it; measures the edges and flips to Delaunay.
/// @return  number of flips
int move_surface(DetailMesh& details, const Eigen::MatrixX3d& V, LengthRule rule);

/// A detail to be inserted into a triangle of M_d.
struct NewDetail {
  Eigen::Vector3d barycentric;  ///< for the corners of the triangle, positive
  SurfacePoint at;              ///< its place (`surface_point_in`)
  Detail like;                  ///< weight, target, type, angle; the rest is set
};

/// Inserts details into triangle `t` of M_d, then flips to Delaunay. Birth, birth_frame and
/// generation are set.
/// @return  numbers of the sites
std::vector<int> insert_details(DetailMesh& details, int t, std::span<const NewDetail> born);
/// Inserts one detail, at the point of the surface nearest to a point of the flat triangle `t`.
int insert_detail(DetailMesh& details, int t, const Eigen::Vector3d& barycentric,
                  const Detail& like);
/// Where `insert_detail` would put it.
SurfacePoint surface_point_in(const DetailMesh& details, int t, const Eigen::Vector3d& barycentric);

/// Removes a detail from M_d; one that holds the topology stays as a ghost.
void remove_detail(DetailMesh& details, int site);

/// Moves every weight towards its target by at most `most`; details that reached target 0 are
/// removed.
/// @return  largest change of a weight
double change_weights(DetailMesh& details, double most);

/// Details that a triangle of M_d holds: a sixth for each corner that is a detail, so that a detail
/// with six triangles counts as one (one sixth for a triangle of ghosts alone).
double details_of(const DetailMesh& details, int triangle);

/// True for a half-edge whose two triangles have details at all corners. Near a border, ghosts
/// decide which edges there are, and their spacing changes with the motion: such edges say nothing
/// of the details.
bool among_details(const DetailMesh& details, int half_edge);

/// Mean length of the edges of M_d among details, whatever their weights (m); 0 without any.
double mean_edge(const DetailMesh& details);

/// Area of all triangles of M_d (m^2).
double total_area(const DetailMesh& details);

/// Triangles of M_d with every site taken out that is no detail of weight above `weight`: the
/// spacing that one sees. A copy is thinned; ghosts stay.
std::vector<std::array<int, 3>> visible_triangles(const DetailMesh& details, double weight);

}  // namespace geoprior::details
