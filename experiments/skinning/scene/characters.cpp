#include "experiments/skinning/scene/characters.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numeric>

#include "core/error.h"
#include "core/geometry/simplify.h"
#include "core/geometry/subdivision.h"
#include "core/geometry/topology.h"
#include "core/limits.h"
#include "core/mesh.h"
#include "experiments/skinning/scene/guess/unit.h"
#include "experiments/skinning/scene/skeleton_size.h"
#include "metrics/contact/joint_region.h"
#include "testbed/formats/mesh/parsed_mesh.h"
#include "testbed/formats/text/letters.h"
#include "testbed/home.h"

namespace geoprior::skinning {
namespace {

namespace fs = std::filesystem;

/// Triangles of a split mesh that survive its weld, so that both have the same triangles in the
/// same order.
void drop_degenerate(TriMesh& split, const std::vector<int>& welded) {
  Eigen::Index kept = 0;
  for (Eigen::Index f = 0; f < split.F.rows(); ++f) {
    const auto w = [&](int k) { return welded[split.F(f, k)]; };
    if (w(0) == w(1) || w(1) == w(2) || w(2) == w(0)) continue;
    if (kept != f) split.F.row(kept) = Eigen::RowVector3i(split.F.row(f));
    ++kept;
  }
  split.F.conservativeResize(kept, 3);
}

/// Weights of welded vertices: the mean over the split vertices they are made of.
SkinWeights weld_weights(const SkinWeights& split, const Weld& weld, std::string& warning) {
  const std::size_t n = weld.mesh.vertex_count();
  std::vector<double> copies(n, 0);
  for (const int w : weld.welded_of_split) copies[w] += 1;
  std::vector<Eigen::Triplet<double>> triplets;
  for (int v = 0; v < split.rows(); ++v) {
    const int w = weld.welded_of_split[v];
    for (SkinWeights::InnerIterator it(split, v); it; ++it)
      triplets.emplace_back(w, static_cast<int>(it.col()), it.value() / copies[w]);
  }
  SkinWeights welded(weld.mesh.vertex_count(), split.cols());
  welded.setFromTriplets(triplets.begin(), triplets.end());
  int differing = 0;
  for (int v = 0; v < split.rows(); ++v) {
    const int w = weld.welded_of_split[v];
    const Eigen::SparseVector<double> difference =
        Eigen::SparseVector<double>(split.row(v).transpose()) -
        Eigen::SparseVector<double>(welded.row(w).transpose());
    if (difference.norm() > 1e-3) ++differing;
  }
  if (differing > 0) {
    warning = std::to_string(differing) +
              " vertices that meet at a seam have different weights: their mean is used";
  }
  return welded;
}

/// Weights of the file on the joints of another skeleton, by name; joints that carry weight are all
/// there.
SkinWeights rename_columns(const SkinWeights& weights, const Skeleton& from, const Skeleton& to) {
  std::vector<Eigen::Triplet<double>> triplets;
  std::vector<int> column;
  for (const Joint& joint : from.joints) column.push_back(find_joint(to, joint.name).value_or(-1));
  for (int v = 0; v < weights.rows(); ++v) {
    for (SkinWeights::InnerIterator it(weights, v); it; ++it)
      triplets.emplace_back(v, column[it.col()], it.value());
  }
  SkinWeights renamed(weights.rows(), to.size());
  renamed.setFromTriplets(triplets.begin(), triplets.end());
  return renamed;
}

std::vector<bool> weighted_joints(const SkinWeights& weights) {
  std::vector<bool> weighted(weights.cols(), false);
  for (int v = 0; v < weights.rows(); ++v)
    for (SkinWeights::InnerIterator it(weights, v); it; ++it) weighted[it.col()] = true;
  return weighted;
}

/// "'a', 'b' and 3 more": names of joints for a line.
std::string quoted_names(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i)
    text += (i == 0 ? "'" : ", '") + names[i] + "'";
  return names.size() <= kShown ? text
                                : text + " and " + std::to_string(names.size() - kShown) + " more";
}

/// Joints of a character that carry weight, by whether a skeleton file has them.
struct WeightedJoints {
  std::vector<bool> is_missing;
  std::vector<std::string> missing;
  bool any_shared = false;
};

WeightedJoints compare(const SkinWeights& weights, const Skeleton& own, const Skeleton& file) {
  WeightedJoints result{weighted_joints(weights), {}, false};
  for (int j = 0; j < own.size(); ++j) {
    if (!result.is_missing[j]) continue;
    if (find_joint(file, own.joints[j].name)) {
      result.is_missing[j] = false;
      result.any_shared = true;
    } else {
      result.missing.push_back(own.joints[j].name);
    }
  }
  return result;
}

/// Puts the skeleton file, already read, over the character's own skeleton. The file helps a rig
/// that has weights: joints that carry weight and are not in the file stay. A file that has none of
/// them replaces the rig, and with it the weights.
void take_skeleton_file(const Skeleton& own, const std::string& where,
                        std::optional<SkinWeights>& given, Character& character) {
  SkeletonFile& file = *character.skeleton_file;
  require_size(file.skeleton, own, character.rig.mesh, character.files.back().string());
  const std::string name = character.files.back().filename().string();
  std::vector<bool> kept(own.joints.size(), false);
  if (given) {
    WeightedJoints joints = compare(*given, own, file.skeleton);
    if (!joints.any_shared) {
      given.reset();
      character.warnings.push_back(name + " has no joint that carries weights of " + where +
                                   ": its skeleton replaces that of the character");
    } else if (!joints.missing.empty()) {
      kept = std::move(joints.is_missing);
      character.warnings.push_back(name + " lacks joints that carry weights of " + where +
                                   ", which are kept: " + quoted_names(joints.missing));
    }
  }
  file = with_kept_joints(file, own, kept, character.files.back().string());
  if (given) given = rename_columns(*given, own, file.skeleton);
  character.rig.skeleton = file.skeleton;
}

bool takes_given(WeightSource source) {
  return source == WeightSource::file_or_heat || source == WeightSource::file;
}

/// Weights computed from mesh and skeleton; by heat where those of the file were asked for.
SkinWeights computed_weights(const CharacterOptions& options, const RiggedMesh& rig) {
  switch (options.weights) {
    case WeightSource::bounded:
      return bounded_weights(rig.mesh, rig.skeleton, options.bounded);
    case WeightSource::narrow:
      return narrow_weights(rig.mesh, rig.skeleton, options.narrow);
    case WeightSource::file_or_heat:
    case WeightSource::file:
    case WeightSource::heat:
      break;
  }
  return heat_weights(rig.mesh, rig.skeleton, options.heat);
}

/// Closes the holes of the skin, where they are to be closed; says what was found.
HoleCaps cap(const CharacterOptions& options, Character& character) {
  if (options.holes == Holes::keep) return {};
  HoleCaps caps = put_caps_on(character.rig.mesh);
  character.cap_triangles = static_cast<int>(caps.triangles.size());
  return caps;
}

/// Opens them again: what changes the mesh goes by its own border.
void uncap(Character& character) {
  take_caps_off(character.rig.mesh, character.cap_triangles);
  character.cap_triangles = 0;
}

/// @param given  weights that came with the character, on its skeleton; absent: there are none
void choose_weights(const CharacterOptions& options, const std::string& file,
                    std::optional<SkinWeights> given, Character& character) {
  if (options.weights == WeightSource::file && !given) {
    throw Error("no weights for the joints of the skeleton", file, "weights = \"heat\"");
  }
  const bool keep = given && takes_given(options.weights);
  character.rig.weights = keep ? std::move(*given) : computed_weights(options, character.rig);
}

/// Parts that meet at seams are welded to one skin; where parts that touch would become one along
/// edges of more than two triangles, as two boxes on each other, they stay apart.
Weld weld_parts(const TriMesh& split, const std::vector<int>& part, const std::string& where,
                std::vector<std::string>& warnings) {
  Weld all = weld_by_position(split);
  const std::size_t crowded = non_manifold_edges(all.mesh.F).size();
  if (crowded == 0 || part.empty() || part.front() == part.back()) return all;
  Weld apart = weld_by_position(split, part);
  if (non_manifold_edges(apart.mesh.F).size() >= crowded) return all;
  warnings.push_back(where + ": its parts touch along " + std::to_string(crowded) +
                     " edges that would have more than two triangles: they are not welded to each "
                     "other");
  return apart;
}

void take_mesh(TriMesh split, const std::vector<int>& part, Character& character, Weld& weld) {
  weld = weld_parts(split, part, character.files.front().string(), character.warnings);
  character.rig.mesh = weld.mesh;
  character.welded_of_input = weld.welded_of_split;
  drop_degenerate(split, weld.welded_of_split);
  character.input_mesh = std::move(split);
}

/// Files in the wild have closed skins that face inwards: viewers draw both sides, volumes and
/// fields tell them apart.
void turn_outwards(const fs::path& file, Character& character) {
  TriMesh& mesh = character.rig.mesh;
  if (!boundary_edges(mesh.F).empty() || signed_volume(mesh.V, mesh.F) >= 0) return;
  mesh.F.col(1).swap(mesh.F.col(2));
  character.input_mesh.F.col(1).swap(character.input_mesh.F.col(2));
  character.warnings.push_back(file.string() + ": the triangles faced inwards and were turned");
}

void read_skeleton_option(const std::string& name, const fs::path& folder, Character& character) {
  const fs::path file = find_input(name, folder);
  character.skeleton_file = read_skeleton_file(file);
  character.files.push_back(file);
}

void scale_to_metres(Skeleton& skeleton, double unit_m) {
  for (Joint& joint : skeleton.joints) {
    joint.head *= unit_m;
    if (joint.tail) *joint.tail *= unit_m;
  }
}

/// Two characters of one file would be one of two parts that have nothing to do with each other.
void require_one_skeleton(const GltfCharacter& character, const fs::path& file) {
  if (character.other_skins.empty()) return;
  std::string others;
  for (const std::string& skin : character.other_skins) others += " and " + skin;
  throw Error(character.first_skin + others +
                  " share no joint and hang on no common node, as two characters do",
              file.string(), "mesh = \"…\", the name of one of these meshes, or one root for all");
}

/// The metres of a unit of the file; what is guessed of it is a warning.
double take_unit(const std::optional<double>& given, const GltfCharacter& gltf,
                 const fs::path& file, std::vector<std::string>& warnings) {
  const ChosenUnit unit = choose_unit(given, gltf);
  if (unit.warning) warnings.push_back(file.string() + ": " + *unit.warning);
  return unit.metres;
}

GltfCharacter read_character_file(const fs::path& file, const std::optional<std::string>& mesh) {
  const std::string extension = lower(file.extension().string());
  if (extension == ".glb" || extension == ".gltf") {
    GltfCharacter character = read_gltf(file, {mesh});
    require_one_skeleton(character, file);
    return character;
  }
  throw Error("is no file that a character is read from", file.string(),
              "glTF 2.0 (.glb, .gltf), skinned or, without skin, with skeleton = "
              "\"<name>.skeleton.toml\"; programs such as Blender write it");
}

void load_file(const CharacterOptions& options, const fs::path& file, const fs::path& folder,
               Character& character) {
  GltfCharacter gltf = read_character_file(file, options.mesh);
  character.files = gltf.files;
  character.warnings = gltf.warnings;
  character.unit_m = take_unit(options.unit_m, gltf, file, character.warnings);
  TriMesh split = gltf.mesh;
  split.V *= character.unit_m;
  Weld weld;
  take_mesh(std::move(split), gltf.part_of_vertex, character, weld);
  std::vector<std::string> left_out;
  note_collapsed(gltf.mesh, weld.mesh, left_out);
  for (const std::string& note : left_out)
    character.warnings.push_back(file.string() + ": " + note);
  const HoleCaps caps = cap(options, character);
  turn_outwards(file, character);
  if (options.skeleton) read_skeleton_option(*options.skeleton, folder, character);
  if (!gltf.skeleton && !character.skeleton_file) {
    throw Error("no skin, and the scene names no skeleton file", file.string(),
                "a skinned file, or skeleton = \"<name>.skeleton.toml\"");
  }
  std::optional<SkinWeights> given;
  if (gltf.skeleton) {
    scale_to_metres(*gltf.skeleton, character.unit_m);
    std::string warning;
    given = weld_weights(gltf.weights, weld, warning);
    if (!warning.empty()) character.warnings.push_back(file.string() + ": " + warning);
  }
  if (!character.skeleton_file) {
    character.rig.skeleton = *gltf.skeleton;
  } else {
    if (options.weights == WeightSource::heat) given.reset();
    take_skeleton_file(gltf.skeleton.value_or(Skeleton{}), file.string(), given, character);
  }
  choose_weights(options, file.string(), std::move(given), character);
  for (const std::string& note : hole_notes(caps, character.rig))
    character.warnings.push_back(file.string() + ": " + note);
  character.gltf = std::move(gltf);
}

std::vector<int> identity(int n) {
  std::vector<int> result(n);
  std::iota(result.begin(), result.end(), 0);
  return result;
}

void take_procedural(const CharacterOptions& options, RiggedMesh rig, const fs::path& folder,
                     Character& character) {
  character.rig = std::move(rig);
  character.input_mesh = character.rig.mesh;
  character.welded_of_input = identity(character.rig.mesh.vertex_count());
  std::optional<SkinWeights> given = std::move(character.rig.weights);
  if (options.skeleton) {
    read_skeleton_option(*options.skeleton, folder, character);
    const Skeleton own = std::move(character.rig.skeleton);
    if (options.weights == WeightSource::heat) given.reset();
    take_skeleton_file(own, "character '" + options.character + "'", given, character);
  }
  choose_weights(options, options.character, std::move(given), character);
}

/// Beyond so many levels in all, every mesh is too large.
constexpr int kMostLevels = 30;

bool is_whole(const RefineOptions& options) {
  return options.region.empty() || options.region == std::vector<std::string>{"all"};
}

/// Triangles of the skin about the named joints; empty for "all".
std::vector<bool> marks_of(const RefineOptions& options, const RiggedMesh& rig) {
  if (is_whole(options)) return {};
  std::vector<bool> marks(rig.mesh.triangle_count(), false);
  std::vector<int> joints;
  for (const std::string& name : options.region) joints.push_back(rig.skeleton.index_of(name));
  const std::vector<Eigen::Vector3d> no_axes(joints.size(), Eigen::Vector3d::Zero());
  const JointRegion region = make_joint_region(rig, "refined", joints, no_axes, options.extent);
  for (const int f : region.triangles) marks[f] = true;
  return marks;
}

/// Vertices after steps of subdivision that split each marked triangle in four; of a closed mesh
/// there are half as many as triangles.
double refined_vertices(const RiggedMesh& rig, double marked, int levels) {
  return rig.mesh.vertex_count() + 0.5 * marked * (std::pow(4.0, levels) - 1);
}

/// Steps that refine the whole mesh multiply, wherever they stand in the list.
void require_refinable(const std::vector<RefineOptions>& steps, const RiggedMesh& rig) {
  int levels = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (!is_whole(steps[i])) continue;
    levels = std::min(levels + steps[i].levels, kMostLevels);
    require_vertices(refined_vertices(rig, rig.mesh.triangle_count(), levels),
                     "scene.refine." + std::to_string(i) + ".levels");
  }
}

