#pragma once

#include "models/embryo/body/body.h"
#include "models/embryo/body/day_state.h"
#include "models/embryo/motion/ease.h"
#include "models/embryo/ontology/ontology.h"
#include "solvers/embryo/rules/effects.h"

namespace geoprior::embryo {

struct StateOptions {
  Interpolation interpolation = Interpolation::monotone;
};

/// What an ontology and the effects of a disease say of a body (thesis 2.3): the key frames of its
/// structures, and of its processes
///   growth       off: sizes stay as at its first day
///   migration    off: the place stays, as a ratio of the crown-rump length in its frame, and with
///                it the directions of the key frames
///   rotation     on: a turn over its span
///   fixation     off: the ends of the ducts that it acts on stay, as ratios in the body. Ducts
///                that no fixation acts on follow their anchors
///   division     on: a septum comes down through the whole, from the middle of its first stage to
///                the first day of its last one, on which the products begin
///   interaction  on: fuses structures from its first day on; `stops_at`, of any kind of process,
///                bounds what it acts on on every day
/// The first day of a process is the middle of its first stage. A process that is dormant and was
/// not enabled, or that requires such a one, is none that was switched off: it holds nothing.
BodyPlan body_plan(const Ontology& ontology, const Effects& effects, const StateOptions& options);

/// The state of every structure on any day. Asks nothing of the graph: what an ontology comes to is
/// found once. Cost: some tens of microseconds a day.
class Development {
 public:
  /// @throws Error  as Body does, and when the effects are those of another ontology
  Development(const Ontology& ontology, const Effects& effects, const StateOptions& options = {});

  /// @throws Error  for a day outside of the stages (names their range)
  [[nodiscard]] DayState at(double day) const { return body_.at(day); }
  [[nodiscard]] double first_day() const { return body_.first_day(); }
  [[nodiscard]] double last_day() const { return body_.last_day(); }

 private:
  Body body_;
};

}  // namespace geoprior::embryo
