#include "experiments/assembly/topic.h"

#include "experiments/assembly/files/assembly_file.h"
#include "experiments/assembly/scene/scene.h"
#include "experiments/assembly/vary_command.h"

namespace geoprior::assembly {

Topic make_topic() {
  Topic topic;
  topic.name = "assembly";
  topic.summary = "new assemblies are made of connected parts of others (thesis 2.2.3)";
  topic.default_scene = [] { return std::make_unique<TypedOptions<AssemblySceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path& folder, std::uint64_t seed) {
    return load_assembly_scene(dynamic_cast<const TypedOptions<AssemblySceneOptions>&>(set).options,
                               folder, seed);
  };
  topic.methods = methods();
  topic.inputs = {"random-replacement", "brute-force"};
  topic.metrics = metrics();
  topic.diagnostics = diagnostics();
  topic.view.direction = {-0.5, -1, 0.6};
  topic.view.up = {0, 0, 1};
  topic.view.shading = FigureView::Shading::flat;
  topic.commands = {vary_command()};
  topic.files = {assembly_keys()};
  return topic;
}

}  // namespace geoprior::assembly
