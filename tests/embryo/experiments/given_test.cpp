// What a program from outside is given of a body, before anything is derived from it.
#include <gtest/gtest.h>

#include "experiments/embryo/frames/recorded.h"
#include "experiments/embryo/scene/scene.h"
#include "solvers/embryo/state/development.h"
#include "testbed/home.h"

namespace geoprior::embryo {
namespace {

std::shared_ptr<EmbryoScene> loaded(const EmbryoSceneOptions& options = {}) {
  return load_embryo_scene(options, geoprior_home() / "experiments/embryo");
}

int code(const EmbryoScene& scene, const char* name) {
  return scene.ontology.find_structure(name).value();
}

TEST(GivenEmbryo, KeysHaveWhatTheBodyHasOnTheirDays) {
  const auto scene = loaded();
  const Frame given = scene->given();
  const Development development(scene->ontology, scene->healthy_effects, {});
  const int kidney = code(*scene, "LeftMetanephros");
  const Eigen::MatrixXd& keys = given.require_table("keys").rows;
  int found = 0;
  for (Eigen::Index r = 0; r < keys.rows(); ++r) {
    const Eigen::RowVectorXd row = keys.row(r);
    if (row[1] != kidney) continue;
    const DayState state = development.at(row[2]);
    const Shape& shape = find_state(state, kidney)->shape;
    // Lengths are interpolated as logarithms.
    EXPECT_LT((row.segment<3>(14).transpose() - shape.radii).norm(), 1e-12 * shape.radii.norm());
    const Eigen::Vector3d ratio = row.segment<3>(5);
    EXPECT_EQ(row[4], -1) << "in the body's frame";
    EXPECT_LT((ratio * state.crown_rump_length - shape.center).norm(), 1e-12);
    ++found;
  }
  EXPECT_EQ(found, std::ssize(scene->ontology.structures[kidney].keys));
  EXPECT_GT(found, 5);
}

TEST(GivenEmbryo, StructuresAreThoseOfFramesInTheMiddlesOfStages) {
  const auto scene = loaded();
  const Frame given = scene->given();
  const Development development(scene->ontology, scene->healthy_effects, {});
  const FrameTable& all = given.require_table(recorded::kShapes);
  const Eigen::MatrixXd& stages = given.require_table("stages").rows;
  ASSERT_EQ(stages.rows(), std::ssize(scene->ontology.stages));
  const double day = stages(3, 2);
  Frame middle;
  FrameTable& own = middle.tables[recorded::kShapes];
  for (Eigen::Index r = 0; r < all.rows.rows(); ++r) {
    if (all.rows(r, 0) != day) continue;
    own.rows.conservativeResize(own.rows.rows() + 1, all.rows.cols() - 1);
    own.rows.bottomRows<1>() = all.rows.row(r).tail(all.rows.cols() - 1);
  }
  const DayState state = development.at(day);
  const std::vector<RecordedShape> shapes = recorded_shapes(middle);
  ASSERT_EQ(shapes.size(), state.structures.size());
  std::size_t ducts = 0;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    EXPECT_EQ(shapes[i].structure, state.structures[i].structure);
    EXPECT_TRUE(shapes[i].shape.center == state.structures[i].shape.center);
    ducts += shapes[i].shape.primitive == Primitive::duct ? 1 : 0;
  }
  const Part& lines = given.require_part("centrelines_0003", Part::Kind::lines);
  EXPECT_EQ(lines.lines.size(), ducts);
  EXPECT_EQ(lines.require_array(recorded::kStructure, NamedArray::On::cells, 1).names,
            scene->structure_labels);
}

TEST(GivenEmbryo, OfADiseaseWhatItNamesIsGivenAndNothingThatFollows) {
  EmbryoSceneOptions options;
  options.disease = "RenalAgenesisLeft";
  options.only = {"LeftUreter"};
  const auto scene = loaded(options);
  const Eigen::MatrixXd& catalogue = scene->given().require_table("catalogue").rows;
  EXPECT_EQ(catalogue(code(*scene, "LeftUretericBud"), 3), 1);
  EXPECT_EQ(catalogue(code(*scene, "LeftMetanephros"), 3), 0) << "its absence is a consequence";
  EXPECT_EQ(catalogue.col(2).sum(), 1);
  EXPECT_EQ(catalogue(code(*scene, "LeftUreter"), 2), 1);
  EXPECT_TRUE(scene->given().require_table(recorded::kShapes).rows ==
              loaded()->given().require_table(recorded::kShapes).rows)
      << "the healthy body's";
}

TEST(GivenEmbryo, EndsOfDuctsAreOnTheAnchorsGiven) {
  const auto scene = loaded();
  const Frame given = scene->given();
  const Development development(scene->ontology, scene->healthy_effects, {});
  const Eigen::MatrixXd &keys = given.require_table("keys").rows,
                        &ends = given.require_table("ends").rows;
  const int ureter = code(*scene, "LeftUreter");
  int anchored = 0;
  for (Eigen::Index r = 0; r < ends.rows(); ++r) {
    const Eigen::RowVectorXd key = keys.row(static_cast<Eigen::Index>(ends(r, 0)));
    EXPECT_EQ(key[3], static_cast<double>(Primitive::duct));
    if (key[1] != ureter || ends(r, 2) < 0) continue;
    const DayState state = development.at(key[2]);
    const StructureState* anchor = find_state(state, static_cast<int>(ends(r, 2)));
    const StructureState* duct = find_state(state, ureter);
    if (anchor == nullptr || duct == nullptr) continue;
    const Eigen::Vector3d end =
        ends(r, 1) == 0 ? duct->shape.points.front() : duct->shape.points.back();
    const Eigen::Vector3d uvw = ends.row(r).tail<3>();
    EXPECT_LT((anchor_point(anchor->shape, uvw) - end).norm(), 1e-12);
    ++anchored;
  }
  EXPECT_GT(anchored, 4);
}

TEST(GivenEmbryo, QuestionsAreOfTheScenesDays) {
  EmbryoSceneOptions options;
  options.days = {44, 58};
  const auto scene = loaded(options);
  const Frame given = scene->given();
  const Eigen::MatrixXd& questions = given.require_table("questions").rows;
  ASSERT_EQ(questions.rows(), 2);
  EXPECT_EQ(questions(1, 1), 58);
  EXPECT_EQ(questions(1, 2), code(*scene, "LeftMetanephros"));
  EXPECT_EQ(questions(1, 3), code(*scene, "UrinarySystem"));
}

}  // namespace
}  // namespace geoprior::embryo
