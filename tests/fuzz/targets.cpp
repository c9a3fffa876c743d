#include "tests/fuzz/targets.h"

#include <cstring>
#include <string_view>
#include <vector>

#include "experiments/skinning/bvh/bvh.h"
#include "experiments/skinning/scene/skeleton_file.h"
#include "testbed/formats/gltf/reader.h"
#include "testbed/runner/spec/toml_tree.h"
#include "tests/fuzz/allow_error.h"

namespace geoprior::test {

using namespace skinning;

void fuzz_gltf(const std::uint8_t* data, std::size_t size) {
  std::vector<std::byte> bytes(size);
  if (size > 0) std::memcpy(bytes.data(), data, size);
  allow_error([&] {
    const GltfCharacter character = read_gltf_bytes(bytes, "fuzz");
    for (const GltfClip& clip : character.clips) {
      if (character.skeleton) clip_pose(character, clip, (clip.start_s + clip.end_s) / 2);
    }
  });
}

void fuzz_bvh(const std::uint8_t* data, std::size_t size) {
  allow_error([&] {
    const BvhMotion motion = parse_bvh(text_of(data, size), "fuzz");
    bvh_frame(motion, motion.frame_count() - 1);
  });
}

void fuzz_toml(const std::uint8_t* data, std::size_t size) {
  const std::string_view text = text_of(data, size);
  allow_error([&] { parse_skeleton(text, "fuzz"); });
  allow_error([&] { parse_poses(text, "fuzz"); });
  allow_error([&] { parse_toml_text(text, "fuzz"); });
}

}  // namespace geoprior::test
