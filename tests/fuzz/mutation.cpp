#include "tests/fuzz/mutation.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

#include "testbed/formats/atomic_file.h"

namespace geoprior::test {
namespace {

constexpr std::array kNumbers{
    "0",    "1",   "2",     "3",     "-1",         "-0",
    "0.5",  "10",  "100",   "99999", "2147483648", "4294967295",
    "1e-9", "1e9", "1e999", "nan",   "1e-400",     "18446744073709551615"};
constexpr std::array kWords{"[]",  "null", "{}", "true", "\"\"", "..", "../../../escape",
                            "a/b", "%2F"};

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

bool is_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '-' || c == '+';
}

/// Replaces a word at a random place by one that readers trip over; mostly a number by a number.
void replace_word(std::string& text, RandomStream& random) {
  const bool number = random.below(4) != 0;
  std::size_t begin = below(random, text.size());
  while (begin < text.size() && !(number ? is_digit(text[begin]) : is_of_word(text[begin])))
    ++begin;
  std::size_t end = begin;
  while (end < text.size() && is_of_word(text[end])) ++end;
  text.replace(
      begin, end - begin,
      number ? kNumbers[below(random, kNumbers.size())] : kWords[below(random, kWords.size())]);
}

/// A short piece many times over: what is nested gets deep, what is counted gets long.
void repeat_piece(std::string& text, RandomStream& random) {
  const std::size_t at = below(random, text.size());
  const std::string piece = text.substr(at, 1 + below(random, 8));
  const std::size_t times = std::size_t{1} << random.below(15);
  std::string repeated;
  repeated.reserve(times * piece.size());
  for (std::size_t i = 0; i < times; ++i) repeated += piece;
  text.insert(at, repeated);
}

void mutate(std::string& text, const std::vector<std::string>& seeds, RandomStream& random) {
  const std::size_t at = below(random, text.size());
  const std::size_t length =
      std::min(1 + below(random, 64), text.size() - std::min(at, text.size()));
  switch (text.empty() ? 4 : random.below(17) / 2) {
    case 0:
      text[at] = static_cast<char>(text[at] ^ (1 << random.below(8)));
      break;
    case 1:
      text[at] = static_cast<char>(random.below(256));
      break;
    case 2:
      text.erase(at, length);
      break;
    case 3:
      text.insert(below(random, text.size()), text.substr(at, length));
      break;
    case 4:
      text.insert(at, 1, static_cast<char>(random.below(256)));
      break;
    case 5: {
      const std::string& other = seeds[below(random, seeds.size())];
      text.replace(at, length, other.substr(below(random, other.size()), length));
      break;
    }
    case 6:
      text.resize(at);
      break;
    case 7:
      replace_word(text, random);
      break;
    default:
      repeat_piece(text, random);
      break;
  }
}

const std::filesystem::path kCorpus = GEOPRIOR_SOURCE_DIR "/tests/fuzz/corpus";

}  // namespace

std::string corpus_file(const std::string& name) { return read_whole_file(kCorpus / name); }

std::vector<std::string> corpus(const std::string& extension) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(kCorpus)) {
    if (entry.path().extension() == extension) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> seeds;
  for (const auto& file : files) seeds.push_back(read_whole_file(file));
  return seeds;
}

std::size_t below(RandomStream& random, std::size_t n) {
  return random.below(static_cast<std::uint32_t>(std::max<std::size_t>(n, 1)));
}

std::string mutated(const std::vector<std::string>& seeds, RandomStream& random) {
  std::string text = seeds[below(random, seeds.size())];
  const bool words_only = random.below(2) == 0;
  const std::uint32_t count = 1 + random.below(words_only ? 3 : 6);
  for (std::uint32_t k = 0; k < count; ++k) {
    if (words_only) {
      replace_word(text, random);
    } else {
      mutate(text, seeds, random);
    }
  }
  return text;
}

}  // namespace geoprior::test
