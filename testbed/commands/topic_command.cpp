#include <nlohmann/json.hpp>

#include "testbed/commands/commands.h"
#include "testbed/commands/console.h"
#include "testbed/runner/options/toml.h"

namespace geoprior {
namespace {

/// The value of a flag: a text is a text whatever it holds, anything else is TOML.
TomlNode flag_value(const OptionRow& row, const std::string& written) {
  if (!row.is_text()) return parse_toml_value(written, "option " + row.key);
  TomlNode node;
  node.kind = TomlNode::Kind::text;
  node.text = written;
  node.place = "option " + row.key;
  return node;
}

std::unique_ptr<OptionSet> read_flags(const TopicCommandRequest& request) {
  const TopicCommand& command = *request.command;
  const auto listed = command.default_options();
  TomlNode table;
  table.place = "command line";
  for (const OptionRow& row : list_options([&](OptionVisitor& v) { listed->visit(v); })) {
    const std::string& written = request.options.at(row.key);
    if (!written.empty()) table.set(row.key, flag_value(row, written));
  }
  auto options = command.default_options();
  OptionTomlReader reader(table, "");
  options->visit(reader);
  reader.finish();
  return options;
}

}  // namespace

int topic_command(const CommandContext& context, const TopicCommandRequest& request) {
  const CommandText result = request.command->run(request.input, *read_flags(request));
  for (const std::string& notice : result.notices) say("warning: " + notice);
  if (context.json) {
    print_json({{"text", result.text}, {"notices", result.notices}});
  } else {
    print_out(result.text);
  }
  return result.fell_short ? fell_short : done;
}

}  // namespace geoprior