void refine(const RefineOptions& options, const std::string& where, Character& character) {
  if (options.levels == 0) return;
  const std::vector<bool> marks = marks_of(options, character.rig);
  const auto marked = marks.empty() ? character.rig.mesh.triangle_count()
                                    : std::count(marks.begin(), marks.end(), true);
  require_vertices(refined_vertices(character.rig, static_cast<double>(marked), options.levels),
                   where + ".levels");
  TriMesh welded = character.rig.mesh;
  RefinedRig refined = loop_subdivide_region(character.rig, marks, options.levels);
  for (const Subdivision& step : refined.steps) {
    welded.V = Eigen::MatrixX3d(step.stencil * welded.V);
    SplitSubdivision split =
        subdivide_split(character.input_mesh, character.welded_of_input, welded.F, step, welded.V);
    welded.F = step.F;
    character.input_mesh = std::move(split.mesh);
    character.welded_of_input = std::move(split.welded_of_split);
  }
  character.rig = std::move(refined.rig);
}

/// Coarser mesh with computed weights: quadric collapse carries no weights and no seams along.
void simplify_character(const CharacterOptions& options, int target, Character& character) {
  if (options.weights == WeightSource::file)
    throw Error("weights of the file do not survive simplify_to", "scene.weights",
                "weights that are computed");
  const int before = character.rig.mesh.vertex_count();
  uncap(character);
  character.rig.mesh = simplify(character.rig.mesh, target);
  character.input_mesh = character.rig.mesh;
  character.welded_of_input = identity(character.rig.mesh.vertex_count());
  cap(options, character);
  character.rig.weights = computed_weights(options, character.rig);
  character.warnings.push_back("simplified from " + std::to_string(before) + " to " +
                               std::to_string(character.rig.mesh.vertex_count()) +
                               " vertices, with computed weights and without the file's seams");
}

