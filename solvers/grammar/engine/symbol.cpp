#include "solvers/grammar/engine/symbol.h"

namespace geoprior::grammar {

std::string_view name_of(DeltaKind kind) {
  constexpr std::string_view kNames[] = {"identity",  "free",    "rigid",         "affine",
                                         "translate", "extrude", "set-parameter", "children"};
  return kNames[static_cast<int>(kind)];
}

std::string_view name_of(Origin origin) {
  constexpr std::string_view kNames[] = {"user", "parent", "child", "self"};
  return kNames[static_cast<int>(origin)];
}

std::string_view name_of(Phase phase) { return phase == Phase::up ? "up" : "down"; }

}  // namespace geoprior::grammar
