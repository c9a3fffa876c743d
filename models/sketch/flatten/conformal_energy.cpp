#include "models/sketch/flatten/conformal_energy.h"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/topology.h"

namespace geoprior::sketch {
namespace {

using SparseComplex = Eigen::SparseMatrix<Complex>;
using ComplexFactor = Eigen::SimplicialLDLT<SparseComplex>;

/// Makes the constant maps cost something, in units of the border's lumped lengths.
constexpr double kConstantShift = 1e-8;
constexpr int kMostInverseSteps = 30;
constexpr double kMapSettled = 1e-9;  ///< change of the eigenvector in a step

class ConformalAssembly {
 public:
  ConformalAssembly(const Eigen::MatrixX3i& F, int vertex_count) : F_(F), n_(vertex_count) {
    entries_.reserve(9 * F.rows());
  }

  void add(int t, const std::array<double, 3>& cot) {
    for (int k = 0; k < 3; ++k) {
      const int a = F_(t, k), b = F_(t, (k + 1) % 3);
      const double weight = cot[k] / 4;
      entries_.emplace_back(a, a, weight);
      entries_.emplace_back(b, b, weight);
      // -area: -conj(a) b / 4i + a conj(b) / 4i
      const Complex at_ab(-weight, 0.25);
      if (a > b) {
        entries_.emplace_back(a, b, at_ab);
      } else {
        entries_.emplace_back(b, a, std::conj(at_ab));
      }
    }
  }

  [[nodiscard]] SparseComplex matrix() const {
    SparseComplex energy(n_, n_);
    energy.setFromTriplets(entries_.begin(), entries_.end());
    return energy;
  }

 private:
  const Eigen::MatrixX3i& F_;
  int n_;
  std::vector<Eigen::Triplet<Complex>> entries_;
};

void factorise_conformal(ComplexFactor& factor, const SparseComplex& matrix) {
  factor.compute(matrix);
  if (factor.info() != Eigen::Success) {
    throw Error("the conformal energy cannot be factorised", "flattening",
                "a connected piece with a border");
  }
}

/// Half the length of the border beside each vertex.
Eigen::VectorXd lumped_border(const TriMesh& mesh) {
  Eigen::VectorXd lumped = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (const Edge& edge : boundary_edges(mesh.F)) {
    const double half = (mesh.V.row(edge[1]) - mesh.V.row(edge[0])).norm() / 2;
    lumped(edge[0]) += half;
    lumped(edge[1]) += half;
  }
  return lumped;
}

void project_out_constant(const Eigen::VectorXd& lumped, Eigen::VectorXcd& z) {
  z.array() -= lumped.cast<Complex>().dot(z) / lumped.sum();
}

void normalise_border(const Eigen::VectorXd& lumped, Eigen::VectorXcd& z) {
  z /= std::sqrt(lumped.dot(z.cwiseAbs2()));
}

/// Any map without symmetry will do; this one spreads the vertices evenly in a fixed order.
Eigen::VectorXcd scattered_guess(Eigen::Index n) {
  Eigen::VectorXcd z(n);
  for (Eigen::Index i = 0; i < n; ++i)
    z(i) = std::polar(1.0, std::numbers::phi * static_cast<double>(i * i % 65521));
  return z;
}

}  // namespace

SparseComplex conformal_energy(const Eigen::MatrixX3i& F,
                               std::span<const std::array<double, 3>> cot, int vertex_count) {
  ConformalAssembly assembly(F, vertex_count);
  for (int t = 0; t < F.rows(); ++t) assembly.add(t, cot[t]);
  return assembly.matrix();
}

SparseComplex conformal_energy(const Eigen::MatrixX3i& F, std::span<const FlatTriangle> triangles,
                               int vertex_count) {
  ConformalAssembly assembly(F, vertex_count);
  for (int t = 0; t < F.rows(); ++t) assembly.add(t, triangles[t].cot);
  return assembly.matrix();
}

Eigen::VectorXcd pinned_conformal_map(const SparseComplex& energy, std::array<int, 2> pins,
                                      std::array<Complex, 2> places) {
  if (pins[0] == pins[1]) {
    throw Error("both pins are at one vertex", "vertex " + std::to_string(pins[0]), "two vertices");
  }
  const Eigen::Index n = energy.rows();
  Eigen::VectorXcd z = Eigen::VectorXcd::Zero(n);
  std::vector<int> unknown(n, 0);
  for (std::size_t i = 0; i < 2; ++i) {
    z(pins[i]) = places[i];
    unknown[pins[i]] = -1;
  }
  int count = 0;
  for (int& u : unknown) {
    if (u == 0) u = count++;
  }
  Eigen::VectorXcd right(count);
  const Eigen::VectorXcd pull = energy.selfadjointView<Eigen::Lower>() * z;
  std::vector<Eigen::Triplet<Complex>> entries;
  entries.reserve(energy.nonZeros());
  for (Eigen::Index column = 0; column < n; ++column) {
    if (unknown[column] >= 0) right(unknown[column]) = -pull(column);
    for (SparseComplex::InnerIterator it(energy, column); it; ++it) {
      if (unknown[it.row()] >= 0 && unknown[column] >= 0)
        entries.emplace_back(unknown[it.row()], unknown[column], it.value());
    }
  }
  SparseComplex reduced(count, count);
  reduced.setFromTriplets(entries.begin(), entries.end());
  ComplexFactor factor;
  factorise_conformal(factor, reduced);
  const Eigen::VectorXcd solved = factor.solve(right);
  for (Eigen::Index v = 0; v < n; ++v) {
    if (unknown[v] >= 0) z(v) = solved(unknown[v]);
  }
  return z;
}

Eigen::VectorXcd spectral_conformal_map(const TriMesh& mesh, const SparseComplex& energy) {
  const Eigen::VectorXd lumped = lumped_border(mesh);
  if (!(lumped.sum() > 0)) throw Error("surface has no border", "flattening", "a disc");
  SparseComplex shifted = energy;
  shifted.diagonal() += kConstantShift * lumped / lumped.maxCoeff();
  ComplexFactor factor;
  factorise_conformal(factor, shifted);
  Eigen::VectorXcd z = scattered_guess(energy.rows());
  for (int step = 0; step < kMostInverseSteps; ++step) {
    project_out_constant(lumped, z);
    normalise_border(lumped, z);
    const Eigen::VectorXcd right = lumped.cast<Complex>().cwiseProduct(z);
    Eigen::VectorXcd next = factor.solve(right);
    project_out_constant(lumped, next);
    normalise_border(lumped, next);
    const double aligned = std::abs(lumped.cast<Complex>().cwiseProduct(next).dot(z));
    z = next;
    if (1 - aligned < kMapSettled) break;
  }
  return z;
}

}  // namespace geoprior::sketch
