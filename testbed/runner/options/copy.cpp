#include "testbed/runner/options/copy.h"

#include <deque>

namespace geoprior {

namespace {

/// Both walks see the same members in the same order; `exchange_value` is what they do to each.
class Walk : public OptionVisitor {
 public:
  explicit Walk(std::deque<OptionValue>& values) : values_(values) {}

  void choice(std::string_view, int& index, std::span<const std::string_view>,
              const OptionInfo&) override {
    exchange(index);
  }
  void optional_choice(std::string_view, std::optional<int>& index,
                       std::span<const std::string_view>, const OptionInfo&) override {
    exchange(index);
  }
  void group(std::string_view, const OptionInfo&, const std::function<void()>& inside) override {
    inside();
  }
  void optional_group(std::string_view, bool& present, const OptionInfo&,
                      const std::function<void()>& inside) override {
    exchange(present);
    if (present) inside();
  }

 protected:
  virtual void exchange_value(OptionValue& value) = 0;
  void visit_value(std::string_view, const OptionReference& x, const OptionInfo&) final {
    std::visit([&](auto* value) { exchange(*value); }, x);
  }
  template <class T>
  void exchange(T& x) {
    OptionValue value = x;
    exchange_value(value);
    x = std::get<T>(std::move(value));
  }
  std::deque<OptionValue>& values_;
};

class Collect final : public Walk {
 public:
  using Walk::Walk;
  void list(std::string_view, std::size_t count, const OptionInfo&,
            const std::function<void(std::size_t)>&,
            const std::function<void(std::size_t)>& inside) override {
    int elements = static_cast<int>(count);
    exchange(elements);
    for (std::size_t i = 0; i < count; ++i) inside(i);
  }

 private:
  void exchange_value(OptionValue& value) override { values_.push_back(value); }
};

class Assign final : public Walk {
 public:
  Assign(std::deque<OptionValue>& values,
         const std::function<std::string(const std::string&)>& on_text)
      : Walk(values), on_text_(on_text) {}
  void list(std::string_view, std::size_t count, const OptionInfo&,
            const std::function<void(std::size_t)>& resize,
            const std::function<void(std::size_t)>& inside) override {
    int elements = static_cast<int>(count);
    exchange(elements);
    resize(elements);
    for (int i = 0; i < elements; ++i) inside(i);
  }

 private:
  void exchange_value(OptionValue& value) override {
    value = std::move(values_.front());
    values_.pop_front();
    if (auto* text = std::get_if<std::string>(&value)) *text = on_text_(*text);
    if (auto* text = std::get_if<std::optional<std::string>>(&value); text && *text) {
      *text = on_text_(**text);
    }
    if (auto* texts = std::get_if<std::vector<std::string>>(&value)) {
      for (std::string& text : *texts) text = on_text_(text);
    }
  }
  const std::function<std::string(const std::string&)>& on_text_;
};

}  // namespace

void copy_options(const OptionSet& from, OptionSet& to,
                  const std::function<std::string(const std::string&)>& on_text) {
  std::deque<OptionValue> values;
  Collect collect(values);
  // `visit` is not const because readers assign; this visitor puts back what it finds.
  const_cast<OptionSet&>(from).visit(collect);
  Assign assign(values, on_text);
  to.visit(assign);
}

}  // namespace geoprior
