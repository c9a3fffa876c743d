#include "models/sound/events/friction.h"

#include <algorithm>

namespace geoprior::sound {

using Eigen::Vector3d;

SlideDetector::SlideDetector(const Sheet& sheet, const SoundGrid& grid)
    : sheet_(sheet), grid_(grid), courses_(sheet.obstacles.size()) {}

SoundEvent SlideDetector::event_of(const Course& course) const {
  SoundEvent event;
  event.kind = SoundKind::friction;
  event.time = course.sliding.front().time;
  event.duration = course.sliding.back().time - event.time;
  event.position = course.weighted_place / course.weight;
  event.sliding = course.sliding;
  double slid = 0, held = 0;
  for (std::size_t i = 1; i < course.sliding.size(); ++i) {
    const Sliding &a = course.sliding[i - 1], &b = course.sliding[i];
    const double dt = b.time - a.time;
    event.energy += dt * (a.power + b.power) / 2;
    slid += dt * (a.area + b.area) / 2;
    held += dt;
  }
  event.area = held > 0 ? slid / held : course.sliding.front().area;
  return event;
}

std::vector<SoundEvent> SlideDetector::push(const SheetField& field) {
  std::vector<SoundEvent> ended;
  for (std::size_t k = 0; k < courses_.size(); ++k) {
    const paper::ObstacleAt obstacle(sheet_.obstacles[k], field.time);
    Course& course = courses_[k];
    Sliding now{field.time};
    for (int c = 0; c < grid_.count(); ++c) {
      if (!field.inside[c]) continue;
      const Vector3d place = field.place.row(c);
      const Obstacle::Contact contact = obstacle.contact(place);
      if (contact.distance > contact_.distance + kSlideMargin) continue;
      const Vector3d relative = field.velocity.row(c).transpose() - contact.velocity;
      const double slip = (relative - relative.dot(contact.normal) * contact.normal).norm();
      if (slip < kLeastSlideSpeed) continue;
      const double area = grid_.cell_area();
      const double pressure =
          contact_.stiffness * std::max(0.0, contact_.distance - contact.distance);
      now.area += area;
      now.speed += area * slip;
      now.power += sheet_.material.friction * pressure * slip * area;
      course.weighted_place += area * place;
      course.weight += area;
    }
    if (now.area > 0) {
      now.speed /= now.area;
      course.sliding.push_back(now);
      continue;
    }
    if (course.sliding.empty()) continue;
    if (field.time - course.sliding.back().time <= kSlidePause) continue;
    ended.push_back(event_of(course));
    course = {};
  }
  return ended;
}

std::vector<SoundEvent> SlideDetector::finish() {
  std::vector<SoundEvent> ended;
  for (Course& course : courses_) {
    if (!course.sliding.empty()) ended.push_back(event_of(course));
    course = {};
  }
  return ended;
}

void SlideDetector::save(StateWriter& out) const {
  for (const Course& course : courses_) {
    out.items(course.sliding);
    out.matrix(course.weighted_place);
    out.number(course.weight);
  }
}

void SlideDetector::load(StateReader& in) {
  for (Course& course : courses_) {
    in.items(course.sliding);
    in.matrix(course.weighted_place);
    course.weight = in.number<double>();
  }
}

}  // namespace geoprior::sound
