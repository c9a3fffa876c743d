#include "testbed/runner/reference/blessed_claims.h"

#include <algorithm>

namespace geoprior {
namespace {

std::string place_of(const std::string& text, const std::string& in) {
  return "claim '" + text + "'" + (in.empty() ? "" : ", case '" + in + "'");
}

std::string named(const std::string& null) { return null.empty() ? "none" : "'" + null + "'"; }

}  // namespace

const BlessedClaim* find_claim(const BlessedClaims& blessed, const ClaimRecord& claim) {
  const auto cases = blessed.find(claim.text);
  if (cases == blessed.end()) return nullptr;
  const auto found = cases->second.find(claim.case_name);
  return found == cases->second.end() ? nullptr : &found->second;
}

BlessedClaims bless_claims(const std::vector<ClaimRecord>& claims) {
  BlessedClaims blessed;
  for (const ClaimRecord& claim : claims) {
    BlessedClaim& one = blessed[claim.text][claim.case_name];
    one = {outcome_of(claim), !claim.excepted.empty(), claim.null.variant, claim.grade.of, 0};
    if (claim.grade.of != Graded::not_graded) one.least = claim.grade.least;
  }
  return blessed;
}

std::vector<std::string> changed_claims(const std::vector<ClaimRecord>& now,
                                        const BlessedClaims& blessed) {
  std::vector<std::string> lines;
  for (const ClaimRecord& claim : now) {
    const std::string place = place_of(claim.text, claim.case_name);
    const BlessedClaim* before = find_claim(blessed, claim);
    if (before == nullptr) {
      lines.push_back(place + ": is decided here, and was not when it was blessed");
      continue;
    }
    if (before->outcome != outcome_of(claim)) {
      lines.push_back(place + ": " + text_of(outcome_of(claim)) +
                      ", when it was blessed it was: " + text_of(before->outcome));
    }
    if (before->excepted != !claim.excepted.empty()) {
      lines.push_back(place + ": is " + (before->excepted ? "not " : "") +
                      "excepted, when it was blessed it was" + (before->excepted ? "" : " not"));
    }
    if (before->null != claim.null.variant) {
      lines.push_back(place + ": its null is " + named(claim.null.variant) +
                      ", when it was blessed it was " + named(before->null));
    }
  }
  for (const auto& [text, cases] : blessed) {
    for (const auto& [in, claim] : cases) {
      const bool decided = std::any_of(now.begin(), now.end(), [&](const ClaimRecord& one) {
        return one.text == text && one.case_name == in;
      });
      if (!decided) lines.push_back(place_of(text, in) + ": is not decided here any more");
    }
  }
  return lines;
}

}  // namespace geoprior
