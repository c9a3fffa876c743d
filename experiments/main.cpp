#include "experiments/program.h"
#include "experiments/topic.h"

int main(int argc, char** argv) {
  return geoprior::run_program(argc, argv, geoprior::all_topics());
}
