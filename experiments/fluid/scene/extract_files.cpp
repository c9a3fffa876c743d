#include "experiments/fluid/scene/extract_files.h"

#include <iterator>
#include <string>

#include "experiments/fluid/scene/exr_maps.h"
#include "experiments/fluid/scene/feature_files.h"

namespace geoprior::fluid {

void describe(OptionVisitor& v, StoredExtractOptions& options) {
  describe(v, options.extract);
  v.value("exr", options.exr,
          {.doc = "whether the maps of lifted features are written as OpenEXR pictures too"});
}

FeatureFiles feature_files(const StoredExtractOptions& options) {
  return [exr = options.exr](const std::vector<Feature>& features) {
    std::vector<Artifact> files;
    files.push_back({"features.h5", feature_library_bytes(features)});
    for (const Feature& feature : features) {
      if (!exr || feature.kind != RegionKind::differential) continue;
      std::vector<Artifact> maps = exr_maps(feature, "feature" + std::to_string(feature.id));
      files.insert(files.end(), std::make_move_iterator(maps.begin()),
                   std::make_move_iterator(maps.end()));
    }
    return files;
  };
}

}  // namespace geoprior::fluid
