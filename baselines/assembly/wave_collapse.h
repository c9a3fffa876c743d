#pragma once

#include <memory>

#include "core/method.h"
#include "models/assembly/search/input.h"

namespace geoprior::assembly {

struct WaveCollapseOptions {
  int count = 16;
  int attempts = 1000;
  int parts = 100;
  bool symmetries = true;
};
void describe(OptionVisitor& v, WaveCollapseOptions& options);

/// A generator in the manner of wave function collapse, on ports in place of tiles.
///
/// It begins with the first part of an input that is an entry (without entries: with any of its
/// parts), where it stands. Of all ports that are undecided, the one with the fewest choices is
/// decided next: any port that some model joins with it, or open where it is open in some model, by
/// how often that was seen; choices whose part would be below the floor or meet another part are
/// none. A port that meets an undecided one, of a kind that was seen joined with it, is joined. A
/// port without a choice, or more than so many parts, ends an attempt.
///
/// What it cannot do: it knows neither the inputs' larger arrangements nor loops; they close by
/// chance.
/// Source: Gumin 2016, "WaveFunctionCollapse" (order of decisions, weights); ports are ours.
std::unique_ptr<Process> make_wave_collapse(const AssemblyInput& input,
                                            const WaveCollapseOptions& options);

}  // namespace geoprior::assembly
