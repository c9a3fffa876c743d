#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "baselines/fluid/liquid/tank/tank.h"
#include "baselines/fluid/ocean/ocean.h"
#include "core/options.h"
#include "experiments/fluid/injected/sequence.h"
#include "solvers/fluid/edits.h"
#include "testbed/formats/sequence/files.h"
#include "testbed/keyframes.h"

namespace geoprior::fluid {

/// A body: a tagged choice, `kind` selects which of the others are described.
struct LiquidShapeOptions {
  LiquidShape::Kind kind = LiquidShape::Kind::box;
  std::array<double, 3> centre{0, 0, 0};
  std::array<double, 3> size{1, 1, 1};
  double radius = 0.1;
  std::array<double, 3> axis{0, 0, 1};
  double length = 0.2;
  std::string file;
  double scale = 1;
  double turn_z_deg = 0;
};
void describe(OptionVisitor& v, LiquidShapeOptions& options);

/// One of `volumes`.
struct LiquidVolumeOptions {
  std::string name;
  LiquidShapeOptions shape;
  std::array<double, 3> velocity{0, 0, 0};
};
void describe(OptionVisitor& v, LiquidVolumeOptions& options);

/// One of `sources`.
struct LiquidSourceOptions {
  std::string name;
  LiquidShapeOptions shape;
  std::array<double, 3> velocity{0, 0, 0};
  double from = 0, until = 0;
};
void describe(OptionVisitor& v, LiquidSourceOptions& options);

/// One of `solids`.
struct TankSolidOptions {
  std::string name;
  LiquidShapeOptions shape;
  std::vector<KeyOptions> keys;
};
void describe(OptionVisitor& v, TankSolidOptions& options);

/// `tank`: what the simulation fills.
struct TankOptions {
  std::array<double, 3> origin{0, 0, 0};
  std::array<double, 3> size{1, 1, 1};
  double cell = 1.0 / 32;
  bool open_top = true;
  double density = 1000;
  std::vector<LiquidVolumeOptions> volumes;
  std::vector<LiquidSourceOptions> sources;
  std::vector<TankSolidOptions> solids;
};
void describe(OptionVisitor& v, TankOptions& options);

/// One of `sequences`: an animation that features are lifted out of.
struct NamedSequenceOptions {
  std::string name;
  SequenceOptions sequence;
};
void describe(OptionVisitor& v, NamedSequenceOptions& options);

/// One of `libraries`: features that were stored.
struct LibraryOptions {
  std::string name;
  std::string path;
};
void describe(OptionVisitor& v, LibraryOptions& options);

enum class TargetKind { sequence, mesh, ocean, injected };

/// `target`: what features are pasted into.
struct TargetOptions {
  TargetKind kind = TargetKind::sequence;
  SequenceOptions sequence;
  std::string file;
  double scale = 1;
  std::array<double, 3> move{0, 0, 0};
  std::array<double, 3> turn_deg{0, 0, 0};
  OceanOptions ocean;
  int ocean_seed = 1;
};
void describe(OptionVisitor& v, TargetOptions& options);

/// `[scene]` of a fluid experiment. Methods use what they need of it: a simulation the tank, an
/// extraction the first sequence, a paste sequences, libraries, target and edits.
struct FluidSceneOptions {
  double duration = 1;
  double frame_interval = 0.04;
  double start = 0;
  std::array<double, 3> gravity{0, 0, -9.81};
  std::optional<TankOptions> tank;
  std::optional<InjectedOptions> injected;
  std::vector<NamedSequenceOptions> sequences;
  std::vector<LibraryOptions> libraries;
  std::optional<TargetOptions> target;
  std::vector<Edit> edits;
  std::optional<std::string> edit_list;
};
void describe(OptionVisitor& v, FluidSceneOptions& options);

}  // namespace geoprior::fluid
