#include "core/random.h"

#include <cmath>
#include <numbers>

namespace geoprior {

RandomStream::RandomStream(std::uint64_t seed, std::uint64_t stream)
    : increment_((stream << 1U) | 1U) {
  next();
  state_ += seed;
  next();
}

RandomStream::RandomStream(std::uint64_t seed, std::string_view purpose)
    : RandomStream(seed, fnv1a(purpose)) {}

std::uint32_t RandomStream::next() {
  const std::uint64_t old = state_;
  state_ = old * 6364136223846793005ULL + increment_;
  const auto shifted = static_cast<std::uint32_t>(((old >> 18U) ^ old) >> 27U);
  const auto turn = static_cast<std::uint32_t>(old >> 59U);
  return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
}

double RandomStream::uniform() {
  const std::uint64_t high = next();
  const std::uint64_t bits = (high << 21U) ^ (next() >> 11U);
  return static_cast<double>(bits) * 0x1p-53;
}

std::uint32_t RandomStream::below(std::uint32_t bound) {
  const std::uint32_t threshold = (0U - bound) % bound;
  for (;;) {
    const std::uint32_t r = next();
    if (r >= threshold) return r % bound;
  }
}

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  const double angle = 2 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

std::uint64_t scene_seed(std::uint64_t experiment, int own) {
  return experiment + static_cast<std::uint64_t>(own) - 1;
}

std::uint64_t fnv1a(std::string_view text) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  return hash;
}

}  // namespace geoprior
