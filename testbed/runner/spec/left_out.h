#pragma once

#include <string>
#include <vector>

#include "testbed/runner/spec/claims.h"
#include "testbed/runner/spec/experiment.h"
#include "testbed/runner/spec/toml_tree.h"

namespace geoprior {

/// What a run leaves out of its experiment file: variants that --variant or a quick run does not
/// run, the sweeps that are about them alone, cases that only the full version has, and what the
/// file claims and draws of all these.

/// @param root     the file after [quick] and --set
/// @param written  the file with all of its sweeps: what is claimed of cases that --set or the
///                 quick version leave out is no mistake of the file
/// @param selected variants that run; empty: all
KnownNames known_names(const TomlNode& root, const TomlNode& written,
                       const std::vector<std::string>& selected, bool quick);

/// Quick runs decide no claim about a variant that they leave out: the file says so of both.
/// @throws Error  naming the claim and the variant
void require_claimed_variants(const TomlNode& root, const std::vector<std::string>& dropped);

/// Takes dropped variants out of the sweeps, and sweeps that are about dropped ones alone: they
/// would only repeat the base case. A grid runs the variants of all of its sweeps.
void drop_sweeps(TomlNode& root, const std::vector<std::string>& dropped);

/// Forgets cases that `drop_sweeps` took away or that only the full version has; a study that was
/// only about them goes too.
void drop_cases(std::vector<StudySpec>& studies, const std::vector<CaseSpec>& cases);
void drop_cases(std::vector<ClaimSpec>& claims, const std::vector<CaseSpec>& cases);

/// The figure shows what this run makes of what the file asks for.
void leave_out_of_view(TomlNode& root, const KnownNames& names, const std::vector<CaseSpec>& cases);

}  // namespace geoprior