/// The body of Debian's assimp-testmodels, converted at set-up.
void load_human(CharacterOptions options, const fs::path& folder, Character& character) {
  const fs::path file = data_folder() / "human.glb";
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) {
    throw Error("the body is not converted yet", file.string(), "run scripts/convert_data.sh");
  }
  if (!options.mesh) options.mesh = "human-baseMesh";
  if (!options.skeleton) options.skeleton = "human.skeleton.toml";
  load_file(options, file, folder, character);
}

}  // namespace

Character load_character(const CharacterOptions& options, const fs::path& folder) {
  Character character;
  if (options.character == "human") {
    load_human(options, folder, character);
  } else if (options.character == "cylinder") {
    take_procedural(options, two_bone_cylinder(options.cylinder), folder, character);
  } else if (options.character == "finger") {
    take_procedural(options, capsule_finger(options.finger), folder, character);
  } else {
    load_file(options, find_input(options.character, folder), folder, character);
  }
  if (options.simplify_to) simplify_character(options, *options.simplify_to, character);
  if (options.refine.empty()) return character;
  require_refinable(options.refine, character.rig);
  uncap(character);
  for (std::size_t i = 0; i < options.refine.size(); ++i) {
    refine(options.refine[i], "scene.refine." + std::to_string(i), character);
  }
  cap(options, character);
  return character;
}

