#pragma once

#include "core/method.h"
#include "core/options.h"

namespace geoprior::sample {

struct GrowingSquareOptions {
  double rate = 1;  ///< of the edge (m/s)
};
void describe(OptionVisitor& v, GrowingSquareOptions& options);

/// A square of edge rate * t in the plane z = 0: the smallest method that a topic can have.
class GrowingSquare final : public PoseMethod {
 public:
  explicit GrowingSquare(const GrowingSquareOptions& options) : options_(options) {}
  void solve(double time, RunContext& context) override;
  [[nodiscard]] Frame frame() const override;

 private:
  GrowingSquareOptions options_;
  double time_ = 0;
};

}  // namespace geoprior::sample
