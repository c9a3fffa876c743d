#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "models/paper/sheet/process.h"
#include "models/paper/tear/growth.h"
#include "solvers/paper/hybrid_options.h"
#include "solvers/paper/meshing/look_timer.h"
#include "solvers/paper/meshing/ruling_editor.h"
#include "solvers/paper/meshing/ruling_mesh.h"
#include "solvers/paper/sheet/propagation.h"
#include "solvers/paper/shell/bending_guide.h"
#include "solvers/paper/shell/isometry_projection.h"

namespace geoprior::paper {

/// The geometric layer as a mesher of the common loop.
class HybridMesher final : public SheetMesher {
 public:
  explicit HybridMesher(const HybridOptions& options)
      : options_(options), looks_(options.look_frames) {}

  [[nodiscard]] ShellState start(const Sheet& sheet, RunContext& context) override;
  void stepped(const Sheet& sheet, ShellStepper& stepper, ShellState& state,
               RunContext& context) override;
  bool adapt(const Sheet& sheet, ShellStepper& stepper, ShellState& state,
             RunContext& context) override;
  bool take_back(const Sheet& sheet, ShellState& state, RunContext& context) override;
  bool settle(const Sheet& sheet, ShellStepper& stepper, ShellState& state,
              RunContext& context) override;
  void annotate(const ShellState& state, Frame& frame) const override;
  void save(StateWriter& out) const override;
  void load(const Sheet& sheet, StateReader& in) override;

  [[nodiscard]] const PaperStructure& structure() const { return structure_; }
  /// Absent on a sheet that does not tear.
  [[nodiscard]] const Tears* tears() const { return tearing_ ? &tearing_->tears() : nullptr; }
  [[nodiscard]] const RulingMesh& mesh() const { return mesh_; }
  /// The pattern, cut along the tears.
  [[nodiscard]] const Pattern& torn() const { return pattern_; }

 private:
  /// What an attempt to change the structure may have to give back.
  struct Snapshot {
    PaperStructure structure;
    RulingMesh mesh;
    ShellState state;
    PropagationReport events;
    ProjectionReport projection;
  };
  [[nodiscard]] Snapshot snapshot(const ShellState& state) const;
  void restore(const Snapshot& before, ShellState& state);

  void take_scene(const Sheet& sheet);
  void tear_mesh(ShellState& state);
  [[nodiscard]] RulingEditor editor();
  void remesh();
  void attend(const Sheet& sheet, const ShellStepper& stepper, ShellState& state);
  [[nodiscard]] std::vector<DemandGroup> analyse(const Sheet& sheet, ShellState& state,
                                                 RunContext& context);
  bool track(RulingEditor& editor, PropagationReport& events);
  [[nodiscard]] PropagationReport edit(const ShellState& state,
                                       const std::vector<DemandGroup>& groups, bool tracking,
                                       std::uint64_t seed);
  void resolve(const ShellState& state, const std::vector<DemandGroup>& groups, std::uint64_t seed,
               RulingEditor& pen, PropagationReport& total);
  bool look(const Sheet& sheet, const std::vector<DemandGroup>& groups, bool reviews,
            const Snapshot& before, ShellState& state, RunContext& context);
  bool try_change(const Sheet& sheet, const std::vector<DemandGroup>& groups, bool tracking,
                  int effort, const Snapshot& before, ShellState& state, RunContext& context);
  [[nodiscard]] bool strains() const;
  void keep(const Sheet& sheet, int effort, ShellState& state, RunContext& context);
  bool refine(const Sheet& sheet, const Snapshot& before, ShellState& state, RunContext& context);
  bool last_resort(const Sheet& sheet, const std::vector<DemandGroup>& groups,
                   const Snapshot& before, const Snapshot* tried, ShellState& state,
                   RunContext& context);
  void weigh_births(const Sheet& sheet, const Snapshot& before, ShellState& state,
                    RunContext& context);
  bool review_points(const Sheet& sheet, ShellState& state, RunContext& context);
  void carry(const Sheet& sheet, ShellState& state, std::size_t old_points,
             RunContext& context) const;
  void give_up();
  [[nodiscard]] bool strains_without_change(const Sheet& sheet, ShellState state,
                                            RunContext& context);
  [[nodiscard]] bool moves_too_far(const Sheet& sheet, const ShellState& state) const;
  void project(const Sheet& sheet, int effort, ShellState& state, RunContext& context);

  HybridOptions options_;
  PaperStructure structure_;
  RulingMesh mesh_;
  Eigen::MatrixX3d curvature_;  ///< of each triangle, at the end of the frame's steps
  std::vector<double> folds_;   ///< of each ruling, likewise (rad)
  Pattern pattern_;
  std::vector<Eigen::Vector2d> anchors_;
  std::optional<IsometryProjector> projector_;
  std::optional<BendingGuide> guide_;
  std::optional<BendingField> field_;
  std::optional<TearGrowth> tearing_;
  std::uint64_t draws_ = 0;         ///< of singular points, so far
  bool meshed_ = false;             ///< false after `load`, until the mesh is made again
  std::optional<Snapshot> before_;  ///< the last `adapt`
  PropagationReport events_;
  ProjectionReport projection_;
  int settle_steps_ = 0;  ///< in this frame
  int meshes_made_ = 0;   ///< in this frame, of changes taken back too
  int frames_ = 0;        ///< so far
  LookTimer looks_;
  int look_span_ = 0;               ///< frames that the last look stands for
  bool strains_unchanged_ = false;  ///< in this frame, the mesh being as it was
  bool weighed_ = false;            ///< in this frame, a singular point
  double left_strain_ = 0;          ///< by a last look in vain
  int unborn_ = 0;                  ///< singular points that were not worth their energy, so far
  int rejected_ = 0;                ///< changes that strained the sheet or moved it too far, so far
};

}  // namespace geoprior::paper
