#include "core/limits.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace geoprior {
namespace {

constexpr const char* kMemoryVariable = "GEOPRIOR_MEMORY_GB";
constexpr double kShare = 0.8;  ///< of the machine's memory: others use it too

std::string formatted(const char* format, double x) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), format, x);
  return text.data();
}

double machine_memory() {
  double bytes = static_cast<double>(::sysconf(_SC_PHYS_PAGES)) *
                 static_cast<double>(::sysconf(_SC_PAGE_SIZE));
  rlimit limit{};
  if (::getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    bytes = std::min(bytes, static_cast<double>(limit.rlim_cur));
  }
  return kShare * bytes;
}

}  // namespace

double memory_limit() {
  const char* given = std::getenv(kMemoryVariable);
  if (given == nullptr || *given == '\0') return machine_memory();
  char* end = nullptr;
  const double gigabytes = std::strtod(given, &end);
  if (*end != '\0' || !(gigabytes > 0) || !std::isfinite(gigabytes)) {
    throw Error("'" + std::string(given) + "' is no size", kMemoryVariable, "GB, more than 0");
  }
  return gigabytes * 1e9;
}

std::string bytes_text(double bytes) {
  constexpr std::array kUnits{"B", "kB", "MB", "GB", "TB", "PB"};
  std::size_t unit = 0;
  for (; unit + 1 < kUnits.size() && bytes >= 1000; ++unit) bytes /= 1000;
  return formatted(unit == 0 ? "%.0f " : bytes < 1e4 ? "%.1f " : "%.2g ", bytes) + kUnits.at(unit);
}

std::string count_text(double count) {
  return formatted(std::abs(count) < 1e15 ? "%.0f" : "%.3g", count);
}

void require_count(double count, const std::string& what, double most, const std::string& where) {
  if (count <= most) return;
  throw Error("asks for " + count_text(count) + " " + what, where, "at most " + count_text(most));
}

void require_memory(double bytes, double count, const std::string& what, const std::string& where) {
  const double limit = memory_limit();
  if (bytes <= limit) return;
  throw Error(
      "asks for " + count_text(count) + " " + what + ", about " + bytes_text(bytes) + " of memory",
      where, "at most " + bytes_text(limit) + ", or what " + kMemoryVariable + " says");
}

void require_vertices(double vertices, const std::string& where) {
  require_memory(vertices * kBytesPerVertex, vertices, "vertices", where);
  require_count(vertices, "vertices", kMostVertices, where);
}

Error out_of_memory(const std::string& where) {
  return Error("the memory of the machine does not suffice", where,
               "a smaller scene, fewer or smaller frames");
}

void require_frames(double duration, double interval, const std::string& where) {
  require_count(duration / interval + 1, "frames of " + formatted("%g", interval) + " s",
                kMostFrames, where);
}

}  // namespace geoprior