CharacterSkeleton read_character_skeleton(const fs::path& file,
                                          const std::optional<std::string>& mesh,
                                          const std::optional<double>& unit_m) {
  GltfCharacter gltf = read_character_file(file, mesh);
  if (!gltf.skeleton)
    throw Error("no skin: the file has no skeleton", file.string(), "a skinned file");
  scale_to_metres(*gltf.skeleton, take_unit(unit_m, gltf, file, gltf.warnings));
  return {std::move(*gltf.skeleton), std::move(gltf.warnings)};
}

fs::path data_folder() { return geoprior_home() / "data"; }

fs::path test_models_folder() { return "/usr/share/assimp/models"; }

fs::path find_input(const std::string& name, const fs::path& folder) {
  const fs::path path(name);
  std::vector<fs::path> tried{folder / path};  // an absolute path replaces the folder
  if (path.is_relative()) {
    tried.push_back(geoprior_home() / "experiments" / "skinning" / path);
    tried.push_back(data_folder() / path);
    tried.push_back(test_models_folder() / path);
  }
  std::string list;
  for (const fs::path& candidate : tried) {
    std::error_code ignored;
    if (fs::is_regular_file(candidate, ignored)) return candidate.lexically_normal();
    list += (list.empty() ? "" : ", ") + candidate.lexically_normal().string();
  }
  throw Error("no such file", name, "one of " + list);
}

