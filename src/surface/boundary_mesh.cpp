// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/boundary.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/grouped.hpp"
#include "base/parallel.hpp"
#include "delaunay/edges.hpp"
#include "sampling/restricted_facets.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Vertex positions of the facet opposite to each vertex of a positively oriented tetrahedron, counter-clockwise as seen
// from outside of it.
constexpr std::array<std::array<int, 3>, 4> kFacetFromOutside{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// The facet that follows across the edge opposite to `corner` (a position in the cell), as seen from inside: the first
/// on the way around the edge through inside cells. So four facets at an edge are two pairs, whose surfaces touch
/// there. \returns the facet, and the position in its cell of the corner opposite to the edge
std::pair<RestrictedFacet, int> across(const Samples& samples, RestrictedFacet facet, int corner) {
    auto [cell, exit] = facet;
    int apex = corner;
    // The edge has neither `exit` nor `apex`: go on through the facet that has the edge and the former exit's vertex.
    std::swap(exit, apex);
    while (!is_restricted(samples, cell, exit)) {
        const Index next = samples.neighbors[cell][exit];
        // The apex of this cell is the vertex that is left behind in the next one.
        const int next_exit = position_of(samples.tetrahedra[next], samples.tetrahedra[cell][apex]);
        apex = position_of(samples.neighbors[next], cell);
        exit = next_exit;
        cell = next;
    }
    return {{cell, exit}, apex};
}

/// Appends the triangle, cut so that the middles of its edges become vertices: `middles[k]` is that of the edge
/// opposite to corner `k`, or `kNone`.
void append_cut(TriangleMesh& mesh, const std::array<Index, 3>& triangle, const std::array<Index, 3>& middles) {
    for (int k = 0; k < 3; ++k) {
        if (const Index middle = middles[k]; middle != kNone) {
            const int next = (k + 1) % 3;
            const int last = (k + 2) % 3;
            append_cut(mesh, {triangle[k], triangle[next], middle}, {kNone, kNone, middles[last]});
            append_cut(mesh, {triangle[k], middle, triangle[last]}, {kNone, middles[next], kNone});
            return;
        }
    }
    mesh.triangles.push_back(triangle);
}

/// Where several pairs of triangles have an edge with the same two ends, each pair gets a vertex in the middle of it.
/// \param across the side that follows across each side. Side `3 t + k` lies between the corners of triangle `t` other
///     than `k`
/// \returns how many
Index part_edges(TriangleMesh& mesh, const std::vector<Index>& across) {
    const auto ends_of = [&](Index side) {
        const std::array<Index, 3>& triangle = mesh.triangles[side / 3];
        return std::minmax({triangle[(side + 1) % 3], triangle[(side + 2) % 3]});
    };
    const IndexLists sides_at = grouped(mesh.vertices.size(), [&](const auto& add) {
        for (Index side = 0; side < static_cast<Index>(across.size()); ++side) {
            add(ends_of(side).first, side);
        }
    });
    std::vector<Index> middles(across.size(), kNone);  // of each side
    Index parted = 0;
    std::vector<std::pair<Index, Index>> sides;  // the other end, and the side
    CancellationPoint cancellation_point;
    for (std::size_t low = 0; low < sides_at.size(); ++low) {
        cancellation_point();
        sides.clear();
        for (const Index side : sides_at[low]) {
            sides.emplace_back(ends_of(side).second, side);
        }
        std::sort(sides.begin(), sides.end());
        for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
            while (end < sides.size() && sides[end].first == sides[begin].first) {
                ++end;
            }
            for (std::size_t i = begin; i < end && end - begin > 2; ++i) {
                const auto& [high, side] = sides[i];
                if (middles[side] == kNone) {
                    middles[side] = middles[across[side]] = static_cast<Index>(mesh.vertices.size());
                    mesh.vertices.push_back(midpoint(mesh.vertices[low], mesh.vertices[high]));
                    ++parted;
                }
            }
        }
    }
    if (parted > 0) {
        const std::vector<std::array<Index, 3>> whole = std::exchange(mesh.triangles, {});
        for (std::size_t t = 0; t < whole.size(); ++t) {
            append_cut(mesh, whole[t], {middles[3 * t], middles[3 * t + 1], middles[3 * t + 2]});
        }
    }
    return parted;
}

