// What somebody gets of `geoprior derive`.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiments/grammar/topic.h"
#include "testbed/formats/text/text_file.h"
#include "tests/testbed/program_process.h"
#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class DeriveProgram : public geoprior::test::ScratchFolder {
 protected:
  int derive_words(std::vector<std::string> words) const {
    words.insert(words.begin(), "derive");
    geoprior::test::ProgramProcess program(
        [&] { return geoprior::test::run_as_program(words, {make_topic()}); }, folder() / "log");
    return program.wait();
  }
  [[nodiscard]] std::string log() const { return text(folder() / "log"); }
  [[nodiscard]] static std::string text(const std::filesystem::path& file) {
    return read_text_file(file);
  }
};

TEST_F(DeriveProgram, PrintsTheDerivationAsATree) {
  const std::string file = write("small.toml", R"(topic = "grammar"
[scene]
object = "arm"
edits = [{ element = "joint-2", kind = "turn", angle_deg = 30 }]
)")
                               .string();
  ASSERT_EQ(derive_words({file, "--out", (folder() / "tree.txt").string()}), 0) << log();
  EXPECT_THAT(text(folder() / "tree.txt"),
              AllOf(HasSubstr("^ joint-2  rigid from user"), HasSubstr("v part-2")));
  EXPECT_THAT(log(), HasSubstr("would change"));
}

TEST_F(DeriveProgram, RefusesWhatIsNoStepOfTheScene) {
  const std::string file = write("small.toml", R"(topic = "grammar"
[scene]
object = "arm"
edits = [{ element = "joint-2", kind = "turn", angle_deg = 30 }]
)")
                               .string();
  EXPECT_EQ(derive_words({file, "--step", "2"}), 2);
  EXPECT_THAT(log(), HasSubstr("--step: there is no step 2 (allowed: 1 to 1)"));
  const std::string other = write("other.toml", "topic = \"torus\"\n[scene]\n").string();
  EXPECT_EQ(derive_words({other}), 2);
  EXPECT_THAT(log(), HasSubstr("is of the topic 'torus' (allowed: grammar)"));
}

}  // namespace
}  // namespace geoprior::grammar
