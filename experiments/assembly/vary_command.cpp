#include "experiments/assembly/vary_command.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "experiments/assembly/files/gltf_parts.h"
#include "experiments/assembly/processes/process.h"
#include "experiments/assembly/scene/inputs.h"
#include "models/assembly/search/search.h"
#include "solvers/assembly/exact.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/formats/gltf/writer.h"
#include "testbed/formats/text/letters.h"
#include "testbed/runner/number_text.h"

namespace geoprior::assembly {
namespace {

namespace fs = std::filesystem;

/// What is read of a file, and how an assembly of its parts is written.
struct VariedFile {
  ReadAssemblies read;
  std::function<std::string(const Variation&, const std::string& name)> glb;
};

VariedFile read_varied(const fs::path& file) {
  const std::string extension = lower(file.extension().string());
  VariedFile out;
  out.read = read_assemblies({file});
  if (extension == ".glb" || extension == ".gltf") {
    const auto parts = std::make_shared<GltfParts>(read_gltf_parts(file));
    out.glb = [parts](const Variation& v, const std::string&) {
      return assembly_glb(*parts, v.assembly);
    };
  } else {
    const auto types = std::make_shared<std::vector<PartType>>(out.read.set.types);
    out.glb = [types](const Variation& v, const std::string& name) {
      const Part surface = assembly_frame(0, v, *types, nullptr).require_part("surface");
      return surface_glb({surface.points, surface.triangles}, name);
    };
  }
  return out;
}

/// Labels of parts all of which have their lowest point at the lowest height of their model.
std::vector<std::string> standing_labels(const AssemblySet& set, double tolerance) {
  std::vector<char> stands(set.types.size(), 0), floats(set.types.size(), 0);
  for (const Assembly& model : set.models) {
    std::vector<double> lowest;
    for (const PlacedPart& part : model.parts)
      lowest.push_back(lowest_point(set.types[part.type], part.pose));
    for (std::size_t i = 0; i < lowest.size(); ++i)
      (std::abs(lowest[i]) <= tolerance ? stands : floats)[model.parts[i].type] = 1;
  }
  std::vector<std::string> labels;
  for (std::size_t t = 0; t < stands.size(); ++t)
    if (stands[t] && !floats[t]) labels.push_back(set.types[t].label);
  return labels;
}

/// Moves the models so that the lowest point of each is at height 0.
/// @return  how far the first was lifted
double lift_to_floor(AssemblySet& set) {
  std::optional<double> lift;
  for (Assembly& model : set.models) {
    double lowest = std::numeric_limits<double>::infinity();
    for (const PlacedPart& part : model.parts)
      lowest = std::min(lowest, lowest_point(set.types[part.type], part.pose));
    if (!std::isfinite(lowest)) continue;
    for (PlacedPart& part : model.parts) part.pose.translation().z() -= lowest;
    if (!lift) lift = -lowest;
  }
  return lift.value_or(0);
}

/// Rules that the models keep themselves.
Rules own_rules(const AssemblySet& set, const std::optional<double>& gap) {
  constexpr double kLeastGap = 1e-6, kLeastAngle = 0.01, kHalfMore = 1.5;
  Rules rules;
  Misfit worst;
  for (const Assembly& model : set.models) {
    const Misfit m = largest(joint_misfits(model, set.types));
    worst.translation = std::max(worst.translation, m.translation);
    worst.angle = std::max(worst.angle, m.angle);
  }
  rules.tolerance.translation = gap.value_or(std::max(kLeastGap, kHalfMore * worst.translation));
  rules.tolerance.angle_deg =
      std::max(kLeastAngle, kHalfMore * worst.angle * 180 / std::numbers::pi);
  rules.connected = std::all_of(set.models.begin(), set.models.end(),
                                [](const Assembly& m) { return components(m).count == 1; });
  rules.grounded = standing_labels(set, rules.ground_tolerance);
  for (const Assembly& model : set.models) {
    Assembly itself = model;
    Rules trial = rules;
    trial.grounded.clear();
    if (first_broken(itself, set.types, trial) == Filter::collision) rules.collisions = false;
  }
  return rules;
}

std::string file_name(const fs::path& input, int number) {
  char text[16];
  std::snprintf(text, sizeof text, "-%02d.glb", number);
  return input.stem().string() + text;
}

/// Writes variations as they come.
class GlbSink final : public FrameSink {
 public:
  /// @param lift  of the models over where the file has them
  GlbSink(const VariedFile& file, fs::path input, fs::path folder, double lift)
      : file_(file), input_(std::move(input)), folder_(std::move(folder)), lift_(lift) {}

