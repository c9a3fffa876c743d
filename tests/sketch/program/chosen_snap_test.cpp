// How far ends of borders are joined, by what the drawing itself says.

#include "experiments/sketch/command/chosen_snap.h"

#include <gtest/gtest.h>

#include "experiments/sketch/drawing/drawing_file.h"
#include "solvers/sketch/one_view.h"

namespace geoprior::sketch {
namespace {

View one_view_of(const char* name) {
  const Drawing drawing =
      read_drawing(std::string(GEOPRIOR_SOURCE_DIR "/experiments/sketch/") + name, {}).drawing;
  return *drawing.find(ViewKind::photo);
}

// The strap of the bag and the comb of the helmet end nearer to other borders than 2 percent of the
// diagonal, which they do not belong to: their panels say so, and without them it shows.
TEST(ChosenSnap, IsLessWhereStrangersWouldBeJoined) {
  for (const char* name : {"bag.svg", "helmet.svg"}) {
    View view = one_view_of(name);
    EXPECT_FALSE(chosen_snap(view)) << name;
    for (Stroke& stroke : view.strokes) {
      stroke.panels.clear();
      if (stroke.name == "strap" || stroke.name == "comb") stroke.name.clear();
    }
    const std::optional<double> snap = chosen_snap(view);
    ASSERT_TRUE(snap) << name;
    EXPECT_LT(*snap, OneViewOptions().curves.snap) << name;
  }
}

TEST(ChosenSnap, IsTheUsualOneWhereItJoinsWhatBelongsTogether) {
  EXPECT_FALSE(chosen_snap(one_view_of("tent.svg")));
}

}  // namespace
}  // namespace geoprior::sketch
