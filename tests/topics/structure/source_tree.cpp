#include "tests/topics/structure/source_tree.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace geoprior::test::structure {
namespace {

namespace fs = std::filesystem;

constexpr std::array kRooms{"core",    "metrics",     "models", "baselines",  "solvers",
                            "testbed", "experiments", "tests",  "benchmarks", "examples"};

std::string text_of_file(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> includes_of(const std::string& text) {
  static const std::regex include("^#include \"([^\"]+)\"");
  std::vector<std::string> includes;
  std::istringstream in(text);
  std::smatch found;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("#include") && std::regex_search(line, found, include)) {
      includes.push_back(found[1]);
    }
  }
  return includes;
}

/// `geoprior_topic(sound USES paper DEPS …)`: sound uses paper. A word in capitals ends the list.
std::map<std::string, std::set<std::string>> read_uses(const std::string& cmake) {
  static const std::regex topic(R"((?:^|\n)geoprior_topic\((\w+)([^)]*)\))");
  std::map<std::string, std::set<std::string>> uses;
  for (std::sregex_iterator it(cmake.begin(), cmake.end(), topic), end; it != end; ++it) {
    std::set<std::string>& used = uses[it->str(1)];
    std::istringstream words(it->str(2));
    bool listed = false;
    for (std::string word; words >> word;) {
      const bool is_keyword = word.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_") == word.npos;
      if (is_keyword) listed = word == "USES";
      if (!is_keyword && listed) used.insert(word);
    }
  }
  return uses;
}

}  // namespace

std::map<std::string, std::set<std::string>> uses_of_topics(const fs::path& root) {
  return read_uses(text_of_file(root / "CMakeLists.txt"));
}

SourceTree read_source_tree(const fs::path& root) {
  SourceTree tree;
  for (const char* room : kRooms) {
    if (!fs::exists(root / room)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / room)) {
      const std::string extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      const std::string path = entry.path().lexically_relative(root).generic_string();
      std::string text = text_of_file(entry.path());
      std::vector<std::string> includes = includes_of(text);
      tree.files.push_back({path, std::move(text), std::move(includes)});
      if (extension == ".h") tree.headers.insert(path);
    }
  }
  std::sort(tree.files.begin(), tree.files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  tree.uses = uses_of_topics(root);
  return tree;
}

std::string unit_of(const std::string& path) { return path.substr(0, path.rfind('.')); }

std::vector<std::string> path_parts(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream in(path);
  for (std::string part; std::getline(in, part, '/');) parts.push_back(part);
  return parts;
}

}  // namespace geoprior::test::structure
