#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "models/details/mesh.h"
#include "solvers/details/local_chart.h"
#include "solvers/details/triplet_options.h"

namespace geoprior::details {

/// Area and smallest angle of a triangle with edges |01|, |12|, |20|: the keys of the table.
struct TriangleKeys {
  double area = 0;
  double least_angle = 0;  ///< rad
};
TriangleKeys keys_of(const std::array<double, 3>& edges);

/// A detail inside a triplet.
struct TripletInterior {
  int detail = 0;
  std::array<float, 2> first_two{};  ///< of its barycentric coordinates; the third makes 1
  [[nodiscard]] Eigen::Vector3d barycentric() const {
    const double a = first_two[0], b = first_two[1];
    return {a, b, 1 - a - b};
  }
};

/// Most details inside a triplet: larger ones are left out. Chosen: with R = 3 mean edges few have
/// more.
inline constexpr int kMostInside = 8;

/// A triplet that qualifies, before the table decides whether to keep it.
struct FoundTriplet {
  std::array<int, 3> corner{};
  std::array<float, 3> edge{};  ///< |01| <= |12| <= |20|
  bool clockwise = false;       ///< corners, seen from outside
  int cell = 0;
  std::vector<TripletInterior> interior;
};

/// Enumerates the triplets whose smallest-numbered detail is a given one, in the chart around it.
class TripletSearch {
 public:
  TripletSearch(const DetailMesh& original, const TripletOptions& options, double mean_edge);

  /// Appends the triplets of `source` that qualify; `met` counts all.
  void around(int source, std::vector<FoundTriplet>& into, std::int64_t& met);
  [[nodiscard]] double largest_area() const { return largest_area_; }

 private:
  bool collect_interior(const std::array<std::size_t, 3>& corner, FoundTriplet& triplet) const;

  const DetailMesh& original_;
  TripletOptions options_;
  double reach_ = 0;         ///< longest edge (m)
  double largest_area_ = 0;  ///< u = 1
  LocalChart chart_;
  std::vector<ChartPoint> points_;  ///< details of the chart
};

/// Corners of a triangle with edges |01|, |12|, |20| in the order in which its edges are sorted:
/// the shortest joins the first two, the longest the last and the first.
std::array<std::size_t, 3> corners_by_edges(const std::array<double, 3>& edges);

/// Cell of the grid for a triangle; clamped to its rim.
std::array<int, 2> triplet_cell(const TriangleKeys& keys, double largest_area, int cells);

}  // namespace geoprior::details
