// SPDX-License-Identifier: Apache-2.0
/// \file
/// What collapses leave of a medial complex.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis::inline v1 {

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

    explicit Remainder(const MedialComplex& complex);

    /// The only face at an edge, or `kNone` if there are none or several.
    Index only_face(Index edge) const {
        const Cofaces& faces = faces_at_edge[edge];
        return faces.count == 1 ? faces.combined : kNone;
    }

    /// The only edge at a vertex if it has no faces, else `kNone`.
    Index only_bare_edge(Index vertex) const {
        const Cofaces& edges = edges_at_vertex[vertex];
        return edges.count == 1 && faces_at_edge[edges.combined].count == 0 ? edges.combined : kNone;
    }

    void remove_face(const MedialComplex& complex, Index face) {
        has_face[face] = 0;
        for (const Index e : complex.face_edges[face]) {
            faces_at_edge[e].remove(face);
        }
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
MedialComplex complex_of(const Remainder& remainder, const MedialComplex& complex);

/// The maximal chains of edges without faces: the edges of each.
IndexLists find_curves(const MedialComplex& complex, const Remainder& remainder);

/// The end of an edge that is not `vertex`.
inline Index other_end(const std::array<Index, 2>& edge, Index vertex) { return edge[0] == vertex ? edge[1] : edge[0]; }

}  // namespace scaleaxis::inline v1
