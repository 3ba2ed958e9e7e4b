// SPDX-License-Identifier: Apache-2.0
/// \file
/// Topological invariants of solids and complexes in three-dimensional space.
#pragma once

#include <cstdint>
#include <optional>

namespace scaleaxis::inline v1 {

/// Betti numbers and the Euler characteristic: `euler = components - tunnels + voids`.
struct Topology {
    std::int64_t components = 0;          ///< b0: connected components
    std::int64_t euler = 0;               ///< Euler characteristic
    std::optional<std::int64_t> tunnels;  ///< b1: independent handles; unset where not computed
    std::optional<std::int64_t> voids;    ///< b2: enclosed cavities; unset where not computed

    friend bool operator==(const Topology&, const Topology&) = default;
};

/// Do two descriptions agree in all that both of them know?
inline bool agree(const Topology& a, const Topology& b) {
    const auto compatible = [](const auto& x, const auto& y) { return !x || !y || *x == *y; };
    return a.components == b.components && a.euler == b.euler && compatible(a.tunnels, b.tunnels) &&
           compatible(a.voids, b.voids);
}

}  // namespace scaleaxis::inline v1
