#include "solvers/embryo/queries/rows.h"

#include <algorithm>
#include <array>

#include "core/error.h"

namespace geoprior::embryo {
namespace {

using Row = std::vector<std::string>;

constexpr std::array<std::string_view, 2> kExisting = {"structure", "stage"};
constexpr std::array<std::string_view, 4> kKeyFrames = {"key", "stage", "order", "primitive"};
constexpr std::array<std::string_view, 1> kParts = {"part"};
constexpr std::array<std::string_view, 1> kProgenitors = {"progenitor"};
constexpr std::array<std::string_view, 2> kRunning = {"process", "kind"};
constexpr std::array<std::string_view, 5> kNumbers = {"node", "property", "value", "unit",
                                                      "source"};
constexpr std::array<std::string_view, 2> kIncomplete = {"structure", "missing"};
constexpr std::array<std::string_view, 6> kBundle = {"structure", "key",      "stage",
                                                     "primitive", "property", "value"};

std::string_view text_of(Missing missing) {
  constexpr std::array<std::string_view, 3> kTexts = {"first stage", "last stage", "geometry"};
  return kTexts[static_cast<int>(missing)];
}

class RowWriter {
 public:
  explicit RowWriter(const Graph& graph) : terms_(graph.dictionary()) {}
  template <class... T>
  void add(T... term) {
    rows.push_back({text(term)...});
  }
  std::vector<Row> rows;

 private:
  [[nodiscard]] std::string text(Term term) const {
    if (term < 0) return {};
    if (terms_.kind(term) == Dictionary::Kind::blank) return "_:" + terms_.text(term);
    return terms_.text(term);
  }
  static std::string text(const std::string& given) { return given; }

  const Dictionary& terms_;
};

void add_bundle(const FrameBundle& bundle, RowWriter& out) {
  for (const FrameBundle::Entry& entry : bundle.entries) {
    const KeyFrame& f = entry.frame;
    for (int i = entry.first_value; i < entry.last_value; ++i)
      out.add(f.structure, f.key, f.stage, f.primitive, bundle.values[i].property,
              bundle.values[i].value);
  }
}

[[noreturn]] void refuse(int query) {
  throw Error("there is no query " + std::to_string(query), "viewer's queries", "1 to 8");
}

}  // namespace

std::span<const std::string_view> query_columns(int query) {
  switch (query) {
    case 1:
      return kExisting;
    case 2:
      return kKeyFrames;
    case 3:
      return kParts;
    case 4:
      return kProgenitors;
    case 5:
      return kRunning;
    case 6:
      return kNumbers;
    case 7:
      return kIncomplete;
    case 8:
      return kBundle;
    default:
      refuse(query);
  }
}

std::vector<std::vector<std::string>> query_rows(const ViewerQueries& queries, int query,
                                                 const ViewerQuestion& question) {
  RowWriter out(queries.graph());
  const auto named = [&](const std::string& local) {
    return queries.graph().dictionary().find_local(local).value_or(-1);
  };
  switch (query) {
    case 1:
      for (const auto& row : queries.existing(question.day)) out.add(row.structure, row.stage);
      break;
    case 2:
      for (const auto& row : queries.key_frames(named(question.structure)))
        out.add(row.key, row.stage, std::to_string(row.order), row.primitive);
      break;
    case 3:
      for (const Term part : queries.parts(named(question.system))) out.add(part);
      break;
    case 4:
      for (const Term one : queries.progenitors(named(question.structure))) out.add(one);
      break;
    case 5:
      for (const auto& row : queries.running(question.day)) out.add(row.process, row.kind);
      break;
    case 6:
      for (const auto& row : queries.numbers())
        out.add(row.node, row.property, row.value, row.unit, row.source);
      break;
    case 7:
      for (const auto& row : queries.incomplete())
        out.add(row.structure, std::string(text_of(row.missing)));
      break;
    case 8:
      add_bundle(queries.bundle(question.day), out);
      break;
    default:
      refuse(query);
  }
  std::sort(out.rows.begin(), out.rows.end());
  return std::move(out.rows);
}

}  // namespace geoprior::embryo
