// A program like geoprior with the toy topics of the tests, which start, kill and resume it.
#include "experiments/toy/toy_topic.h"
#include "testbed/program.h"

int main(int argc, char** argv) {
  return geoprior::run_program(argc, argv, geoprior::toy::topics());
}
