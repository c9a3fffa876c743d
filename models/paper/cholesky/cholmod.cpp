#include "models/paper/cholesky/cholmod.h"

#include <cholmod.h>

#include <cmath>
#include <cstring>
#include <mutex>

#include "core/error.h"

extern "C" {
void openblas_set_num_threads(int threads);
// CHOLMOD's own loops use OpenMP where it was built so; the symbol is absent otherwise.
__attribute__((weak)) void omp_set_max_active_levels(int levels);
}

namespace geoprior::paper {
namespace {

/// One thread in BLAS and CHOLMOD: their results depend on the number, and TBB has the cores.
void force_one_thread() {
  static std::once_flag once;
  std::call_once(once, [] { openblas_set_num_threads(1); });
  if (omp_set_max_active_levels != nullptr) omp_set_max_active_levels(0);
}

/// A CHOLMOD workspace and what was allocated in it.
class Common {
 public:
  Common() {
    force_one_thread();
    cholmod_start(&common_);
    common_.print = 0;
    common_.error_handler = nullptr;
    common_.quick_return_if_not_posdef = 1;
  }
  ~Common() { cholmod_finish(&common_); }
  Common(const Common&) = delete;
  Common& operator=(const Common&) = delete;
  cholmod_common* get() { return &common_; }
  cholmod_common* operator->() { return &common_; }

 private:
  cholmod_common common_{};
};

cholmod_sparse view(int n, int* outer, int* inner, double* values, int stype) {
  cholmod_sparse s{};
  s.nrow = s.ncol = static_cast<std::size_t>(n);
  s.nzmax = outer[n];
  s.p = outer;
  s.i = inner;
  s.x = values;
  s.stype = stype;
  s.itype = CHOLMOD_INT;
  s.xtype = values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
  s.dtype = CHOLMOD_DOUBLE;
  s.sorted = 0;
  s.packed = 1;
  return s;
}

class CholmodCholesky final : public SparseCholesky {
 public:
  explicit CholmodCholesky(const BlockMatrix& matrix) {
    if (matrix.triangle() != BlockMatrix::Triangle::lower) {
      throw Error("the upper triangle is stored", "CHOLMOD", "lower");
    }
    common_->nmethods = 1;
    common_->method[0].ordering = CHOLMOD_NATURAL;
    common_->postorder = 0;
    common_->supernodal = CHOLMOD_SUPERNODAL;
    cholmod_sparse a = scalar(matrix);
    factor_ = cholmod_analyze(&a, common_.get());
    if (factor_ == nullptr) throw Error("CHOLMOD could not analyse the system");
  }
  ~CholmodCholesky() override {
    cholmod_free_dense(&solution_, common_.get());
    cholmod_free_dense(&work_y_, common_.get());
    cholmod_free_dense(&work_e_, common_.get());
    cholmod_free_factor(&factor_, common_.get());
  }
  CholmodCholesky(const CholmodCholesky&) = delete;
  CholmodCholesky& operator=(const CholmodCholesky&) = delete;

  bool factorise(const BlockMatrix& matrix) override {
    force_one_thread();
    cholmod_sparse a = scalar(matrix);
    cholmod_factorize(&a, factor_, common_.get());
    return common_->status == CHOLMOD_OK && factor_->minor == factor_->n && pivots_are_finite();
  }

  void solve(Eigen::VectorXd& b) override {
    cholmod_dense right{};
    right.nrow = right.nzmax = right.d = static_cast<std::size_t>(b.size());
    right.ncol = 1;
    right.x = b.data();
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    if (cholmod_solve2(CHOLMOD_A, factor_, &right, nullptr, &solution_, nullptr, &work_y_, &work_e_,
                       common_.get()) == 0) {
      throw Error("CHOLMOD could not solve the system");
    }
    std::memcpy(b.data(), solution_->x, static_cast<std::size_t>(b.size()) * sizeof(double));
  }

  [[nodiscard]] long nonzeros() const override { return static_cast<long>(factor_->xsize); }

 private:
  /// A NaN passes the comparisons by which LAPACK finds a matrix that is not positive definite.
  [[nodiscard]] bool pivots_are_finite() const {
    const auto* super = static_cast<const int*>(factor_->super);
    const auto* rows = static_cast<const int*>(factor_->pi);
    const auto* start = static_cast<const int*>(factor_->px);
    const auto* values = static_cast<const double*>(factor_->x);
    for (std::size_t s = 0; s < factor_->nsuper; ++s) {
      const int height = rows[s + 1] - rows[s];
      for (int c = 0; c < super[s + 1] - super[s]; ++c) {
        if (!std::isfinite(values[start[s] + c * (height + 1)])) return false;
      }
    }
    return true;
  }

  /// CHOLMOD does not write to a matrix it factorises, but its interface has no const.
  static cholmod_sparse scalar(const BlockMatrix& matrix) {
    const BlockMatrix::Sparse& s = matrix.sparse();
    return view(static_cast<int>(s.rows()), const_cast<int*>(s.outerIndexPtr()),
                const_cast<int*>(s.innerIndexPtr()), const_cast<double*>(s.valuePtr()), -1);
  }

  Common common_;
  cholmod_factor* factor_ = nullptr;
  cholmod_dense* solution_ = nullptr;
  cholmod_dense* work_y_ = nullptr;
  cholmod_dense* work_e_ = nullptr;
};

}  // namespace

std::unique_ptr<SparseCholesky> make_cholmod_cholesky(const BlockMatrix& matrix) {
  return std::make_unique<CholmodCholesky>(matrix);
}

std::vector<int> elimination_order(const NodeGraph& graph, Ordering ordering) {
  Common common;
  common->nmethods = 1;
  common->method[0].ordering = ordering == Ordering::minimum_degree ? CHOLMOD_AMD : CHOLMOD_METIS;
  common->postorder = 1;
  common->supernodal = CHOLMOD_SIMPLICIAL;
  const int n = graph.nodes();
  std::vector<int> outer(1, 0);
  std::vector<int> inner;
  for (int i = 0; i < n; ++i) {
    for (const int j : graph.neighbours(i)) {
      if (j < i) inner.push_back(j);
    }
    inner.push_back(i);
    outer.push_back(static_cast<int>(inner.size()));
  }
  cholmod_sparse a = view(n, outer.data(), inner.data(), nullptr, 1);
  cholmod_factor* factor = cholmod_analyze(&a, common.get());
  if (factor == nullptr) throw Error("CHOLMOD could not order the system");
  std::vector<int> position(n);
  for (int p = 0; p < n; ++p) {
    position[static_cast<const int*>(factor->Perm)[p]] = p;
  }
  cholmod_free_factor(&factor, common.get());
  return position;
}

}  // namespace geoprior::paper
