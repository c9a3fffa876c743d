#pragma once

#include "testbed/runner/options/values.h"

namespace geoprior {

template <class Derived>
template <class T>
void OptionValues<Derived>::hand_on(Key key, T& x, const OptionInfo& info) {
  static_cast<Derived&>(*this).visit_value(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, double& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, int& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, bool& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, std::string& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, std::vector<double>& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, std::vector<std::string>& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, std::optional<double>& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, std::optional<int>& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, std::optional<std::string>& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, std::array<double, 3>& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

template <class Derived>
void OptionValues<Derived>::value(Key key, std::array<int, 3>& x, const OptionInfo& info) {
  hand_on(key, x, info);
}

}  // namespace geoprior
