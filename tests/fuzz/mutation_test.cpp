#include "tests/fuzz/mutation.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "experiments/fluid/scene/exr_maps.h"
#include "experiments/fluid/scene/feature_files.h"
#include "testbed/formats/wav_file.h"
#include "tests/fuzz/sample_features.h"
#include "tests/fuzz/sample_layouts.h"
#include "tests/fuzz/targets.h"
#include "tests/support/long_tests.h"
#include "tests/testbed/fake_run.h"

// Seeded mutations of the files in tests/fuzz/corpus: every reader either accepts what it is given
// or throws Error. The number of mutations is fixed, 3,000 with GEOPRIOR_LONG;
// GEOPRIOR_FUZZ_SECONDS goes on for that long.

namespace geoprior::test {
namespace {

using Target = void (*)(const std::uint8_t*, std::size_t);

double seconds_asked() {
  const char* text = std::getenv("GEOPRIOR_FUZZ_SECONDS");
  return text == nullptr ? 0 : std::strtod(text, nullptr);
}

/// Fewer for readers that take milliseconds.
struct Counts {
  std::uint64_t usual = 500;
  std::uint64_t at_length = 3000;
};

void run_on(const std::string& name, const std::vector<std::string>& seeds, Target target,
            const Counts& counts = {}) {
  ASSERT_FALSE(seeds.empty());
  for (const std::string& seed : seeds)
    target(reinterpret_cast<const std::uint8_t*>(seed.data()), seed.size());
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  const std::uint64_t mutations = at_length() ? counts.at_length : counts.usual;
  std::uint64_t i = 0;
  for (; i < mutations || elapsed() < seconds_asked(); ++i) {
    RandomStream random(i, "fuzz" + name);
    const std::string text = mutated(seeds, random);
    try {
      target(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    } catch (const std::exception& e) {
      FAIL() << "mutation " << i << ": " << e.what() << "\n" << text.substr(0, 2000);
    }
  }
  std::cout << name << ": " << i << " inputs\n";
}

void run(const std::string& extension, Target target) {
  run_on(extension, corpus(extension), target);
}

std::string as_text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(LongFuzz, GltfReaderAcceptsOrThrowsError) {
  run(".gltf", fuzz_gltf);
  run(".glb", fuzz_gltf);
}
TEST(LongFuzz, BvhReaderAcceptsOrThrowsError) { run(".bvh", fuzz_bvh); }
TEST(LongFuzz, TomlReadersAcceptOrThrowError) { run(".toml", fuzz_toml); }
TEST(LongFuzz, ObjReaderAcceptsOrThrowsError) { run(".obj", fuzz_obj); }
TEST(LongFuzz, PlyReaderAcceptsOrThrowsError) { run(".ply", fuzz_ply); }
TEST(LongFuzz, OffReaderAcceptsOrThrowsError) { run(".off", fuzz_off); }
TEST(LongFuzz, StlReaderAcceptsOrThrowsError) { run(".stl", fuzz_stl); }
TEST(LongFuzz, VtkReaderAcceptsOrThrowsError) { run(".vtp", fuzz_vtp); }
TEST(LongFuzz, CollectionReaderAcceptsOrThrowsError) { run(".pvd", fuzz_pvd); }
TEST(LongFuzz, SeriesReaderAcceptsOrThrowsError) { run(".series", fuzz_series); }
TEST(LongFuzz, PieceReaderAcceptsOrThrowsError) { run(".pvtp", fuzz_pvtp); }
TEST(LongFuzz, SidecarReaderAcceptsOrThrowsError) { run(".json", fuzz_sidecar); }
TEST(LongFuzz, EditListReaderAcceptsOrThrowsError) { run(".toml", fuzz_edits); }
TEST(LongFuzz, JournalReaderAcceptsOrThrowsError) { run(".jsonl", fuzz_journal); }
TEST(LongFuzz, ReferenceReaderAcceptsOrThrowsError) { run(".txt", fuzz_reference); }
TEST(LongFuzz, PointReaderAcceptsOrThrowsError) { run(".csv", fuzz_points); }
TEST(LongFuzz, DrawingReaderAcceptsOrThrowsError) { run(".svg", fuzz_svg); }
TEST(LongFuzz, SketchReaderAcceptsOrThrowsError) { run(".svg", fuzz_sketch); }
TEST(LongFuzz, TableReaderAcceptsOrThrowsError) { run(".csv", fuzz_table); }
TEST(LongFuzz, LayoutReaderAcceptsOrThrowsError) { run(".xtc", fuzz_xtrackcad); }
TEST(LongFuzz, AssemblyReaderAcceptsOrThrowsError) {
  for (const char* file : {"blocks.assembly.toml", "blocks.json"})
    run_on(file, {corpus_file(file)}, fuzz_assembly);
}
TEST(LongFuzz, GestureReaderAcceptsOrThrowsError) {
  run_on("drag.gesture.toml", {corpus_file("drag.gesture.toml")}, fuzz_gesture);
}
TEST(LongFuzz, TurtleReaderAcceptsOrThrowsError) { run(".ttl", fuzz_turtle); }
TEST(LongFuzz, NTriplesReaderAcceptsOrThrowsError) { run(".nt", fuzz_ntriples); }
TEST(LongFuzz, RdfXmlReaderAcceptsOrThrowsError) { run(".rdf", fuzz_rdfxml); }
TEST(LongFuzz, ScriptsOfRulesRunOrThrowError) {
  run_on("rules.lua", {corpus_file("rules.lua")}, fuzz_rules);
}
TEST(LongFuzz, ReaderOfPartsInScenesAcceptsOrThrowsError) {
  run_on("parts.glb", {corpus_file("blocks.glb")}, fuzz_gltf_parts);
}

TEST(LongFuzz, FramesOfOthersAreReadOrThrowError) {
  const Files layout = sheet_layout();
  constexpr Counts kFolders{100, 1000};
  run_on("frames.csv", {layout.at("frames.csv")}, fuzz_frame_list, kFolders);
  run_on("diagnostics.csv", {layout.at("diagnostics.csv")}, fuzz_diagnostics, kFolders);
  run_on("events.csv", {layout.at("events.csv")}, fuzz_events, kFolders);
  run_on("correspondence", {"vertex\n2\n0\n1\n"}, fuzz_correspondence);
  std::vector<std::string> parts = corpus(".ply");
  for (const auto& [name, bytes] : layout) {
    if (name.ends_with(".ply")) parts.push_back(bytes);
  }
  run_on("parts.ply", parts, fuzz_ply_part);
}

TEST(LongFuzz, MapReaderAcceptsOrThrowsError) {
  const auto pictures = fluid::exr_maps(sample_features().front(), "map");
  run_on(".exr", {as_text(pictures[0].bytes), as_text(pictures[1].bytes)}, fuzz_exr, {40, 300});
}

TEST(LongFuzz, SoundReaderAcceptsOrThrowsError) {
  const Sound mono{48000, Eigen::VectorXd::LinSpaced(200, -1, 1)};
  const Sound stereo{44100, Eigen::MatrixXd::Constant(100, 2, 0.25)};
  run_on(".wav", {as_text(wav_bytes(mono)), as_text(wav_bytes(stereo))}, fuzz_wav);
}

// A process for every file: HDF5 crashes on some of them, the reader must not.
constexpr Counts kProcesses{10, 200};

TEST(LongFuzz, FeatureLibraryReaderAcceptsOrThrowsError) {
  run_on("library", {as_text(fluid::feature_library_bytes(sample_features()))},
         fuzz_feature_library, kProcesses);
}

TEST(LongFuzz, RunFileReaderAcceptsOrThrowsError) {
  const TestFolder folder;
  make_fake_run(folder.path);
  run_on("run", {read_whole_file(folder.path / "run.h5")}, fuzz_run_file, kProcesses);
}

}  // namespace
}  // namespace geoprior::test
