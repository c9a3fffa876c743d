#pragma once

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/frame.h"
#include "core/method.h"
#include "core/options.h"
#include "testbed/figure_view.h"
#include "testbed/frame_sequence.h"
#include "testbed/runner/options/listing.h"

namespace geoprior {

/// What a part of every frame has to be, whoever makes the frame: metrics rely on it.
struct PartShape {
  std::string part;
  Part::Kind kind = Part::Kind::triangles;
  /// Vertices that the part has, each at its index; absent: as many as the method likes.
  std::optional<Eigen::Index> vertices = {};
  /// Triangles that it has, where the vertices are given; frames from outside may come without.
  Eigen::MatrixX3i triangles = {};
};

/// The typed scene of a topic, seen by the runner.
class Scene {
 public:
  virtual ~Scene() = default;
  /// Pose methods are solved at these parameters, in order. Empty for a topic of processes.
  [[nodiscard]] virtual std::vector<double> parameters() const = 0;
  [[nodiscard]] virtual std::string parameter_name() const = 0;  ///< "angle", "time", …
  [[nodiscard]] virtual std::string parameter_unit() const = 0;  ///< "deg", "s", …
  /// Files read while loading, for the record (their sha256 goes into the run).
  [[nodiscard]] virtual std::vector<std::filesystem::path> inputs() const = 0;
  /// What was ignored or repaired while loading: printed once, recorded.
  [[nodiscard]] virtual std::vector<std::string> warnings() const { return {}; }
  /// Plain numbers worth recording (vertices, triangles, regions), shown in the report.
  [[nodiscard]] virtual std::map<std::string, double> facts() const { return {}; }
  /// What shows best what happens, where the experiment file says nothing of the camera; recorded.
  [[nodiscard]] virtual std::optional<Camera> camera() const { return std::nullopt; }
  /// Files that the user asked for beside a frame of a process, made while no clock runs. They may
  /// add parts to the frame, or be all that becomes of one; what is only looked at may be a part
  /// that is added here too.
  /// @throws Error  when one cannot be made: the variant has failed
  [[nodiscard]] virtual std::vector<Artifact> files_of(Frame& /*frame*/) const { return {}; }
  /// What a program from outside is given of the scene beside its options and input files: geometry
  /// at rest and tables, for the folder that the method "external" writes. The parameter means
  /// nothing.
  [[nodiscard]] virtual Frame given() const { return {}; }
  /// Parts that every frame must have. Frames from outside are held against it.
  [[nodiscard]] virtual std::vector<PartShape> frame_shape() const { return {}; }
  /// False where methods may do the work of several frames in one: times are compared by whole
  /// runs.
  [[nodiscard]] virtual bool frames_share_work() const { return true; }
};

/// A scene of processes, whose frames are times: what all such scenes say alike.
class ProcessScene : public Scene {
 public:
  std::vector<std::filesystem::path> input_files;
  std::vector<std::string> load_warnings;

  [[nodiscard]] std::vector<double> parameters() const override { return {}; }
  [[nodiscard]] std::string parameter_name() const override { return "time"; }
  [[nodiscard]] std::string parameter_unit() const override { return "s"; }
  [[nodiscard]] std::vector<std::filesystem::path> inputs() const override { return input_files; }
  [[nodiscard]] std::vector<std::string> warnings() const override { return load_warnings; }
};

/// A struct of options with its `describe`, type-erased: the runner parses into it, lists it and
/// records it.
class OptionSet {
 public:
  virtual ~OptionSet() = default;
  virtual void visit(OptionVisitor& visitor) = 0;
};

template <class Options>
class TypedOptions final : public OptionSet {
 public:
  void visit(OptionVisitor& visitor) override { describe(visitor, options); }
  Options options;
};

class FrameFiles;
struct VariantRecord;

/// What a method that works outside of the program has to know of its place in a run.
struct MethodSite {
  std::string topic;
  std::string experiment_id;
  std::filesystem::path folder;  ///< of the experiment file
  std::filesystem::path work;    ///< of this variant inside the run; not there yet
  std::string case_name;
  std::string variant;
  std::uint64_t seed = 1;
  std::string scene_json;  ///< resolved options of the scene
  /// What was recorded of the variant that this one names as its reference, and its files; null
  /// when it names none, or that was left out.
  const VariantRecord* reference = nullptr;
  const FrameFiles* files = nullptr;
};

/// One row of a topic's method table.
struct MethodEntry {
  using Instance = std::variant<std::unique_ptr<PoseMethod>, std::unique_ptr<Process>>;
  std::string name;
  bool is_baseline = false;
  std::string summary;  ///< one line
  std::string source;   ///< paper or thesis section
  std::function<std::unique_ptr<OptionSet>()> default_options;
  /// `prepare`: builds the method for a scene. Timed by the runner as phase "prepare".
  /// @throws NotApplicable  where the method is not for the scene: its variant fails alone
  std::function<Instance(const Scene&, const OptionSet&, RunContext&)> make;
  std::string ungated = {};  ///< why its results do not repeat: `check` does not compare them
  /// In place of `make`, of a method that works outside of the program.
  std::function<Instance(const MethodSite&, const Scene&, const OptionSet&, RunContext&)> make_at =
      {};
  /// The program that such a method would start, with its arguments; empty or absent: none.
  std::function<std::string(const OptionSet&)> starts = {};
  /// Files that it reads at such a site, for the record; absent: none.
  std::function<std::vector<std::filesystem::path>(const MethodSite&, const OptionSet&)> inputs =
      {};
  /// What its user should know of these options on this scene: printed and recorded with what was
  /// said of the scene. Absent: nothing, ever.
  std::function<std::vector<std::string>(const Scene&, const OptionSet&)> warnings = {};

