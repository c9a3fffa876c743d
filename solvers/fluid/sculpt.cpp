#include "solvers/fluid/sculpt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/frame_loop.h"
#include "solvers/fluid/lift/lift.h"
#include "solvers/fluid/lift/lifted_frames.h"
#include "solvers/fluid/warnings.h"

namespace geoprior::fluid {
namespace {

std::string known_sources(const SculptScene& scene) {
  std::string text;
  for (const auto& entry : scene.sources) text += (text.empty() ? "" : ", ") + entry.first;
  for (const auto& entry : scene.libraries) text += (text.empty() ? "" : ", ") + entry.first;
  return text.empty() ? "none: the scene has no source" : text;
}

/// Edits with names and sources: a scene with one source needs none.
std::vector<Edit> named_edits(const SculptScene& scene) {
  std::vector<Edit> edits = scene.edits;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    if (edits[i].name.empty()) edits[i].name = std::to_string(i + 1);
    if (edits[i].source.empty() && scene.sources.size() + scene.libraries.size() == 1) {
      edits[i].source =
          scene.sources.empty() ? scene.libraries.begin()->first : scene.sources.begin()->first;
    }
    require_valid(edits[i]);
    for (std::size_t j = 0; j < i; ++j) {
      if (edits[j].name != edits[i].name) continue;
      throw Error("two edits have this name", "edit '" + edits[i].name + "'", "distinct names");
    }
    if (!scene.sources.contains(edits[i].source) && !scene.libraries.contains(edits[i].source)) {
      throw Error("there is no source '" + edits[i].source + "'", "edit '" + edits[i].name + "'",
                  known_sources(scene));
    }
  }
  return edits;
}

/// What is taken out of the target before features are pasted into it.
struct Cut {
  Extraction extraction;  ///< of the source that is the target
  std::set<int> ids;
};

/// @throws Error  when an edit cuts out of an animation that is not the target
void require_cuts_target(const SculptScene& scene, const Edit& edit) {
  const auto source = scene.sources.find(edit.source);
  const SurfaceSequence& target = *scene.target;
  bool same = source != scene.sources.end() && source->second->name() == target.name() &&
              source->second->frame_count() == target.frame_count();
  for (int f = 0; same && f < target.frame_count(); ++f) {
    same = source->second->time(f) == target.time(f);
  }
  if (same) return;
  throw Error("cuts features out of '" + edit.source + "', which is not the target",
              "edit '" + edit.name + "'", "the same animation as source and target, or no cut");
}

/// A warning without its time: what makes it the same one again.
std::string without_time(const std::string& text) {
  const std::size_t at = text.find(" at ");
  return at == std::string::npos ? text : text.substr(0, at);
}

/// How far a point is beside a box, seen along `up`.
double distance_beside(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& point,
                       const Eigen::Vector3d& up) {
  const Eigen::Vector3d away = point - point.cwiseMax(box.min()).cwiseMin(box.max());
  return (away - away.dot(up) * up).norm();
}

class SculptFrames final : public FrameModel {
 public:
  SculptFrames(const SculptScene& scene, const SculptOptions& options)
      : scene_(scene), options_(options) {}

  [[nodiscard]] int frame_count() const override { return static_cast<int>(scene_.times.size()); }

  void begin(FrameSink& sink, RunContext& context) override {
    make_insertions(sink, context);
    if (context.stop_requested()) return;
    require_on_target(sink);
    for (const auto& entry : lifted_) {
      for (const Feature& f : entry.second) feature_bytes_ += static_cast<double>(f.bytes());
      lifted_features_ += static_cast<double>(entry.second.size());
    }
  }

  void record(int number, FrameSink& sink, RunContext& context) override {
    Frame frame = pasted(scene_.times[number], sink, context);
    frame.diagnostics["lifted_features"] = lifted_features_;
    frame.diagnostics["feature_bytes"] = feature_bytes_;
    sink.frame(std::move(frame));
  }

  void save(StateWriter& out) const override { warnings_.save(out); }
  void load(StateReader& in, int /*next_frame*/) override { warnings_.load(in); }

