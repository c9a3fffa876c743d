#include "testbed/runner/spec/scene_place.h"

#include <gtest/gtest.h>

namespace geoprior {
namespace {

TEST(ScenePlace, IsThatOfTheLongestPathThatTheFileHas) {
  const std::map<std::string, std::string> places{{"scene", "f:3:1"},
                                                  {"scene.handles", "f:5:1"},
                                                  {"scene.handles.0", "f:6:3"},
                                                  {"scene.handles.1", "f:7:3"},
                                                  {"scene.handles.1.keys", "f:7:20"}};
  const auto place = [&](const char* message) { return place_of_scene_key(places, message); };
  EXPECT_EQ(place("scene.handles.1.keys: is empty"), "f:7:20");
  EXPECT_EQ(place("scene.handles.1 'left hand'.keys.2.t: 1 does not follow 2"), "f:7:20");
  EXPECT_EQ(place("scene.handles.0 and scene.handles.1 meet"), "f:6:3");
  EXPECT_EQ(place("scene.handles.10: is one too many"), "f:5:1");
  EXPECT_EQ(place("scene.gravity: is not finite"), "f:3:1") << "a default: where the scene begins";
  EXPECT_EQ(place("human.glb: no skin"), "");
}

}  // namespace
}  // namespace geoprior
