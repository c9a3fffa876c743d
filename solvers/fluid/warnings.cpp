#include "solvers/fluid/warnings.h"

namespace geoprior::fluid {

void Warnings::warn(const std::string& text, const std::string& about, double time,
                    FrameSink& sink) {
  if (!told_.insert(about).second) return;
  Event event;
  event.time_s = time;
  event.kind = "warning: " + text;
  sink.event(event);
}

void Warnings::save(StateWriter& out) const {
  out.number(told_.size());
  for (const std::string& about : told_) out.text(about);
}

void Warnings::load(StateReader& in) {
  told_.clear();
  for (std::size_t left = in.count(); left > 0; --left) told_.insert(in.text());
}

}  // namespace geoprior::fluid
