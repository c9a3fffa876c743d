#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/options.h"
#include "models/details/mesh.h"
#include "models/details/point_grid.h"
#include "solvers/details/pair_correlation.h"
#include "solvers/details/triplet_options.h"
#include "solvers/details/triplet_table.h"

namespace geoprior::details {

struct PatternCopierOptions {
  TripletOptions triplets;
  bool histogram = false;
  int candidates = 6;
  PairCorrelationOptions pair_correlation;
};
void describe(OptionVisitor& v, PatternCopierOptions& options);

/// What a triangle that asks for details is given (thesis 2.2.2): those inside the triangle of
/// three details of the original that is most similar to it, by barycentric coordinates, with
/// weight 0. Copies that land where the triangle does not follow the surface, or nearer to a detail
/// than the original has any, are not made.
class PatternCopier {
 public:
  /// @param leaves_bare  the pattern leaves a part of the surface bare
  PatternCopier(const DetailMesh& original, const PatternCopierOptions& options, bool leaves_bare,
                std::uint64_t seed);

  /// What is asked of copies by their user, before they are compared.
  using Accept = std::function<bool(const std::vector<NewDetail>&)>;

  /// To be called before the first triangle of a frame.
  void begin_frame(const DetailMesh& now);
  /// What fits triangle `t` of `now` best: at most `room` details, which `accept` allows.
  /// @return  none where no candidate fits; absent where no triangle of the original is similar
  std::optional<std::vector<NewDetail>> copies_for(const DetailMesh& now, int t, int room,
                                                   const Accept& accept);
  /// Takes note of a detail that was inserted.
  void add(const DetailMesh& now, int site);

  [[nodiscard]] const TripletTable& table() const { return table_; }

 private:
  [[nodiscard]] std::vector<NewDetail> copy_of(const TripletMatch& match, const DetailMesh& now,
                                               int t) const;
  [[nodiscard]] bool crowds(const DetailMesh& now, const std::vector<NewDetail>& born);
  [[nodiscard]] double histogram_distance(const DetailMesh& now, int t,
                                          const std::vector<NewDetail>& born);
  void carry_tangents(const TripletMatch& match, const DetailMesh& now, int t,
                      std::vector<NewDetail>& born) const;
  [[nodiscard]] double carried_angle(const TripletMatch& match, int source, const DetailMesh& now,
                                     int t, const SurfacePoint& at) const;

  DetailMesh original_;  ///< at rest: what triplets refer to
  PatternCopierOptions options_;
  TripletTable table_;
  PairCorrelation correlation_;
  Eigen::VectorXd histogram_at_rest_, histogram_now_;
  double area_per_detail_ = 0;  ///< at rest (m^2)
  double least_gap_ = 0;        ///< half of the distance of the nearest two at rest (m)
  bool leaves_bare_ = false;
  std::vector<TripletMatch> matches_;
  std::vector<double> distances_;
  std::optional<PointGrid> near_;  ///< details of this frame, when surface is bare
};

}  // namespace geoprior::details
