#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/embryo/scene/expected.h"
#include "experiments/embryo/scene/options.h"
#include "experiments/embryo/scene/source_files.h"
#include "models/embryo/ontology/ontology.h"
#include "solvers/embryo/ontology/consistency.h"
#include "solvers/embryo/rules/closure.h"
#include "solvers/embryo/rules/effects.h"
#include "solvers/embryo/triples/graph.h"
#include "testbed/topic.h"

namespace geoprior::embryo {

/// An ontology with what follows from it under a disease, and the days that are looked at: what
/// every method of the topic is given and every metric is measured on.
class EmbryoScene final : public Scene {
 public:
  EmbryoSceneOptions options;
  SourceFiles files;  ///< bytes as they were read, for methods that read them again
  Graph graph;        ///< with copies
  Graph saturated;    ///< and what follows from it under the disease
  Ontology ontology;
  std::optional<int> disease;  ///< of the ontology
  Effects effects;             ///< of the disease, by the rules
  Effects named_effects;       ///< of the disease, without rules: what it names, and no more
  Effects healthy_effects;
  std::vector<Violation> violations;
  std::optional<ExpectedChanges> expected;
  std::vector<bool> meshed;  ///< structures that get a surface
  std::vector<double> days;
  std::vector<std::string> structure_names;   ///< local names, by code
  std::vector<std::string> structure_labels;  ///< what pictures call them
  std::vector<std::string> kind_names;        ///< what structures are coloured by
  std::vector<int> kind_of_structure;

  /// By structure, whether the disease itself disables the process that makes it.
  [[nodiscard]] std::vector<bool> named_structures() const;

  [[nodiscard]] std::vector<double> parameters() const override { return days; }
  [[nodiscard]] std::string parameter_name() const override { return "day"; }
  [[nodiscard]] std::string parameter_unit() const override { return "d"; }
  [[nodiscard]] std::vector<std::filesystem::path> inputs() const override { return files.paths; }
  [[nodiscard]] std::map<std::string, double> facts() const override;
  /// What the scene knows of a body before anything is derived from it, as a program from outside
  /// is given it: what the methods of the topic begin with. Structures are numbers, in the order of
  /// the ontology; keys are those common to all parameter sets and those of the scene's.
  ///
  /// Tables: `stages` (stage, first, middle and last day); `body` (day, crown-rump length);
  /// `catalogue` (structure, its kind as frames have it, surface: 1 if it gets one; named: 1 if the
  /// scene's disease names what makes it; mirror_of: -1 of none); `keys` (a row a key frame: key,
  /// structure, day, primitive, frame, its Geometry; -1: the body's frame), `ends` (of ducts: key,
  /// end, structure that it is anchored to or -1, where on it), `via` (of ducts: key, a point
  /// between the ends); `structures` (day, then a frame's columns: the healthy body in the middle
  /// of each stage, in which a structure that exists in a stage has a row); `questions` (frame,
  /// day, and the structure and the system that the viewer's queries are about; -1: of none).
  /// Parts: `centrelines_0000` … of the healthy body's ducts, a part a stage, as frames have them;
  /// their array `structure` has the structures' names.
  [[nodiscard]] Frame given() const override;
};

/// @param folder  of the experiment file, against which relative files are tried first
/// @throws Error  naming the file and its line, or the option
std::shared_ptr<EmbryoScene> load_embryo_scene(const EmbryoSceneOptions& options,
                                               const std::filesystem::path& folder);

}  // namespace geoprior::embryo
