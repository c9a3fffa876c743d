#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  geoprior::test::fuzz_xtrackcad(data, size);
  return 0;
}
