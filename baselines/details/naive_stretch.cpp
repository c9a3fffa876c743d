#include "baselines/details/naive_stretch.h"

namespace geoprior::details {
namespace {

class NaiveStretch final : public DetailMethod {
 public:
  NaiveStretch(const DetailScene& scene, const NaiveStretchOptions& options)
      : options_(options), now_(build_detail_mesh(scene.surface, scene.details)) {}

  void step(const Eigen::MatrixX3d& V, RunContext& context) override {
    const Phase phase(context, "move");
    flips_ = move_surface(now_, V, options_.lengths);
  }
  [[nodiscard]] const DetailMesh& details() const override { return now_; }
  void diagnose(std::map<std::string, double>& into) const override { into["flips"] = flips_; }
  void save(StateWriter& out) const override { now_.save(out); }
  void load(StateReader& in) override { now_.load(in); }

 private:
  NaiveStretchOptions options_;
  DetailMesh now_;
  int flips_ = 0;
};

}  // namespace

void describe(OptionVisitor& v, NaiveStretchOptions& options) {
  describe_lengths(v, options.lengths);
}

std::unique_ptr<DetailMethod> make_naive_stretch(const DetailScene& scene,
                                                 const NaiveStretchOptions& options) {
  require_valid(scene);
  return std::make_unique<NaiveStretch>(scene, options);
}

std::unique_ptr<Process> make_naive_stretch_process(const DetailScene& scene,
                                                    const NaiveStretchOptions& options) {
  return make_detail_process(scene, [options](const DetailScene& s, RunContext&) {
    return make_naive_stretch(s, options);
  });
}

}  // namespace geoprior::details
