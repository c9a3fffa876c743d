#include <string>
#include <utility>
#include <vector>

#include "baselines/grammar/direct.h"
#include "baselines/grammar/free_form.h"
#include "baselines/grammar/instance_frames.h"
#include "baselines/grammar/nothing.h"
#include "baselines/grammar/optimum/optimum.h"
#include "baselines/grammar/regeneration.h"
#include "core/error.h"
#include "experiments/grammar/processes/methods.h"
#include "solvers/grammar/rules/rules.h"

namespace geoprior::grammar {
namespace {

/// A baseline that keeps a state after the edits, which are made as they are asked for: no rules.
class PlainDeformer : public Deformer {
 public:
  explicit PlainDeformer(const GrammarScene& scene)
      : scene_(scene), base_(scene.rest), undo_(base_) {
    no_rules_.bound_locality("*");
  }
  void edit(const SceneEdit& edit) override {
    derive(base_, undo_, no_rules_, edit.wish);
    if (edit.tag) base_.set_tag(edit.wish.element, *edit.tag);
    deformed_ = false;
  }
  void deform(std::size_t, const std::shared_ptr<const SpatialMap>& map) override {
    deformed_ = true;
    make(*map);
  }
  [[nodiscard]] const Hierarchy& shown() const override { return base_; }

 protected:
  virtual void make(const SpatialMap& map) = 0;
  [[nodiscard]] bool shows_base() const { return !deformed_; }

  const GrammarScene& scene_;
  Hierarchy base_;

 private:
  RuleSet no_rules_;
  Transaction undo_;
  bool deformed_ = false;  ///< rather than edited, last
};

/// Ignores edits, too.
class NothingDeformer final : public Deformer {
 public:
  explicit NothingDeformer(const GrammarScene& scene) : scene_(scene) {}
  void edit(const SceneEdit&) override {}
  void deform(std::size_t, const std::shared_ptr<const SpatialMap>&) override {}
  [[nodiscard]] const Hierarchy& shown() const override { return nothing(scene_.rest); }

 private:
  const GrammarScene& scene_;
};

/// Moves key points and vertices, and knows no elements.
class GeometryDeformer : public PlainDeformer {
 public:
  explicit GeometryDeformer(const GrammarScene& scene)
      : PlainDeformer(scene), moved_elements_(elements_below(scene.rest, scene.gesture_element)) {}
  [[nodiscard]] Geometry geometry(bool with_surface) const override {
    return shows_base() ? geometry_of(base_, with_surface) : moved_;
  }

 protected:
  [[nodiscard]] Geometry before(bool vertices) const {
    return geometry_of(base_, vertices || scene_.record == GrammarSceneOptions::Record::surface);
  }
  std::vector<char> moved_elements_;
  Geometry moved_;
};

class FreeFormDeformer final : public GeometryDeformer {
 public:
  using GeometryDeformer::GeometryDeformer;

 private:
  void make(const SpatialMap& map) override {
    moved_ = free_form(before(false), map, moved_elements_);
  }
};

class RigidDeformer final : public GeometryDeformer {
 public:
  RigidDeformer(const GrammarScene& scene, const RigidAsPossibleOptions& options)
      : GeometryDeformer(scene), options_(options) {}

 private:
  void make(const SpatialMap& map) override {
    moved_ = rigid_as_possible(before(true), map, options_, moved_elements_);
    if (scene_.record == GrammarSceneOptions::Record::surface) return;
    moved_.surface = {};
  }
  RigidAsPossibleOptions options_;
};

/// Makes a hierarchy of the state after the edits.
class HierarchyDeformer : public PlainDeformer {
 public:
  using PlainDeformer::PlainDeformer;
  [[nodiscard]] const Hierarchy& shown() const override { return shows_base() ? base_ : made_; }

 protected:
  Hierarchy made_;
};

class FramesDeformer final : public HierarchyDeformer {
 public:
  using HierarchyDeformer::HierarchyDeformer;

 private:
  void make(const SpatialMap& map) override {
    made_ = instance_frames(base_, map, scene_.gesture_element);
  }
};

class RegeneratingDeformer final : public HierarchyDeformer {
 public:
  using HierarchyDeformer::HierarchyDeformer;

 private:
  void make(const SpatialMap& map) override {
    made_ = regenerate(scene_.rest, scene_.generate, map);
  }
};

class CarriedDetailsDeformer final : public HierarchyDeformer {
 public:
  using HierarchyDeformer::HierarchyDeformer;

