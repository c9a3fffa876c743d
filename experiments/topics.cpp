#include "testbed/external/method.h"
#include "testbed/topic.h"

/// Every topic of the program, in the order in which they are listed: one line each. CMake has the
/// other line, and says by GEOPRIOR_HAS_<name> which of them this program was built with.
#define GEOPRIOR_TOPICS(TOPIC) \
  TOPIC(skinning)              \
  TOPIC(paper)                 \
  TOPIC(sound)                 \
  TOPIC(fluid)                 \
  TOPIC(details)               \
  TOPIC(sketch)                \
  TOPIC(torus)                 \
  TOPIC(assembly)              \
  TOPIC(grammar)               \
  TOPIC(embryo)

/// What experiments/<name> defines.
#define GEOPRIOR_DECLARE(name) \
  namespace geoprior::name {   \
  Topic make_topic();          \
  }
GEOPRIOR_TOPICS(GEOPRIOR_DECLARE)

namespace geoprior {

std::vector<Topic> all_topics() {
  std::vector<Topic> topics;
#define GEOPRIOR_ADD(name) \
  if constexpr (GEOPRIOR_HAS_##name) topics.push_back(name::make_topic());
  GEOPRIOR_TOPICS(GEOPRIOR_ADD)
  for (Topic& topic : topics) add_external_method(topic);
  return topics;
}

}  // namespace geoprior
