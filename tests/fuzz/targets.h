#pragma once

#include <cstddef>
#include <cstdint>

namespace geoprior::test {

/// What is fuzzed: each reads bytes and may throw Error and nothing else.
void fuzz_gltf(const std::uint8_t* data, std::size_t size);
void fuzz_bvh(const std::uint8_t* data, std::size_t size);
void fuzz_toml(const std::uint8_t* data, std::size_t size);
// Meshes are repaired too, as the frames of a sequence are.
void fuzz_obj(const std::uint8_t* data, std::size_t size);
void fuzz_ply(const std::uint8_t* data, std::size_t size);
void fuzz_off(const std::uint8_t* data, std::size_t size);
void fuzz_stl(const std::uint8_t* data, std::size_t size);
/// In a child process, as the program reads it: a crash of VTK there is an Error here.
void fuzz_vtp(const std::uint8_t* data, std::size_t size);
void fuzz_pvd(const std::uint8_t* data, std::size_t size);
void fuzz_series(const std::uint8_t* data, std::size_t size);
void fuzz_pvtp(const std::uint8_t* data, std::size_t size);
void fuzz_sidecar(const std::uint8_t* data, std::size_t size);
void fuzz_edits(const std::uint8_t* data, std::size_t size);
void fuzz_journal(const std::uint8_t* data, std::size_t size);
void fuzz_reference(const std::uint8_t* data, std::size_t size);
void fuzz_table(const std::uint8_t* data, std::size_t size);
/// JSON where the first byte is a brace, else TOML.
void fuzz_assembly(const std::uint8_t* data, std::size_t size);
void fuzz_xtrackcad(const std::uint8_t* data, std::size_t size);
void fuzz_gesture(const std::uint8_t* data, std::size_t size);
void fuzz_rules(const std::uint8_t* data, std::size_t size);
void fuzz_gltf_parts(const std::uint8_t* data, std::size_t size);
void fuzz_turtle(const std::uint8_t* data, std::size_t size);
void fuzz_ntriples(const std::uint8_t* data, std::size_t size);
void fuzz_rdfxml(const std::uint8_t* data, std::size_t size);
void fuzz_ply_part(const std::uint8_t* data, std::size_t size);
// These readers open a file: the bytes are written to one.
void fuzz_points(const std::uint8_t* data, std::size_t size);
void fuzz_svg(const std::uint8_t* data, std::size_t size);
void fuzz_sketch(const std::uint8_t* data, std::size_t size);
void fuzz_exr(const std::uint8_t* data, std::size_t size);
void fuzz_wav(const std::uint8_t* data, std::size_t size);
void fuzz_run_file(const std::uint8_t* data, std::size_t size);
void fuzz_correspondence(const std::uint8_t* data, std::size_t size);
/// Beside the other files of a folder of frames (docs/external-methods.md), as the two below.
void fuzz_frame_list(const std::uint8_t* data, std::size_t size);
void fuzz_diagnostics(const std::uint8_t* data, std::size_t size);
void fuzz_events(const std::uint8_t* data, std::size_t size);
void fuzz_feature_library(const std::uint8_t* data, std::size_t size);

}  // namespace geoprior::test
