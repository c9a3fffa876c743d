#include "experiments/fluid/scene/edit_list.h"
#include "testbed/formats/sequence/pvd.h"
#include "testbed/formats/sequence/sidecar.h"
#include "tests/fuzz/allow_error.h"
#include "tests/fuzz/targets.h"

namespace geoprior::test {

using namespace fluid;

void fuzz_pvd(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { parse_pvd(text_of(data, size), "fuzz.pvd"); });
}

void fuzz_series(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { parse_series(text_of(data, size), "fuzz.vtp.series"); });
}

void fuzz_sidecar(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { parse_sidecar(text_of(data, size), "fuzz"); });
}

void fuzz_edits(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { parse_edit_list(text_of(data, size), "fuzz"); });
}

}  // namespace geoprior::test
