#include "baselines/fluid/ocean/transform.h"

#include <fftw3.h>

#include <mutex>
#include <new>

namespace geoprior::fluid {
namespace {

/// FFTW's planner is one for the process and not safe to enter twice; executing plans is.
std::mutex& planner() {
  static std::mutex mutex;
  return mutex;
}

fftw_complex* as_fftw(std::complex<double>* c) { return reinterpret_cast<fftw_complex*>(c); }

template <class T>
T* allocate(std::size_t count) {
  void* memory = fftw_malloc(count * sizeof(T));
  if (memory == nullptr) throw std::bad_alloc();
  return static_cast<T*>(memory);
}

}  // namespace

void InverseTransform::Release::operator()(void* memory) const { fftw_free(memory); }

InverseTransform::InverseTransform(int n) : n_(n), plan_(nullptr) {
  const Coefficients in = coefficients();
  const Field out(allocate<double>(static_cast<std::size_t>(n) * n));
  const std::scoped_lock lock(planner());
  plan_ =
      fftw_plan_dft_c2r_2d(n, n, as_fftw(in.get()), out.get(), FFTW_ESTIMATE | FFTW_DESTROY_INPUT);
}

InverseTransform::~InverseTransform() {
  const std::scoped_lock lock(planner());
  fftw_destroy_plan(static_cast<fftw_plan>(plan_));
}

InverseTransform::Coefficients InverseTransform::coefficients() const {
  const auto count = static_cast<std::size_t>(n_) * (n_ / 2 + 1);
  return Coefficients(allocate<std::complex<double>>(count));
}

InverseTransform::Field InverseTransform::field(std::complex<double>* coefficients) const {
  Field out(allocate<double>(static_cast<std::size_t>(n_) * n_));
  fftw_execute_dft_c2r(static_cast<fftw_plan>(plan_), as_fftw(coefficients), out.get());
  return out;
}

}  // namespace geoprior::fluid
