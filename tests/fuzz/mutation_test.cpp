#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "core/random.h"
#include "testbed/formats/atomic_file.h"
#include "tests/fuzz/targets.h"

// Seeded mutations of the files in tests/fuzz/corpus: every reader either accepts what it is given
// or throws Error. The number of mutations is fixed; GEOPRIOR_FUZZ_SECONDS goes on for that long.

namespace geoprior::test {
namespace {

using Target = void (*)(const std::uint8_t*, std::size_t);

std::vector<std::string> corpus(const std::string& extension) {
  std::vector<std::filesystem::path> files;
  const auto folder = std::filesystem::path(GEOPRIOR_SOURCE_DIR) / "tests" / "fuzz" / "corpus";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> seeds;
  for (const auto& file : files) seeds.push_back(read_whole_file(file));
  return seeds;
}

std::size_t below(RandomStream& random, std::size_t n) {
  return random.below(static_cast<std::uint32_t>(std::max<std::size_t>(n, 1)));
}

/// Replaces the number (or word) at a random place by one that readers trip over.
void replace_word(std::string& text, RandomStream& random) {
  static constexpr std::array<const char*, 16> kWords{
      "-1",     "0",          "1e999", "nan",  "4294967295", "18446744073709551615",
      "1e-400", "2147483648", "[]",    "null", "{}",         "true",
      "\"\"",   "0.5",        "99999", "-0"};
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '+';
  };
  std::size_t begin = below(random, text.size());
  while (begin < text.size() && !is_word(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && is_word(text[end])) ++end;
  text.replace(begin, end - begin, kWords[below(random, kWords.size())]);
}

void mutate(std::string& text, const std::vector<std::string>& seeds, RandomStream& random) {
  const std::size_t at = below(random, text.size());
  const std::size_t length =
      std::min(1 + below(random, 64), text.size() - std::min(at, text.size()));
  switch (text.empty() ? 4 : random.below(8)) {
    case 0:
      text[at] = static_cast<char>(text[at] ^ (1 << random.below(8)));
      break;
    case 1:
      text[at] = static_cast<char>(random.below(256));
      break;
    case 2:
      text.erase(at, length);
      break;
    case 3:
      text.insert(below(random, text.size()), text.substr(at, length));
      break;
    case 4:
      text.insert(at, 1, static_cast<char>(random.below(256)));
      break;
    case 5: {
      const std::string& other = seeds[below(random, seeds.size())];
      text.replace(at, length, other.substr(below(random, other.size()), length));
      break;
    }
    case 6:
      text.resize(at);
      break;
    default:
      replace_word(text, random);
      break;
  }
}

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
    std::string text = seeds[below(random, seeds.size())];
    const std::uint32_t count = 1 + random.below(6);
    for (std::uint32_t k = 0; k < count; ++k) mutate(text, seeds, random);
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
TEST(Fuzz, VtkReaderAcceptsOrThrowsError) { run(".vtp", fuzz_vtp); }
TEST(Fuzz, CollectionReaderAcceptsOrThrowsError) { run(".pvd", fuzz_pvd); }
TEST(Fuzz, SidecarReaderAcceptsOrThrowsError) { run(".json", fuzz_sidecar); }
TEST(Fuzz, EditListReaderAcceptsOrThrowsError) { run(".toml", fuzz_edits); }

}  // namespace
}  // namespace geoprior::test