 private:
  /// Features that the edits select from one source, lifted when it is a sequence.
  std::map<std::string, std::vector<int>> lift_source(const std::string& source,
                                                      std::vector<Feature>& features,
                                                      FrameSink& sink, RunContext& context) {
    const auto library = scene_.libraries.find(source);
    Extraction extraction;
    std::vector<FeatureSummary> summaries;
    if (library != scene_.libraries.end()) {
      for (const Feature& f : library->second) summaries.push_back(summary_of(f));
    } else {
      extraction = extract_regions(*scene_.sources.at(source), options_.extraction, context);
      if (context.stop_requested()) return {};
      for (const std::string& w : extraction.warnings) {
        warnings_.warn(source + ": " + w, source + ": " + w, 0, sink);
      }
      summaries = track_summaries(extraction, 1);
    }
    std::map<std::string, std::vector<int>> selected;
    std::set<int> ids;
    for (const Edit& edit : scene_.edits) {
      if (edit.source != source) continue;
      selected[edit.name] = select_features(of_length(summaries, edit), edit);
      ids.insert(selected[edit.name].begin(), selected[edit.name].end());
      if (edit.cut) cut_.ids.insert(selected[edit.name].begin(), selected[edit.name].end());
    }
    if (library != scene_.libraries.end()) {
      for (const Feature& f : library->second) {
        if (ids.contains(f.id)) features.push_back(f);
      }
    } else {
      features = lift_features(*scene_.sources.at(source), extraction, options_.extraction,
                               {ids.begin(), ids.end()}, context);
    }
    // Features are cut out of the target only, which one source is: there is one extraction to
    // keep.
    if (!cut_.ids.empty() && cut_.extraction.segmenter == nullptr) {
      cut_.extraction = std::move(extraction);
    }
    return selected;
  }

  /// Short tracks are selected by their id only.
  [[nodiscard]] std::vector<FeatureSummary> of_length(const std::vector<FeatureSummary>& all,
                                                      const Edit& edit) const {
    if (!edit.ids.empty()) return all;
    std::vector<FeatureSummary> result;
    for (const FeatureSummary& s : all) {
      if (std::ssize(s.times) >= options_.extraction.shortest_track) {
        result.push_back(s);
      }
    }
    return result;
  }

  void make_insertions(FrameSink& sink, RunContext& context) {
    std::map<std::string, std::map<std::string, std::vector<int>>> selected;
    for (const Edit& edit : scene_.edits) {
      if (selected.contains(edit.source)) continue;
      selected[edit.source] = lift_source(edit.source, lifted_[edit.source], sink, context);
      if (context.stop_requested()) return;
    }
    for (const Edit& edit : scene_.edits) {
      for (const Feature& f : lifted_[edit.source]) {
        const auto& ids = selected[edit.source][edit.name];
        if (std::find(ids.begin(), ids.end(), f.id) != ids.end()) insertions_.push_back({&f, edit});
      }
    }
  }

  [[nodiscard]] SurfaceFrame target_at(double time) const {
    SurfaceFrame frame = scene_.target->frame(scene_.target->nearest_frame(time));
    if (scene_.target->frame_count() == 1 && frame.velocity.rows() == 0) {
      frame.velocity = Eigen::MatrixX3d::Zero(frame.mesh.V.rows(), 3);  // a still mesh rests
    }
    return frame;
  }

  /// Before anything is pasted: every map meets the target at some time, or there is no point.
  void require_on_target(FrameSink& sink) {
    Eigen::AlignedBox3d box;
    const SurfaceFrame first = target_at(scene_.times.front());
    for (Eigen::Index v = 0; v < first.mesh.V.rows(); ++v) {
      box.extend(first.mesh.V.row(v).transpose());
    }
    for (const Insertion& insertion : insertions_) {
      const std::string who =
          "edit '" + insertion.edit.name + "', feature " + std::to_string(insertion.feature->id);
      bool alive = false;
      double nearest = std::numeric_limits<double>::infinity();
      for (const double time : scene_.times) {
        const auto frame = edited_frame(*insertion.feature, insertion.edit, time, scene_.up);
        if (!frame) continue;
        alive = true;
        const Eigen::Vector3d scale = frame->placement.linear().colwise().norm().transpose();
        nearest =
            std::min(nearest, distance_beside(box, frame->placement.translation(), scene_.up) -
                                  0.5 * insertion.feature->extent * scale.head<2>().maxCoeff());
      }
      if (!alive) {
        const std::string text = who + ": lives at none of the result's times";
        warnings_.warn(text, text, scene_.times.front(), sink);
      } else if (nearest > 0 && insertion.feature->kind == RegionKind::differential) {
        throw Error("lies off the target at all times, by " + std::to_string(nearest) + " m", who,
                    "a place on the target, which reaches from " + text_of(box.min()) + " to " +
                        text_of(box.max()));
      }
    }
  }