 private:
  void make(const SpatialMap& map) override { made_ = carried_details(base_, map); }
};

/// Edits are turns of joints; there is no gesture.
class RigidPartsDeformer final : public Deformer {
 public:
  explicit RigidPartsDeformer(const GrammarScene& scene) : parts_(scene.rest), shown_(scene.rest) {}

  void edit(const SceneEdit& edit) override {
    const int element = edit.wish.element;
    if (edit.wish.delta.kind != DeltaKind::rigid)
      throw Error("is asked for something else",
                  "edit of '" + shown_.label(element) + "' by direct code", "a turn");
    parts_.turn(element, Eigen::Quaterniond(edit.wish.delta.transform.linear()));
    parts_.place(shown_);
    if (edit.tag) shown_.set_tag(element, *edit.tag);
  }
  void deform(std::size_t, const std::shared_ptr<const SpatialMap>&) override {}
  [[nodiscard]] const Hierarchy& shown() const override { return shown_; }
  [[nodiscard]] Geometry geometry(bool with_surface) const override {
    return parts_.geometry(with_surface);
  }

 private:
  RigidParts parts_;
  Hierarchy shown_;
};

class OptimumDeformer final : public Deformer {
 public:
  explicit OptimumDeformer(const GrammarScene& scene)
      : scene_(scene), grammar_(scene.rest, object_rules(), {}) {}

  void edit(const SceneEdit& edit) override {
    grammar_.edit(edit.wish, edit.tag);
    base_ = grammar_.state();
    result_.reset();
  }
  void deform(std::size_t, const std::shared_ptr<const SpatialMap>& map) override {
    grammar_.gesture(scene_.gesture_element, map, map);
    const Hierarchy& rest = base_ ? *base_ : scene_.rest;
    result_ = optimise_object(rest, grammar_.state(), *map);
  }
  [[nodiscard]] const Hierarchy& shown() const override {
    return result_ ? result_->state : grammar_.state();
  }
  [[nodiscard]] std::map<std::string, double> diagnostics() const override {
    if (!result_) return {};
    return {{"iterations", result_->iterations},
            {"gradient", result_->gradient},
            {"start", result_->start}};
  }

 private:
  const GrammarScene& scene_;
  DeformationGrammar grammar_;
  std::optional<Hierarchy> base_;
  std::optional<OptimumResult> result_;
};

}  // namespace

std::unique_ptr<Deformer> nothing_deformer(const GrammarScene& scene) {
  return std::make_unique<NothingDeformer>(scene);
}

std::unique_ptr<Deformer> free_form_deformer(const GrammarScene& scene) {
  return std::make_unique<FreeFormDeformer>(scene);
}

std::unique_ptr<Deformer> frames_deformer(const GrammarScene& scene) {
  return std::make_unique<FramesDeformer>(scene);
}

std::unique_ptr<Deformer> rigid_deformer(const GrammarScene& scene,
                                         const RigidAsPossibleOptions& options) {
  return std::make_unique<RigidDeformer>(scene, options);
}

std::unique_ptr<Deformer> regenerating_deformer(const GrammarScene& scene) {
  if (!scene.generate)
    throw Error("has no procedure", "object '" + scene.object + "'", "a procedural object");
  return std::make_unique<RegeneratingDeformer>(scene);
}

std::unique_ptr<Deformer> direct_deformer(const GrammarScene& scene) {
  const std::string where = "direct code for object '" + scene.object + "'";
  if (scene.kind == Object::arm) {
    if (scene.steps.size() > scene.edits.size() + 1)
      throw Error("has a gesture", where, "turns of joints alone (scene.edits)");
    return std::make_unique<RigidPartsDeformer>(scene);
  }
  if (scene.kind == Object::surface_set) {
    if (scene.gesture_element != 0)
      throw Error("has a gesture of one item", where, "a gesture of the whole surface");
    return std::make_unique<CarriedDetailsDeformer>(scene);
  }
  if (!scene.gesture.lattice)
    throw Error("is not there", where, "an arm, a surface-set, or a gesture with a lattice");
  return std::make_unique<FreeFormDeformer>(scene);
}

std::unique_ptr<Deformer> optimum_deformer(const GrammarScene& scene) {
  return std::make_unique<OptimumDeformer>(scene);
}

}  // namespace geoprior::grammar
