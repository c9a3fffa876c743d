#include "solvers/fluid/sculpting.h"

namespace geoprior {

void describe(OptionVisitor& v, ExtractOptions& o) {
  describe_group(v, "extraction", o.extraction, {.doc = "features of the source"});
}

void describe(OptionVisitor& v, SculptOptions& o) {
  describe_group(v, "extraction", o.extraction, {.doc = "features of the sources"});
  describe_group(v, "paste", o.paste, {.doc = "how features are put into the target"});
}

}  // namespace geoprior
