#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "models/details/mesh.h"
#include "solvers/details/triplet_builder.h"
#include "solvers/details/triplet_options.h"

namespace geoprior::details {

/// Answer of a query: the corners of the triplet in the order in which its edges fit best.
struct TripletMatch {
  int triplet = 0;
  std::array<int, 3> order{0, 1, 2};  ///< corner of the triplet for corner k of the triangle
  bool mirrored = false;              ///< the triplet is laid on the triangle as in a mirror
  double edge_difference = 0;         ///< L1 distance of the edge lengths (m)
};

/// The set T of the thesis: triangles of three details, sorted into a grid over
/// u = sqrt(area / largest area) and v = smallest angle / 60 degrees, so that a query costs the
/// same for any number of details.
class TripletTable {
 public:
  TripletTable() = default;
  /// @throws Error  for `all` with more than 400 details
  TripletTable(const DetailMesh& original, const TripletOptions& options, std::uint64_t seed);

  /// Closest triplets to a triangle with edges |01|, |12|, |20| (m) among those that hold 1 …
  /// `max_interior` details: cells in growing rings around its keys, one ring beyond the first that
  /// holds any, there by L1 difference of edge lengths over the six permutations of the corners.
  /// @return  up to `count`, best first; empty when no triplet qualifies
  void closest(const std::array<double, 3>& edges, int max_interior, int count,
               std::vector<TripletMatch>& into) const;
  [[nodiscard]] std::span<const TripletInterior> interior(int triplet) const;
  [[nodiscard]] const std::array<int, 3>& corners(int triplet) const;

  [[nodiscard]] int size() const { return static_cast<int>(entry_.size()); }
  [[nodiscard]] std::int64_t met() const { return met_; }  ///< triplets enumerated
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Entry {
    std::array<int, 3> corner;
    std::array<float, 3> edge;    ///< |01| <= |12| <= |20|
    std::int32_t interior_begin;  ///< up to that of the next entry
    bool clockwise;
  };
  void search_cell(int cell, const std::array<double, 3>& sorted, int max_interior, int count,
                   std::vector<TripletMatch>& into) const;

  int cells_ = 0;
  double largest_area_ = 0;
  std::vector<int> cell_begin_;
  std::vector<Entry> entry_;
  std::vector<TripletInterior> interior_;
  std::int64_t met_ = 0;
};

}  // namespace geoprior::details
