#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/topic.h"

namespace geoprior {

/// One method with its options on the scene of a case.
struct VariantSpec {
  std::string name;
  std::string method;
  std::string role;                      ///< "method", "baseline" or "ablation"
  std::optional<std::string> reference;  ///< variant that metrics with needs_reference compare with
  std::shared_ptr<const OptionSet> options;
  std::string options_json;  ///< resolved: every option, defaults included
};

/// One point of the sweeps: a scene and the variants that run on it.
struct CaseSpec {
  std::string name = "default";              ///< "stop_angle_deg=26", folder-safe
  std::map<std::string, std::string> swept;  ///< dotted key to the JSON text of its value
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: all
  std::shared_ptr<const OptionSet> scene;
  std::string scene_json;  ///< resolved
  std::vector<VariantSpec> variants;
};

/// A statement that the runner can decide: value (is) factor * value of the other side + offset.
struct ClaimSpec {
  std::string text;
  std::string metric;  ///< of the metric table, or "timing:<phase>" (median, in s)
  std::string variant;
  std::optional<std::string> of;  ///< compared with this variant; absent: with `value`
  std::optional<double> value;
  std::string is = "<=";  ///< "<=", "<", ">=", ">", "=="
  double factor = 1;
  double offset = 0;
  double tolerance = 0;                ///< for "=="
  std::optional<double> at_parameter;  ///< at = { angle_deg = 90 }; the frame must exist
  std::string reduce =
      "max";  ///< "max", "min", "median", "mean", "last" over the frames, when there is no `at`
  std::vector<std::string> cases;  ///< empty: every case
};

/// A quantity across cases.
struct StudySpec {
  std::string name;
  std::string kind;  ///< "exponent": slope of log y against log x; "order": observed order of
                     ///< convergence; "spread"
  std::string variant;
  std::string
      quantity;  ///< a metric's summary, or "timing:<phase>" (median over frames and repetitions)
  std::string against;  ///< a scene fact ("vertices") or a swept key; unused by "spread"
  std::string reduce = "median";
};

/// How the picture of the experiment is drawn. Positions in metres; absent: fitted to the part.
struct FigureView {
  std::optional<double> at_parameter;  ///< frame drawn; absent: the last
  std::vector<double> parameters;      ///< further columns/rows, when more than one frame is drawn
  std::string part = "surface";
  std::optional<std::string> color_by;  ///< array of the part; absent: plain material
  std::optional<std::array<double, 3>> target;
  std::array<double, 3> direction{0, 0, 1};  ///< from the target to the eye
  std::array<double, 3> up{0, 1, 0};
  std::optional<double> height_m;     ///< height of the view (parallel projection)
  std::vector<std::string> variants;  ///< empty: all
  std::vector<std::string> cases;     ///< empty: all
  std::vector<std::string> metrics;   ///< curves of metrics.svg; empty: all that vary
};

struct Experiment {
  std::string id;  ///< "skinning/knee"
  std::string title;
  std::string figure;
  std::string topic;
  std::filesystem::path file;
  bool quick = false;
  std::vector<CaseSpec> cases;
  std::vector<ClaimSpec> claims;
  std::vector<StudySpec> studies;
  std::map<std::string, Tolerance>
      tolerances;  ///< [tolerance] overrides of the metric table, by metric
  int timing_repetitions = 1;
  int timing_warm_up = 1;
  FigureView view;
  std::string resolved_toml;  ///< the whole text after quick, --set and defaults, before sweeps
  std::string hash;  ///< sha256 of `resolved_toml`, topic and program version; 64 hex digits
};

struct LoadRequest {
  bool quick = false;
  std::vector<std::string> sets;      ///< "key=value" of --set
  std::vector<std::string> variants;  ///< of --variant; empty: all
  std::optional<int> threads;         ///< of --threads
};

/// Parses, applies [quick] and --set, expands sweeps, resolves options. Throws Error naming file,
/// line, key, allowed.
Experiment load_experiment(const std::filesystem::path& file, const std::vector<Topic>& topics,
                           const LoadRequest& request);

}  // namespace geoprior
