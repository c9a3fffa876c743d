// What quick runs leave out: no topic's method.
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

#include "testbed/catalogue.h"
#include "testbed/runner/spec/spec.h"
#include "testbed/topic.h"

namespace geoprior::test {
namespace {

TEST(QuickRuns, RunEveryMethod) {
  const std::vector<Topic> topics = all_topics();
  LoadRequest quick;
  quick.quick = true;
  std::map<std::string, std::set<std::string>> methods;  // by topic
  for (const CatalogueEntry& entry : catalogue()) {
    for (const CaseSpec& made : load_experiment(entry.file, topics, quick).cases) {
      for (const VariantSpec& variant : made.variants) methods[entry.topic].insert(variant.method);
    }
  }
  for (const Topic& topic : topics) {
    for (const MethodEntry& method : topic.methods) {
      if (method.make_at) continue;  // tests/testbed/external runs it in every topic
      EXPECT_TRUE(methods[topic.name].contains(method.name)) << topic.name << " " << method.name;
    }
  }
}

}  // namespace
}  // namespace geoprior::test
