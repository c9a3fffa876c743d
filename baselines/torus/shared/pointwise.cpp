#include "baselines/torus/shared/pointwise.h"

#include "core/parallel.h"

namespace geoprior::torus {
namespace {

class PointwiseMap final : public TorusMap {
 public:
  explicit PointwiseMap(TorusPoint point) : point_(std::move(point)) {}

  Eigen::MatrixX3d points(std::size_t /*i*/, const TorusSamples& samples,
                          RunContext& /*context*/) override {
    constexpr std::size_t kBlock = 1024;
    Eigen::MatrixX3d out(samples.at.rows(), 3);
    parallel_blocks(out.rows(), kBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) out.row(i) = point_(samples.at.row(i));
    });
    return out;
  }

 private:
  TorusPoint point_;
};

}  // namespace

std::unique_ptr<TorusMap> make_pointwise_map(TorusPoint point) {
  return std::make_unique<PointwiseMap>(std::move(point));
}

}  // namespace geoprior::torus
