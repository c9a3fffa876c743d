#pragma once

#include <cstdint>
#include <string_view>

namespace geoprior {

/// PCG32 (O'Neill 2014, XSH-RR 64/32): one stream of reproducible random numbers.
///
/// The distributions are ours because those of the standard library differ between implementations.
class RandomStream {
 public:
  explicit RandomStream(std::uint64_t seed, std::uint64_t stream = 0);
  /// A stream of its own for every purpose: same seed and name, same numbers, whatever else is
  /// drawn.
  RandomStream(std::uint64_t seed, std::string_view purpose);

  std::uint32_t next();
  /// Uniform in [0, 1) with 53 random bits.
  double uniform();
  /// Uniform in 0 … bound-1 without bias; `bound` > 0.
  std::uint32_t below(std::uint32_t bound);
  /// Standard normal (Box–Muller, both values used).
  double normal();

 private:
  std::uint64_t state_ = 0;
  std::uint64_t increment_ = 1;
  double spare_ = 0;
  bool has_spare_ = false;
};

/// Seed of what a scene draws: the experiment's, moved on by the scene's own key, so that the one
/// reaches everything and the other still gives another scene within an experiment. With the
/// experiment's seed 1, the default, it is the key's value.
std::uint64_t scene_seed(std::uint64_t experiment, int own = 1);

/// FNV-1a, 64 bit: to name streams, not to protect anything.
std::uint64_t fnv1a(std::string_view text);

}  // namespace geoprior
