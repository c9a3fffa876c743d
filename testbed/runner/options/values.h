#pragma once

#include "core/options.h"

namespace geoprior {

/// Hands every overload of `value` to one template of `Derived`:
///
///   template <class T> void visit_value(std::string_view key, T& x, const OptionInfo& info);
///
/// A .cpp that includes option_values_definition.h, defines `visit_value` and then says
/// `template class OptionValues<Derived>;` keeps to itself what is done to each type; the header of
/// `Derived` says `extern template class OptionValues<Derived>;`.
template <class Derived>
class OptionValues : public OptionVisitor {
 public:
  using Key = std::string_view;
  void value(Key key, double& x, const OptionInfo& info) final;
  void value(Key key, int& x, const OptionInfo& info) final;
  void value(Key key, bool& x, const OptionInfo& info) final;
  void value(Key key, std::string& x, const OptionInfo& info) final;
  void value(Key key, std::vector<double>& x, const OptionInfo& info) final;
  void value(Key key, std::vector<std::string>& x, const OptionInfo& info) final;
  void value(Key key, std::optional<double>& x, const OptionInfo& info) final;
  void value(Key key, std::optional<int>& x, const OptionInfo& info) final;
  void value(Key key, std::optional<std::string>& x, const OptionInfo& info) final;
  void value(Key key, std::array<double, 3>& x, const OptionInfo& info) final;
  void value(Key key, std::array<int, 3>& x, const OptionInfo& info) final;

 private:
  template <class T>
  void hand_on(Key key, T& x, const OptionInfo& info);
};

}  // namespace geoprior
