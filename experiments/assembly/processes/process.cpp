#include "experiments/assembly/processes/process.h"

#include <utility>

#include "experiments/assembly/processes/survey.h"

namespace geoprior::assembly {

std::unique_ptr<Process> replacement_process(const AssemblyInput& input, FinderFactory factory,
                                             bool symmetries, const SearchOptions& options) {
  return input.survey ? survey_process(input, std::move(factory), symmetries, options)
                      : variation_process(input, std::move(factory), symmetries, options);
}

}  // namespace geoprior::assembly
