#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "experiments/skinning/scene/scene.h"
#include "experiments/skinning/topic.h"
#include "tests/skinning/experiments/made_rigs.h"
#include "tests/testbed/run_fixture.h"

namespace geoprior::skinning {

/// Experiments on a character that the test has made: my.glb, whose joint "upper" turns by 60
/// degrees about y in two frames unless another motion is given.
class MadeCharacterTest : public test::RunTest {
 protected:
  static constexpr const char* kBend =
      "motion = { joint = \"upper\", axis = \"+y\", to_deg = 60, frames = 2 }\n";

  void write_character(const test::GltfSample& sample) const {
    const auto path = folder() / "experiments" / "skinning" / "my.glb";
    std::filesystem::create_directories(path.parent_path());
    const std::vector<std::byte> bytes = sample.bytes();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::ssize(bytes));
  }

  [[nodiscard]] Experiment experiment(const std::string& scene_lines, const std::string& motion,
                                      const std::string& variants) const {
    const auto file = write_experiment("skinning/mine",
                                       "title = \"Mine\"\ntopic = \"skinning\"\n[scene]\n"
                                       "character = \"my.glb\"\n" +
                                           scene_lines + motion + variants);
    return load_experiment(file, {make_topic()}, {});
  }
  [[nodiscard]] static std::string variant(const std::string& method) {
    return "[[variant]]\nname = \"" + method + "\"\nmethod = \"" + method + "\"\n";
  }

  [[nodiscard]] std::shared_ptr<SkinningScene> load(const std::string& scene_lines,
                                                    const std::string& motion = kBend) const {
    const Experiment mine = experiment(scene_lines, motion, variant("linear-blend"));
    return std::dynamic_pointer_cast<SkinningScene>(
        make_topic().load(*mine.cases[0].scene, mine.file.parent_path(), 1));
  }

  /// The frame of a method's default options at the end of the motion.
  [[nodiscard]] Frame posed(const SkinningScene& scene, const std::string& method) const {
    for (const MethodEntry& entry : methods()) {
      if (entry.name != method) continue;
      RunContext context;
      const auto made = entry.make(scene, *entry.default_options(), context);
      PoseMethod& pose = *std::get<std::unique_ptr<PoseMethod>>(made);
      pose.solve(scene.frame_parameter.back(), context);
      return pose.frame();
    }
    throw Error("no method '" + method + "'");
  }

  /// Runs every method.
  [[nodiscard]] CaseRecord run_all(const std::string& scene_lines,
                                   const std::string& motion = kBend) const {
    std::string variants;
    for (const MethodEntry& entry : methods()) variants += variant(entry.name);
    ExecuteRequest request;
    request.out = folder() / "out";
    request.timing = false;
    return execute(experiment(scene_lines, motion, variants), {make_topic()}, request)
        .record.cases.at(0);
  }

  /// The error of a run; fails when it left anything.
  [[nodiscard]] std::string refusal(const std::string& scene_lines,
                                    const std::string& motion = kBend) const {
    const std::string error =
        test::error_of([&] { static_cast<void>(run_all(scene_lines, motion)); });
    EXPECT_FALSE(std::filesystem::exists(folder() / "out")) << error;
    return error;
  }
};

}  // namespace geoprior::skinning
