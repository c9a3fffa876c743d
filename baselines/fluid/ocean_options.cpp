#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <string_view>

#include "baselines/fluid/ocean.h"
#include "core/error.h"

namespace geoprior {
namespace {

constexpr int kMostSamples = 4096;
constexpr int kMostVerticesAlong = 8192;

void require(bool holds, const char* option, double value, const std::string& where,
             const std::string& allowed) {
  if (holds) return;
  throw Error(std::string(option) + " is " + std::to_string(value), where, allowed);
}

}  // namespace

void describe(OptionVisitor& v, OceanOptions& o) {
  static constexpr std::array<std::string_view, 4> kSpectra{"phillips", "pierson-moskowitz",
                                                            "jonswap", "tma"};
  static constexpr std::array<std::string_view, 4> kSpreadings{"none", "cosine-squared",
                                                               "mitsuyasu", "one-sided"};
  describe_choice(v, "spectrum", o.spectrum, kSpectra, {.doc = "S(omega)"});
  describe_choice(v, "spreading", o.spreading, kSpreadings,
                  {.doc = "D(theta): all directions; 2/pi cos^2; cos^2s(theta/2); downwind half"});
  v.value(
      "samples", o.samples,
      {.doc = "N, along each edge of the patch, a power of two", .min = 4, .max = kMostSamples});
  v.value("size", o.size, {.doc = "L, edge of the patch", .unit = "m", .min = 1e-6, .max = 1e7});
  v.value("wind_speed", o.wind_speed,
          {.doc = "U, 10 m above the sea", .unit = "m/s", .min = 1e-3, .max = 200});
  v.value("wind_direction_deg", o.wind_direction_deg,
          {.doc = "where it blows to, from +x towards +y", .unit = "deg"});
  v.value("fetch", o.fetch,
          {.doc = "F, distance over which it blows (jonswap, tma)", .unit = "m", .min = 1e-3});
  v.value("peak_enhancement", o.peak_enhancement,
          {.doc = "gamma (jonswap, tma)", .min = 1, .max = 20});
  v.value("depth", o.depth, {.doc = "H", .unit = "m", .min = 1e-6});
  v.value("gravity", o.gravity, {.doc = "g", .unit = "m/s^2", .min = 1e-6});
  v.value("choppiness", o.choppiness,
          {.doc = "lambda, scale of the horizontal displacement", .min = 0, .max = 10});
  v.value("smallest_wave", o.smallest_wave,
          {.doc = "length s of waves that are damped by 1/e, shorter ones more",
           .unit = "m",
           .min = 0});
  v.value("amplitude", o.amplitude,
          {.doc = "significant wave height to scale to; absent: as the spectrum says",
           .unit = "m",
           .min = 0});
  v.value("mean_level", o.mean_level, {.doc = "z of the rest surface", .unit = "m"});
  v.value("tiles", o.tiles, {.doc = "patches along x and y", .min = 1, .max = 64});
}

void require_valid(const OceanOptions& o, const std::string& where) {
  require(o.samples >= 4 && o.samples <= kMostSamples &&
              std::has_single_bit(static_cast<unsigned>(o.samples)),
          "samples", o.samples, where, "a power of two, 4 to " + std::to_string(kMostSamples));
  require(o.tiles >= 1 && o.samples * static_cast<long>(o.tiles) <= kMostVerticesAlong, "tiles",
          o.tiles, where,
          "1 or more, samples * tiles at most " + std::to_string(kMostVerticesAlong));
  const auto positive = [&](const char* option, double value) {
    require(std::isfinite(value) && value > 0, option, value, where, "positive");
  };
  const auto not_negative = [&](const char* option, double value) {
    require(std::isfinite(value) && value >= 0, option, value, where, "0 or more");
  };
  const auto finite = [&](const char* option, double value) {
    require(std::isfinite(value), option, value, where, "finite");
  };
  positive("size", o.size);
  positive("wind_speed", o.wind_speed);
  positive("fetch", o.fetch);
  positive("depth", o.depth);
  positive("gravity", o.gravity);
  not_negative("choppiness", o.choppiness);
  not_negative("smallest_wave", o.smallest_wave);
  if (o.amplitude) not_negative("amplitude", *o.amplitude);
  finite("wind_direction_deg", o.wind_direction_deg);
  finite("mean_level", o.mean_level);
  require(std::isfinite(o.peak_enhancement) && o.peak_enhancement >= 1, "peak_enhancement",
          o.peak_enhancement, where, "1 or more");
}

}  // namespace geoprior
