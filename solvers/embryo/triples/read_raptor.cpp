#include <raptor2.h>

#include <algorithm>
#include <memory>

#include "core/error.h"
#include "solvers/embryo/triples/triple_sink.h"

namespace geoprior::embryo {

namespace {

/// Raptor wants a base to resolve IRIs against: those that begin with ours had none.
constexpr std::string_view kNoBase = "no-base:/";

std::string_view view_of(const unsigned char* text, std::size_t size) {
  return {reinterpret_cast<const char*>(text), text == nullptr ? 0 : size};
}

std::string_view view_of(raptor_uri* uri) {
  if (uri == nullptr) return {};
  std::size_t size = 0;
  const unsigned char* text = raptor_uri_as_counted_string(uri, &size);
  return view_of(text, size);
}

/// What raptor calls back.
class RaptorInput {
 public:
  RaptorInput(TripleSink& sink, const std::string& blank_prefix)
      : sink_(sink), blank_prefix_(blank_prefix) {}

  void set_parser(raptor_parser* parser) { parser_ = parser; }

  static void add_statement(void* self, raptor_statement* statement) {
    auto& input = *static_cast<RaptorInput*>(self);
    input.attempt([&] {
      const int line = input.line();
      const Term s = input.term(statement->subject, line);
      const Term p = input.term(statement->predicate, line);
      input.sink_.add(s, p, input.term(statement->object, line), line);
    });
  }

  static void report(void* self, raptor_log_message* message) {
    auto& input = *static_cast<RaptorInput*>(self);
    if (message->level < RAPTOR_LOG_LEVEL_ERROR) return;
    const int reported = message->locator == nullptr ? 0 : message->locator->line;
    const int line = reported > 0 ? reported : input.line();
    input.attempt(
        [&] { input.sink_.refuse("malformed: " + std::string(message->text), std::max(line, 1)); });
  }

  [[nodiscard]] int line() const {
    raptor_locator* locator = raptor_parser_get_locator(parser_);
    return locator == nullptr ? 0 : std::max(locator->line, 0);
  }

 private:
  template <class Action>
  void attempt(Action action) {
    if (!sink_.keep_error(action) && parser_ != nullptr) raptor_parser_parse_abort(parser_);
  }

  Term term(const raptor_term* term, int line) {
    if (term->type == RAPTOR_TERM_TYPE_BLANK) {
      const std::string_view label =
          view_of(term->value.blank.string, term->value.blank.string_len);
      return sink_.blank(blank_prefix_ + std::string(label), line);
    }
    if (term->type == RAPTOR_TERM_TYPE_LITERAL) {
      const raptor_term_literal_value& value = term->value.literal;
      return sink_.literal(view_of(value.string, value.string_len), whole(value.datatype, line),
                           view_of(value.language, value.language_len), line);
    }
    return sink_.iri(whole(term->value.uri, line), line);
  }

  [[nodiscard]] std::string_view whole(raptor_uri* uri, int line) const {
    const std::string_view iri = view_of(uri);
    if (iri.starts_with(kNoBase))
      sink_.refuse("the relative IRI <" + std::string(iri.substr(kNoBase.size())) + ">", line,
                   "whole IRIs, or an xml:base");
    return iri;
  }

  TripleSink& sink_;
  const std::string& blank_prefix_;
  raptor_parser* parser_ = nullptr;
};

}  // namespace

void read_by_raptor(TripleSink& sink, std::string_view bytes, const std::string& blank_prefix) {
  const std::unique_ptr<raptor_world, decltype(&raptor_free_world)> world(raptor_new_world(),
                                                                          raptor_free_world);
  RaptorInput input(sink, blank_prefix);
  raptor_world_set_log_handler(world.get(), &input, RaptorInput::report);
  const std::unique_ptr<raptor_uri, decltype(&raptor_free_uri)> base(
      raptor_new_uri(world.get(), reinterpret_cast<const unsigned char*>(kNoBase.data())),
      raptor_free_uri);
  const std::unique_ptr<raptor_parser, decltype(&raptor_free_parser)> parser(
      raptor_new_parser(world.get(), "rdfxml"), raptor_free_parser);
  if (!parser || !base) throw Error("raptor has no reader of RDF/XML");
  for (const raptor_option option : {RAPTOR_OPTION_NO_NET, RAPTOR_OPTION_NO_FILE})
    raptor_parser_set_option(parser.get(), option, nullptr, 1);
  raptor_parser_set_option(parser.get(), RAPTOR_OPTION_LOAD_EXTERNAL_ENTITIES, nullptr, 0);
  raptor_parser_set_statement_handler(parser.get(), &input, RaptorInput::add_statement);
  input.set_parser(parser.get());
  int status = raptor_parser_parse_start(parser.get(), base.get());
  if (status == 0)
    status = raptor_parser_parse_chunk(
        parser.get(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), 1);
  if (status != 0) sink.keep_error([&] { sink.refuse("malformed RDF/XML", input.line()); });
}

}  // namespace geoprior::embryo
