#pragma once

#include <map>
#include <optional>
#include <string>

#include "testbed/runner/reference/blessed_claims.h"
#include "testbed/runner/reference/outcomes.h"

namespace geoprior {

/// One value that was blessed.
struct ReferenceValue {
  double value = 0;  ///< NaN: there was none
  std::string unit;
};

/// Case, variant, name of a gated value (gates.h).
using ReferenceSet =
    std::map<std::string, std::map<std::string, std::map<std::string, ReferenceValue>>>;

/// What the blessed run was, byte by byte.
struct ContentHash {
  std::string instruction_set;  ///< of the build: other ones round differently
  std::string frames;           ///< RunRecord::frames_sha256
  std::string metrics;          ///< RunRecord::metrics_sha256
  /// RunRecord::content_sha256, of both together: all that is known of a run blessed before they
  /// were told apart; else empty.
  std::string content = {};
};

struct Blessing {
  std::string commit;
  std::string reason;
};

/// What was blessed of the full or of the quick runs.
struct BlessedSet {
  Blessing blessing;  ///< the last
  std::optional<ContentHash> content;
  std::optional<double> processor_s;  ///< processor time that the run took
  ReferenceSet values;
  Outcomes outcomes = {};  ///< of experiments whose `[check]` asks for them
  BlessedClaims claims = {};
};

/// results/reference/<id>.txt: a set "full", a set "quick", or one of them.
using Reference = std::map<std::string, BlessedSet>;

}  // namespace geoprior
