#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/options.h"
#include "models/details/mesh.h"
#include "solvers/details/local_chart.h"

namespace geoprior::details {

/// Pair correlation of details by distance along M_d, the histogram that thesis 2.2.2 proposes as
/// an extension.
struct PairCorrelationOptions {
  double radius = 3;
  int bins = 24;
  double bandwidth = 0.1;
};
void describe(OptionVisitor& v, PairCorrelationOptions& options);

/// Estimates g(r) = (1 / (N rho)) sum_i sum_{j != i} k_sigma(r - d(i, j)) / (dA_i(r) / dr), with
/// the annulus dA_i(r) / dr = 2 pi r: distances are those of a local chart, in which the plane is
/// laid out. Ghosts and fading details do not count.
class PairCorrelation {
 public:
  PairCorrelation() = default;
  PairCorrelation(double mean_edge, const PairCorrelationOptions& options);

  /// The whole pattern. `stride` > 1 takes every stride-th detail as centre.
  [[nodiscard]] Eigen::VectorXd of(const DetailMesh& details, int stride = 1);
  /// Adds what one neighbour at a distance contributes to a centre: k_sigma(r - d) / (2 pi r),
  /// per bin (1/m^2). `of` is the mean over centres, times area / number of details.
  void add(double distance, Eigen::VectorXd& into) const;
  /// Distances from a point of triangle `t` to the details around (m), up to the radius.
  void distances(const DetailMesh& details, int t, const Eigen::Vector3d& barycentric,
                 std::vector<double>& into);
  [[nodiscard]] int bins() const { return static_cast<int>(radius_of_bin_.size()); }
  [[nodiscard]] double reach() const { return reach_; }

 private:
  static bool counts(const DetailMesh& details, int site);

  double reach_ = 0, sigma_ = 0;
  Eigen::VectorXd radius_of_bin_;
  LocalChart chart_;
};

}  // namespace geoprior::details