  [[nodiscard]] bool gated() const { return ungated.empty(); }
};

/// Builds a MethodEntry from typed pieces: `make(const S&, const Options&, RunContext&)` returns a
/// unique_ptr.
template <class S, class Options, class Make>
MethodEntry method_entry(std::string name, bool is_baseline, std::string summary,
                         std::string source, Make make) {
  return {std::move(name),
          is_baseline,
          std::move(summary),
          std::move(source),
          [] { return std::make_unique<TypedOptions<Options>>(); },
          [make](const Scene& scene, const OptionSet& set,
                 RunContext& context) -> MethodEntry::Instance {
            return make(dynamic_cast<const S&>(scene),
                        dynamic_cast<const TypedOptions<Options>&>(set).options, context);
          }};
}

/// The entry with its warnings: `warn(const S&, const Options&)` returns texts.
template <class S, class Options, class Warn>
MethodEntry with_warnings(MethodEntry entry, Warn warn) {
  entry.warnings = [warn](const Scene& scene, const OptionSet& set) -> std::vector<std::string> {
    return warn(dynamic_cast<const S&>(scene),
                dynamic_cast<const TypedOptions<Options>&>(set).options);
  };
  return entry;
}

enum class Direction { lower_is_better, higher_is_better, closer_to_target, none };

/// How far a value may be from its reference value before `check` reports it.
struct Tolerance {
  double absolute = 0;
  double relative = 0;

  /// What it comes to for a value of that size.
  [[nodiscard]] double of(double value) const { return absolute + relative * std::abs(value); }
};

/// One row of a topic's metric table.
struct MetricEntry {
  std::string name;  ///< snake_case
  std::string unit;
  std::string definition;  ///< one sentence: what is measured and how
  Direction direction = Direction::lower_is_better;
  Tolerance tolerance;
  double target = 0;  ///< for Direction::closer_to_target
  /// An identity or a closed form: what a row says of a method is decided by its own tests, which
  /// mutate the method.
  bool oracle = false;
  std::string ungated = {};  ///< why `check` does not hold the row against a reference value

  [[nodiscard]] bool gated() const { return ungated.empty(); }
};

/// Values of a group's rows, in their order; absent where a row has no meaning.
using MetricValues = std::vector<std::optional<double>>;

/// Rows of a topic's metric table that are read off one measurement, which is made once. Exactly
/// one of `of_frame` and `of_sequence` is set. testbed/metric_rows.h makes groups of typed pieces.
struct MetricGroup {
  std::vector<MetricEntry> rows;
  bool needs_reference = false;  ///< left out where there is no reference frame
  /// Parts and tables of the reference frame that are looked at: others are not read. Empty: all.
  std::vector<std::string> reference_parts = {};
  /// Values at one frame. `reference` is the frame of equal parameter of the variant that the
  /// experiment names as reference, or null.
  std::function<MetricValues(const Scene&, const Frame&, const Frame* reference)> of_frame = {};
  /// One value a row and variant, from all of its frames in order of parameter. They may have to be
  /// read from the disk: go through them once (FrameSequence).
  std::function<MetricValues(const Scene&, const FrameSequence&)> of_sequence = {};
  /// Beside `of_sequence`, where the rows look at nothing but events: those of several cases may be
  /// measured together, in time one case after another (a study of the kind "pooled").
  std::function<MetricValues(const std::vector<Event>&)> of_events = {};
};

/// One row of a topic's table of diagnostics: what only a method can know of a frame (iterations,
/// residual, evaluations), under one name for all methods.
struct DiagnosticEntry {
  std::string name;        ///< snake_case, as in Frame::diagnostics
  std::string unit;        ///< "1" for a count or a ratio
  std::string definition;  ///< one line
  /// Work that the method counts (iterations, evaluations): `check` fails when the mean over the
  /// frames grows by more than `tolerance`.
  bool counted_work = false;
  Tolerance tolerance = {};
  /// The metric that measures the same from outside: it is what a claim reads. Empty: none does.
  std::string metric = {};
  std::string unmeasured = {};  ///< why none does; empty beside a metric
};

/// A topic's diagnostics, each with the metric that measures the same, or why none does.
class DiagnosticTable {
 public:
  void measured(std::string metric, DiagnosticEntry row);
  void unmeasured(const std::string& why, std::vector<DiagnosticEntry> rows);
  [[nodiscard]] std::vector<DiagnosticEntry> rows() { return std::move(rows_); }