/// The corners of the facets; corner `k` of facet `f` is `3 f + k`.
struct VertexCorners {
    DisjointSets sets;          ///< corners that are the same vertex: their triangles are neighbours around it
    std::vector<Index> across;  ///< of each corner's opposite side: the corner opposite to the same side, across it
};

VertexCorners corners_of(const Samples& samples, const std::vector<RestrictedFacet>& facets) {
    std::vector<std::array<Index, 4>> facet_of(samples.tetrahedra.size(), {kNone, kNone, kNone, kNone});
    for (std::size_t f = 0; f < facets.size(); ++f) {
        facet_of[facets[f].cell][facets[f].opposite] = static_cast<Index>(f);
    }
    const auto corner_at = [&](const RestrictedFacet& facet, Index vertex) {
        const Index f = facet_of[facet.cell][facet.opposite];
        const auto& order = kFacetFromOutside[facet.opposite];
        const auto& cell = samples.tetrahedra[facet.cell];
        return 3 * f + (cell[order[0]] == vertex ? 0 : cell[order[1]] == vertex ? 1 : 2);
    };
    VertexCorners corners{DisjointSets(3 * facets.size()), std::vector<Index>(3 * facets.size())};
    CancellationPoint cancellation_point;
    for (std::size_t f = 0; f < facets.size(); ++f) {
        cancellation_point();
        const RestrictedFacet& facet = facets[f];
        const auto& order = kFacetFromOutside[facet.opposite];
        for (int k = 0; k < 3; ++k) {
            const auto [other, apex] = across(samples, facet, order[k]);
            corners.across[3 * f + k] = corner_at(other, samples.tetrahedra[other.cell][apex]);
            for (const int end : {order[(k + 1) % 3], order[(k + 2) % 3]}) {
                const Index vertex = samples.tetrahedra[facet.cell][end];
                corners.sets.join(corner_at(facet, vertex), corner_at(other, vertex));
            }
        }
    }
    return corners;
}

}  // namespace

SamplingOptions boundary_sampling(double tolerance) {
    constexpr double kFacetDistance = 1.0 / 8.0;
    return {.tolerance = tolerance,
            .sizing = Sizing::kUniform,
            .needs_manifold = true,
            .facet_distance = kFacetDistance * tolerance};
}

BoundaryMesh boundary_mesh(const Samples& samples, const Execution& execution) {
    return in_arena(execution, [&] {
        constexpr std::string_view kStage = "boundary mesh";
        report(execution, kStage, 0.0);
        const std::vector<RestrictedFacet> facets = restricted_facets(samples);
        VertexCorners corners = corners_of(samples, facets);
        report(execution, kStage, 0.5);

        BoundaryMesh result;
        std::vector<Index> vertex_of_set(3 * facets.size(), kNone);
        std::vector<std::uint8_t> is_used(samples.points.size());
        result.mesh.triangles.resize(facets.size());
        CancellationPoint cancellation_point;
        for (std::size_t f = 0; f < facets.size(); ++f) {
            cancellation_point();
            for (int k = 0; k < 3; ++k) {
                const Index sample = samples.tetrahedra[facets[f].cell][kFacetFromOutside[facets[f].opposite][k]];
                Index& vertex = vertex_of_set[corners.sets.find(static_cast<Index>(3 * f) + k)];
                if (vertex == kNone) {
                    vertex = static_cast<Index>(result.mesh.vertices.size());
                    result.mesh.vertices.push_back(samples.points[sample]);
                    result.copied_vertices += is_used[sample];
                    is_used[sample] = 1;
                }
                result.mesh.triangles[f][k] = vertex;
            }
        }
        result.parted_edges = part_edges(result.mesh, corners.across);
        for (const std::uint8_t used : is_used) {
            result.lost_samples += used != 0 ? 0 : 1;
        }
        report(execution, kStage, 1.0);
        return result;
    });
}

}  // namespace scaleaxis::inline v1
