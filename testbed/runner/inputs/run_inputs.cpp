#include "testbed/runner/inputs/run_inputs.h"

#include <algorithm>
#include <set>

#include "core/error.h"
#include "testbed/catalogue.h"
#include "testbed/formats/folders.h"
#include "testbed/runner/inputs/run_reference.h"
#include "testbed/runner/options/copy.h"
#include "testbed/runner/run_folder.h"
#include "testbed/runner/spec/spec.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

/// <id>.toml among the experiments of the clone, or beside the experiment that needs it.
fs::path file_of(const std::string& id, const Experiment& needed_by) {
  const fs::path name = id + ".toml";
  const fs::path beside = needed_by.file.parent_path();
  for (const fs::path& file : {beside.parent_path() / name, beside / name.filename()}) {
    if (fs::is_regular_file(file)) return file;
  }
  if (const auto file = catalogued_file(id)) return *file;
  throw Error("there is no experiment '" + id + "' to take as input", needed_by.file.string(),
              "an experiment of the testbed, or a file beside this one");
}

Experiment load_input(const RunReference& reference, const Experiment& needed_by,
                      const std::vector<Topic>& topics) {
  LoadRequest load;
  load.quick = needed_by.quick;
  return load_experiment(file_of(reference.experiment_id, needed_by), topics, load);
}

/// The run references among the options of all scenes, each once.
std::set<std::string> references_of(const Experiment& experiment, const Topic& topic) {
  std::set<std::string> references;
  const auto collect = [&](const std::string& text) {
    if (is_run_reference(text)) references.insert(text);
    return text;
  };
  for (const CaseSpec& spec : experiment.cases) {
    copy_options(*spec.scene, *topic.default_scene(), collect);
  }
  return references;
}

/// Looks for a way along inputs that comes back. Files are compared, not identifiers, which two
/// files may share and a reference need not repeat.
class CircleSearch {
 public:
  explicit CircleSearch(const std::vector<Topic>& topics) : topics_(topics) {}

  void visit(const Experiment& experiment) {
    const fs::path file = fs::weakly_canonical(experiment.file);
    const auto waits = std::find_if(chain_.begin(), chain_.end(),
                                    [&](const Link& link) { return link.file == file; });
    if (waits != chain_.end()) {
      throw Error("runs need each other in a circle: " + chain_text() + experiment.id,
                  chain_.back().file.string());
    }
    if (!sound_.insert(file).second) return;
    if (chain_.size() == kLongestChain) {
      throw Error("more runs wait for one another than can be made", file.string(),
                  "at most " + std::to_string(kLongestChain) + " in a chain");
    }
    chain_.push_back({experiment.id, file});
    for (const std::string& text : references_of(experiment, topic_of(experiment, topics_))) {
      visit(load_input(parse_run_reference(text), experiment, topics_));
    }
    chain_.pop_back();
  }

 private:
  static constexpr std::size_t kLongestChain = 100;
  struct Link {
    std::string id;
    fs::path file;
  };

  [[nodiscard]] std::string chain_text() const {
    std::string text;
    for (const Link& link : chain_) text += link.id + " -> ";
    return text;
  }

  const std::vector<Topic>& topics_;
  std::vector<Link> chain_;   ///< that wait for the experiment which is visited
  std::set<fs::path> sound_;  ///< visited already, or in the chain
};

const VariantRecord& require_variant(const RunRecord& record, const RunReference& reference,
                                     const std::string& text) {
  std::string allowed;
  for (const CaseRecord& one : record.cases) {
    for (const VariantRecord& variant : one.variants) {
      if (one.name == reference.case_name && variant.name == reference.variant) return variant;
      allowed += (allowed.empty() ? "" : ", ") + one.name + "/" + variant.name;
    }
  }
  throw Error("the run has no such case or variant", "input \"" + text + "\"", allowed);
}

const StoredFile& require_artifact(const VariantRecord& variant, const std::string& name,
                                   const std::string& text) {
  std::string allowed;
  for (const StoredFile& file : variant.artifacts) {
    const std::string known = fs::path(file.name).filename().string();
    if (known == name) return file;
    allowed += (allowed.empty() ? "" : ", ") + known;
  }
  throw Error("the variant has no such artifact", "input \"" + text + "\"",
              allowed.empty() ? "none: it left no artifacts" : allowed);
}

/// Folder of the frames, or the artifact, that a reference means in its run.
std::string place_in(const OpenedRun& run, const RunReference& reference, const std::string& text) {
  const VariantRecord& variant = require_variant(run.record(), reference, text);
  if (!reference.artifact.empty()) {
    return run.file(require_artifact(variant, reference.artifact, text)).string();
  }
  require_recorded_frames(run, variant);
  const fs::path frames = fs::path("frames") / reference.case_name / reference.variant;
  return path_below(run.folder(), frames).string();
}

}  // namespace

void require_no_circle(const Experiment& experiment, const std::vector<Topic>& topics) {
  CircleSearch(topics).visit(experiment);
}

ResolvedScene resolve_run_inputs(const Experiment& experiment, const CaseSpec& spec,
                                 const std::vector<Topic>& topics, const ExecuteRequest& request,
                                 const InputMaker& make) {
  ResolvedScene resolved;
  const auto file_of_run = [&](const std::string& text) -> std::string {
    if (!is_run_reference(text) || resolved.stopped) return text;
    const RunReference reference = parse_run_reference(text);
    const Experiment input = load_input(reference, experiment, topics);
    const auto run = make(input, request);
    if (!run) {
      resolved.stopped = true;
      return text;
    }
    resolved.inputs.push_back({text, run->record().content_sha256});
    return place_in(*run, reference, text);
  };
  std::shared_ptr<OptionSet> copy = topic_of(experiment, topics).default_scene();
  copy_options(*spec.scene, *copy, file_of_run);
  resolved.options = std::move(copy);
  return resolved;
}

std::shared_ptr<const OptionSet> resolve_recorded_inputs(const Experiment& experiment,
                                                         const CaseSpec& spec,
                                                         const std::vector<Topic>& topics,
                                                         const std::vector<StoredFile>& recorded) {
  const auto place_of_run = [&](const std::string& text) -> std::string {
    if (!is_run_reference(text)) return text;
    const RunReference reference = parse_run_reference(text);
    const auto input = std::find_if(recorded.begin(), recorded.end(),
                                    [&](const StoredFile& file) { return file.name == text; });
    if (input == recorded.end()) {
      throw Error("the run did not record which run it read", "input \"" + text + "\"");
    }
    const OpenedRun run(find_run_of_content(reference.experiment_id, input->sha256));
    return place_in(run, reference, text);
  };
  std::shared_ptr<OptionSet> copy = topic_of(experiment, topics).default_scene();
  copy_options(*spec.scene, *copy, place_of_run);
  return copy;
}

}  // namespace geoprior
