#include <memory>
#include <string>

#include "experiments/grammar/files/gesture_file.h"
#include "experiments/grammar/scene/arm.h"
#include "solvers/grammar/engine/derivation.h"
#include "solvers/grammar/script/lua_rules.h"
#include "tests/fuzz/allow_error.h"
#include "tests/fuzz/targets.h"

namespace geoprior::test {

using namespace grammar;

void fuzz_gesture(const std::uint8_t* data, std::size_t size) {
  allow_error([&] {
    const Gesture gesture = parse_gesture(text_of(data, size), "fuzz");
    const auto map = map_of(gesture, 0.7);
    map->with_jacobian({0.1, 0.2, 0.9});
    drawn(gesture);
  });
}

/// The script is loaded, and its rules interpret a shift of a chain of joints.
void fuzz_rules(const std::uint8_t* data, std::size_t size) {
  allow_error([&] {
    LuaLimits limits;
    limits.instructions = 20000;
    limits.memory = 1 << 20;
    const RuleSet rules = lua_rules(std::string(text_of(data, size)), "fuzz.lua", limits, 1, {});
    Hierarchy arm = make_arm({});
    Transaction undo(arm);
    const auto map =
        std::make_shared<AffineMap>(Eigen::Affine3d(Eigen::Translation3d(0.1, 0, 0.2)));
    derive(arm, undo, rules, {0, Delta::free(map)});
  });
}

}  // namespace geoprior::test
