#include "solvers/fluid/sculpting.h"

namespace geoprior {

void describe(OptionVisitor& v, ExtractOptions& o) {
  describe_group(v, "extraction", o.extraction, {.doc = "features of the source"});
  v.value("lift", o.lift, {.doc = "lifts the features out: their maps are recorded and stored"});
  v.value("map_feature", o.map_feature,
          {.doc = "id of the differential feature whose map is recorded; absent: the largest",
           .min = 1});
}

void describe(OptionVisitor& v, SculptOptions& o) {
  describe_group(v, "extraction", o.extraction, {.doc = "features of the sources"});
  describe_group(v, "paste", o.paste, {.doc = "how features are put into the target"});
}

}  // namespace geoprior
