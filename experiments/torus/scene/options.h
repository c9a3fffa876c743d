#pragma once

#include <optional>
#include <vector>

#include "core/options.h"

namespace geoprior::torus {

/// An element of `scene.corrugations`.
struct CorrugationOptions {
  int direction = 0;
  std::optional<int> number;
  std::optional<double> share;
};
void describe(OptionVisitor& v, CorrugationOptions& options);

/// `scene.view`: a square part of the torus.
struct ViewOptions {
  double x = 0.5;
  double y = 0.5;
  double width = 0.1;
  std::optional<int> zooms;
  double nearer = 10;
};
void describe(OptionVisitor& v, ViewOptions& options);

/// `scene.detail`: a further part of the torus.
struct DetailOptions {
  double x = 0.5;
  double y = 0.5;
  double width = 0.05;
};
void describe(OptionVisitor& v, DetailOptions& options);

/// `scene.print`: files for printers and viewers.
struct PrintOptions {
  double size = 0.1;
  double thickness = 0;
};
void describe(OptionVisitor& v, PrintOptions& options);

/// `[scene]` of a torus experiment.
struct TorusSceneOptions {
  double r1 = 0.2;
  double r2 = 0.5;
  std::vector<CorrugationOptions> corrugations;
  double margin = 0.5;
  int surface = 400;
  int windows = 256;
  int window_seed = 1;
  std::optional<ViewOptions> view;
  std::optional<DetailOptions> detail;
  std::optional<int> whole;
  std::optional<PrintOptions> print;
};
void describe(OptionVisitor& v, TorusSceneOptions& options);

}  // namespace geoprior::torus
