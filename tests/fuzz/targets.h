#pragma once

#include <cstddef>
#include <cstdint>

namespace geoprior::test {

/// What is fuzzed: each reads bytes and may throw Error and nothing else.
void fuzz_gltf(const std::uint8_t* data, std::size_t size);
void fuzz_bvh(const std::uint8_t* data, std::size_t size);
void fuzz_toml(const std::uint8_t* data, std::size_t size);

}  // namespace geoprior::test
