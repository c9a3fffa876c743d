#include "core/state_bytes.h"

namespace geoprior {

Error StateReader::ends_early() { return Error("ends early", "checkpoint", "an unharmed one"); }

void StateReader::copy(void* to, std::size_t size) {
  if (size > state_.size() - at_) throw ends_early();
  if (size > 0) std::memcpy(to, state_.data() + at_, size);
  at_ += size;
}

State StateReader::bytes() {
  State result(count());
  copy(result.data(), result.size());
  return result;
}

std::string StateReader::text() {
  std::string result(count(), '\0');
  copy(result.data(), result.size());
  return result;
}

void StateReader::require_end() const {
  if (at_ != state_.size()) throw Error("is longer than expected", "checkpoint", "an unharmed one");
}

void StateReader::require_size(Eigen::Index rows, Eigen::Index cols, std::size_t scalar,
                               int fixed_rows, int fixed_cols) const {
  const auto fits = [](Eigen::Index size, int fixed) {
    return size >= 0 && (fixed == Eigen::Dynamic || size == fixed);
  };
  if (!fits(rows, fixed_rows) || !fits(cols, fixed_cols)) {
    throw Error("holds a matrix of another shape", "checkpoint", "an unharmed one");
  }
  const std::size_t left = (state_.size() - at_) / scalar;
  if (cols > 0 && static_cast<std::size_t>(rows) > left / cols) {
    throw ends_early();
  }
}

}  // namespace geoprior
