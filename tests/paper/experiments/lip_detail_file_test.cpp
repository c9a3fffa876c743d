// What a user likes to see along the lips of a tear, asked for in an experiment file.

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <string>
#include <variant>

#include "experiments/paper/topic.h"
#include "tests/support/recording.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::paper {
namespace {

using namespace test;

/// A sheet cut nearly through, its two halves pulled apart out of the plane.
const std::string kTorn = R"(title = "Lips"
topic = "paper"
[scene]
pattern        = { kind = "rectangle", width = 0.08, height = 0.1, cuts = [{ points = [{ u = 0, v = -0.05 }, { u = 0, v = 0.02 }] }] }
toughness      = { energy = 3e3 }
gravity        = [0, 0, 0]
duration       = 0.6
frame_interval = 0.3
substeps       = 6
handle_step    = 5e-3
handles        = [
  { points = [{ u = -0.03, v = -0.05 }, { u = -0.005, v = -0.05 }], stiffness = 300, keys = [{ t = 0 }, { t = 0.6, move = [0, 0.05, 0.09] }] },
  { points = [{ u = 0.03, v = -0.05 }, { u = 0.005, v = -0.05 }], stiffness = 300, keys = [{ t = 0 }, { t = 0.6, move = [0, 0.05, -0.09] }] },
]
)";

class LipDetailInAFile : public RunTest {
 protected:
  /// The last frame of each variant, which has these options for the detail.
  [[nodiscard]] std::map<std::string, Frame> last_frames(
      const std::string& method, const std::string& options,
      const std::map<std::string, std::string>& variants) const {
    std::string text = kTorn;
    for (const auto& [name, detail] : variants)
      text += "[[variant]]\nname = \"" + name + "\"\nmethod = \"" + method + "\"\noptions = { " +
              options + "tearing = { detail = { " + detail + " } } }\n";
    const auto file = write_experiment("paper/lips", text);
    const Topic topic = make_topic();
    const Experiment experiment = load_experiment(file, {topic}, {});
    const CaseSpec& given = experiment.cases[0];
    const auto scene = topic.load(*given.scene, file.parent_path(), 1);
    std::map<std::string, Frame> frames;
    for (const VariantSpec& variant : given.variants) {
      for (const MethodEntry& entry : topic.methods) {
        if (entry.name != variant.method) continue;
        RunContext context(1);
        auto instance = entry.make(*scene, *variant.options, context);
        Recording recording;
        std::get<std::unique_ptr<Process>>(instance)->run(recording, context, {});
        frames[variant.name] = recording.frames.back();
      }
    }
    return frames;
  }
};

double band_cells(const Frame& frame) {
  const Part& lips = frame.require_part("lip_detail", Part::Kind::triangles);
  return lips.require_array("bevel", NamedArray::On::cells, 1).values.sum();
}

TEST_F(LipDetailInAFile, IsWhatTheUserAsksFor) {
  const std::map<std::string, std::string> methods{
      {"dense", "triangles = 60, "},
      {"adaptive", "size_min = 0.05, size_max = 0.2, refine_angle = 1, settle = { steps = 0 }, "},
      {"hybrid", "flat_size = 0.05, "}};
  for (const auto& [method, options] : methods) {
    const auto frames = last_frames(method, options,
                                    {{"off", "on = false"},
                                     {"all", "on = true"},
                                     {"straight", "on = true, noise = 0"},
                                     {"bald", "on = true, fibre_length = 0"},
                                     {"plain", "on = true, bevel = 0"}});
    EXPECT_EQ(frames.at("off").find_part("lip_detail"), nullptr) << method;
    EXPECT_EQ(frames.at("off").find_part("fibres"), nullptr) << method;
    const Part& all = frames.at("all").require_part("lip_detail", Part::Kind::triangles);
    ASSERT_GT(all.triangles.rows(), 0) << method;
    // Straight lips gain nothing: what is left is the band.
    const Part& straight = frames.at("straight").require_part("lip_detail", Part::Kind::triangles);
    EXPECT_EQ(static_cast<double>(straight.triangles.rows()), band_cells(frames.at("straight")))
        << method;
    EXPECT_GT(static_cast<double>(all.triangles.rows()), band_cells(frames.at("all"))) << method;
    EXPECT_FALSE(frames.at("all").require_part("fibres").lines.empty()) << method;
    EXPECT_TRUE(frames.at("bald").require_part("fibres").lines.empty()) << method;
    EXPECT_GT(band_cells(frames.at("all")), 0) << method;
    EXPECT_EQ(band_cells(frames.at("plain")), 0) << method;
  }
}

}  // namespace
}  // namespace geoprior::paper
