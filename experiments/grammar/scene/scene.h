#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/grammar/maps/gesture.h"
#include "experiments/grammar/scene/options.h"
#include "models/grammar/hierarchy/hierarchy.h"
#include "solvers/grammar/engine/derivation.h"
#include "testbed/topic.h"

namespace geoprior::grammar {

/// One edit of a scene.
struct SceneEdit {
  Edit wish;
  std::optional<Tag> tag;
};

/// What happens in one frame.
struct Step {
  enum class Kind { rest, edit, gesture, random };
  Kind kind = Kind::rest;
  int number = 0;       ///< of the edit, or of the random gesture
  double fraction = 0;  ///< of the gesture that is done
  double before = 0;    ///< fraction of the step before
};

/// An object, edits and a gesture: what all methods are given. Frame 0 is the object at rest, then
/// each edit has a frame, then each step of the gesture or each random gesture.
class GrammarScene final : public ProcessScene {
 public:
  Object kind = Object::tree;
  std::string object;  ///< its name: "tree", …
  Hierarchy rest;
  /// The procedural object again, stretched along x, y, z; absent where it has no procedure.
  std::function<Hierarchy(const Eigen::Vector3d& stretch)> generate;
  std::vector<SceneEdit> edits;
  Gesture gesture;
  int gesture_element = 0;
  std::vector<Step> steps;
  std::uint64_t random_seed = 1;
  Eigen::AlignedBox3d box;  ///< of the key points at rest
  std::string script;       ///< text of the rules; empty: none
  std::string script_file;
  GrammarSceneOptions::Record record = GrammarSceneOptions::Record::surface;

  /// Deformation of space that a step asks for, from the state after the edits; null for edits.
  [[nodiscard]] std::shared_ptr<const SpatialMap> asked_map(std::size_t step) const;
  /// From the step before to this one.
  [[nodiscard]] std::shared_ptr<const SpatialMap> asked_since(std::size_t step) const;
  /// The dabs of a step's strokes: `asked_map` but for a lattice and a cage. None of edits.
  [[nodiscard]] std::vector<Dab> asked_dabs(std::size_t step) const;
  /// Strokes of a step, to be drawn.
  [[nodiscard]] DrawnGesture drawn_gesture(std::size_t step) const;
  /// Elements that are tagged when the step begins.
  [[nodiscard]] std::vector<int> tagged(std::size_t step) const;

  [[nodiscard]] std::string parameter_name() const override { return "step"; }
  [[nodiscard]] std::string parameter_unit() const override { return "1"; }
  [[nodiscard]] std::map<std::string, double> facts() const override;
  /// The object and what is asked of it as a program from outside is given them.
  ///
  /// Parts: the object at rest as frames have it (models/grammar/record.h), `type` with the names
  /// of the types; `asked_0000` …: for each frame the key points of the rest where the user asks
  /// them to be (points; `element`, `key`). Tables: `type_0000` … a row an element at rest of that
  /// type, its number and its parameters by name; `ranges` (type, parameter, least and largest
  /// value); `steps` (frame, kind, element that is deformed or edited, fraction of the gesture;
  /// codes of Step); `edits` (a row an edit; codes of DeltaKind and Tag::Follow, -1: it may be
  /// undone); `dabs` (in the order in which they move a point in that frame: Dab). A lattice and a
  /// cage are in none of the dabs: `asked_0000` … know them, and the input files have them.
  [[nodiscard]] Frame given() const override;
};

/// @throws Error  naming the key or file
std::shared_ptr<GrammarScene> load_grammar_scene(const GrammarSceneOptions& options,
                                                 const std::filesystem::path& folder,
                                                 std::uint64_t seed);

}  // namespace geoprior::grammar
