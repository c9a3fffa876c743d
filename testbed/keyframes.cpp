#include "testbed/keyframes.h"

#include "core/angles.h"
#include "core/error.h"

namespace geoprior {
namespace {

/// A rotation from key to key is the shorter way round: one of half a turn or more would go the
/// other way. Beyond a whole turn the quaternions, which repeat after two, no longer tell.
void require_less_than_half_a_turn(const KeyOptions& before, const KeyOptions& key,
                                   const std::string& where) {
  constexpr double kSlack = 1e-9;
  const double cosine_of_half = to_rotation(before.turn_deg).dot(to_rotation(key.turn_deg));
  const double change_deg = (to_vector(key.turn_deg) - to_vector(before.turn_deg)).norm();
  if (cosine_of_half > kSlack && change_deg < 360) return;
  throw Error("turns by 180 degrees or more from the key before", where,
              "less than 180 degrees from key to key");
}

}  // namespace

void describe(OptionVisitor& v, KeyOptions& options) {
  v.value("t", options.t, {.doc = "time of the key", .unit = "s", .required = true});
  v.value("move", options.move, {.doc = "displacement from the place at the start", .unit = "m"});
  v.value("turn_deg", options.turn_deg,
          {.doc = "rotation about the centre, axis times angle; less than 180 from key to key",
           .unit = "deg"});
}

void describe_keys(OptionVisitor& v, std::vector<KeyOptions>& keys) {
  describe_list(v, "keys", keys,
                {.doc = "motion: place and orientation at times that increase, cubic between"});
}

Eigen::Vector3d to_vector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

Eigen::Quaterniond to_rotation(const std::array<double, 3>& turn_deg) {
  const Eigen::Vector3d r = to_vector(turn_deg) * kDegree;
  const double angle = r.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, r / angle));
}

Trajectory to_trajectory(const std::vector<KeyOptions>& keys, const std::string& where) {
  Trajectory result;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const KeyOptions& key = keys[i];
    if (i > 0) {
      require_less_than_half_a_turn(keys[i - 1], key,
                                    where + "." + std::to_string(i) + ".turn_deg");
    }
    result.keys.push_back({key.t, to_vector(key.move), to_rotation(key.turn_deg)});
  }
  return result;
}

}  // namespace geoprior
