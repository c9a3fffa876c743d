// Claims of all experiments together: what no single file can see.
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "testbed/catalogue.h"
#include "testbed/runner/inputs/made_run.h"
#include "testbed/runner/reference/reference.h"
#include "testbed/runner/spec/spec.h"
#include "testbed/topic.h"

namespace geoprior::test {
namespace {

// A sentence that stands in two files is counted twice, and says of neither scene what is seen.
TEST(Claims, SayEachSentenceOnce) {
  const std::vector<Topic> topics = all_topics();
  std::map<std::string, std::string> said_in;
  for (const CatalogueEntry& entry : catalogue()) {
    for (const ClaimSpec& claim : load_experiment(entry.file, topics, {}).claims) {
      const auto known = said_in.emplace(claim.text, entry.id).first;
      EXPECT_EQ(known->second, entry.id) << claim.text;
    }
  }
}

// What is not blessed could be decided in fewer cases, or against another null, and nobody saw it.
TEST(Claims, OfQuickRunsAreBlessed) {
  const std::vector<Topic> topics = all_topics();
  LoadRequest quick;
  quick.quick = true;
  for (const CatalogueEntry& entry : catalogue()) {
    Experiment experiment = load_experiment(entry.file, topics, quick);
    leave_out_times(experiment);
    const BlessedClaims blessed = read_reference(reference_file(entry.id)).at("quick").claims;
    for (const ClaimSpec& claim : experiment.claims) {
      EXPECT_TRUE(blessed.contains(claim.text)) << entry.id << ": " << claim.text;
    }
  }
}

}  // namespace
}  // namespace geoprior::test
