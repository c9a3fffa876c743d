#include <cstring>
#include <string_view>
#include <vector>

#include "experiments/assembly/files/assembly_file.h"
#include "experiments/assembly/files/gltf_parts.h"
#include "experiments/assembly/files/xtrackcad.h"
#include "tests/fuzz/allow_error.h"
#include "tests/fuzz/targets.h"

namespace geoprior::test {

using namespace assembly;

void fuzz_assembly(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = text_of(data, size);
  allow_error([&] {
    const bool json = text.starts_with('{');
    const ReadAssemblies read = parse_assembly_file(text, "fuzz", "no-folder", json);
    require_valid(read.set);
  });
}

void fuzz_xtrackcad(const std::uint8_t* data, std::size_t size) {
  allow_error([&] {
    ReadAssemblies read;
    read_xtrackcad_text(text_of(data, size), "fuzz.xtc", read);
    require_valid(read.set);
  });
}

/// What is read is also written, as a variation of it would be.
void fuzz_gltf_parts(const std::uint8_t* data, std::size_t size) {
  std::vector<std::byte> bytes(size);
  if (size > 0) std::memcpy(bytes.data(), data, size);
  allow_error([&] {
    const GltfParts parts = read_gltf_parts_bytes(bytes, "fuzz.glb");
    require_valid(parts.read.set);
    assembly_glb(parts, parts.read.set.models.front());
  });
}

}  // namespace geoprior::test
