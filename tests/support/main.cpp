// `main` of every test executable.
#include "tests/support/watched_tests.h"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  return geoprior::test::run_watched_tests(geoprior::test::usual_cost());
}
