#pragma once

#include <map>
#include <optional>

#include "experiments/grammar/measures/fidelity.h"
#include "experiments/grammar/measures/recorded_state.h"

namespace geoprior::grammar {

/// What becomes of elements that a user edited and that nothing above them may undo. Following
/// rigidly is allowed, so that places are not compared: distances and parameters are.
class PersistenceMeter {
 public:
  /// The element as its edit left it: what later states are compared with. None that the method
  /// has lost already.
  void remember(const RecordedState& state, int element);
  /// An element that is edited again. @return  whether it was remembered
  bool forget(int element) { return kept_.erase(element) > 0; }
  void compare(const RecordedState& state);

  /// m: largest change of a distance between two key points of one of the elements; absent before
  /// there is anything to compare, or where all are lost.
  [[nodiscard]] std::optional<double> distance() const { return distance_; }
  /// Largest difference of a parameter, in its unit.
  [[nodiscard]] std::optional<double> parameter() const { return parameter_; }
  /// Elements that were absent, or of which a distance changed by over 1e-9 m or a parameter at
  /// all, in any state that was compared.
  [[nodiscard]] std::optional<double> lost() const;

 private:
  struct Kept {
    std::optional<RecordedElement> then;  ///< absent: lost at once
    bool lost = false;
  };
  std::map<int, Kept> kept_;
  std::optional<double> distance_, parameter_;
  bool compared_ = false;
};

}  // namespace geoprior::grammar
