// geoprior with the toy topics of the tests: what tests start as a program of its own.
#include "experiments/program.h"
#include "tests/experiments/toy_topic.h"

int main(int argc, char** argv) {
  std::vector<geoprior::Topic> topics = geoprior::all_topics();
  for (geoprior::Topic& toy : geoprior::toy::topics()) topics.push_back(std::move(toy));
  return geoprior::run_program(argc, argv, topics);
}