void describe(OptionVisitor& v, RefineOptions& options) {
  v.value("region", options.region,
          {.doc = "joints whose skin is refined, as one region; [\"all\"]: the whole mesh"});
  v.value("levels", options.levels, {.doc = "steps of Loop subdivision", .min = 0, .max = 5});
  v.value("extent", options.extent,
          {.doc = "half length of a joint's region along its bones, in local radii",
           .min = 0.1,
           .max = 20});
}

void describe(OptionVisitor& v, CharacterOptions& options) {
  static constexpr std::array<std::string_view, 5> kWeights{"file-or-heat", "file", "heat",
                                                            "bounded", "narrow"};
  static constexpr std::array<std::string_view, 2> kHoles{"cap", "keep"};
  v.value("character", options.character,
          {.doc = "\"human\", \"cylinder\", \"finger\", or a .glb or .gltf file",
           .named = Named::file});
  v.value(
      "mesh", options.mesh,
      {.doc = "name of the mesh of the file that is read; absent: all of its scene that move with "
              "one skeleton, of one skin or several; without a skeleton all"});
  v.value("skeleton", options.skeleton,
          {.doc = "skeleton file that overrides the file's hierarchy", .named = Named::file});
  v.value(
      "unit_m", options.unit_m,
      {.doc = "metres for one unit of the file; absent: guessed from the size of the character, "
              "with a warning where it is not 1",
       .unit = "m",
       .min = 1e-9,
       .max = 1e9});
  describe_choice(v, "holes", options.holes, kHoles,
                  {.doc = "what becomes of holes of the skin: closed by caps on the vertices of "
                          "their borders, for weights, methods and metrics but not in what is "
                          "written back, or left open, so that methods that need an inside are "
                          "refused and volumes absent"});
  describe_choice(
      v, "weights", options.weights, kWeights,
      {.doc = "where weights come from: the file, heat diffusion, bounded and smooth, or "
              "narrow as a hand paints them"});
  describe_group(v, "heat", options.heat, {.doc = "weights by bone heat diffusion"});
  describe_group(v, "bounded", options.bounded, {.doc = "biharmonic weights within bounds"});
  describe_group(v, "narrow", options.narrow,
                 {.doc = "weights of the nearest bones with a painted-like falloff"});
  describe_group(v, "cylinder", options.cylinder, {.doc = "shape of character = \"cylinder\""});
  describe_group(v, "finger", options.finger, {.doc = "shape of character = \"finger\""});
  v.value("simplify_to", options.simplify_to,
          {.doc = "vertices that are left by collapsing edges, with weights computed anew, before "
                  "refining",
           .min = 4});
  describe_list(v, "refine", options.refine,
                {.doc = "Loop subdivision of the whole mesh or of regions, in order"});
}

}  // namespace geoprior::skinning
