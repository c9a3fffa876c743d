#include "core/freed_memory.h"
#include "testbed/program.h"
#include "testbed/topic.h"

int main(int argc, char** argv) {
  geoprior::keep_freed_memory();
  return geoprior::run_program(argc, argv, geoprior::all_topics());
}
