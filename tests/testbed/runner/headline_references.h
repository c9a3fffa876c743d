#pragma once

// What the committed reference values guard: every headline metric of a topic's experiments is
// worsened in memory, one value at a time, and the comparison must name it.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "testbed/catalogue.h"
#include "testbed/formats/atomic_file.h"
#include "testbed/runner/reference/reference.h"
#include "testbed/runner/reference/text.h"
#include "testbed/runner/spec/spec.h"

namespace geoprior::test {

/// The values themselves, as a run would give them.
inline GatedValues values_of(const ReferenceSet& set) {
  GatedValues values;
  for (const auto& [in, variants] : set) {
    for (const auto& [variant, named] : variants) {
      for (const auto& [name, value] : named) values[in][variant][name] = {value.value, value.unit};
    }
  }
  return values;
}

/// A value that is worse than the reference by a hundredth more than `headline_limit`.
inline double worsened(const Gate& gate, double reference) {
  const double step = 1.01 * headline_limit(gate, reference) + 1e-300;
  const bool down = gate.direction == Direction::higher_is_better ||
                    (gate.direction == Direction::closer_to_target && reference < gate.target);
  return down ? reference - step : reference + step;
}

/// Worsens the headline values of one set.
/// @return  how many there are
inline std::size_t expect_guarded(const ReferenceSet& set, const Gates& gates,
                                  const std::string& place) {
  std::size_t headlines = 0;
  for (const auto& [in, variants] : set) {
    const ReferenceSet before{{in, variants}};
    GatedValues now = values_of(before);
    EXPECT_TRUE(compare_with_reference(now, before, gates).empty()) << place << ", " << in;
    for (auto& [variant, named] : now[in]) {
      for (auto& [name, value] : named) {
        const Gate gate = gates.of(variant, name);
        if (!gate.headline || !gate.compared || !std::isfinite(value.value)) continue;
        const double recorded = value.value;
        value.value = worsened(gate, recorded);
        const std::vector<Mismatch> found = compare_with_reference(now, before, gates);
        ++headlines;
        const bool named_alone = found.size() == 1 && found[0].fails && found[0].metric == name &&
                                 found[0].variant == variant && found[0].case_name == in;
        EXPECT_TRUE(named_alone) << place << ", " << in << ", " << variant << ", " << name << ": "
                                 << recorded << " -> " << value.value;
        value.value = recorded;
      }
    }
  }
  return headlines;
}

/// Does so for every experiment of the topic that has reference values, full and quick.
inline void expect_headline_metrics_are_guarded(const Topic& topic) {
  std::size_t files = 0, headlines = 0;
  for (const CatalogueEntry& entry : catalogue()) {
    if (entry.topic != topic.name) continue;
    const std::filesystem::path file = reference_file(entry.id);
    const Reference reference = read_reference(file);
    EXPECT_TRUE(reference.empty() || reference_text(reference) == read_whole_file(file))
        << "not as bless writes it: " << file;
    ++files;
    for (const auto& [size, set] : reference) {
      LoadRequest load;
      load.quick = size == "quick";
      const Experiment experiment = load_experiment(entry.file, {topic}, load);
      headlines +=
          expect_guarded(set.values, Gates(experiment, topic), entry.id + " (" + size + ")");
    }
  }
  EXPECT_GT(files, 0U);
  EXPECT_GT(headlines, files) << "claims name metrics";
}

}  // namespace geoprior::test
