#include "experiments/skinning/weights/weight_rows.h"

#include <algorithm>
#include <string>

#include "core/error.h"

namespace geoprior::skinning {
namespace {

struct BoneValue {
  double value;
  std::size_t bone;
};

/// Positive values of a row, largest first (equal values: smaller bone first).
void sorted_values(const Eigen::MatrixXd& values, Eigen::Index v, std::vector<BoneValue>& row) {
  row.clear();
  for (Eigen::Index j = 0; j < values.cols(); ++j) {
    if (values(v, j) > 0) row.push_back({values(v, j), static_cast<std::size_t>(j)});
  }
  std::stable_sort(row.begin(), row.end(),
                   [](const BoneValue& a, const BoneValue& b) { return a.value > b.value; });
}

/// Drops the values after the first `count` and takes the largest of them from the others; of equal
/// values, which leave nothing, the first stay as they are.
void keep_strongest(std::vector<BoneValue>& row, std::size_t count) {
  if (row.size() <= count) return;
  const double left_out = row[count].value;
  row.resize(count);
  if (row.front().value > left_out) {
    for (BoneValue& entry : row) entry.value -= left_out;
  }
}

}  // namespace

SkinWeights strongest_influences(const Eigen::MatrixXd& values, const std::vector<Bone>& bones,
                                 int joint_count, int max_influences) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<BoneValue> row;
  for (Eigen::Index v = 0; v < values.rows(); ++v) {
    sorted_values(values, v, row);
    if (row.empty()) throw Error("no bone holds the skin", "vertex " + std::to_string(v));
    if (max_influences > 0) keep_strongest(row, max_influences);
    double sum = 0;
    for (const BoneValue& entry : row) sum += entry.value;
    for (const BoneValue& entry : row) {
      if (entry.value > 0)
        entries.emplace_back(static_cast<int>(v), bones[entry.bone].joint, entry.value / sum);
    }
  }
  SkinWeights weights(values.rows(), joint_count);
  weights.setFromTriplets(entries.begin(), entries.end());
  return weights;
}

void describe_influence_limit(OptionVisitor& v, int& max_influences) {
  v.value(
      "max_influences", max_influences,
      {.doc = "influences of a vertex that are kept, less the largest left out, and renormalised; "
              "0 keeps all",
       .min = 0,
       .max = 65535});
}

void require_influence_limit(int max_influences, const std::string& who) {
  if (max_influences < 0) throw Error("max_influences is negative", who, ">= 0");
}

}  // namespace geoprior::skinning
