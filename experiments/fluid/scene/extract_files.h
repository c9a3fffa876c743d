#pragma once

#include "solvers/fluid/extract.h"

namespace geoprior::fluid {

/// Options of the method "extract": the solver's, and what is written of lifted features.
struct StoredExtractOptions {
  ExtractOptions extract;
  bool exr = false;
};
void describe(OptionVisitor& v, StoredExtractOptions& options);

/// Artifacts of an extraction: "features.h5", a library of all lifted features (feature_files.h),
/// and with `exr` a sequence of pictures "feature<id>_0000.exr" … of every differential one
/// (exr_maps.h).
FeatureFiles feature_files(const StoredExtractOptions& options);

}  // namespace geoprior::fluid
