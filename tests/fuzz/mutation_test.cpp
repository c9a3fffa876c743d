#include "tests/fuzz/mutation.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <string>
#include <vector>

#include "tests/fuzz/targets.h"

// Seeded mutations of the files in tests/fuzz/corpus: every reader either accepts what it is given
// or throws Error. The number of mutations is fixed; GEOPRIOR_FUZZ_SECONDS goes on for that long.

namespace geoprior::test {
namespace {

using Target = void (*)(const std::uint8_t*, std::size_t);

double seconds_asked() {
  const char* text = std::getenv("GEOPRIOR_FUZZ_SECONDS");
  return text == nullptr ? 0 : std::strtod(text, nullptr);
}

void run(const std::string& extension, Target target) {
  const std::vector<std::string> seeds = corpus(extension);
  ASSERT_FALSE(seeds.empty());
  for (const std::string& seed : seeds)
    target(reinterpret_cast<const std::uint8_t*>(seed.data()), seed.size());
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  constexpr std::uint64_t kMutations = 3000;
  for (std::uint64_t i = 0; i < kMutations || elapsed() < seconds_asked(); ++i) {
    RandomStream random(i, "fuzz" + extension);
    const std::string text = mutated(seeds, random);
    try {
      target(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    } catch (const std::exception& e) {
      FAIL() << "mutation " << i << ": " << e.what() << "\n" << text.substr(0, 2000);
    }
  }
}

TEST(Fuzz, GltfReaderAcceptsOrThrowsError) {
  run(".gltf", fuzz_gltf);
  run(".glb", fuzz_gltf);
}
TEST(Fuzz, BvhReaderAcceptsOrThrowsError) { run(".bvh", fuzz_bvh); }
TEST(Fuzz, TomlReadersAcceptOrThrowError) { run(".toml", fuzz_toml); }
TEST(Fuzz, ObjReaderAcceptsOrThrowsError) { run(".obj", fuzz_obj); }
TEST(Fuzz, PlyReaderAcceptsOrThrowsError) { run(".ply", fuzz_ply); }
TEST(Fuzz, OffReaderAcceptsOrThrowsError) { run(".off", fuzz_off); }
TEST(Fuzz, CollectionReaderAcceptsOrThrowsError) { run(".pvd", fuzz_pvd); }
TEST(Fuzz, SidecarReaderAcceptsOrThrowsError) { run(".json", fuzz_sidecar); }
TEST(Fuzz, EditListReaderAcceptsOrThrowsError) { run(".toml", fuzz_edits); }

}  // namespace
}  // namespace geoprior::test
