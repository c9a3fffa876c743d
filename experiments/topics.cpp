#include "experiments/details/topic.h"
#include "experiments/fluid/topic.h"
#include "experiments/paper/topic.h"
#include "experiments/skinning/topic.h"
#include "experiments/topic.h"

namespace geoprior {

std::vector<Topic> all_topics() {
  return {skinning_topic(), paper_topic(), fluid_topic(), details_topic()};
}

}  // namespace geoprior
