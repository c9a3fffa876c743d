#include "models/sketch/rigid_layout.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "models/sketch/anderson_mixing.h"

namespace geoprior::sketch {
namespace {

using SparseReal = Eigen::SparseMatrix<double>;

/// Half of a cotangent is not below this: a wide angle would push its edge apart.
constexpr double kLeastWeight = -1;

std::array<double, 3> edge_weights(const FlatTriangle& t) {
  std::array<double, 3> w{};
  for (std::size_t k = 0; k < 3; ++k) w[k] = std::max(t.cot[k] / 2, kLeastWeight);
  return w;
}

}  // namespace

struct RigidLayout::Impl {
  std::span<const FlatTriangle> triangles;
  const Eigen::MatrixX3i& F;
  int n = 0;
  double area = 0;
  std::vector<std::array<double, 3>> weight;
  Eigen::SimplicialLDLT<SparseReal> factor;

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
  factor.compute(matrix);
  if (factor.info() != Eigen::Success) {
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
  return to_complex(factor.solve(right));
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

RigidLayoutReport RigidLayout::improve(Eigen::VectorXcd& z,
                                       const RigidLayoutOptions& options) const {
  using Reals = Eigen::Map<const Eigen::VectorXd>;
  const auto reals = [](const Eigen::VectorXcd& c) {
    return Reals(reinterpret_cast<const double*>(c.data()), 2 * c.size());
  };
  AndersonMixing mixing(options.mixing);
  std::vector<Complex> turns;
  Eigen::VectorXcd image = z;  // of the last plain step: what is fallen back to
  RigidLayoutReport report{0, impl_->turn(z, turns)};
  while (report.iterations < options.iterations &&
         report.energy > options.least_energy * impl_->area) {
    ++report.iterations;
    image = impl_->place(turns);
    const Eigen::VectorXd mixed = mixing.next(reals(z), reals(image));
    z = Eigen::Map<const Eigen::VectorXcd>(reinterpret_cast<const Complex*>(mixed.data()),
                                           z.size());
    double energy = impl_->turn(z, turns);
    if (!(energy <= report.energy)) {
      mixing.restart();
      z = image;
      energy = impl_->turn(z, turns);
    }
    const double change = report.energy - energy;
    report.energy = energy;
    if (std::abs(change) <= options.tolerance * energy) break;
  }
  return report;
}

}  // namespace geoprior::sketch
