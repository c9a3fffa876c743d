#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "testbed/runner/journal/run_record.h"
#include "testbed/runner/spec/terms.h"

namespace geoprior {

/// What a claim came to in one case when it was blessed.
struct BlessedClaim {
  ClaimOutcome outcome = ClaimOutcome::holds;
  bool excepted = false;  ///< it need not hold here
  std::string null;       ///< empty: it names none
  Graded graded = Graded::not_graded;
  double least = 0;  ///< grade, where it is graded
};

/// Text of the claim, case (empty: of a study).
using BlessedClaims = std::map<std::string, std::map<std::string, BlessedClaim>>;

/// What was blessed of the claim in its case; null where that is nothing.
const BlessedClaim* find_claim(const BlessedClaims& blessed, const ClaimRecord& claim);

BlessedClaims bless_claims(const std::vector<ClaimRecord>& claims);

/// One line for each claim that is decided in another case than it was, comes to something else
/// there, is excepted there, or names another null: a list of cases or a null that is changed after
/// the fact is seen.
std::vector<std::string> changed_claims(const std::vector<ClaimRecord>& now,
                                        const BlessedClaims& blessed);

}  // namespace geoprior
