#pragma once

#include <array>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "baselines/details/area_budget.h"
#include "baselines/details/point_grid.h"
#include "solvers/details/pair_correlation.h"
#include "solvers/details/replication.h"
#include "solvers/details/triplet_table.h"

namespace geoprior {

/// What a step of the replication did.
struct ReplicationCounts {
  int inserted = 0;
  int revived = 0;
  int fading = 0;
  int flips = 0;
  int failed_queries = 0;
  double max_weight_change = 0;
};

/// A triangle of M_d that asks for a change, for the sake of a patch. The least rank comes first;
/// ties by number.
struct WantingTriangle {
  double rank = 0;
  int triangle = 0;
  int patch = 0;
};

/// What the patch of a site asks for.
enum class Need : signed char { fewer = -1, nothing = 0, more = 1 };

/// The method: `step` in the order of the header of `ReplicationOptions`.
class Replication final : public DetailMethod {
 public:
  Replication(const DetailScene& scene, const ReplicationOptions& options, std::uint64_t seed);
  void step(const Eigen::MatrixX3d& V, RunContext& context) override;
  [[nodiscard]] const DetailMesh& details() const override { return now_; }
  void diagnose(std::map<std::string, double>& into) const override;
  void save(StateWriter& out) const override;
  void load(StateReader& in) override;

 private:
  // replication.cpp
  [[nodiscard]] double wanted_area(int triangle) const;
  [[nodiscard]] double ratio(int triangle) const;
  [[nodiscard]] int patch_of_site(int site) const {
    return patch_of_site_[static_cast<std::size_t>(site)];
  }
  void find_patches(std::span<const int> sites);
  void find_all_patches();
  /// A patch acts when it is off by this many details.
  [[nodiscard]] double limit() const { return 0.5 + options_.dead_band; }
  void find_needs();
  [[nodiscard]] int patch_in_need(int triangle, Need need) const;
  void rank_triangles(Need need, const std::function<double(int)>& rank);
  void act_in_order(Need need, const std::function<void(int)>& act);
  void use_new_marks();
  [[nodiscard]] bool marked(int triangle) const;
  void mark(int site);
  [[nodiscard]] double weight_step(const Eigen::MatrixX3d& V) const;
  // replication_insert.cpp
  void insert();
  void revive();
  [[nodiscard]] double largest_deficit(int triangle) const;
  bool fill(int triangle);
  [[nodiscard]] std::vector<NewDetail> copy_of(const TripletMatch& match, int triangle) const;
  [[nodiscard]] bool strays(int triangle, const std::vector<NewDetail>& born) const;
  [[nodiscard]] bool crowds(const std::vector<NewDetail>& born);
  void carry_tangents(const TripletMatch& match, int triangle, std::vector<NewDetail>& born) const;
  [[nodiscard]] double carried_angle(const TripletMatch& match, int source, int triangle,
                                     const SurfacePoint& at) const;
  [[nodiscard]] bool within_budget(const std::vector<NewDetail>& born) const;
  [[nodiscard]] double histogram_distance(int triangle, const std::vector<NewDetail>& born);
  void measure_histogram();
  // replication_merge.cpp
  void merge();
  void fade_one_of(int triangle);
  [[nodiscard]] bool has_ghost(int triangle) const;
  [[nodiscard]] double crowding(int triangle) const;
  [[nodiscard]] double room_of(int site) const;
  [[nodiscard]] int loser(int triangle) const;
  [[nodiscard]] bool may_fade(int site) const;

  ReplicationOptions options_;
  DetailMesh original_;  ///< at rest: what triplets refer to
  DetailMesh now_;
  TripletTable table_;
  AreaBudget budget_;
  PairCorrelation correlation_;
  Eigen::VectorXd histogram_at_rest_, histogram_now_;
  double rest_edge_ = 0;        ///< mean edge of M_d at rest (m)
  double rest_area_ = 0;        ///< mean area of its triangles
  double least_gap_ = 0;        ///< half of the distance of the nearest two at rest (m)
  double area_per_detail_ = 0;  ///< at rest
  ReplicationCounts counts_;
  std::vector<int> mark_;  ///< frame mark of sites whose surroundings changed
  int current_mark_ = 0;
  static constexpr double kNotWanting = std::numeric_limits<double>::infinity();
  std::vector<Need> need_;  ///< of the patches of the sites
  std::vector<int> patch_of_site_;
  std::vector<double> rank_;  ///< of triangles
  std::vector<int> patch_of_triangle_;
  std::vector<WantingTriangle> wanting_;  ///< by patch; those of a patch become a heap
  std::vector<TripletMatch> matches_;
  std::vector<double> distances_;
  std::optional<PointGrid> near_;  ///< details of this frame, when surface is bare
};

}  // namespace geoprior
