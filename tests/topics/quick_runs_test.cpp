// What quick runs leave out: no topic's method.
#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "testbed/runner/spec.h"
#include "testbed/topic.h"

namespace geoprior::test {
namespace {

namespace fs = std::filesystem;

TEST(QuickRuns, RunEveryMethod) {
  const std::vector<Topic> topics = all_topics();
  LoadRequest quick;
  quick.quick = true;
  for (const Topic& topic : topics) {
    std::set<std::string> methods;
    for (const auto& entry :
         fs::directory_iterator(GEOPRIOR_SOURCE_DIR "/experiments/" + topic.name)) {
      const fs::path& file = entry.path();
      if (file.extension() != ".toml" || file.stem().has_extension()) continue;
      for (const CaseSpec& made : load_experiment(file, topics, quick).cases) {
        for (const VariantSpec& variant : made.variants) methods.insert(variant.method);
      }
    }
    for (const MethodEntry& method : topic.methods) {
      EXPECT_TRUE(methods.contains(method.name)) << topic.name << " " << method.name;
    }
  }
}

}  // namespace
}  // namespace geoprior::test
