#include "baselines/skinning/direct_delta_mush/implicit_smoothing.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <vector>

#include "baselines/skinning/shared/lanes.h"
#include "core/error.h"
#include "models/skinning/surface_diffusion.h"

#pragma GCC diagnostic ignored "-Wpsabi"

namespace geoprior::skinning {
namespace {

/// Columns that are solved together: three registers a row.
constexpr int kWidth = 12;

/// Right-hand sides of one vertex.
struct RowOfTwelve {
  lanes::Double4 a, b, c;
};

[[gnu::always_inline]] inline RowOfTwelve load_row(const double* p) {
  return {lanes::load(p), lanes::load(p + 4), lanes::load(p + 8)};
}

[[gnu::always_inline]] inline void store_row(double* p, const RowOfTwelve& row) {
  lanes::store(p, row.a);
  lanes::store(p + 4, row.b);
  lanes::store(p + 8, row.c);
}

[[gnu::always_inline]] inline RowOfTwelve scaled(double s, const RowOfTwelve& row) {
  const lanes::Double4 factor = lanes::all(s);
  return {factor * row.a, factor * row.b, factor * row.c};
}

/// row + s other
[[gnu::always_inline]] inline RowOfTwelve add_scaled(const RowOfTwelve& row, double s,
                                                     const RowOfTwelve& other) {
  const lanes::Double4 factor = lanes::all(s);
  return {lanes::multiply_add(factor, other.a, row.a), lanes::multiply_add(factor, other.b, row.b),
          lanes::multiply_add(factor, other.c, row.c)};
}

}  // namespace

ImplicitSmoothing::ImplicitSmoothing(const TriMesh& mesh, double length, int steps)
    : ImplicitSmoothing(positive_cotangent_laplacian(mesh), {}, length, steps) {}

ImplicitSmoothing::ImplicitSmoothing(const TriMesh& mesh, const Eigen::VectorXd& mass,
                                     double length, int steps)
    : ImplicitSmoothing(positive_cotangent_laplacian(mesh), mass, length, steps) {}

ImplicitSmoothing::ImplicitSmoothing(const Eigen::SparseMatrix<double>& laplacian,
                                     const Eigen::VectorXd& mass, double length, int steps)
    : steps_(steps) {
  using Sparse = Eigen::SparseMatrix<double>;
  Eigen::VectorXd diagonal = laplacian.diagonal();
  if (mass.size() > 0) diagonal = mass;
  diagonal = (diagonal.array() > 0).select(diagonal, 1.0);
  Sparse system = length * laplacian;
  for (Eigen::Index v = 0; v < diagonal.size(); ++v) system.coeffRef(v, v) += diagonal(v);
  system.makeCompressed();
  const Eigen::SimplicialLLT<Sparse> cholesky(system);
  if (cholesky.info() != Eigen::Success)
    throw Error("the smoothing of the surface has no unique solution", "implicit smoothing");
  factor_ = cholesky.matrixL();
  place_ = cholesky.permutationP().indices();
  if (place_.size() == 0)
    place_.setLinSpaced(diagonal.size(), 0, static_cast<int>(diagonal.size()) - 1);
  diagonal_.resize(diagonal.size());
  for (Eigen::Index v = 0; v < diagonal.size(); ++v) diagonal_(place_(v)) = diagonal(v);
}

/// rows <- (L L')^-1 D rows
void ImplicitSmoothing::solve(double* rows) const {
  const int* begin = factor_.outerIndexPtr();
  const int* index = factor_.innerIndexPtr();
  const double* value = factor_.valuePtr();
  const auto row = [rows](int i) { return rows + static_cast<std::ptrdiff_t>(kWidth) * i; };
  const auto n = static_cast<int>(factor_.cols());
  for (int j = 0; j < n; ++j) store_row(row(j), scaled(diagonal_(j), load_row(row(j))));
  for (int j = 0; j < n; ++j) {
    const RowOfTwelve x = scaled(1 / value[begin[j]], load_row(row(j)));
    store_row(row(j), x);
    for (int e = begin[j] + 1; e < begin[j + 1]; ++e)
      store_row(row(index[e]), add_scaled(load_row(row(index[e])), -value[e], x));
  }
  for (int j = n - 1; j >= 0; --j) {
    RowOfTwelve x = load_row(row(j));
    for (int e = begin[j] + 1; e < begin[j + 1]; ++e)
      x = add_scaled(x, -value[e], load_row(row(index[e])));
    store_row(row(j), scaled(1 / value[begin[j]], x));
  }
}

void ImplicitSmoothing::apply(
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>& values) const {
  std::vector<double> rows(static_cast<std::size_t>(values.rows()) * kWidth, 0.0);
  for (Eigen::Index first = 0; first < values.cols(); first += kWidth) {
    const Eigen::Index count = std::min<Eigen::Index>(kWidth, values.cols() - first);
    for (Eigen::Index v = 0; v < values.rows(); ++v) {
      double* row = rows.data() + static_cast<std::ptrdiff_t>(kWidth) * place_(v);
      for (Eigen::Index c = 0; c < count; ++c) row[c] = values(v, first + c);
    }
    for (int step = 0; step < steps_; ++step) solve(rows.data());
    for (Eigen::Index v = 0; v < values.rows(); ++v) {
      const double* row = rows.data() + static_cast<std::ptrdiff_t>(kWidth) * place_(v);
      for (Eigen::Index c = 0; c < count; ++c) values(v, first + c) = row[c];
    }
  }
}

}  // namespace geoprior::skinning
