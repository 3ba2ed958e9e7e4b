// SPDX-License-Identifier: Apache-2.0
#include "balls/dual_complex.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "base/parallel.hpp"
#include "delaunay/edges.hpp"
#include "spatial/spheres.hpp"

namespace scaleaxis::inline v1 {
namespace {

using Balls = std::span<const Ball>;

Triangulation regular_triangulation(Balls balls) {
    std::vector<Point> centers(balls.size());
    std::vector<double> weights(balls.size());
    for (std::size_t i = 0; i < balls.size(); ++i) {
        centers[i] = balls[i].center;
        weights[i] = balls[i].radius * balls[i].radius;
    }
    return triangulate(centers, weights);
}

bool has_ghost(const std::array<Index, 4>& cell) { return std::any_of(cell.begin(), cell.end(), is_ghost); }

void find_tetrahedra(DualComplex& complex, Balls balls) {
    const Triangulation& t = complex.triangulation;
    complex.has_cell = mapped<std::uint8_t>(t.size(), [&](std::size_t c) {
        const auto& [p, q, r, s] = t.cells[c].vertices;
        return !has_ghost(t.cells[c].vertices) && meet(balls[p], balls[q], balls[r], balls[s]) ? 1 : 0;
    });
}

// A facet belongs to the complex with one of its tetrahedra, or if its balls meet and neither of the two balls beside
// it takes the place where they do.
bool has_facet(const DualComplex& complex, Balls balls, Index cell, int k) {
    const Triangulation& t = complex.triangulation;
    const Index neighbor = t.cells[cell].neighbors[k];
    if (complex.has_cell[cell] != 0 || (neighbor != kNone && complex.has_cell[neighbor] != 0)) {
        return true;
    }
    const std::array<Index, 4>& v = t.cells[cell].vertices;
    const Index p = v[(k + 1) & 3];
    const Index q = v[(k + 2) & 3];
    const Index r = v[(k + 3) & 3];
    if (is_ghost(p) || is_ghost(q) || is_ghost(r) || !meet(balls[p], balls[q], balls[r])) {
        return false;
    }
    const auto is_taken_by = [&](Index other) {
        return !is_ghost(other) && conflicts(balls[p], balls[q], balls[r], balls[other]);
    };
    const auto& back = t.cells[neighbor].neighbors;
    const auto mirror = std::find(back.begin(), back.end(), cell) - back.begin();
    return !is_taken_by(v[k]) && !is_taken_by(t.cells[neighbor].vertices[mirror]);
}

void find_triangles(DualComplex& complex, Balls balls) {
    const Triangulation& t = complex.triangulation;
    const auto cells = static_cast<Index>(t.size());
    // Each facet is decided once, by the cell of the smaller index…
    complex.facets.resize(cells);
    for_each_index(cells, [&](Index c) {
        for (int k = 0; k < 4; ++k) {
            if (t.cells[c].neighbors[k] > c && has_facet(complex, balls, c, k)) {
                complex.facets[c] = static_cast<std::uint8_t>(complex.facets[c] | 1 << k);
            }
        }
    });
    // …and the other one takes it over. The bits that are read here are not written any more.
    std::vector<std::uint8_t> taken_over(cells);
    for_each_index(cells, [&](Index c) {
        for (int k = 0; k < 4; ++k) {
            const Index neighbor = t.cells[c].neighbors[k];
            if (neighbor != kNone && neighbor < c) {
                const auto& back = t.cells[neighbor].neighbors;
                const auto mirror = std::find(back.begin(), back.end(), c) - back.begin();
                taken_over[c] =
                    static_cast<std::uint8_t>(taken_over[c] | (complex.facets[neighbor] >> mirror & 1) << k);
            }
        }
    });
    for_each_index(cells,
                   [&](Index c) { complex.facets[c] = static_cast<std::uint8_t>(complex.facets[c] | taken_over[c]); });
}

struct FoundEdges {
    std::vector<std::array<Index, 2>> all;
    std::vector<std::array<Index, 2>> singular;
};

FoundEdges join(std::vector<FoundEdges>& parts) {
    return {joined(parts, &FoundEdges::all), joined(parts, &FoundEdges::singular)};
}

void find_edges(DualComplex& complex, Balls balls) {
    const Triangulation& t = complex.triangulation;
    const auto is_wanted = [](Index) { return true; };
    FoundEdges found = collect_edges<FoundEdges>(t, is_wanted, [&](const auto& around, FoundEdges& out) {
        const std::array<Index, 2> ends = ends_of_edge(t, around.front());
        const Index p = ends[0];
        const Index q = ends[1];
        if (is_ghost(p) || is_ghost(q)) {
            return;
        }
        const bool has_triangle = std::any_of(around.begin(), around.end(), [&](const AroundEdge& at) {
            return (complex.facets[at.cell] >> at.exit & 1) != 0;
        });
        if (has_triangle) {
            out.all.push_back({p, q});
            return;
        }
        const auto is_taken_by = [&](const AroundEdge& at) {
            const Index other = t.cells[at.cell].vertices[at.apex];
            return !is_ghost(other) && conflicts(balls[p], balls[q], balls[other]);
        };
        if (meet(balls[p], balls[q]) && std::none_of(around.begin(), around.end(), is_taken_by)) {
            out.all.push_back({p, q});
            out.singular.push_back({p, q});
        }
    });
    complex.edges = std::move(found.all);
    complex.singular_edges = std::move(found.singular);
}

void find_vertices(DualComplex& complex, Balls balls) {
    const Triangulation& t = complex.triangulation;
    enum class State : std::uint8_t { kHidden, kVisible, kCovered, kHasEdge };
    std::vector<State> states(balls.size(), State::kHidden);
    for (const auto& edge : complex.edges) {
        states[edge[0]] = states[edge[1]] = State::kHasEdge;
    }
    CancellationPoint cancellation_point;
    for (const auto& [cell, neighbors] : t.cells) {
        cancellation_point();
        for (const Index v : cell) {
            if (is_ghost(v) || states[v] == State::kHasEdge) {
                continue;
            }
            const bool is_covered = std::any_of(cell.begin(), cell.end(), [&](Index other) {
                return other != v && !is_ghost(other) && conflicts(balls[v], balls[other]);
            });
            if (is_covered) {
                states[v] = State::kCovered;
            } else if (states[v] == State::kHidden) {
                states[v] = State::kVisible;
            }
        }
    }
    complex.hidden_balls = static_cast<Index>(std::count(states.begin(), states.end(), State::kHidden));
    complex.vertices = static_cast<Index>(std::count(states.begin(), states.end(), State::kHasEdge));
    for (Index v = 0; v < static_cast<Index>(balls.size()); ++v) {
        if (states[v] == State::kVisible) {
            complex.singular_vertices.push_back(v);
        }
    }
    complex.vertices += static_cast<Index>(complex.singular_vertices.size());
}

// The connected components of the complement of the complex, that outside all balls among them.
std::int64_t parts_of_complement(const DualComplex& complex) {
    const Triangulation& t = complex.triangulation;
    DisjointSets complement(t.size());
    std::int64_t parts = std::count(complex.has_cell.begin(), complex.has_cell.end(), 0);
    CancellationPoint cancellation_point;
    for (Index c = 0; c < static_cast<Index>(t.size()); ++c) {
        cancellation_point();
        for (int k = 0; k < 4; ++k) {
            const Index neighbor = t.cells[c].neighbors[k];
            if (neighbor > c && (complex.facets[c] >> k & 1) == 0) {
                parts -= complement.join(c, neighbor) ? 1 : 0;
            }
        }
    }
    return parts;
}

// By Alexander duality the voids of the complex are the bounded components of its complement, so that all Betti
// numbers follow from counting.
void find_topology(DualComplex& complex, std::size_t balls, std::int64_t parts_of_complement) {
    std::int64_t facet_sides = 0;
    for (const std::uint8_t mask : complex.facets) {
        facet_sides += (mask & 1) + (mask >> 1 & 1) + (mask >> 2 & 1) + (mask >> 3 & 1);
    }
    complex.triangles = static_cast<Index>(facet_sides / 2);  // none of them is at the hull, which is made of ghosts
    complex.tetrahedra = std::accumulate(complex.has_cell.begin(), complex.has_cell.end(), Index{0});

    Topology& topology = complex.topology;
    topology.euler = std::int64_t{complex.vertices} - static_cast<std::int64_t>(complex.edges.size()) +
                     complex.triangles - complex.tetrahedra;

    DisjointSets components(balls);
    std::int64_t joins = 0;
    CancellationPoint cancellation_point;
    for (const auto& [p, q] : complex.edges) {
        cancellation_point();
        joins += components.join(p, q) ? 1 : 0;
    }
    topology.components = complex.vertices - joins;
    topology.voids = parts_of_complement - 1;
    topology.tunnels = topology.components + *topology.voids - topology.euler;
}

}  // namespace

DualComplex dual_complex(std::span<const Ball> balls) { return dual_complex(regular_triangulation(balls), balls); }

DualComplex dual_complex(Triangulation triangulation, std::span<const Ball> balls) {
    DualComplex complex;
    complex.triangulation = std::move(triangulation);
    find_tetrahedra(complex, balls);
    find_triangles(complex, balls);
    std::int64_t parts = 0;
    run_together([&] { parts = parts_of_complement(complex); },
                 [&] {
                     find_edges(complex, balls);
                     find_vertices(complex, balls);
                 });
    find_topology(complex, balls.size(), parts);
    return complex;
}

}  // namespace scaleaxis::inline v1