  static std::string text_of(const Eigen::Vector3d& p) {
    return "(" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " +
           std::to_string(p.z()) + ")";
  }

  Frame pasted(double time, FrameSink& sink, RunContext& context) {
    SurfaceFrame target = target_at(time);
    if (!cut_.ids.empty()) {
      const Phase phase(context, "cut");
      target = without_feature(target, scene_.target->nearest_frame(time), cut_.extraction,
                               options_.extraction, {cut_.ids.begin(), cut_.ids.end()});
    }
    PasteReport report;
    SurfaceFrame result;
    {
      const Phase phase(context, "paste");
      result = paste(target, insertions_, time, scene_.up, options_.paste, &report);
    }
    for (const std::string& w : report.warnings) warnings_.warn(w, without_time(w), time, sink);
    Frame frame;
    frame.parameter = time;
    frame.tables["insertions"] = present(time);
    Part& surface = frame.parts["surface"];
    const Eigen::Index n = result.mesh.V.rows();
    surface.points = std::move(result.mesh.V);
    surface.triangles = std::move(result.mesh.F);
    if (result.velocity.rows() == n && n > 0) {
      surface.arrays.push_back({"velocity", "m/s", NamedArray::On::points, result.velocity});
    }
    Eigen::VectorXd feature(n);
    for (Eigen::Index v = 0; v < n; ++v) {
      feature[v] = report.vertex_feature[v];
    }
    surface.arrays.push_back({"feature", "1", NamedArray::On::points, feature});
    frame.diagnostics["target_vertices"] = static_cast<double>(target.mesh.V.rows());
    frame.diagnostics["displaced_vertices"] = report.displaced_vertices;
    frame.diagnostics["added_triangles"] = report.added_triangles;
    frame.diagnostics["features"] = report.features;
    frame.diagnostics["added_volume"] = report.added_volume;
    frame.diagnostics["min_jacobian"] = report.min_jacobian;
    return frame;
  }

  [[nodiscard]] FrameTable present(double time) const {
    FrameTable table;
    table.columns = {"edit [1]", "feature [1]", "x [m]",          "y [m]",
                     "z [m]",    "fade [1]",    "source_time [s]"};
    for (const Insertion& insertion : insertions_) {
      const auto frame = edited_frame(*insertion.feature, insertion.edit, time, scene_.up);
      if (!frame) continue;
      const auto edit = std::find_if(scene_.edits.begin(), scene_.edits.end(),
                                     [&](const Edit& e) { return e.name == insertion.edit.name; });
      const Eigen::Vector3d c = frame->placement.translation();
      table.rows.conservativeResize(table.rows.rows() + 1, 7);
      table.rows.row(table.rows.rows() - 1) << static_cast<double>(edit - scene_.edits.begin() + 1),
          insertion.feature->id, c.x(), c.y(), c.z(), frame->fade, frame->source_time;
    }
    if (table.rows.rows() == 0) table.rows.resize(0, 7);
    return table;
  }

  const SculptScene& scene_;
  const SculptOptions& options_;
  Warnings warnings_;
  std::map<std::string, std::vector<Feature>> lifted_;  ///< by source
  Cut cut_;
  std::vector<Insertion> insertions_;  ///< of features in `lifted_`
  double lifted_features_ = 0, feature_bytes_ = 0;
};

}  // namespace

std::unique_ptr<Process> make_sculpt(const SculptScene& scene, const SculptOptions& options) {
  if (scene.target == nullptr || scene.target->frame_count() == 0) {
    throw Error("there is nothing to paste into", "scene", "a target");
  }
  if (scene.times.empty()) throw Error("the result has no times", "scene", "at least one time");
  if (scene.edits.empty()) throw Error("there are no edits", "scene", "at least one [[edit]]");
  SculptScene named = scene;
  named.edits = named_edits(scene);
  for (const Edit& edit : named.edits) {
    if (edit.cut) require_cuts_target(named, edit);
  }
  return frame_process([scene = std::move(named), options](RunContext& /*context*/) {
    return std::make_unique<SculptFrames>(scene, options);
  });
}

void describe(OptionVisitor& v, SculptOptions& o) {
  describe_group(v, "extraction", o.extraction, {.doc = "how features are found in the sources"});
  describe_group(v, "paste", o.paste, {.doc = "how features are put into the target"});
}

}  // namespace geoprior::fluid
