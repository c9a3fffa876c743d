#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "baselines/details/shared/rest_density.h"
#include "core/context.h"
#include "core/options.h"
#include "models/details/area_budget.h"
#include "models/details/mesh.h"
#include "models/details/process.h"
#include "models/details/step.h"

namespace geoprior::details {

/// Edge of the equilateral lattice with one point per unit area, sqrt(2 / sqrt(3)), and the
/// circumradius of its triangles, edge / sqrt(3): what a density asks for, in units of
/// 1 / sqrt(density).
inline constexpr double kLatticeEdge = 1.0745699318235418;
inline constexpr double kLatticeRadius = 0.6204032394013997;
/// A point farther than three such edges from all details lies on a bare part of the surface.
inline constexpr double kBareRadius = 3 * kLatticeEdge;

/// Per site: 1 / sqrt(density at rest) (m); infinity where the surface is bare.
std::vector<double> spacing_of_sites(const DetailMesh& details, const RestDensity& density);

/// Mean over the corners of triangle `t` with finite spacing; infinity without one.
double spacing_of(const DetailMesh& details, int t, const std::vector<double>& spacing);

/// A point of M_d.
struct MeshPoint {
  int triangle = 0;
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();  ///< not negative
};

/// Circumcentre of a triangle, walked to over the edges of M_d, triangles unfolded on the way;
/// absent when it lies beyond a border.
std::optional<MeshPoint> circumcentre(const IntrinsicTriangulation& mesh, int t);

/// Options of the methods that keep their number of details by `DensityMoves`.
struct DensityMoveOptions {
  double circumradius = 1;
  double shortest_edge = 1;
  int patch_details = 48;
  double dead_band = 0.1;
  bool anticipate = true;  ///< see `lead_of`
  double weight_rate = 0.1;
  LengthRule lengths = LengthRule::chord;
};
void describe(OptionVisitor& v, DensityMoveOptions& options);

/// What the moves of a frame did: numbers of details.
struct DensityChanges {
  int inserted = 0, revived = 0, fading = 0;
  void diagnose(std::map<std::string, double>& into) const;
};

/// Keeps the number of details of every patch near its budget: a patch acts when it is off by
/// 1/2 + `dead_band` or more. Details that fade turn back where some are lacking; others fade at
/// short edges, or come at circumcentres. Patches and numbers are those of the thesis' method with
/// its budget, so that what differs is where details come and which ones go. Nothing comes or goes
/// where the surface is bare.
class DensityMoves {
 public:
  /// @param details  with the density at rest; all references are kept
  DensityMoves(DetailMesh& details, const RestDensity& density, AreaBudget& budget,
               double dead_band);
  /// The moves of a frame. Phases: "budget", "merge", "insert".
  DensityChanges keep_number(const DensityMoveOptions& options, RunContext& context);

 private:
  /// To be called before the others: counts details, measures areas.
  void measure(const AreaBudget::Lead& lead);
  /// Lets one end fade of edges that are crowded: the shortest in units of the lattice's first, up
  /// to `most` of it; no two share a vertex. The end goes that has the shorter other edges. To be
  /// called before details are inserted.
  /// @return  number of details
  int fade_shortest_edges(double most);
  /// Inserts details of weight 0 at circumcentres of triangles that lack details around: the
  /// largest circumradius in units of the lattice's first, down to `least` of it; no two share a
  /// vertex.
  /// @return  number of details
  int insert_at_circumcentres(double least);
  [[nodiscard]] double deficit(int site) const;
  [[nodiscard]] bool lacks(int triangle) const;
  [[nodiscard]] bool may_fade(int site) const;
  [[nodiscard]] double second_edge(int site, int but) const;
  [[nodiscard]] bool touched(int triangle) const;
  void touch(int triangle);
  bool insert_near(int triangle, double least);

  DetailMesh& now_;
  const RestDensity& density_;
  AreaBudget& budget_;
  double limit_;
  std::vector<double> spacing_;
  std::vector<char> touched_;
};

/// A method that lets details come and go by `DensityMoves`; one that derives from it may move them
/// afterwards. Diagnostics: those of `DensityChanges`, flips, refused_flips, max_weight_change.
class DensityMethod : public DetailMethod {
 public:
  DensityMethod(const DetailScene& scene, const DensityMoveOptions& options);
  void step(const Eigen::MatrixX3d& V, RunContext& context) final;
  [[nodiscard]] const DetailMesh& details() const final { return now_; }
  void diagnose(std::map<std::string, double>& into) const override;
  void save(StateWriter& out) const final;
  void load(StateReader& in) final;

 protected:
  /// Called after the moves of every frame, before weights change. Marks its own phases.
  /// @return  number of flips in M_d
  virtual int relax(bool /*surface_moved*/, RunContext& /*context*/) { return 0; }

  DetailMesh now_;
  const RestDensity density_;

 private:
  DensityMoveOptions options_;
  AreaBudget budget_;
  DensityMoves moves_;
  DensityChanges changes_;
  StepReport report_;
};

}  // namespace geoprior::details