  void frame(Frame frame) override {
    if (frame.parameter < 1) return;
    if (lines_.empty()) make_folders(folder_);
    const fs::path path = folder_ / file_name(input_, static_cast<int>(frame.parameter));
    Variation variation = variation_of(frame);
    for (PlacedPart& part : variation.assembly.parts) part.pose.translation().z() -= lift_;
    write_file_atomically(path, file_.glb(variation, path.stem().string()));
    lines_ += path.string() + "\n";
  }
  void event(const Event&) override {}
  void artifact(Artifact) override {}
  void checkpoint(const State&) override {}
  [[nodiscard]] const std::string& lines() const { return lines_; }

 private:
  const VariedFile& file_;
  fs::path input_, folder_;
  double lift_;
  std::string lines_;
};

CommandText vary(const std::string& input, const VaryOptions& options) {
  VariedFile file = read_varied(input);
  AssemblyInput scene;
  scene.set = file.read.set;
  const double lift = lift_to_floor(scene.set);
  scene.rules = own_rules(scene.set, options.gap_m);
  if (!options.keep.empty()) scene.guide.keep.push_back(options.keep);
  ExactOptions find;
  find.match.boundary = options.boundary;
  SearchOptions search;
  search.count = options.count;
  search.generations = options.generations;
  const auto process = replacement_process(
      scene,
      [&](const DonorSet& donors, bool keep_alike, RunContext&) {
        return make_exact_finder(donors, find, keep_alike);
      },
      true, search);
  GlbSink sink(file, input, options.out, lift);
  RunContext context;
  process->run(sink, context, std::nullopt);
  CommandText out{sink.lines(), file.read.warnings};
  std::string grounded;
  for (const std::string& label : scene.rules.grounded)
    grounded += (grounded.empty() ? "" : ", ") + label;
  out.notices.push_back("on the floor stay: " + (grounded.empty() ? "no parts" : grounded));
  if (!scene.rules.collisions)
    out.notices.push_back("parts of the scene meet already: collisions are not looked at");
  if (sink.lines().empty())
    out.notices.push_back(
        "no variation keeps these rules: more connections (--boundary), more "
        "replacements (--generations) or a larger gap (--gap-m) may find some");
  return out;
}

}  // namespace

void describe(OptionVisitor& v, VaryOptions& options) {
  v.value("out", options.out, {.doc = "folder that the variations are written to"});
  v.value("count", options.count,
          {.doc = "variations after which the search ends", .min = 1, .max = 10000});
  v.value("boundary", options.boundary,
          {.doc = "most connections that lead out of a substructure", .min = 1, .max = 4});
  v.value("generations", options.generations,
          {.doc = "replacements one after the other that a variation may be of the scene",
           .min = 1,
           .max = 100});
  v.value("keep", options.keep, {.doc = "label of parts that stay as they are; empty: none"});
  v.value("gap_m", options.gap_m,
          {.doc = "most that two joined ports may be apart; absent: half more than in the scene",
           .unit = "m",
           .min = 0});
}

TopicCommand vary_command() {
  return topic_command<VaryOptions>(
      "vary", "new assemblies of the parts of a scene, as glTF", "scene",
      "glTF scene whose empties are ports, a file of assemblies (.toml, .json) or a layout (.xtc)",
      vary);
}

}  // namespace geoprior::assembly
