#include "core/inputs/surface_sequence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace geoprior {

double SurfaceSequence::frame_interval() const {
  double shortest = std::numeric_limits<double>::infinity();
  for (int i = 1; i < frame_count(); ++i) shortest = std::min(shortest, time(i) - time(i - 1));
  return std::isfinite(shortest) ? shortest : 0;
}

int SurfaceSequence::nearest_frame(double when) const {
  int best = 0;
  for (int i = 1; i < frame_count(); ++i) {
    if (std::abs(time(i) - when) < std::abs(time(best) - when)) best = i;
  }
  return best;
}

StoredSequence::StoredSequence(std::vector<SurfaceFrame> frames, std::string name)
    : frames_(std::move(frames)), name_(std::move(name)) {
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    if (!(frames_[i].time > frames_[i - 1].time)) {
      throw Error("time " + std::to_string(frames_[i].time) + " s does not follow " +
                      std::to_string(frames_[i - 1].time) + " s",
                  name_ + ", frame " + std::to_string(i), "times that increase strictly");
    }
  }
}

double StoredSequence::time(int frame) const { return frames_.at(frame).time; }

SurfaceFrame StoredSequence::frame(int frame) const { return frames_.at(frame); }

}  // namespace geoprior
