#pragma once

#include <string>

#include "core/options.h"
#include "experiments/details/drawing/detail_drawing.h"

namespace geoprior::details {

/// `drawing`: details as geometry, in some of the recorded frames.
struct DetailDrawingOptions {
  int frames = 1;
  int pop_frames = 2;
  DrawingOptions look;
  std::string file;
};
void describe(OptionVisitor& v, DetailDrawingOptions& options);

}  // namespace geoprior::details
