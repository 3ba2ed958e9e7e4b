// SPDX-License-Identifier: Apache-2.0
/// \file
/// What collapses leave of a medial complex.
#pragma once

#include <cstdint>
#include <vector>

#include "axis/complex.hpp"
#include "base/run_together.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {

/// How many elements (of one dimension higher) an element belongs to, and the exclusive or of their indices: which one
/// it is, if there is only one.
struct Cofaces {
    Index count = 0;
    Index combined = 0;

    void add(Index element) {
        ++count;
        combined ^= element;
    }
    void remove(Index element) {
        --count;
        combined ^= element;
    }
};

/// What is left of a complex.
struct Remainder {
    std::vector<Cofaces> faces_at_edge;
    std::vector<Cofaces> edges_at_vertex;
    std::vector<std::uint8_t> has_vertex;
    std::vector<std::uint8_t> has_edge;
    std::vector<std::uint8_t> has_face;

    explicit Remainder(const MedialComplex& complex)
        : faces_at_edge(complex.edges.size()),
          edges_at_vertex(complex.vertices.size()),
          has_vertex(complex.vertices.size(), 1),
          has_edge(complex.edges.size(), 1),
          has_face(complex.faces.size(), 1) {
        run_together(
            [&] {
                for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
                    for (const Index e : complex.face_edges[f]) {
                        faces_at_edge[e].add(f);
                    }
                }
            },
            [&] {
                for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
                    for (const Index v : complex.edges[e]) {
                        edges_at_vertex[v].add(e);
                    }
                }
            });
    }

    /// The only face at an edge, or `kNone` if there are none or several.
    Index only_face(Index edge) const {
        const Cofaces& faces = faces_at_edge[edge];
        return faces.count == 1 ? faces.combined : kNone;
    }

    /// For edges that no face is left at.
    void remove_edge(const MedialComplex& complex, Index edge) {
        has_edge[edge] = 0;
        for (const Index v : complex.edges[edge]) {
            edges_at_vertex[v].remove(edge);
        }
    }
};

/// The part of a complex that a remainder stands for.
inline MedialComplex complex_of(const Remainder& remainder, const MedialComplex& complex) {
    return subcomplex(complex, remainder.has_vertex, remainder.has_edge, remainder.has_face);
}

}  // namespace scaleaxis
