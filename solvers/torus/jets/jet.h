#pragma once

#include <Eigen/Core>
#include <array>

namespace geoprior::torus {

/// Four points at a time: one register of the processor.
using Lane = Eigen::Array<double, 4, 1>;

/// Place of the monomial x^(degree - j) y^j among those of a jet, ordered by degree.
constexpr int monomial(int degree, int j) { return degree * (degree + 1) / 2 + j; }

/// Taylor polynomial in two variables, cut after `Order`, at four points: f(x0 + x, y0 + y) =
/// sum of c[monomial(i + j, j)] x^i y^j. Sums and products are exact up to their order.
template <int Order>
struct Jet {
  static constexpr int kCount = monomial(Order + 1, 0);
  std::array<Lane, kCount> c;

  static Jet constant(const Lane& value) {
    Jet jet;
    jet.c.fill(Lane::Zero());
    jet.c[0] = value;
    return jet;
  }
  [[nodiscard]] const Lane& value() const { return c[0]; }
};

template <int Order>
Jet<Order> operator+(Jet<Order> a, const Jet<Order>& b) {
  for (int k = 0; k < Jet<Order>::kCount; ++k) a.c[k] += b.c[k];
  return a;
}

template <int Order>
Jet<Order> operator-(Jet<Order> a, const Jet<Order>& b) {
  for (int k = 0; k < Jet<Order>::kCount; ++k) a.c[k] -= b.c[k];
  return a;
}

template <int Order>
Jet<Order> operator*(double factor, Jet<Order> a) {
  for (Lane& c : a.c) c *= factor;
  return a;
}

template <int Order>
Jet<Order> operator*(const Jet<Order>& a, const Jet<Order>& b) {
  Jet<Order> out;
  for (int k = 0; k < Jet<Order>::kCount; ++k) out.c[k] = a.c[0] * b.c[k];
  for (int p = 1; p <= Order; ++p)
    for (int i = 0; i <= p; ++i) {
      const Lane factor = a.c[monomial(p, i)];
      for (int q = 0; q <= Order - p; ++q)
        for (int j = 0; j <= q; ++j) out.c[monomial(p + q, i + j)] += factor * b.c[monomial(q, j)];
    }
  return out;
}

/// The same polynomial cut after a lower order.
template <int Order, int From>
Jet<Order> cut(const Jet<From>& a) {
  static_assert(Order <= From);
  Jet<Order> out;
  for (int k = 0; k < Jet<Order>::kCount; ++k) out.c[k] = a.c[k];
  return out;
}

/// d/dx, of one order less.
template <int Order>
Jet<Order - 1> derivative_x(const Jet<Order>& a) {
  Jet<Order - 1> out;
  for (int p = 0; p < Order; ++p)
    for (int j = 0; j <= p; ++j) out.c[monomial(p, j)] = (p + 1 - j) * a.c[monomial(p + 1, j)];
  return out;
}

/// d/dy, of one order less.
template <int Order>
Jet<Order - 1> derivative_y(const Jet<Order>& a) {
  Jet<Order - 1> out;
  for (int p = 0; p < Order; ++p)
    for (int j = 0; j <= p; ++j) out.c[monomial(p, j)] = (j + 1) * a.c[monomial(p + 1, j + 1)];
  return out;
}

/// Coefficients of a power series in one variable.
template <int Order>
using Series = std::array<Lane, Order + 1>;

/// sum of series[k] (a - a(x0, y0))^k (Horner).
template <int Order>
Jet<Order> compose(const Series<Order>& series, const Jet<Order>& a) {
  Jet<Order> out = Jet<Order>::constant(series[Order]);
  if constexpr (Order > 0) {
    Jet<Order> rest = a;
    rest.c[0] = Lane::Zero();
    for (int k = Order - 1; k >= 0; --k) {
      out = out * rest;
      out.c[0] += series[k];
    }
  }
  return out;
}

/// Powers of the linear function g_x x + g_y y: weight of each monomial in (g_x x + g_y y)^degree.
template <int Order>
class LinearPowers {
 public:
  explicit LinearPowers(const Eigen::Vector2d& gradient) {
    weights_[0] = 1;
    for (int p = 1; p <= Order; ++p)
      for (int j = 0; j <= p; ++j)
        weights_[monomial(p, j)] = (j < p ? gradient.x() * weights_[monomial(p - 1, j)] : 0) +
                                   (j > 0 ? gradient.y() * weights_[monomial(p - 1, j - 1)] : 0);
  }

  /// sum of series[k] (g_x x + g_y y)^k.
  [[nodiscard]] Jet<Order> compose(const Series<Order>& series) const {
    Jet<Order> out;
    for (int p = 0; p <= Order; ++p)
      for (int j = 0; j <= p; ++j) out.c[monomial(p, j)] = series[p] * weights_[monomial(p, j)];
    return out;
  }

 private:
  std::array<double, Jet<Order>::kCount> weights_;
};

/// a^exponent for a positive a, of which `first` is the value at the centre.
template <int Order>
Jet<Order> power(const Jet<Order>& a, double exponent, const Lane& first) {
  Series<Order> series;
  series[0] = first;
  const Lane inverse = a.value().inverse();
  for (int k = 1; k <= Order; ++k) series[k] = series[k - 1] * inverse * ((exponent - k + 1) / k);
  return compose(series, a);
}

template <int Order>
Jet<Order> inverse(const Jet<Order>& a) {
  return power(a, -1, a.value().inverse());
}

template <int Order>
Jet<Order> sqrt(const Jet<Order>& a) {
  return power(a, 0.5, a.value().sqrt());
}

/// Power series e of the inverse function, about `first`: sum of series[k] (e(d) - first)^k =
/// series[0] + d. Coefficient n of the powers of e - first needs those of e below n alone.
template <int Order>
Series<Order> inverted(const Series<Order>& series, const Lane& first) {
  Series<Order> e;
  e.fill(Lane::Zero());
  e[0] = first;
  if constexpr (Order > 0) {
    const Lane slope = series[1].inverse();
    e[1] = slope;
    for (int n = 2; n <= Order; ++n) {
      Series<Order> power = e;  // (e - first)^k; its own coefficient n is still 0
      Lane sum = Lane::Zero();
      for (int k = 2; k <= n; ++k) {
        Series<Order> next;
        next.fill(Lane::Zero());
        for (int i = k - 1; i < n; ++i)
          for (int j = 1; i + j <= n; ++j) next[i + j] += power[i] * e[j];
        power = next;
        sum += series[k] * power[n];
      }
      e[n] = -slope * sum;
    }
  }
  return e;
}

}  // namespace geoprior::torus
