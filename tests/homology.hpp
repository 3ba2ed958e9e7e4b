// SPDX-License-Identifier: Apache-2.0
/// \file
/// Betti numbers by linear algebra over Z/2: slow, and independent of all that the library knows about topology.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::test {

/// A matrix over Z/2: the rows of the ones of every column.
using Columns = std::vector<std::vector<Index>>;

/// Rank by elimination.
inline std::int64_t rank(Columns columns) {
    std::map<Index, std::vector<Index>> reduced;  // by their last row
    for (std::vector<Index>& column : columns) {
        std::sort(column.begin(), column.end());
        while (!column.empty()) {
            const auto [pivot, is_new] = reduced.try_emplace(column.back(), column);
            if (is_new) {
                break;
            }
            std::vector<Index> sum;
            std::set_symmetric_difference(column.begin(), column.end(), pivot->second.begin(), pivot->second.end(),
                                          std::back_inserter(sum));
            column = std::move(sum);
        }
    }
    return static_cast<std::int64_t>(reduced.size());
}

/// Betti numbers of a complex in space. `boundaries[k]` has a column for each element of dimension k + 1: the elements
/// of dimension k that bound it.
inline Topology homology(std::int64_t vertices, const std::vector<Columns>& boundaries) {
    std::array<std::int64_t, 4> count{vertices, 0, 0, 0};
    std::array<std::int64_t, 5> ranks{};
    for (std::size_t k = 0; k < boundaries.size(); ++k) {
        count[k + 1] = static_cast<std::int64_t>(boundaries[k].size());
        ranks[k + 1] = rank(boundaries[k]);
    }
    const auto betti = [&](std::size_t k) { return count[k] - ranks[k] - ranks[k + 1]; };
    return {betti(0), betti(0) - betti(1) + betti(2), betti(1), betti(2)};
}

/// Of a medial complex, from its edges and faces.
inline Topology homology(const MedialComplex& complex) {
    Columns edges;
    for (const auto& [p, q] : complex.edges) {
        edges.push_back({p, q});
    }
    Columns faces;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        faces.emplace_back(complex.face_edges[f].begin(), complex.face_edges[f].end());
    }
    return homology(static_cast<std::int64_t>(complex.vertices.size()), {edges, faces});
}

namespace details {

/// Where all balls have equal power within the affine hull of their centres, if that is in the convex hull of the
/// centres: there the largest of their powers is smallest. Returns this power, else minus infinity.
inline double power_of_their_own(std::span<const Ball> balls) {
    const std::size_t n = balls.size() - 1;
    const Point origin = balls[0].center;
    const auto weight = [](const Ball& b) { return b.radius * b.radius; };
    // Unknowns x: the point is origin + Σ x_i e_i. Equal power: 2 e_i·Σ x_j e_j = e_i·e_i + w_0 - w_i.
    std::array<std::array<double, 4>, 3> rows{};
    for (std::size_t i = 0; i < n; ++i) {
        const Point e = balls[i + 1].center - origin;
        for (std::size_t j = 0; j < n; ++j) {
            rows[i][j] = 2.0 * dot(e, balls[j + 1].center - origin);
        }
        rows[i][3] = squared_norm(e) + weight(balls[0]) - weight(balls[i + 1]);
    }
    for (std::size_t i = 0; i < n; ++i) {  // Gram matrices need no pivoting
        for (std::size_t k = 0; k < n; ++k) {
            if (k != i) {
                const double factor = rows[k][i] / rows[i][i];
                for (std::size_t j = 0; j < 4; ++j) {
                    rows[k][j] -= factor * rows[i][j];
                }
            }
        }
    }
    Point to_center;
    double rest = 1.0;
    for (std::size_t i = 0; i < n; ++i) {
        const double x = rows[i][3] / rows[i][i];
        if (!(x >= 0.0)) {
            return -std::numeric_limits<double>::infinity();
        }
        rest -= x;
        to_center = to_center + x * (balls[i + 1].center - origin);
    }
    return rest >= 0.0 ? squared_norm(to_center) - weight(balls[0]) : -std::numeric_limits<double>::infinity();
}

}  // namespace details

/// Of a union of a few balls in general position, from its nerve: all pairs, triples, quadruples that have a common
/// point. No triangulation is involved.
inline Topology nerve_homology(std::span<const Ball> balls) {
    using Simplex = std::vector<Index>;
    std::map<Simplex, double> values;  // the smallest possible value of the largest power; ≤ 0 where balls meet
    std::vector<Columns> boundaries;
    std::map<Simplex, Index> lower;
    for (Index i = 0; i < static_cast<Index>(balls.size()); ++i) {
        lower.emplace(Simplex{i}, i);
        values[{i}] = -balls[i].radius * balls[i].radius;
    }
    for (int dimension = 1; dimension <= 3; ++dimension) {
        std::map<Simplex, Index> simplices;
        Columns columns;
        for (const auto& entry : lower) {
            for (Index last = entry.first.back() + 1; last < static_cast<Index>(balls.size()); ++last) {
                Simplex simplex = entry.first;
                simplex.push_back(last);
                std::vector<Ball> members;
                for (const Index i : simplex) {
                    members.push_back(balls[i]);
                }
                double value = details::power_of_their_own(members);
                std::vector<Index> column;
                for (std::size_t k = 0; k < simplex.size(); ++k) {
                    Simplex facet = simplex;
                    facet.erase(facet.begin() + static_cast<std::ptrdiff_t>(k));
                    const auto found = lower.find(facet);
                    if (found == lower.end()) {
                        break;
                    }
                    column.push_back(found->second);
                    value = std::max(value, values[facet]);
                }
                if (column.size() == simplex.size() && value <= 0.0) {
                    values[simplex] = value;
                    simplices.emplace(simplex, static_cast<Index>(columns.size()));
                    columns.push_back(column);
                }
            }
        }
        boundaries.push_back(std::move(columns));
        lower = std::move(simplices);
    }
    return homology(static_cast<std::int64_t>(balls.size()), boundaries);
}

}  // namespace scaleaxis::test
