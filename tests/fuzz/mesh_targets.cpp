#include <string_view>

#include "core/error.h"
#include "experiments/fluid/mesh_sequence_repair.h"
#include "experiments/formats/mesh_file.h"
#include "tests/fuzz/targets.h"

namespace geoprior::test {
namespace {

/// Runs a reader; Error is its way to refuse.
template <class Action>
void allow_error(Action action) {
  try {
    action();
  } catch (const Error&) {
  }
}

std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// What becomes of a mesh once it is read.
void use(MeshFile file) {
  SurfaceFrame frame;
  frame.mesh = std::move(file.mesh);
  frame.velocity = std::move(file.velocity);
  std::vector<std::string> notes;
  repair(frame, "fuzz", notes);
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

}  // namespace geoprior::test
