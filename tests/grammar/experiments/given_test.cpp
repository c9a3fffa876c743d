// What a program from outside is given of an object and what is asked of it.
#include <gtest/gtest.h>

#include "experiments/grammar/measures/recorded_state.h"
#include "tests/grammar/experiments/loaded.h"

namespace geoprior::grammar {
namespace {

/// A small tree whose third branch is turned, then pulled over in two steps.
GrammarSceneOptions leaning_tree() {
  GrammarSceneOptions options;
  options.tree.branches = 60;
  options.edits.push_back(
      {.element = "branch-3", .kind = EditOptions::Kind::turn, .angle_deg = 30});
  options.gesture = GestureOptions{};
  options.gesture->file = "gestures/lean.gesture.toml";
  options.gesture->steps = 2;
  return options;
}

/// The dabs of a frame, as its rows say.
StrokeMap map_of_rows(const FrameTable& table, int frame) {
  std::vector<Dab> dabs;
  for (Eigen::Index r = 0; r < table.rows.rows(); ++r) {
    const Eigen::RowVectorXd row = table.rows.row(r);
    if (row[0] != frame) continue;
    const auto three = [&](int column) -> Eigen::Vector3d { return row.segment<3>(column); };
    dabs.push_back({static_cast<Stroke::Kind>(static_cast<int>(row[1])), three(2), row[5], three(6),
                    three(9), three(12), row[15]});
  }
  EXPECT_FALSE(dabs.empty());
  return StrokeMap(dabs);
}

TEST(GivenGrammar, TheRestIsThatOfFramesAndTypesAreNamed) {
  const auto scene = loaded(leaning_tree());
  const Frame given = scene->given();
  const RecordedState read(given, scene->rest.types()), rest(scene->rest);
  ASSERT_EQ(read.elements().size(), rest.elements().size());
  for (std::size_t i = 0; i < rest.elements().size(); ++i)
    EXPECT_TRUE(same_bytes(read.elements()[i], rest.elements()[i]));
  EXPECT_NE(given.find_part("surface"), nullptr);
  const NamedArray& type = given.require_array("elements", "type", NamedArray::On::points, 1);
  EXPECT_EQ(type.names.at(1), "branch");
}

TEST(GivenGrammar, ParametersAreColumnsOfTheirType) {
  const auto scene = loaded(leaning_tree());
  const Frame given = scene->given();
  const FrameTable& branches = given.require_table("type_0001");
  EXPECT_EQ(branches.columns.at(1), "length [m]");
  for (Eigen::Index r = 0; r < branches.rows.rows(); ++r)
    EXPECT_EQ(branches.rows(r, 1),
              scene->rest.parameter(static_cast<int>(branches.rows(r, 0)),
                                    scene->rest.types()[1].parameter("length")));
  EXPECT_EQ(branches.rows.rows(), 60);
}

TEST(GivenGrammar, DabsAndAskedPlacesAreOneMap) {
  auto options = leaning_tree();
  options.edits.clear();
  const auto scene = loaded(options);
  const Frame given = scene->given();
  const Eigen::MatrixX3d& rest = given.require_part("keys").points;
  EXPECT_TRUE(given.require_part("asked_0000").points == rest);
  for (const int frame : {1, 2}) {
    const StrokeMap map = map_of_rows(given.require_table("dabs"), frame);
    const Eigen::MatrixX3d& asked =
        given.require_part(frame == 1 ? "asked_0001" : "asked_0002").points;
    ASSERT_EQ(asked.rows(), rest.rows());
    for (Eigen::Index k = 0; k < rest.rows(); ++k)
      EXPECT_EQ(map.at(rest.row(k)), Eigen::Vector3d(asked.row(k)));
  }
}

TEST(GivenGrammar, AnEditMovesWhatIsBelowItByTheMotionGiven) {
  const auto scene = loaded(leaning_tree());
  const Frame given = scene->given();
  const FrameTable& edits = given.require_table("edits");
  ASSERT_EQ(edits.rows.rows(), 1);
  const Eigen::RowVectorXd row = edits.rows.row(0);
  const int element = scene->edits[0].wish.element;
  EXPECT_EQ(row[0], 1) << "the frame of the edit";
  EXPECT_EQ(row[1], element);
  const Eigen::RowVectorXd last = row.tail<12>();
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> motion(last.data());
  const Part &rest = given.require_part("keys"), &asked = given.require_part("asked_0001");
  const Eigen::MatrixXd& of = rest.require_array("element", NamedArray::On::points, 1).values;
  int moved = 0;
  for (Eigen::Index k = 0; k < of.rows(); ++k) {
    const Eigen::Vector3d x = rest.points.row(k), y = asked.points.row(k);
    const bool is_below = scene->rest.is_below(static_cast<int>(of(k, 0)), element);
    const Eigen::Vector3d wanted = is_below ? Eigen::Vector3d(motion * x.homogeneous()) : x;
    EXPECT_LT((y - wanted).norm(), 1e-12);
    moved += is_below ? 1 : 0;
  }
  EXPECT_GT(moved, 0);
}

TEST(GivenGrammar, EveryRandomGestureIsGiven) {
  GrammarSceneOptions options;
  options.object = Object::volume_set;
  options.volume_set.spacing = 0.5;
  options.random = RandomGestureOptions{3, 0};
  const auto scene = loaded(options);
  const Frame given = scene->given();
  EXPECT_EQ(given.require_table("steps").rows.rows(), 4);
  for (int step = 1; step <= 3; ++step) {
    const StrokeMap map = map_of_rows(given.require_table("dabs"), step);
    const Eigen::Vector3d x(0.1, 0.2, -0.1);
    EXPECT_EQ(map.at(x), scene->asked_map(step)->at(x));
  }
}

}  // namespace
}  // namespace geoprior::grammar
