#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/options.h"
#include "experiments/grammar/scene/arm.h"
#include "experiments/grammar/scene/building.h"
#include "models/grammar/objects/forest.h"
#include "models/grammar/objects/landscape.h"
#include "models/grammar/objects/surface_set.h"
#include "models/grammar/objects/tree.h"
#include "models/grammar/objects/volume_set.h"

namespace geoprior::grammar {

/// What a scene is of.
enum class Object { tree, building, surface_set, volume_set, landscape, forest, arm, imported };

struct ImportedOptions {
  std::string file;
  double unit = 1;  ///< m
};

/// One edit of one element, before the gesture.
struct EditOptions {
  enum class Kind { translate, turn, set, extrude, children };
  enum class Keep { rigid, stop, no };
  std::string element = {};
  Kind kind = Kind::translate;
  std::array<double, 3> by{0, 0, 0};    ///< translate (m)
  std::array<double, 3> axis{0, 0, 1};  ///< turn, about the element's position
  double angle_deg = 0;                 ///< turn
  std::string parameter = {};           ///< set, extrude
  double value = 0;  ///< set: the value; extrude: by how much; children: how many
  Keep keep = Keep::rigid;
};

/// Gestures drawn at random, a frame each, from the same state.
struct RandomGestureOptions {
  int count = 200;
  int first = 0;
};

struct GestureOptions {
  enum class Course {
    once,  ///< from nothing to all of it
    back,  ///< and back to nothing
  };
  std::string file;     ///< of recorded strokes
  std::string element;  ///< that is deformed; empty: the root
  int steps = 30;
  Course course = Course::once;
  int repeats = 1;
  double scale = 1;  ///< of positions and lengths of the strokes
};

struct GrammarSceneOptions {
  enum class Record { surface, keys, sample };
  Object object = Object::tree;
  TreeOptions tree;
  BuildingOptions building;
  SurfaceSetOptions surface_set;
  VolumeSetOptions volume_set;
  LandscapeOptions landscape;
  ForestOptions forest;
  ArmOptions arm;
  ImportedOptions imported;
  int seed = 1;
  std::vector<EditOptions> edits;
  std::optional<GestureOptions> gesture;
  std::optional<RandomGestureOptions> random;
  std::string rules;  ///< file of a script; empty: none
  Record record = Record::surface;
};

void describe(OptionVisitor& v, ImportedOptions& options);
void describe(OptionVisitor& v, EditOptions& options);
void describe(OptionVisitor& v, RandomGestureOptions& options);
void describe(OptionVisitor& v, GestureOptions& options);
void describe(OptionVisitor& v, GrammarSceneOptions& options);

}  // namespace geoprior::grammar
