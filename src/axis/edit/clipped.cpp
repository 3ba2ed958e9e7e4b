// SPDX-License-Identifier: Apache-2.0
#include "axis/edit/clipped.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "axis/edit/halving.hpp"
#include "axis/edit/remainder.hpp"

namespace scaleaxis::inline v1 {

MedialComplex clipped(const MedialComplex& complex, std::span<const double> values) {
    Halving cuts{std::vector<std::uint8_t>(complex.edges.size(), 0), std::vector<double>(complex.edges.size(), 0.0),
                 std::vector<double>(complex.edges.size(), 0.0)};
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        const auto& [a, b] = complex.edges[e];
        if (std::min(values[a], values[b]) < 0.0 && std::max(values[a], values[b]) > 0.0) {
            cuts.is_halved[e] = 1;
            cuts.parts[e] = values[a] / (values[a] - values[b]);
            cuts.radii[e] = complex.radii[a] + cuts.parts[e] * (complex.radii[b] - complex.radii[a]);
        }
    }
    const MedialComplex cut = halved(complex, cuts);
    const auto is_beyond = [&](Index v) { return v < static_cast<Index>(values.size()) && values[v] < 0.0; };
    Remainder rest(cut);
    for (Index f = 0; f < static_cast<Index>(cut.faces.size()); ++f) {
        if (std::ranges::any_of(cut.faces[f], is_beyond)) {
            rest.remove_face(cut, f);
        }
    }
    for (Index e = 0; e < static_cast<Index>(cut.edges.size()); ++e) {
        if (std::ranges::any_of(cut.edges[e], is_beyond)) {
            rest.remove_edge(cut, e);
        }
    }
    for (Index v = 0; v < static_cast<Index>(cut.vertices.size()); ++v) {
        if (is_beyond(v)) {
            rest.has_vertex[v] = 0;
        }
    }
    return complex_of(rest, cut);
}

}  // namespace scaleaxis::inline v1
