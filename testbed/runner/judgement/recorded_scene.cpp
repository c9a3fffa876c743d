#include "testbed/runner/judgement/recorded_scene.h"

#include <algorithm>
#include <filesystem>

#include "core/error.h"
#include "testbed/runner/inputs/run_inputs.h"
#include "testbed/runner/journal/sha256.h"
#include "testbed/runner/run_folder.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

void require_recorded_inputs(const Scene& scene, const RunRecord& record) {
  for (const fs::path& file : scene.inputs()) {
    const std::string name = input_name(file);
    const std::string sha256 = sha256_of_file(file);
    const bool is_same = std::any_of(
        record.inputs.begin(), record.inputs.end(),
        [&](const StoredFile& input) { return input.name == name && input.sha256 == sha256; });
    if (!is_same) {
      throw Error("is not the input that the run read: its frames cannot be measured with it",
                  file.string(), "the file as it was, or a new run");
    }
  }
}

}  // namespace

const CaseSpec& case_spec(const Experiment& experiment, const std::string& name) {
  for (const CaseSpec& spec : experiment.cases) {
    if (spec.name == name) return spec;
  }
  throw Error("the run has a case '" + name + "' that its own experiment does not make",
              experiment.id);
}

std::shared_ptr<Scene> load_recorded_scene(const Experiment& experiment, const CaseSpec& spec,
                                           const std::vector<Topic>& topics,
                                           const RunRecord& record) {
  try {
    const auto options = resolve_recorded_inputs(experiment, spec, topics, record.inputs);
    auto scene =
        topic_of(experiment, topics).load(*options, experiment.file.parent_path(), spec.seed);
    require_recorded_inputs(*scene, record);
    return scene;
  } catch (const Error& error) {
    throw Error(error.what(), "scene of case '" + spec.name + "'");
  }
}

const VariantRecord* reference_of(const CaseRecord& in, const VariantRecord& variant) {
  if (variant.reference.empty() || variant.reference == variant.name) return nullptr;
  return find_variant(in, variant.reference);
}

}  // namespace geoprior
