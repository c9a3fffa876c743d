#include "baselines/skinning/centers_of_rotation/integral.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "baselines/skinning/shared/influences.h"
#include "baselines/skinning/shared/lanes.h"
#include "core/error.h"
#include "core/parallel.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior::skinning {
namespace {

using lanes::Double4;
using JointPair = std::pair<int, int>;

/// Pieces of the surface that two joints share: weights a and b, area times a b, centroid. Those of
/// one cell of weights are taken together at their mean.
class SharedPieces {
 public:
  std::vector<double> a, b, share, x, y, z;

  /// @param cell  width of the cells; 0 keeps every piece
  void add(double weight_a, double weight_b, double area, const Eigen::Vector3d& centroid,
           double cell) {
    const double s = area * weight_a * weight_b;
    const std::size_t i = index_of(weight_a, weight_b, cell);
    share[i] += s;
    a[i] += s * weight_a;
    b[i] += s * weight_b;
    x[i] += s * centroid.x();
    y[i] += s * centroid.y();
    z[i] += s * centroid.z();
  }

  /// Sums become means; the number of entries a multiple of four.
  void finish() {
    for (std::size_t i = 0; i < share.size(); ++i) {
      if (!(share[i] > 0)) continue;
      for (std::vector<double>* mean : {&a, &b, &x, &y, &z}) (*mean)[i] /= share[i];
    }
    while (share.size() % 4 != 0) append();
  }

 private:
  std::size_t append() {
    for (std::vector<double>* values : {&a, &b, &share, &x, &y, &z}) values->push_back(0);
    return share.size() - 1;
  }

  std::size_t index_of(double weight_a, double weight_b, double cell) {
    if (!(cell > 0)) return append();
    const auto number = [cell](double w) { return static_cast<std::uint64_t>(w / cell); };
    const auto [at, is_new] =
        cells_.try_emplace((number(weight_a) << 32U) | number(weight_b), share.size());
    return is_new ? append() : at->second;
  }

  std::unordered_map<std::uint64_t, std::size_t> cells_;
};

using PiecesOfPairs = std::map<JointPair, SharedPieces>;

/// Weights of a triangle's corners for the joints that act on it: one row a joint.
struct TriangleWeights {
  std::vector<int> joints;
  Eigen::Matrix<double, Eigen::Dynamic, 3> of_corner;
};

TriangleWeights weights_of(const RiggedMesh& rig, Eigen::Index triangle) {
  TriangleWeights result;
  for (int corner = 0; corner < 3; ++corner) {
    for (SkinWeights::InnerIterator w(rig.weights, rig.mesh.F(triangle, corner)); w; ++w)
      if (w.value() > 0) result.joints.push_back(static_cast<int>(w.col()));
  }
  std::sort(result.joints.begin(), result.joints.end());
  result.joints.erase(std::unique(result.joints.begin(), result.joints.end()), result.joints.end());
  result.of_corner.setZero(result.joints.size(), 3);
  for (int corner = 0; corner < 3; ++corner) {
    for (SkinWeights::InnerIterator w(rig.weights, rig.mesh.F(triangle, corner)); w; ++w) {
      const auto joint = std::lower_bound(result.joints.begin(), result.joints.end(), w.col());
      if (w.value() > 0) result.of_corner(joint - result.joints.begin(), corner) = w.value();
    }
  }
  return result;
}

/// Calls `visit(barycentric)` for the centroids of the k^2 equal pieces of a triangle.
template <class Visit>
void for_pieces(int k, const Visit& visit) {
  const auto at = [k](double i, double j) {
    return Eigen::Vector3d(i / k, j / k, 1 - (i + j) / k);
  };
  for (int i = 0; i < k; ++i) {
    for (int j = 0; i + j < k; ++j) {
      visit(at(i + 1.0 / 3, j + 1.0 / 3));
      if (i + j + 1 < k) visit(at(i + 2.0 / 3, j + 2.0 / 3));
    }
  }
}

/// Pieces along an edge so that no weight changes by more than `step` over one.
int pieces_along_an_edge(const TriangleWeights& weights, double step) {
  const Eigen::VectorXd change =
      weights.of_corner.rowwise().maxCoeff() - weights.of_corner.rowwise().minCoeff();
  return std::max(1, static_cast<int>(std::ceil(change.maxCoeff() / step - 1e-9)));
}

PiecesOfPairs pieces_by_pair(const RiggedMesh& rig, const CentersOfRotationOptions& options) {
  PiecesOfPairs pairs;
  for (Eigen::Index t = 0; t < rig.mesh.F.rows(); ++t) {
    const TriangleWeights weights = weights_of(rig, t);
    if (weights.joints.size() < 2) continue;
    Eigen::Matrix3d corners;
    for (int c = 0; c < 3; ++c) corners.col(c) = rig.mesh.V.row(rig.mesh.F(t, c));
    const double area =
        (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0)).norm() / 2;
    const int k = pieces_along_an_edge(weights, options.weight_step);
    for_pieces(k, [&](const Eigen::Vector3d& barycentric) {
      const Eigen::VectorXd w = weights.of_corner * barycentric;
      for (Eigen::Index a = 0; a < w.size(); ++a) {
        for (Eigen::Index b = a + 1; b < w.size(); ++b) {
          if (!(w(a) * w(b) > 0)) continue;
          pairs[{weights.joints[a], weights.joints[b]}].add(
              w(a), w(b), area / (k * k), corners * barycentric, options.weight_cell);
        }
      }
    });
  }
  for (auto& [pair, pieces] : pairs) pieces.finish();
  return pairs;
}

