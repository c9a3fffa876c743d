#include "testbed/runner/run_inputs.h"

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "core/error.h"
#include "testbed/formats/folders.h"
#include "testbed/home.h"
#include "testbed/runner/names.h"
#include "testbed/runner/opened_run.h"
#include "testbed/runner/option_copy.h"
#include "testbed/runner/run_folder.h"

namespace geoprior {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kPrefix = "run:";

/// <id>.toml among the experiments of the clone, or beside the experiment that needs it.
fs::path file_of(const std::string& id, const Experiment& needed_by) {
  const fs::path name = id + ".toml";
  const fs::path beside = needed_by.file.parent_path();
  const std::vector<fs::path> places{beside.parent_path() / name, beside / name.filename(),
                                     geoprior_home() / "experiments" / name};
  for (const fs::path& file : places) {
    if (fs::is_regular_file(file)) return file;
  }
  throw Error("there is no experiment '" + id + "' to take as input", needed_by.file.string(),
              "an experiment of the testbed, or a file beside this one");
}

std::string chain_text(const std::vector<std::string>& chain, const std::string& last) {
  std::string text;
  for (const std::string& id : chain) text += id + " -> ";
  return text + last;
}

/// Finished already, or made now; nothing after a stop.
std::optional<OpenedRun> find_or_make(const Experiment& input, const std::vector<Topic>& topics,
                                      const ExecuteRequest& request,
                                      const std::vector<std::string>& chain) {
  if (const auto folder = find_run(input)) return OpenedRun(*folder);
  ExecuteRequest own = request;
  own.out.reset();
  own.resume = find_unfinished_run(input).has_value();
  std::fprintf(stderr, "%s is needed first\n", input.id.c_str());
  ExecuteResult made = execute_in_chain(input, topics, own, chain);
  if (made.stopped) return std::nullopt;
  return OpenedRun(made.folder, std::move(made.record));
}

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

}  // namespace

bool is_run_reference(const std::string& text) { return text.starts_with(kPrefix); }

RunReference parse_run_reference(const std::string& text) {
  std::vector<std::string> parts;
  const std::size_t hash = std::min(text.find('#'), text.size());
  const std::string place = text.substr(kPrefix.size(), hash - kPrefix.size());
  std::istringstream in(place);
  for (std::string part; std::getline(in, part, '/');) parts.push_back(part);
  const bool named = std::all_of(parts.begin(), parts.end(),
                                 [](const std::string& part) { return is_name(part); });
  const std::string artifact = text.substr(std::min(hash + 1, text.size()));
  if (!named || !(artifact.empty() || is_name(artifact)) || parts.size() < 3 || parts.size() > 4 ||
      place.ends_with('/') || text.ends_with('#')) {
    throw Error("no reference to a run: " + quoted_name(text), "",
                "\"run:<topic>/<experiment>/<variant>\" or "
                "\"run:<topic>/<experiment>/<case>/<variant>\", and \"#<file>\" for an artifact");
  }
  RunReference reference;
  reference.artifact = artifact;
  reference.experiment_id = parts[0] + "/" + parts[1];
  if (parts.size() == 4) reference.case_name = parts[2];
  reference.variant = parts.back();
  return reference;
}

ResolvedScene resolve_run_inputs(const Experiment& experiment, const CaseSpec& spec,
                                 const std::vector<Topic>& topics, const ExecuteRequest& request,
                                 const std::vector<std::string>& chain) {
  ResolvedScene resolved;
  const auto file_of_run = [&](const std::string& text) -> std::string {
    if (!is_run_reference(text) || resolved.stopped) return text;
    const RunReference reference = parse_run_reference(text);
    if (std::find(chain.begin(), chain.end(), reference.experiment_id) != chain.end()) {
      throw Error("runs need each other in a circle: " + chain_text(chain, reference.experiment_id),
                  experiment.file.string());
    }
    LoadRequest load;
    load.quick = experiment.quick;
    const Experiment input =
        load_experiment(file_of(reference.experiment_id, experiment), topics, load);
    const auto run = find_or_make(input, topics, request, chain);
    if (!run) {
      resolved.stopped = true;
      return text;
    }
    const VariantRecord& variant = require_variant(run->record(), reference, text);
    resolved.inputs.push_back({text, run->record().content_sha256});
    if (!reference.artifact.empty()) {
      return run->file(require_artifact(variant, reference.artifact, text)).string();
    }
    for (const FrameRecord& frame : variant.frames) {
      for (const StoredFile& file : frame.files) (void)run->file(file);
    }
    const fs::path frames = fs::path("frames") / reference.case_name / reference.variant;
    return path_below(run->folder(), frames).string();
  };
  std::shared_ptr<OptionSet> copy = topic_of(experiment, topics).default_scene();
  copy_options(*spec.scene, *copy, file_of_run);
  resolved.options = std::move(copy);
  return resolved;
}

}  // namespace geoprior
