#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/frame.h"
#include "testbed/frame_sequence.h"
#include "testbed/topic.h"

namespace geoprior {

/// What went wrong in reading the value of one row off what its group measured.
class MetricRowError : public Error {
 public:
  MetricRowError(std::string row, const Error& error) : Error(error.what()), row_(std::move(row)) {}
  [[nodiscard]] const std::string& row() const { return row_; }

 private:
  std::string row_;
};

/// Builds a MetricGroup: rows, each beside how its value is read off the group's `Measures`.
///
/// frame_metrics, reference_metrics, sequence_metrics and event_metrics below begin one:
/// ```
/// MetricGroup group = frame_metrics<MyScene>(measure_surface)
///     .row("area", "m^2", "area of the surface", Direction::none, kSmooth,
///          [](const SurfaceMeasures& m) { return m.area; })
///     .row("volume", …);
/// ```
template <class Measures>
class MetricRows {
 public:
  using Value = std::optional<double>;
  using Read = std::function<Value(const Measures&)>;

  MetricRows() = default;
  MetricRows(MetricRows&&) = default;
  MetricRows& operator=(MetricRows&&) = default;

  MetricRows& row(std::string name, std::string unit, std::string definition, Direction direction,
                  Tolerance tolerance, Read read) {
    readers_->push_back({name, std::move(read)});
    MetricEntry& entry = group_.rows.emplace_back();
    entry.name = std::move(name);
    entry.unit = std::move(unit);
    entry.definition = std::move(definition);
    entry.direction = direction;
    entry.tolerance = tolerance;
    return *this;
  }

  /// The only row of a group that measures one number.
  MetricRows& row(std::string name, std::string unit, std::string definition, Direction direction,
                  Tolerance tolerance) requires std::is_same_v<Measures, double> {
    return row(std::move(name), std::move(unit), std::move(definition), direction, tolerance,
               [](double value) { return value; });
  }

  /// What the row added last is to be close to.
  MetricRows& target(double value) {
    group_.rows.back().target = value;
    return *this;
  }
  /// Marks the row added last as an identity or a closed form.
  MetricRows& oracle() {
    group_.rows.back().oracle = true;
    return *this;
  }
  /// Takes the row added last out of what `check` compares.
  MetricRows& ungated(std::string reason) {
    group_.rows.back().ungated = std::move(reason);
    return *this;
  }

  /// Implicit, so that a table lists what it builds.
  operator MetricGroup() const { return group_; }

  /// `measure(const Scene&, const Frame&, const Frame* reference)` returns Measures, or an optional
  /// of them.
  template <class Measure>
  void measured_at_frame(Measure measure) {
    group_.of_frame = [readers = readers_, measure = std::move(measure)](
                          const Scene& scene, const Frame& frame, const Frame* reference) {
      return values(*readers, measure(scene, frame, reference));
    };
  }
  /// The same of `measure(const Scene&, const FrameSequence&)`.
  template <class Measure>
  void measured_over_sequence(Measure measure) {
    group_.of_sequence = [readers = readers_, measure = std::move(measure)](
                             const Scene& scene, const FrameSequence& frames) {
      return values(*readers, measure(scene, frames));
    };
  }
  /// The same of `measure(const std::vector<Event>&)`, of one variant or of several together.
  template <class Measure>
  void measured_of_events(Measure measure) {
    group_.of_events = [readers = readers_,
                        measure = std::move(measure)](const std::vector<Event>& events) {
      return values(*readers, measure(events));
    };
    group_.of_sequence = [of_events = group_.of_events](const Scene& /*scene*/,
                                                        const FrameSequence& frames) {
      return of_events(frames.events());
    };
  }
  /// Of a reference frame `parts` are looked at; empty: all.
  void compared_with_reference(std::vector<std::string> parts) {
    group_.needs_reference = true;
    group_.reference_parts = std::move(parts);
  }

 private:
  struct Reader {
    std::string row;
    Read read;
  };
  using Readers = std::vector<Reader>;

  static MetricValues values(const Readers& readers, const std::optional<Measures>& measures) {
    MetricValues out(readers.size());
    if (!measures) return out;
    for (std::size_t i = 0; i < out.size(); ++i) {
      try {
        out[i] = readers[i].read(*measures);
      } catch (const Error& error) {
        throw MetricRowError(readers[i].row, error);
      }
    }
    return out;
  }

  MetricGroup group_;
  std::shared_ptr<Readers> readers_ = std::make_shared<Readers>();
};

namespace metric_rows_detail {

template <class T>
struct Measured {
  using Type = T;
};
template <class T>
struct Measured<std::optional<T>> {
  using Type = T;
};
/// Measures of a function that returns them, or an optional of them.
template <class Function, class... Arguments>
using MeasuresOf =
    typename Measured<std::decay_t<std::invoke_result_t<Function, Arguments...>>>::Type;

}  // namespace metric_rows_detail

/// Metrics of a frame: `measure(const TypedScene&, const Frame&)` returns what the rows read, or an
/// optional of it, absent where none of them has a meaning.
template <class TypedScene, class Measure>
auto frame_metrics(Measure measure) {
  MetricRows<metric_rows_detail::MeasuresOf<Measure, const TypedScene&, const Frame&>> rows;
  rows.measured_at_frame(
      [measure = std::move(measure)](const Scene& scene, const Frame& frame, const Frame*) {
        return measure(dynamic_cast<const TypedScene&>(scene), frame);
      });
  return rows;
}

/// Metrics of a frame that has a reference frame: `measure(const TypedScene&, const Frame& frame,
/// const Frame& reference)`, of which it looks at `reference_parts` only; empty: at all of it.
template <class TypedScene, class Measure>
auto reference_metrics(std::vector<std::string> reference_parts, Measure measure) {
  using Measures =
      metric_rows_detail::MeasuresOf<Measure, const TypedScene&, const Frame&, const Frame&>;
  MetricRows<Measures> rows;
  rows.compared_with_reference(std::move(reference_parts));
  rows.measured_at_frame(
      [measure = std::move(measure)](const Scene& scene, const Frame& frame,
                                     const Frame* reference) -> std::optional<Measures> {
        if (reference == nullptr) return std::nullopt;
        return measure(dynamic_cast<const TypedScene&>(scene), frame, *reference);
      });
  return rows;
}

/// Metrics of all frames together: `measure(const TypedScene&, const FrameSequence&)`.
template <class TypedScene, class Measure>
auto sequence_metrics(Measure measure) {
  MetricRows<metric_rows_detail::MeasuresOf<Measure, const TypedScene&, const FrameSequence&>> rows;
  rows.measured_over_sequence(
      [measure = std::move(measure)](const Scene& scene, const FrameSequence& frames) {
        return measure(dynamic_cast<const TypedScene&>(scene), frames);
      });
  return rows;
}

/// Metrics of events alone: `measure(const std::vector<Event>&)`.
template <class Measure>
auto event_metrics(Measure measure) {
  MetricRows<metric_rows_detail::MeasuresOf<Measure, const std::vector<Event>&>> rows;
  rows.measured_of_events(std::move(measure));
  return rows;
}

}  // namespace geoprior
