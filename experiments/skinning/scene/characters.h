#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/procedural.h"
#include "core/options.h"
#include "experiments/skinning/scene/hole_caps.h"
#include "experiments/skinning/scene/skeleton_file.h"
#include "experiments/skinning/weights/bounded_weights.h"
#include "experiments/skinning/weights/heat_weights.h"
#include "experiments/skinning/weights/narrow_weights.h"
#include "testbed/formats/gltf/reader.h"

namespace geoprior::skinning {

enum class WeightSource { file_or_heat, file, heat, bounded, narrow };

/// Refinement of a part of the mesh before anything else is done with it.
struct RefineOptions {
  std::vector<std::string> region{"all"};
  int levels = 1;
  double extent = 2;
};
void describe(OptionVisitor& v, RefineOptions& options);

/// Which character, and how its mesh, skeleton and weights come about.
struct CharacterOptions {
  std::string character = "human";
  std::optional<std::string> mesh;
  std::optional<std::string> skeleton;
  std::optional<double> unit_m;  ///< absent: guessed (guess/unit.h)
  Holes holes = Holes::cap;
  WeightSource weights = WeightSource::file_or_heat;
  HeatWeightsOptions heat;
  BoundedWeightsOptions bounded;
  NarrowWeightsOptions narrow;
  CylinderOptions cylinder;
  FingerOptions finger;
  std::vector<RefineOptions> refine;
  std::optional<int> simplify_to;
};
/// Members of an enclosing `describe`.
void describe(OptionVisitor& v, CharacterOptions& options);

/// A character in its rest pose, with all that is needed to move it and to write it back.
struct Character {
  RiggedMesh rig;                    ///< welded
  int cap_triangles = 0;             ///< the last ones of `rig.mesh`, which close its holes
  TriMesh input_mesh;                ///< split at seams as in the file, refined alike
  std::vector<int> welded_of_input;  ///< for each vertex of `input_mesh`
  std::optional<SkeletonFile> skeleton_file;
  std::optional<GltfCharacter> gltf;  ///< clips and binding, in the file's unit
  double unit_m = 1;                  ///< metres for one unit of `gltf`
  std::vector<std::filesystem::path> files;
  std::vector<std::string> warnings;
};

/// Loads or makes the character, gives it weights, refines or simplifies it.
/// @param folder  of the experiment, against which relative files are tried first
/// @throws Error  naming the file: no skin and no skeleton file; weights = "file" without any; …
Character load_character(const CharacterOptions& options, const std::filesystem::path& folder);

/// The skeleton that comes with a character's file, in metres.
struct CharacterSkeleton {
  Skeleton skeleton;
  std::vector<std::string> warnings;
};

/// @throws Error  naming the file: no glTF, no skin
CharacterSkeleton read_character_skeleton(const std::filesystem::path& file,
                                          const std::optional<std::string>& mesh,
                                          const std::optional<double>& unit_m);

/// A file named in an experiment: absolute, or relative to `folder`, to experiments/skinning, to
/// data/ or to the models of Debian's assimp-testmodels.
/// @throws Error  listing where it was looked for
std::filesystem::path find_input(const std::string& name, const std::filesystem::path& folder);

/// Folder of converted models (made by scripts/convert_data.sh) and of the installed test models.
std::filesystem::path data_folder();
std::filesystem::path test_models_folder();

}  // namespace geoprior::skinning
