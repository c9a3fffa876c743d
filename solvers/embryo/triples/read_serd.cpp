#include <serd/serd.h>

#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <memory>

#include "core/error.h"
#include "solvers/embryo/triples/triple_sink.h"

namespace geoprior::embryo {

namespace {

std::string_view view_of(const SerdNode* node) {
  return {reinterpret_cast<const char*>(node->buf), node->n_bytes};
}

std::string_view view_of(const SerdChunk& chunk) {
  return {reinterpret_cast<const char*>(chunk.buf), chunk.len};
}

bool is_given(const SerdNode* node) { return node != nullptr && node->type != SERD_NOTHING; }

/// What serd calls back. It is given one byte at a time: it looks one byte ahead, so that the line
/// of the byte that it was given last is the line it is on.
class SerdInput {
 public:
  SerdInput(TripleSink& sink, std::string_view bytes)
      : sink_(sink), bytes_(bytes), env_(serd_env_new(nullptr), serd_env_free) {}

  static std::size_t read(void* buffer, std::size_t, std::size_t, void* self) {
    auto& input = *static_cast<SerdInput*>(self);
    if (input.next_ == input.bytes_.size() || input.sink_.failed()) return 0;
    if (input.next_ > 0 && input.bytes_[input.next_ - 1] == '\n') ++input.line_;
    *static_cast<char*>(buffer) = input.bytes_[input.next_++];
    return 1;
  }

  static int has_failed(void*) { return 0; }

  static SerdStatus set_base(void* self, const SerdNode* uri) {
    auto& input = *static_cast<SerdInput*>(self);
    return input.status([&] {
      input.iri(uri);
      serd_env_set_base_uri(input.env_.get(), uri);
    });
  }

  static SerdStatus set_prefix(void* self, const SerdNode* name, const SerdNode* uri) {
    auto& input = *static_cast<SerdInput*>(self);
    return input.status([&] {
      const std::string expanded(input.iri(uri));
      const SerdNode node =
          serd_node_from_string(SERD_URI, reinterpret_cast<const uint8_t*>(expanded.c_str()));
      serd_env_set_prefix(input.env_.get(), name, &node);
    });
  }

  static SerdStatus add_statement(void* self, SerdStatementFlags, const SerdNode*,
                                  const SerdNode* subject, const SerdNode* predicate,
                                  const SerdNode* object, const SerdNode* datatype,
                                  const SerdNode* language) {
    auto& input = *static_cast<SerdInput*>(self);
    return input.status([&] {
      const Term s = input.term(subject);
      const Term p = input.term(predicate);
      const Term o = object->type == SERD_LITERAL ? input.literal(object, datatype, language)
                                                  : input.term(object);
      input.sink_.add(s, p, o, input.line_);
    });
  }

  static SerdStatus report(void* self, const SerdError* error) {
    auto& input = *static_cast<SerdInput*>(self);
    char text[256];
    va_list arguments;
    va_copy(arguments, *error->args);
    std::vsnprintf(text, sizeof text, error->fmt, arguments);
    va_end(arguments);
    std::string problem(text);
    while (!problem.empty() && (problem.back() == '\n' || problem.back() == '.'))
      problem.pop_back();
    input.status([&] { input.sink_.refuse("malformed: " + problem, input.line_); });
    return SERD_SUCCESS;
  }

  [[nodiscard]] int line() const { return line_; }

 private:
  template <class Action>
  SerdStatus status(Action action) {
    return sink_.keep_error(action) ? SERD_SUCCESS : SERD_ERR_INTERNAL;
  }

  /// Valid until the next call.
  std::string_view iri(const SerdNode* node) {
    if (node->type == SERD_CURIE) {
      SerdChunk prefix{}, suffix{};
      if (serd_env_expand(env_.get(), node, &prefix, &suffix) != SERD_SUCCESS)
        sink_.refuse("the prefix of '" + std::string(view_of(node)) + "' is not declared", line_);
      return expanded_.assign(view_of(prefix)).append(view_of(suffix));
    }
    if (serd_uri_string_has_scheme(node->buf)) return view_of(node);
    SerdNode resolved = serd_env_expand_node(env_.get(), node);
    expanded_.clear();
    if (resolved.buf != nullptr) expanded_ = view_of(&resolved);
    serd_node_free(&resolved);
    if (!serd_uri_string_has_scheme(reinterpret_cast<const uint8_t*>(expanded_.c_str())))
      sink_.refuse("the relative IRI <" + std::string(view_of(node)) + ">", line_,
                   "whole IRIs, or a @base");
    return expanded_;
  }

  Term term(const SerdNode* node) {
    if (node->type == SERD_BLANK) return sink_.blank(view_of(node), line_);
    return sink_.iri(iri(node), line_);
  }

  Term literal(const SerdNode* node, const SerdNode* datatype, const SerdNode* language) {
    return sink_.literal(view_of(node), is_given(datatype) ? iri(datatype) : std::string_view(),
                         is_given(language) ? view_of(language) : std::string_view(), line_);
  }

  TripleSink& sink_;
  std::string_view bytes_;
  std::unique_ptr<SerdEnv, decltype(&serd_env_free)> env_;
  std::size_t next_ = 0;
  int line_ = 1;
  std::string expanded_;
};

}  // namespace

void read_by_serd(TripleSink& sink, std::string_view bytes, bool turtle,
                  const std::string& blank_prefix) {
  SerdInput input(sink, bytes);
  const std::unique_ptr<SerdReader, decltype(&serd_reader_free)> reader(
      serd_reader_new(turtle ? SERD_TURTLE : SERD_NTRIPLES, &input, nullptr, SerdInput::set_base,
                      SerdInput::set_prefix, SerdInput::add_statement, nullptr),
      serd_reader_free);
  serd_reader_set_strict(reader.get(), true);
  serd_reader_set_error_sink(reader.get(), SerdInput::report, &input);
  if (!blank_prefix.empty())
    serd_reader_add_blank_prefix(reader.get(),
                                 reinterpret_cast<const uint8_t*>(blank_prefix.c_str()));
  constexpr std::size_t kOneByte = 1;
  const SerdStatus status =
      serd_reader_read_source(reader.get(), SerdInput::read, SerdInput::has_failed, &input,
                              reinterpret_cast<const uint8_t*>("text"), kOneByte);
  if (status > SERD_FAILURE) {
    sink.keep_error([&] {
      const auto* text = reinterpret_cast<const char*>(serd_strerror(status));
      sink.refuse(std::string("malformed: ") + text, input.line());
    });
  }
}

}  // namespace geoprior::embryo
