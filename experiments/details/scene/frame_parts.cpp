#include "experiments/details/scene/frame_parts.h"

#include <algorithm>

namespace geoprior::details {
namespace {

constexpr double kVisible = 0.5;  ///< half of its size: the weight at which one sees a detail

template <class T>
std::vector<T> column(const Part& part, const char* name) {
  const Eigen::MatrixXd& values = part.require_array(name, NamedArray::On::points, 1).values;
  std::vector<T> out(values.rows());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<T>(values(i, 0));
  return out;
}

}  // namespace

FrameDetails::FrameDetails(const Part& details)
    : birth(column<std::int64_t>(details, "birth")),
      weight(column<double>(details, "weight")),
      target(column<double>(details, "target_weight")),
      face(column<int>(details, "face")),
      barycentric(details.require_array("barycentric", NamedArray::On::points, 3).values) {}

int FrameDetails::visible_count() const {
  return static_cast<int>(
      std::count_if(weight.begin(), weight.end(), [](double w) { return w > kVisible; }));
}

std::vector<SurfacePoint> FrameDetails::visible_places() const {
  std::vector<SurfacePoint> places;
  for (std::size_t i = 0; i < face.size(); ++i) {
    if (!(weight[i] > kVisible)) continue;
    const auto b = barycentric.row(i);
    places.push_back({face[i], b.transpose()});
  }
  return places;
}

std::vector<SurfacePoint> places_of(const std::vector<Detail>& details) {
  std::vector<SurfacePoint> places;
  for (const Detail& d : details) places.push_back(d.at);
  return places;
}

DetailSpacing spacing_of(const Part& mesh, double reference) {
  const std::vector<char> ghosts = column<char>(mesh, "ghost");
  return detail_spacing(mesh.points, mesh.triangles, ghosts, reference);
}

}  // namespace geoprior::details
