#include "testbed/formats/hdf5/content.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "core/error.h"
#include "core/state_bytes.h"

namespace geoprior {

namespace {

/// Writes and reads content as bytes: each kind of value by an overload of `put` and of `get`.
class Packer {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void put(T x) { out_.number(x); }
  void put(const std::string& text) { out_.text(text); }
  void put(const std::array<double, 3>& x) { out_.number(x); }
  template <class T>
  void put(const std::vector<T>& list) {
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::array<double, 3>>) {
      out_.items(list);
    } else {
      out_.number(list.size());
      for (const T& item : list) put(item);
    }
  }
  template <class T>
  void put(const std::map<std::string, T>& map) {
    out_.number(map.size());
    for (const auto& [key, value] : map) {
      put(key);
      put(value);
    }
  }
  template <class... T>
  void put(const std::variant<T...>& values) {
    out_.number(values.index());
    std::visit([this](const auto& of_type) { put(of_type); }, values);
  }
  void put(const H5Column& column) {
    put(column.name);
    put(column.values);
  }
  void put(const H5Data& data) {
    put(data.extents);
    put(data.values);
    put(data.attributes);
  }
  void put(const H5Content& content) {
    put(content.attributes);
    put(content.data);
    put(content.groups);
  }
  [[nodiscard]] State take() const { return out_.take(); }

 private:
  StateWriter out_;
};

class Unpacker {
 public:
  explicit Unpacker(const State& bytes) : in_(bytes) {}

  template <class T>
  requires std::is_arithmetic_v<T>
  void get(T& x) { x = in_.number<T>(); }
  void get(std::string& text) { text = in_.text(); }
  template <class T>
  void get(std::vector<T>& list) {
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::array<double, 3>>) {
      in_.items(list);
    } else {
      list.resize(in_.count());
      for (T& item : list) get(item);
    }
  }
  template <class T>
  void get(std::map<std::string, T>& map) {
    for (std::size_t n = in_.count(); n > 0; --n) {
      std::string key;
      get(key);
      get(map[key]);
    }
  }
  template <class... T>
  void get(std::variant<T...>& values) {
    const auto index = in_.number<std::size_t>();
    std::size_t i = 0;
    const auto take = [&]<class One>(One one) {
      if (i++ != index) return;
      get(one);
      values = std::move(one);
    };
    (take(T{}), ...);
  }
  void get(H5Column& column) {
    get(column.name);
    get(column.values);
  }
  void get(H5Data& data) {
    get(data.extents);
    get(data.values);
    get(data.attributes);
  }
  void get(H5Content& content) {
    get(content.attributes);
    get(content.data);
    get(content.groups);
  }

 private:
  StateReader in_;
};

template <class Map>
std::vector<std::string> keys(const Map& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

}  // namespace

State bytes_of(const H5Content& content) {
  Packer packer;
  packer.put(content);
  return packer.take();
}

H5Content content_of(const State& bytes) {
  H5Content content;
  Unpacker(bytes).get(content);
  return content;
}

std::string H5Node::at(std::string_view name) const {
  return place_ + (place_.ends_with('/') ? "" : "/") + std::string(name);
}

H5Node H5Node::open_group(std::string_view name) const {
  const auto found = content_->groups.find(std::string(name));
  if (found == content_->groups.end()) throw Error("group is missing", at(name));
  return {std::shared_ptr<const H5Content>(content_, &found->second), at(name)};
}

bool H5Node::has(std::string_view name) const {
  const std::string key(name);
  return content_->groups.contains(key) || content_->data.contains(key);
}

std::vector<std::string> H5Node::children() const {
  std::vector<std::string> names = keys(content_->groups);
  for (std::string& name : keys(content_->data)) names.push_back(std::move(name));
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> H5Node::attributes() const { return keys(content_->attributes); }

const H5Attribute& H5Node::attribute(std::string_view name) const {
  const auto found = content_->attributes.find(std::string(name));
  if (found == content_->attributes.end()) throw Error("attribute is missing", at(name));
  return found->second;
}

const H5Data& H5Node::data(std::string_view name) const {
  const auto found = content_->data.find(std::string(name));
  if (found == content_->data.end()) throw Error("data set is missing", at(name));
  return found->second;
}

std::vector<std::string> H5Node::read_texts(std::string_view name) const {
  const auto* texts = std::get_if<std::vector<std::string>>(&attribute(name));
  if (texts == nullptr) throw Error("attribute is no text", at(name));
  return *texts;
}

std::string H5Node::read_text(std::string_view name) const {
  std::vector<std::string> texts = read_texts(name);
  if (texts.size() != 1) throw Error("attribute is no single text", at(name));
  return std::move(texts.front());
}

template <class T>
T H5Node::number(std::string_view name) const {
  const auto* value = std::get_if<T>(&attribute(name));
  if (value == nullptr) throw Error("attribute is no single number of its type", at(name));
  return *value;
}

double H5Node::read_double(std::string_view name) const { return number<double>(name); }
std::int64_t H5Node::read_int(std::string_view name) const { return number<std::int64_t>(name); }
std::uint64_t H5Node::read_unsigned(std::string_view name) const {
  return number<std::uint64_t>(name);
}

H5Array H5Node::read_array(std::string_view name) const {
  const H5Data& of = data(name);
  const auto* values = std::get_if<std::vector<double>>(&of.values);
  if (values == nullptr) throw Error("is no data set of float64", at(name));
  H5Array array{of.extents, *values, {}};
  for (const auto& [key, value] : of.attributes) {
    const auto* texts = std::get_if<std::vector<std::string>>(&value);
    if (texts == nullptr || texts->size() != 1) {
      throw Error("attribute is no single text", at(name) + "@" + key);
    }
    array.attributes[key] = texts->front();
  }
  return array;
}

template <class T>
H5Block<T> H5Node::read_block(std::string_view name, std::size_t rank) const {
  const H5Data& of = data(name);
  const auto* values = std::get_if<std::vector<T>>(&of.values);
  if (values == nullptr) throw Error("is a data set of another type", at(name));
  if (of.extents.size() != rank) {
    throw Error("has " + std::to_string(of.extents.size()) + " extents", at(name),
                std::to_string(rank));
  }
  return {of.extents, *values};
}

template H5Block<float> H5Node::read_block(std::string_view, std::size_t) const;
template H5Block<double> H5Node::read_block(std::string_view, std::size_t) const;
template H5Block<std::int32_t> H5Node::read_block(std::string_view, std::size_t) const;
template H5Block<std::int64_t> H5Node::read_block(std::string_view, std::size_t) const;

const std::vector<H5Column>& H5Node::read_table(std::string_view name) const {
  const auto* table = std::get_if<std::vector<H5Column>>(&data(name).values);
  if (table == nullptr) throw Error("is no table", at(name));
  return *table;
}

void H5Node::read_table(std::string_view name, std::vector<H5Column>& columns) const {
  const std::vector<H5Column>& table = read_table(name);
  for (H5Column& wanted : columns) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const H5Column& column) {
      return column.name == wanted.name;
    });
    if (found == table.end()) throw Error("table has no column '" + wanted.name + "'", at(name));
    if (found->values.index() != wanted.values.index()) {
      throw Error("column '" + wanted.name + "' has another type", at(name));
    }
    wanted.values = found->values;
  }
}

}  // namespace geoprior
