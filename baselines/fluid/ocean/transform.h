#pragma once

#include <complex>
#include <memory>

namespace geoprior::fluid {

/// Sums of waves on an N x N grid: real field from half of its Fourier coefficients,
/// f(x) = sum over k of c(k) e^{i k x}, c(-k) = conj(c(k)).
///
/// Row j of the coefficients has ky = j for j < N/2 and j - N otherwise; kx = 0 ... N/2 along a
/// row. The plan is chosen without timing, so that every run adds in the same order.
class InverseTransform {
 public:
  /// Buffers aligned as the plan needs them.
  struct Release {
    void operator()(void* memory) const;
  };
  using Coefficients = std::unique_ptr<std::complex<double>[], Release>;
  using Field = std::unique_ptr<double[], Release>;

  explicit InverseTransform(int n);
  ~InverseTransform();
  InverseTransform(const InverseTransform&) = delete;
  InverseTransform& operator=(const InverseTransform&) = delete;

  /// N rows of N/2 + 1.
  [[nodiscard]] Coefficients coefficients() const;
  /// N rows of N, x fastest. Destroys the coefficients. Safe from several threads.
  [[nodiscard]] Field field(std::complex<double>* coefficients) const;

 private:
  int n_;
  void* plan_;  ///< fftw_plan; this header does not include FFTW's
};

}  // namespace geoprior::fluid
