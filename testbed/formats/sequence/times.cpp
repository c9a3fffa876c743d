#include "testbed/formats/sequence/times.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "testbed/formats/mesh/mesh_file.h"

namespace geoprior {
namespace {

constexpr double kAssumedRate = 25;
constexpr double kSameInterval = 0.01;  // relative: times of files are often rounded to 1 ms
constexpr std::size_t kMostRanges = 8;

std::string text_of(double x) {
  std::array<char, 32> out{};
  std::snprintf(out.data(), out.size(), "%.6g", x);
  return out.data();
}

/// Times that the files say themselves, or none.
std::vector<double> own_times(const std::vector<FoundFile>& files) {
  std::vector<double> times;
  for (const FoundFile& file : files) {
    std::optional<double> time = file.time;
    const bool may_say = file.file.extension() == ".vtp" || file.file.extension() == ".pvtp";
    if (!time && may_say && files.size() > 1) {
      time = read_mesh_file(file.file).time;
    }
    if (!time) return {};
    times.push_back(*time);
  }
  return times;
}

std::vector<double> regular_times(const std::vector<FoundFile>& files, double rate, double start) {
  std::vector<double> times;
  for (const FoundFile& file : files) {
    times.push_back(start + (file.number - files.front().number) / rate);
  }
  return times;
}

}  // namespace

std::string missing_numbers(const std::vector<int>& numbers) {
  int step = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    step = std::gcd(step, numbers[i] - numbers[i - 1]);
  }
  std::string text;
  std::size_t ranges = 0;
  for (std::size_t i = 1; i < numbers.size(); ++i) {
    const int first = numbers[i - 1] + step, last = numbers[i] - step;
    if (first > last) continue;
    if (ranges++ == kMostRanges) return text + ", …";
    text += (text.empty() ? "" : ", ") + std::to_string(first);
    if (last > first) text += " to " + std::to_string(last);
  }
  return text;
}

std::string uneven_times(const std::vector<double>& times, const std::vector<int>& numbers) {
  if (times.size() < 3) return "";
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times.size(); ++i) {
    intervals.push_back((times[i] - times[i - 1]) / (numbers[i] - numbers[i - 1]));
  }
  const double shortest = *std::min_element(intervals.begin(), intervals.end());
  const auto same = [](double a, double b) { return std::abs(a - b) <= kSameInterval * b; };
  const auto odd = std::find_if(intervals.begin(), intervals.end(),
                                [&](double x) { return !same(x, intervals.front()); });
  if (odd == intervals.end()) return "";
  const bool gaps_only = std::all_of(intervals.begin(), intervals.end(), [&](double x) {
    return std::abs(x / shortest - std::round(x / shortest)) <= kSameInterval;
  });
  const std::size_t at = odd - intervals.begin();
  const std::string change = text_of(intervals.front()) + " s between frames, but " +
                             text_of(*odd) + " s from " + text_of(times[at]) + " s to " +
                             text_of(times[at + 1]) + " s";
  return (gaps_only ? "frames are missing or the rate changes: "
                    : "has more than one frame rate: ") +
         change;
}

std::vector<FrameFile> timed(const std::vector<FoundFile>& files, const Clock& clock,
                             const std::string& name, std::vector<std::string>& warnings) {
  std::vector<int> numbers;
  for (const FoundFile& file : files) numbers.push_back(file.number);
  std::vector<double> times;
  if (!clock.frames_per_second) times = own_times(files);
  const bool own = !times.empty();
  if (own) {
    const std::string uneven = uneven_times(times, numbers);
    if (!uneven.empty()) warnings.push_back(name + ": " + uneven);
    const double shift = clock.start ? *clock.start - times.front() : 0;
    for (double& time : times) time += shift;
  } else {
    if (!clock.frames_per_second && files.size() > 1) {
      warnings.push_back(name + ": nothing says its frame rate; 25 frames a second are assumed");
    }
    const double start = clock.start.value_or(files.front().time.value_or(0));
    times = regular_times(files, clock.frames_per_second.value_or(kAssumedRate), start);
  }
  const std::string missing = missing_numbers(numbers);
  if (!missing.empty()) warnings.push_back(name + ": frames are missing: " + missing);
  std::vector<FrameFile> out;
  for (std::size_t i = 0; i < files.size(); ++i) {
    out.push_back({files[i].file, files[i].number, times[i], files[i].further});
  }
  return out;
}

}  // namespace geoprior