/// exp(x) for x <= 0, to 2e-15 of the value; 0 below -700. x = n log 2 + r, |r| <= log(2) / 2, and
/// exp(r) by its series.
[[gnu::always_inline]] inline Double4 exp_of_negative(const Double4& x) {
  using Long4 [[gnu::vector_size(32)]] = long long;
  constexpr double kLog2High = 6.93147180369123816490e-01, kLog2Low = 1.90821492927058770002e-10;
  // Added and taken away, it rounds to integers, which stay in the low bits.
  const Double4 magic = lanes::all(6755399441055744.0);
  const Double4 bounded = x < -700.0 ? lanes::all(-700.0) : x;
  const Double4 shifted = lanes::multiply_add(bounded, lanes::all(1.4426950408889634), magic);
  const Double4 n = shifted - magic;
  const Double4 r = (bounded - n * kLog2High) - n * kLog2Low;
  Double4 sum = lanes::all(1.0 / 479001600);
  constexpr double kInverseFactorials[] = {1.0 / 39916800, 1.0 / 3628800, 1.0 / 362880, 1.0 / 40320,
                                           1.0 / 5040,     1.0 / 720,     1.0 / 120,    1.0 / 24,
                                           1.0 / 6,        0.5,           1.0,          1.0};
  for (const double c : kInverseFactorials) sum = lanes::multiply_add(sum, r, lanes::all(c));
  const Long4 power = (std::bit_cast<Long4>(shifted) + 1023) << 52;
  return x < -700.0 ? lanes::all(0) : sum * std::bit_cast<Double4>(power);
}

/// Integrals of s and of s x over the pieces of one pair of joints.
struct Moments {
  Double4 mass = lanes::all(0), x = lanes::all(0), y = lanes::all(0), z = lanes::all(0);
};

