#include "experiments/skinning/topic.h"
#include "experiments/topic.h"

namespace geoprior {

std::vector<Topic> all_topics() { return {skinning_topic()}; }

}  // namespace geoprior
