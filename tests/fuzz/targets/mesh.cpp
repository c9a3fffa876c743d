#include "testbed/formats/mesh/mesh_file.h"
#include "testbed/formats/mesh/named_files.h"
#include "testbed/formats/mesh/obj_reader.h"
#include "testbed/formats/mesh/off_reader.h"
#include "testbed/formats/mesh/ply_reader.h"
#include "testbed/formats/mesh/stl_reader.h"
#include "testbed/formats/sequence/repair.h"
#include "tests/fuzz/allow_error.h"
#include "tests/fuzz/targets.h"

namespace geoprior::test {
namespace {

/// What becomes of a mesh once it is read.
void use(MeshFile file) {
  SurfaceFrame frame;
  frame.mesh = std::move(file.mesh);
  frame.velocity = std::move(file.velocity);
  repair(frame, "fuzz", frame.notes);
}

}  // namespace

void fuzz_obj(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { use(parse_obj(text_of(data, size), "fuzz")); });
}

void fuzz_ply(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { use(parse_ply(text_of(data, size), "fuzz")); });
}

void fuzz_off(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { use(parse_off(text_of(data, size), "fuzz")); });
}

void fuzz_stl(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { use(parse_stl(text_of(data, size), "fuzz")); });
}

void fuzz_pvtp(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { parse_pvtp(text_of(data, size), "fuzz.pvtp"); });
}

}  // namespace geoprior::test
