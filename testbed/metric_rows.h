#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/frame.h"
#include "testbed/frame_sequence.h"
#include "testbed/topic.h"

namespace geoprior {

/// Adds rows to a topic's table of metrics, their functions typed by the topic's scene.
template <class TypedScene>
class MetricRows {
 public:
  using Value = std::optional<double>;
  using OfFrame = std::function<Value(const TypedScene&, const Frame&)>;
  using OfPair = std::function<Value(const TypedScene&, const Frame&, const Frame&)>;
  using OfSequence = std::function<Value(const TypedScene&, const FrameSequence&)>;

  explicit MetricRows(std::vector<MetricEntry>& table) : table_(table) {}

  /// A value a frame.
  void frame(const char* name, const char* unit, const char* definition, Direction direction,
             Tolerance tolerance, OfFrame measure) {
    add(name, unit, definition, direction, tolerance).of_frame =
        [measure = std::move(measure)](const Scene& scene, const Frame& frame, const Frame*) {
          return measure(typed(scene), frame);
        };
  }

  /// A value a frame that has a reference frame, of which the part "surface" is looked at.
  void pair(const char* name, const char* unit, const char* definition, Direction direction,
            Tolerance tolerance, OfPair measure) {
    MetricEntry& e = add(name, unit, definition, direction, tolerance);
    e.needs_reference = true;
    e.reference_parts = {"surface"};
    e.of_frame = [measure = std::move(measure)](const Scene& scene, const Frame& frame,
                                                const Frame* reference) -> Value {
      if (reference == nullptr) return {};
      return measure(typed(scene), frame, *reference);
    };
  }

  /// One value of all frames.
  void sequence(const char* name, const char* unit, const char* definition, Direction direction,
                Tolerance tolerance, OfSequence measure) {
    add(name, unit, definition, direction, tolerance).of_sequence =
        [measure = std::move(measure)](const Scene& scene, const FrameSequence& frames) {
          return measure(typed(scene), frames);
        };
  }

  /// Sets the value that the metric of the row added last is to be close to.
  void target(double value) { table_.back().target = value; }

 private:
  static const TypedScene& typed(const Scene& scene) {
    return dynamic_cast<const TypedScene&>(scene);
  }

  MetricEntry& add(const char* name, const char* unit, const char* definition, Direction direction,
                   Tolerance tolerance) {
    MetricEntry& e = table_.emplace_back();
    e.name = name;
    e.unit = unit;
    e.definition = definition;
    e.direction = direction;
    e.tolerance = tolerance;
    return e;
  }

  std::vector<MetricEntry>& table_;
};

}  // namespace geoprior
