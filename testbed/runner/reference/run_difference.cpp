#include "testbed/runner/reference/run_difference.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "testbed/runner/judgement/measure.h"
#include "testbed/runner/number_text.h"

namespace geoprior {
namespace {

/// "surface" of "frames/default/implicit/surface_0012.vtp".
std::string part_of(const StoredFile& file) {
  const std::string name = file.name.substr(file.name.rfind('/') + 1);
  return name.substr(0, name.rfind('_'));
}

/// What became of a part over the frames.
struct PartDifference {
  double moved_m = 0;         ///< farthest of its points
  double largest_change = 0;  ///< of an array's value
  std::string array;          ///< the one that changed most, with its unit
  bool renamed = false;       ///< values of an array have other names
  std::size_t resized = 0;    ///< frames in which it has another number of points or elements
};

void compare_arrays(const Part& now, const Part& before, PartDifference& difference) {
  for (const NamedArray& array : now.arrays) {
    const NamedArray* old = before.find_array(array.name, array.on);
    if (old == nullptr || old->values.rows() != array.values.rows() ||
        old->values.cols() != array.values.cols() || array.values.size() == 0) {
      continue;
    }
    difference.renamed = difference.renamed || array.names != old->names;
    const double change = (array.values - old->values).cwiseAbs().maxCoeff();
    if (!(change > difference.largest_change)) continue;
    difference.largest_change = change;
    difference.array = array.name + (array.unit == "1" ? "" : " [" + array.unit + "]");
  }
}

void compare_parts(const Part& now, const Part& before, PartDifference& difference) {
  const bool same_size = now.kind == before.kind && now.points.rows() == before.points.rows() &&
                         now.triangles.rows() == before.triangles.rows() &&
                         now.lines.size() == before.lines.size();
  if (!same_size) {
    ++difference.resized;
    return;
  }
  if (now.points.rows() > 0) {
    const double moved = (now.points - before.points).rowwise().norm().maxCoeff();
    difference.moved_m = std::max(difference.moved_m, moved);
  }
  compare_arrays(now, before, difference);
}

/// The frames of one variant that are not what they were.
class VariantDifference {
 public:
  VariantDifference(const OpenedRun& now, const OpenedRun& before) : now_(now), before_(before) {}

  void compare(const VariantRecord& now, const VariantRecord& before) {
    frames_ = now.frames.size();
    frames_before_ = before.frames.size();
    for (const FrameRecord& frame : now.frames) {
      const int old = frame_of_parameter(before.frames, frame.parameter);
      const bool same = old >= 0 && compare(frame, before.frames[old]);
      if (same) continue;
      ++differ_;
      if (!first_) first_ = frame.parameter;
    }
  }

  [[nodiscard]] bool any() const { return differ_ > 0 || frames_ != frames_before_; }

  [[nodiscard]] std::string text(const CaseRecord& in) const {
    std::string text =
        std::to_string(differ_) + " of " + std::to_string(frames_) + " frames differ";
    if (frames_ != frames_before_) text += " (there were " + std::to_string(frames_before_) + ")";
    if (first_) {
      text += ", the first at " + in.parameter_name + " " + rounded_text(*first_) +
              (in.parameter_unit == "1" ? "" : " " + in.parameter_unit);
    }
    for (const auto& [name, part] : parts_) text += part_text(name, part);
    return text;
  }

 private:
  /// @return  whether every file is what it was
  bool compare(const FrameRecord& now, const FrameRecord& before) {
    bool same = now.files.size() == before.files.size();
    for (const StoredFile& file : now.files) {
      const auto old = std::find_if(before.files.begin(), before.files.end(),
                                    [&](const auto& f) { return part_of(f) == part_of(file); });
      if (old != before.files.end() && old->sha256 == file.sha256) continue;
      same = false;
      PartDifference& difference = parts_[part_of(file)];
      const bool is_table = file.name.ends_with(".csv");
      if (old == before.files.end() || is_table) continue;
      compare_parts(now_.part(file), before_.part(*old), difference);
    }
    return same;
  }

  static std::string part_text(const std::string& name, const PartDifference& part) {
    std::string text = "; " + name;
    if (part.resized > 0) text += " of another size in " + std::to_string(part.resized);
    if (part.moved_m > 0) text += " moved by up to " + rounded_text(part.moved_m, 2) + " m";
    if (part.renamed) text += ", values with other names";
    if (part.largest_change > 0) {
      text += ", " + part.array + " by up to " + rounded_text(part.largest_change, 2);
    }
    return text;
  }

  const OpenedRun& now_;
  const OpenedRun& before_;
  std::size_t frames_ = 0;
  std::size_t frames_before_ = 0;
  std::size_t differ_ = 0;
  std::optional<double> first_;
  std::map<std::string, PartDifference> parts_;
};

const CaseRecord* find_case(const RunRecord& record, const std::string& name) {
  const auto found = std::find_if(record.cases.begin(), record.cases.end(),
                                  [&](const CaseRecord& in) { return in.name == name; });
  return found == record.cases.end() ? nullptr : &*found;
}

}  // namespace

std::vector<std::string> frame_differences(const OpenedRun& now, const OpenedRun& before) {
  std::vector<std::string> lines;
  for (const CaseRecord& in : now.record().cases) {
    const CaseRecord* old_case = find_case(before.record(), in.name);
    for (const VariantRecord& variant : in.variants) {
      const std::string place = variant.name + ", " + in.name + ": ";
      const VariantRecord* old =
          old_case == nullptr ? nullptr : find_variant(*old_case, variant.name);
      if (old == nullptr) {
        lines.push_back(place + "was not there");
        continue;
      }
      VariantDifference difference(now, before);
      difference.compare(variant, *old);
      if (difference.any()) lines.push_back(place + difference.text(in));
    }
  }
  return lines;
}

}  // namespace geoprior