/// Adds the terms of one pair of joints, whose weights at the vertex are a and b.
void add_pair(const SharedPieces& pieces, double a, double b, double sigma, Moments& moments) {
  Moments sum;
  const Double4 inverse = lanes::all(1 / sigma);
  for (std::size_t t = 0; t < pieces.a.size(); t += 4) {
    const Double4 difference =
        (lanes::all(a) * lanes::load(&pieces.b[t]) - lanes::all(b) * lanes::load(&pieces.a[t])) *
        inverse;
    const Double4 s = lanes::load(&pieces.share[t]) * exp_of_negative(-difference * difference);
    sum.mass += s;
    sum.x = lanes::multiply_add(s, lanes::load(&pieces.x[t]), sum.x);
    sum.y = lanes::multiply_add(s, lanes::load(&pieces.y[t]), sum.y);
    sum.z = lanes::multiply_add(s, lanes::load(&pieces.z[t]), sum.z);
  }
  const Double4 weight = lanes::all(a * b);
  moments.mass += weight * sum.mass;
  moments.x += weight * sum.x;
  moments.y += weight * sum.y;
  moments.z += weight * sum.z;
}

double total(const Double4& x) { return (x[0] + x[1]) + (x[2] + x[3]); }

Eigen::Vector3d center_of(int vertex, const RiggedMesh& rig, const PiecesOfPairs& pairs,
                          double sigma) {
  Moments moments;
  for (SkinWeights::InnerIterator j(rig.weights, vertex); j; ++j) {
    for (SkinWeights::InnerIterator k(rig.weights, vertex); k; ++k) {
      if (k.col() <= j.col() || !(j.value() * k.value() > 0)) continue;
      const auto pieces = pairs.find({static_cast<int>(j.col()), static_cast<int>(k.col())});
      if (pieces == pairs.end()) continue;
      add_pair(pieces->second, j.value(), k.value(), sigma, moments);
    }
  }
  const double mass = total(moments.mass);
  if (!(mass > 0)) return rig.mesh.V.row(vertex);
  return Eigen::Vector3d(total(moments.x), total(moments.y), total(moments.z)) / mass;
}

void check_options(const CentersOfRotationOptions& options) {
  if (!(options.similarity_width > 0 && std::isfinite(options.similarity_width)))
    throw Error("similarity_width of centers of rotation is not positive", "", "> 0");
  if (!(options.weight_step >= 0.01 && options.weight_step <= 1))
    throw Error("weight_step of centers of rotation is out of range", "", "0.01 to 1");
  if (!(options.weight_cell >= 0 && options.weight_cell <= 0.1))
    throw Error("weight_cell of centers of rotation is out of range", "", "0 to 0.1");
}

}  // namespace

void describe(OptionVisitor& v, CentersOfRotationOptions& options) {
  v.value(
      "similarity_width", options.similarity_width,
      {.doc = "sigma: how different the weights of similar places may be", .min = 1e-3, .max = 10});
  v.value("weight_step", options.weight_step,
          {.doc = "largest change of a weight over a piece of a triangle in the integral",
           .min = 0.01,
           .max = 1});
  v.value("weight_cell", options.weight_cell,
          {.doc = "width of a cell of weights whose pieces are taken together; 0: none are",
           .min = 0,
           .max = 0.1});
}

double weight_similarity(const Eigen::VectorXd& a, const Eigen::VectorXd& b, double sigma) {
  if (a.size() != b.size())
    throw Error("weights of different numbers of joints", "weight similarity", "equal numbers");
  if (!(sigma > 0)) throw Error("sigma is not positive", "weight similarity", "> 0");
  double sum = 0;
  for (Eigen::Index j = 0; j < a.size(); ++j) {
    for (Eigen::Index k = 0; k < a.size(); ++k) {
      if (j == k) continue;
      const double difference = (a(j) * b(k) - a(k) * b(j)) / sigma;
      sum += a(j) * a(k) * b(j) * b(k) * std::exp(-difference * difference);
    }
  }
  return sum;
}

Eigen::MatrixX3d centers_of_rotation(const RiggedMesh& rig,
                                     const CentersOfRotationOptions& options) {
  check_options(options);
  require_skinnable(rig);
  const PiecesOfPairs pairs = pieces_by_pair(rig, options);
  Eigen::MatrixX3d centers(rig.mesh.vertex_count(), 3);
  parallel_blocks(centers.rows(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      centers.row(v) = center_of(static_cast<int>(v), rig, pairs, options.similarity_width);
  });
  return centers;
}

}  // namespace geoprior::skinning
