// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/collapse.hpp"
#include "base/disjoint_sets.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Above this size the elimination below is not tried, and the number of voids stays unknown.
constexpr std::size_t kMaxElimination = 3000;

// What is left of a complex without its free faces. Without a face left there is no void.
Remainder without_free_faces(const MedialComplex& complex) {
    return after_collapses(complex, [](const ElementaryCollapse& collapse) { return collapse.has_face; });
}

std::vector<Index> faces_of(const Remainder& left) {
    return indices_where(left.has_face.size(), [&](Index f) { return left.has_face[f] != 0; });
}

// The part without a seam inside that each of the remaining faces belongs to, as one of its faces.
DisjointSets parts_of(const MedialComplex& complex, const Remainder& left, std::span<const Index> faces) {
    DisjointSets parts(complex.faces.size());
    std::vector<Index> first_face_at_edge(complex.edges.size(), kNone);
    for (const Index f : faces) {
        for (const Index e : complex.face_edges[f]) {
            if (left.faces_at_edge[e].count == 2) {
                Index& first = first_face_at_edge[e];
                if (first == kNone) {
                    first = f;
                } else {
                    parts.join(first, f);
                }
            }
        }
    }
    return parts;
}

// A row of a matrix over Z/2: the columns that hold a one, ascending.
using Row = std::vector<Index>;

Row sum(const Row& a, const Row& b) {
    Row result;
    std::ranges::set_symmetric_difference(a, b, std::back_inserter(result));
    return result;
}

std::size_t rank(const std::vector<Row>& matrix) {
    std::map<Index, Row> pivots;  // by their first column
    for (Row row : matrix) {
        while (!row.empty()) {
            const auto [pivot, is_new] = pivots.try_emplace(row.front(), row);
            if (is_new) {
                break;
            }
            row = sum(row, pivot->second);
        }
    }
    return pivots.size();
}

// One equation for every seam: of the parts that meet there, those that do so an odd number of times. Many seams give
// the same one.
std::vector<Row> seam_equations(const MedialComplex& complex, const Remainder& left, std::span<const Index> faces,
                                const std::vector<Index>& unknown_of_face) {
    std::map<Index, Row> equation_of_edge;
    for (const Index f : faces) {
        for (const Index e : complex.face_edges[f]) {
            if (left.faces_at_edge[e].count > 2) {
                Row& equation = equation_of_edge[e];
                equation = sum(equation, {unknown_of_face[f]});
            }
        }
    }
    std::vector<Row> equations;
    for (auto& [edge, equation] : equation_of_edge) {
        equations.push_back(std::move(equation));
    }
    sort_unique(equations);
    return equations;
}

// Dimension of the space of 2-cycles over Z/2 of what is left: unknowns are the parts without a seam inside (a cycle
// holds all faces of a part or none), equations are the seams.
std::optional<std::int64_t> count_voids(const MedialComplex& complex) {
    const Remainder left = without_free_faces(complex);
    const std::vector<Index> faces = faces_of(left);
    if (faces.empty()) {
        return 0;
    }
    DisjointSets parts = parts_of(complex, left, faces);
    std::vector<Index> unknown_of_face(complex.faces.size(), kNone);
    Index unknowns = 0;
    for (const Index f : faces) {
        // A set's representative is its smallest face, so it has its number before the others ask for it.
        const Index first = parts.find(f);
        unknown_of_face[f] = first == f ? unknowns++ : unknown_of_face[first];
    }
    if (static_cast<std::size_t>(unknowns) > kMaxElimination) {
        return std::nullopt;
    }
    const std::size_t equations = rank(seam_equations(complex, left, faces, unknown_of_face));
    return static_cast<std::int64_t>(unknowns) - static_cast<std::int64_t>(equations);
}

std::int64_t count_components(const MedialComplex& complex) {
    DisjointSets components(complex.vertices.size());
    auto count = static_cast<std::int64_t>(complex.vertices.size());
    for (const auto& [p, q] : complex.edges) {
        count -= components.join(p, q) ? 1 : 0;
    }
    return count;
}

}  // namespace

Topology topology_of(const MedialComplex& complex) {
    Topology result;
    run_together([&] { result.voids = count_voids(complex); }, [&] { result.components = count_components(complex); });
    result.euler = static_cast<std::int64_t>(complex.vertices.size()) -
                   static_cast<std::int64_t>(complex.edges.size()) + static_cast<std::int64_t>(complex.faces.size());
    if (result.voids) {
        result.tunnels = result.components + *result.voids - result.euler;
    }
    return result;
}

Topology topology(const MedialComplex& complex) {
    check(complex);
    return topology_of(complex);
}

}  // namespace scaleaxis::inline v1
