#include "models/sketch/flatten/rigid_layout.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "core/numerics/sparse_ldlt.h"
#include "models/sketch/flatten/anderson_mixing.h"

namespace geoprior::sketch {
namespace {

using SparseReal = Eigen::SparseMatrix<double>;

/// Half of a cotangent is not below this: a wide angle would push its edge apart.
constexpr double kLeastWeight = -1;
/// Share by which a length may change between two linearisations.
constexpr double kLengthStep = 0.02;
/// Steps between two linearisations, and the change of energy at which fewer are enough.
constexpr int kStepsARound = 12;
constexpr double kCoarse = 1e-4;

std::array<double, 3> edge_weights(const FlatTriangle& t) {
  std::array<double, 3> w{};
  for (std::size_t k = 0; k < 3; ++k) w[k] = std::max(t.cot[k] / 2, kLeastWeight);
  return w;
}

double chain_length(const KeptLength& chain, const Eigen::VectorXcd& z) {
  double sum = 0;
  for (std::size_t i = 1; i < chain.vertices.size(); ++i)
    sum += std::abs(z(chain.vertices[i]) - z(chain.vertices[i - 1]));
  return sum;
}

double worst_length(std::span<const KeptLength> kept, const Eigen::VectorXcd& z) {
  double worst = 0;
  for (const KeptLength& chain : kept)
    worst = std::max(worst, std::abs(chain_length(chain, z) - chain.length) / chain.length);
  return worst;
}

/// The lengths that are asked for, or as near to them as one linearisation may go.
std::vector<KeptLength> lengths_on_the_way(std::span<const KeptLength> kept,
                                           const Eigen::VectorXcd& z) {
  std::vector<KeptLength> nearer(kept.begin(), kept.end());
  for (KeptLength& chain : nearer) {
    const double now = chain_length(chain, z);
    chain.length = std::clamp(chain.length, now * (1 - kLengthStep), now * (1 + kLengthStep));
  }
  return nearer;
}

/// The correction of least energy that meets the lengths of chains: z += K^-1 A' (A K^-1 A')^-1
/// (l - l(z)), K the matrix of the energy and A the derivative of l at the places this is made at.
/// Elsewhere it is a chord of Newton's method. l itself is never linearised: a chain that is to be
/// shorter would crumple, since u_e (z_b - z_a) falls when an edge turns away from u_e.
class LengthRows {
 public:
  LengthRows(std::span<const KeptLength> kept, const Eigen::VectorXcd& z, const SparseLdlt& factor)
      : kept_(kept), answer_(z.size(), kept.size()) {
    Eigen::MatrixXcd rows = Eigen::MatrixXcd::Zero(z.size(), answer_.cols());
    for (Eigen::Index c = 0; c < rows.cols(); ++c) {
      const std::vector<int>& chain = kept[c].vertices;
      for (std::size_t i = 1; i < chain.size(); ++i) {
        const Complex edge = z(chain[i]) - z(chain[i - 1]);
        const Complex direction = std::abs(edge) > 0 ? edge / std::abs(edge) : Complex(0);
        rows(chain[i], c) += direction;
        rows(chain[i - 1], c) -= direction;
      }
      Eigen::MatrixX2d parts(z.size(), 2);
      parts << rows.col(c).real(), rows.col(c).imag();
      answer_.col(c) = to_complex(factor.solve_columns(parts));
    }
    inverse_.compute((rows.adjoint() * answer_).real());
  }

  void meet(Eigen::VectorXcd& z) const {
    Eigen::VectorXd missing(answer_.cols());
    for (int correction = 0; correction < kCorrections; ++correction) {
      for (Eigen::Index c = 0; c < missing.size(); ++c)
        missing(c) = kept_[c].length - chain_length(kept_[c], z);
      z += answer_ * inverse_.solve(missing);
    }
  }

 private:
  static constexpr int kCorrections = 2;
  std::span<const KeptLength> kept_;
  Eigen::MatrixXcd answer_;  ///< K^-1 A', x and y as a complex number
  /// Rows may depend on each other.
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> inverse_;
};

}  // namespace

struct RigidLayout::Impl {
  std::span<const FlatTriangle> triangles;
  const Eigen::MatrixX3i& F;
  int n = 0;
  double area = 0;
  std::vector<std::array<double, 3>> weight;
  SparseLdlt factor;

  Impl(std::span<const FlatTriangle> flat, const Eigen::MatrixX3i& faces, int vertex_count)
      : triangles(flat), F(faces), n(vertex_count) {
    for (const FlatTriangle& t : triangles) {
      weight.push_back(edge_weights(t));
      area += t.area;
    }
    factorise();
  }

  void factorise();
  [[nodiscard]] double turn(const Eigen::VectorXcd& z, std::vector<Complex>& turns) const;
  [[nodiscard]] Eigen::VectorXcd place(const std::vector<Complex>& turns) const;
  /// Local and global steps until the energy stays; every step meets the rows, if there are any.
  void descend(Eigen::VectorXcd& z, const RigidLayoutOptions& options, const LengthRows* rows,
               RigidLayoutReport& report) const;
};

/// Holding vertex 0 by a spring at the origin removes the translations and changes nothing else:
/// the right side sums to zero, so the spring carries no force.
void RigidLayout::Impl::factorise() {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(triangles.size() * 9 + 1);
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = F(t, k), b = F(t, (k + 1) % 3);
      const double w = weight[t][k];
      entries.emplace_back(a, a, w);
      entries.emplace_back(b, b, w);
      entries.emplace_back(std::max(a, b), std::min(a, b), -w);
    }
  }
  entries.emplace_back(0, 0, 1.0);
  SparseReal matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor = SparseLdlt(matrix);
  if (!factor.succeeded()) {
    throw Error("the weights of the edges cannot be factorised", "flattening",
                "a connected piece without loose vertices");
  }
}

