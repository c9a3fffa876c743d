#include <string_view>

#include "core/error.h"
#include "experiments/fluid/edit_list.h"
#include "experiments/fluid/sequence_files_pvd.h"
#include "experiments/fluid/sequence_files_sidecar.h"
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

}  // namespace

void fuzz_pvd(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { parse_pvd(text_of(data, size), "fuzz.pvd"); });
}

void fuzz_sidecar(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { parse_sidecar(text_of(data, size), "fuzz"); });
}

void fuzz_edits(const std::uint8_t* data, std::size_t size) {
  allow_error([&] { parse_edit_list(text_of(data, size), "fuzz"); });
}

}  // namespace geoprior::test
