// The program with the topic that is plugged in, alone.
#include "testbed/program.h"

#include "testbed/topic.h"

namespace geoprior::sample {
Topic make_topic();
}

int main(int argc, char** argv) {
  return geoprior::run_program(argc, argv, {geoprior::sample::make_topic()});
}
