#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/context.h"
#include "core/state_bytes.h"
#include "experiments/grammar/scene/scene.h"
#include "models/grammar/record.h"

namespace geoprior::grammar {

/// A method as the process of a scene drives it: first the edits, which stay, then the steps of a
/// gesture or random gestures. The process marks them as the phases "edit" and "deform", for all
/// methods alike; how a gesture becomes a map is in neither.
class Deformer {
 public:
  virtual ~Deformer() = default;
  virtual void edit(const SceneEdit& edit) = 0;
  /// A step of the scene that has a map: `map`, from the state after the edits.
  virtual void deform(std::size_t step, const std::shared_ptr<const SpatialMap>& map) = 0;

  /// What is shown, and what is known of it.
  [[nodiscard]] virtual const Hierarchy& shown() const = 0;
  [[nodiscard]] virtual Geometry geometry(bool with_surface) const {
    return geometry_of(shown(), with_surface);
  }
  [[nodiscard]] virtual std::map<std::string, double> diagnostics() const { return {}; }
  /// Adds what only the method can show.
  virtual void add_parts(Frame& /*frame*/) const {}
  /// Files beside the frame.
  [[nodiscard]] virtual std::vector<Artifact> artifacts(int /*frame*/) const { return {}; }
  /// What the next step needs beside the state after the edits.
  virtual void save(StateWriter& /*out*/) const {}
  virtual void load(StateReader& /*in*/) {}
};

/// The process that makes the frames of a scene with a method. A run that is resumed makes the
/// edits again.
/// @param scene  outlives the process
std::unique_ptr<Process> deforming_process(
    const GrammarScene& scene, std::function<std::unique_ptr<Deformer>(RunContext&)> make);

}  // namespace geoprior::grammar
