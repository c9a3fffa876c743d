#pragma once

#include <cstddef>
#include <functional>
#include <optional>

namespace geoprior::test {

/// Calls of malloc and its kin, and so of operator new and of Eigen's arrays, that the calling
/// thread makes while `body` runs. Run it inside `with_threads(1, …)` to see the work of all
/// threads on one. Absent in sanitizer builds, which need malloc for themselves.
std::optional<std::size_t> allocations_of(const std::function<void()>& body);

}  // namespace geoprior::test
