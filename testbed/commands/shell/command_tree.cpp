#include "testbed/commands/shell/command_tree.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <sstream>

namespace geoprior {
namespace {

/// "{obj,ply,glb}", as the check of a choice describes itself, within the type of an option.
std::vector<std::string> choices_of(const std::string& type) {
  const std::size_t open = type.find('{'), close = type.find('}');
  std::vector<std::string> choices;
  if (open == std::string::npos || close == std::string::npos) return choices;
  std::istringstream list(type.substr(open + 1, close - open - 1));
  for (std::string choice; std::getline(list, choice, ',');) choices.push_back(choice);
  return choices;
}

/// What a value is called says what it is.
Offer offer_of(const CommandWord& word) {
  static const std::map<std::string, Offer> kOffers{{"EXPERIMENT", Offer::experiments},
                                                    {"experiment", Offer::experiments},
                                                    {"run", Offer::runs},
                                                    {"before", Offer::runs},
                                                    {"after", Offer::runs},
                                                    {"name", Offer::names},
                                                    {"DIR", Offer::folders},
                                                    {"folder", Offer::folders},
                                                    {"FILE", Offer::files},
                                                    {"file", Offer::files}};
  if (!word.choices.empty()) return Offer::choices;
  const auto known = kOffers.find(word.value);
  if (known != kOffers.end()) return known->second;
  return word.flags.empty() ? Offer::files : Offer::nothing;
}

CommandWord command_word(const CLI::Option& option) {
  CommandWord word;
  for (const std::string& name : option.get_snames()) word.flags.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) word.flags.push_back("--" + name);
  word.description = option.get_description();
  word.required = option.get_required();
  word.repeated = option.get_items_expected_max() > 1;
  const std::string type = option.get_type_name();
  word.choices = choices_of(type);
  if (word.flags.empty()) {
    word.value = option.get_name(true);
  } else if (option.get_items_expected_max() > 0) {
    word.value = type.substr(0, type.find(':'));
    if (!word.choices.empty()) word.value = CLI::detail::join(word.choices, "|");
  }
  word.offer = offer_of(word);
  return word;
}

}  // namespace

CommandTree command_tree(const CLI::App& app) {
  CommandTree tree{app.get_name(), app.get_description(), app.get_footer(), {}, {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    const bool is_argument = option->get_lnames().empty() && option->get_snames().empty();
    (is_argument ? tree.arguments : tree.options).push_back(command_word(*option));
  }
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    tree.commands.push_back(command_tree(*command));
  }
  return tree;
}

}  // namespace geoprior
