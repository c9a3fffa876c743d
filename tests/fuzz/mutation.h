#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/random.h"

namespace geoprior::test {

/// The files of tests/fuzz/corpus with this extension (".ply"), in order of their names.
std::vector<std::string> corpus(const std::string& extension);

/// One file of it.
std::string corpus_file(const std::string& name);

/// Uniform in 0 … n-1; 0 for n = 0.
std::size_t below(RandomStream& random, std::size_t n);

/// Random changes of one of the seeds. Every other time up to six of any kind: flipped bits, bytes
/// and pieces that are replaced, dropped, repeated or taken from another seed; else up to three
/// words that readers trip over in the place of others, which keeps the grammar of a text.
std::string mutated(const std::vector<std::string>& seeds, RandomStream& random);

}  // namespace geoprior::test
