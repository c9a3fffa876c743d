#include "models/sound/events/event.h"

namespace geoprior::sound {
namespace {

/// The plain numbers of an event, in the order in which they are saved.
template <class Event>
auto numbers(Event& e) {
  return std::array{&e.time,          &e.duration,    &e.energy,      &e.ruling_length,
                    &e.free_border,   &e.area,        &e.curvature,   &e.flipped_area,
                    &e.blocked_share, &e.position[0], &e.position[1], &e.position[2]};
}

}  // namespace

void save(const SoundEvent& event, StateWriter& out) {
  out.number(static_cast<int>(event.kind));
  for (const double* x : numbers(event)) out.number(*x);
  out.items(event.sliding);
  out.items(event.cells);
  out.number(event.flips.size());
  for (const FlippedCell& flip : event.flips) {
    out.number(flip.cell);
    out.number(flip.change);
  }
}

SoundEvent load_sound_event(StateReader& in) {
  SoundEvent event;
  event.kind = static_cast<SoundKind>(in.number<int>());
  for (double* x : numbers(event)) *x = in.number<double>();
  in.items(event.sliding);
  in.items(event.cells);
  event.flips.resize(in.count(sizeof(int) + sizeof(double)));
  for (FlippedCell& flip : event.flips) {
    flip.cell = in.number<int>();
    flip.change = in.number<double>();
  }
  return event;
}

}  // namespace geoprior::sound