 private:
  std::vector<DiagnosticEntry> rows_;
};

/// What a command of a topic has to say: a text for standard output, and lines for people.
struct CommandText {
  std::string text;
  std::vector<std::string> notices;
  bool fell_short = false;  ///< there is a result, but not of all that was asked for: exit code 1
};

/// A command of the program that a topic brings: `geoprior <name> <input> [--option …]`, with a
/// flag for each option of its struct (`unit_m` as --unit-m).
struct TopicCommand {
  std::string name;
  std::string summary;        ///< one line
  std::string input;          ///< what its argument is called
  std::string input_meaning;  ///< one line
  std::function<std::unique_ptr<OptionSet>()> default_options;
  std::function<CommandText(const std::string& input, const OptionSet&)> run;
  /// The option that may stand behind the input without its flag; empty: none.
  std::string second_argument = {};
};

/// Builds a TopicCommand from typed pieces: `run(input, const Options&)` returns a CommandText.
template <class Options, class Run>
TopicCommand topic_command(std::string name, std::string summary, std::string input,
                           std::string input_meaning, Run run) {
  return {std::move(name),
          std::move(summary),
          std::move(input),
          std::move(input_meaning),
          [] { return std::make_unique<TypedOptions<Options>>(); },
          [run](const std::string& given, const OptionSet& set) {
            return run(given, dynamic_cast<const TypedOptions<Options>&>(set).options);
          }};
}

/// A kind of file that only the topic reads, for `geoprior describe <name>`.
struct TopicFile {
  std::string name;     ///< "skeleton"
  std::string summary;  ///< one line
  std::string table;    ///< that the keys stand in: "[joint.<name>]"
  std::vector<OptionRow> keys;
};

/// Where the frames of a scene end.
struct LastParameter {
  double value = 0;
  std::string unit;  ///< "s", "deg", …
};

/// Everything the runner knows of a topic: one instance each, listed in ONE table
/// (experiments/topics.cpp).
struct Topic {
  std::string name;
  std::string summary;
  /// Options of the `[scene]` table.
  std::function<std::unique_ptr<OptionSet>()> default_scene;
  /// Loads inputs. `folder` is the folder of the experiment file, against which relative paths are
  /// tried first; `seed` is the experiment's, of whatever the scene draws (core/random.h,
  /// scene_seed).
  std::function<std::shared_ptr<Scene>(const OptionSet&, const std::filesystem::path& folder,
                                       std::uint64_t seed)>
      load;
  /// The last parameter that a scene of these options has, where they tell before it is loaded: a
  /// figure's frames lie before it. Absent: unknown for all.
  std::function<std::optional<LastParameter>(const OptionSet&)> last_parameter = {};
  std::vector<MethodEntry> methods;
  /// Methods that do nothing of what the topic is about, the nearest to its methods first: the
  /// variant of the first that a file has is the input from which its claims are graded.
  std::vector<std::string> inputs = {};
  std::vector<MetricGroup> metrics;
  std::vector<DiagnosticEntry> diagnostics;
  /// What is drawn where the experiment file does not say.
  FigureView view;
  /// Parts of frames that are only looked at: pictures and exports see them, metrics cannot.
  std::set<std::string> looked_at = {};
  std::vector<TopicCommand> commands = {};
  std::vector<TopicFile> files = {};
  /// Artifacts of text whose lines are printed, with their folder, when a run ends.
  std::set<std::string> told_files = {};
};

/// Rows of all groups of the topic's metric table, in their order.
std::vector<std::reference_wrapper<const MetricEntry>> metric_rows(const Topic& topic);

std::vector<std::string> metric_names(const Topic& topic);

/// The row of that name, null when there is none.
const DiagnosticEntry* find_diagnostic(const Topic& topic, const std::string& name);
const MetricEntry* find_metric(const Topic& topic, const std::string& name);

/// The method of that name. @throws Error  naming those that there are
const MethodEntry& method_of(const Topic& topic, const std::string& name);

/// The group that the row is in.
const MetricGroup& group_of(const Topic& topic, const MetricEntry& row);

/// The topics of the program. Tests add theirs.
std::vector<Topic> all_topics();

}  // namespace geoprior