/// Local step; the energy with the turns that it finds.
double RigidLayout::Impl::turn(const Eigen::VectorXcd& z, std::vector<Complex>& turns) const {
  double energy = 0;
  turns.resize(triangles.size());
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const std::array<Complex, 3> corner{z(F(t, 0)), z(F(t, 1)), z(F(t, 2))};
    const std::array<Complex, 3> image{corner[1] - corner[0], corner[2] - corner[1],
                                       corner[0] - corner[2]};
    Complex s = 0;
    for (std::size_t k = 0; k < 3; ++k)
      s += weight[t][k] * std::conj(triangles[t].edge[k]) * image[k];
    const double size = std::abs(s);
    turns[t] = size > 0 ? s / size : Complex(1);
    for (std::size_t k = 0; k < 3; ++k)
      energy += weight[t][k] * std::norm(image[k] - turns[t] * triangles[t].edge[k]);
  }
  return energy / 2;
}

/// Global step.
Eigen::VectorXcd RigidLayout::Impl::place(const std::vector<Complex>& turns) const {
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Complex pull = weight[t][k] * turns[t] * triangles[t].edge[k];
      const int a = F(t, k), b = F(t, (k + 1) % 3);
      right(a, 0) -= pull.real();
      right(a, 1) -= pull.imag();
      right(b, 0) += pull.real();
      right(b, 1) += pull.imag();
    }
  }
  return to_complex(factor.solve_columns(right));
}

RigidLayout::RigidLayout(std::span<const FlatTriangle> triangles, const Eigen::MatrixX3i& F,
                         int vertex_count)
    : impl_(std::make_unique<Impl>(triangles, F, vertex_count)) {}
RigidLayout::~RigidLayout() = default;
RigidLayout::RigidLayout(RigidLayout&&) noexcept = default;
RigidLayout& RigidLayout::operator=(RigidLayout&&) noexcept = default;

double RigidLayout::energy(const Eigen::VectorXcd& z) const {
  std::vector<Complex> turns;
  return impl_->turn(z, turns);
}

void RigidLayout::Impl::descend(Eigen::VectorXcd& z, const RigidLayoutOptions& options,
                                const LengthRows* rows, RigidLayoutReport& report) const {
  using Reals = Eigen::Map<const Eigen::VectorXd>;
  const auto reals = [](const Eigen::VectorXcd& c) {
    return Reals(reinterpret_cast<const double*>(c.data()), 2 * c.size());
  };
  AndersonMixing mixing(options.mixing);
  std::vector<Complex> turns;
  Eigen::VectorXcd image = z;  // of the last plain step: what is fallen back to
  report.energy = turn(z, turns);
  for (int step = 0; step < options.iterations && report.energy > options.least_energy * area;
       ++step) {
    ++report.iterations;
    image = place(turns);
    if (rows != nullptr) rows->meet(image);
    const Eigen::VectorXcd before = z;
    const Eigen::VectorXd mixed = mixing.next(reals(z), reals(image));
    z = Eigen::Map<const Eigen::VectorXcd>(reinterpret_cast<const Complex*>(mixed.data()),
                                           z.size());
    if (rows != nullptr) rows->meet(z);
    double energy = turn(z, turns);
    if (!(energy <= report.energy)) {
      mixing.restart();
      z = image;
      energy = turn(z, turns);
    }
    if (rows != nullptr && !(energy <= report.energy)) {  // directions are too old
      z = before;
      break;
    }
    const double change = report.energy - energy;
    report.energy = energy;
    if (std::abs(change) <= options.tolerance * energy) break;
  }
}

RigidLayoutReport RigidLayout::improve(Eigen::VectorXcd& z,
                                       const RigidLayoutOptions& options) const {
  RigidLayoutReport report;
  impl_->descend(z, options, nullptr, report);
  return report;
}

RigidLayoutReport RigidLayout::hold(Eigen::VectorXcd& z, std::span<const KeptLength> kept,
                                    const RigidLayoutOptions& options) const {
  RigidLayoutReport report{0, energy(z), worst_length(kept, z)};
  RigidLayoutOptions coarse = options;
  coarse.iterations = std::min(coarse.iterations, kStepsARound);
  coarse.tolerance = std::max(coarse.tolerance, kCoarse);
  for (int round = 0;
       round < options.length_rounds && report.length_error > options.length_tolerance; ++round) {
    Eigen::VectorXcd next = z;
    RigidLayoutReport tried = report;
    const std::vector<KeptLength> nearer = lengths_on_the_way(kept, z);
    const LengthRows rows(nearer, z, impl_->factor);
    rows.meet(next);
    impl_->descend(next, coarse, &rows, tried);
    tried.length_error = worst_length(kept, next);
    if (!(tried.length_error < report.length_error)) break;
    z = next;
    report = tried;
  }
  return report;
}

}  // namespace geoprior::sketch
