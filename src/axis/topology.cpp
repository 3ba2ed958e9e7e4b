// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "kernel/disjoint_sets.hpp"
#include "scaleaxis/medial_axis.hpp"

namespace scaleaxis {
namespace {

// Above this size the elimination below is not tried, and the number of voids stays unknown.
constexpr std::size_t kMaxElimination = 3000;

// Faces that remain when faces are removed from their free edges for as long as there are any. The removals keep the
// homotopy type; without a remainder there is no void.
std::vector<std::uint8_t> faces_after_collapse(const MedialComplex& complex, std::vector<Index>& faces_at_edge) {
    std::vector<std::uint8_t> is_left(complex.faces.size(), 1);
    std::vector<Index> sum_at_edge(complex.edges.size());  // of the indices (plus one) of the faces that are left
    faces_at_edge.assign(complex.edges.size(), 0);
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        for (const Index e : complex.face_edges[f]) {
            ++faces_at_edge[e];
            sum_at_edge[e] ^= f + 1;
        }
    }
    std::vector<Index> free_edges;
    for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
        if (faces_at_edge[e] == 1) {
            free_edges.push_back(e);
        }
    }
    while (!free_edges.empty()) {
        const Index edge = free_edges.back();
        free_edges.pop_back();
        if (faces_at_edge[edge] != 1) {
            continue;
        }
        const Index face = sum_at_edge[edge] - 1;
        is_left[face] = 0;
        for (const Index e : complex.face_edges[face]) {
            sum_at_edge[e] ^= face + 1;
            if (--faces_at_edge[e] == 1) {
                free_edges.push_back(e);
            }
        }
    }
    return is_left;
}

// Dimension of the space of 2-cycles over Z/2 of what is left: unknowns are the parts without a seam inside (a cycle
// holds all faces of a part or none), equations are the seams.
std::optional<std::int64_t> count_voids(const MedialComplex& complex) {
    std::vector<Index> faces_at_edge;
    const std::vector<std::uint8_t> is_left = faces_after_collapse(complex, faces_at_edge);
    const auto faces = static_cast<Index>(complex.faces.size());

    DisjointSets parts(faces);
    std::vector<Index> last_face(complex.edges.size(), kNone);
    std::vector<std::vector<Index>> seams;
    std::map<Index, std::size_t> seam_of_edge;
    for (Index f = 0; f < faces; ++f) {
        for (const Index e : is_left[f] != 0 ? complex.face_edges[f] : std::span<const Index>()) {
            if (faces_at_edge[e] > 2) {
                const auto [seam, is_new] = seam_of_edge.try_emplace(e, seams.size());
                if (is_new) {
                    seams.emplace_back();
                }
                seams[seam->second].push_back(f);
            } else if (last_face[e] == kNone) {
                last_face[e] = f;
            } else {
                parts.join(last_face[e], f);
            }
        }
    }
    std::vector<Index> unknown_of_part(faces, kNone);
    std::size_t unknowns = 0;
    for (Index f = 0; f < faces; ++f) {
        if (is_left[f] != 0 && parts.find(f) == f) {
            unknown_of_part[f] = static_cast<Index>(unknowns++);
        }
    }
    if (unknowns > kMaxElimination) {
        return std::nullopt;
    }
    // Each seam gives the set of unknowns that occur an odd number of times; many seams give the same.
    std::vector<std::vector<Index>> equations;
    for (const std::vector<Index>& seam : seams) {
        std::vector<Index> odd;
        for (const Index f : seam) {
            const Index unknown = unknown_of_part[parts.find(f)];
            const auto it = std::find(odd.begin(), odd.end(), unknown);
            if (it == odd.end()) {
                odd.push_back(unknown);
            } else {
                odd.erase(it);
            }
        }
        std::sort(odd.begin(), odd.end());
        equations.push_back(std::move(odd));
    }
    std::sort(equations.begin(), equations.end());
    equations.erase(std::unique(equations.begin(), equations.end()), equations.end());

    std::map<Index, std::vector<Index>> rows;  // by their first unknown
    for (std::vector<Index>& row : equations) {
        while (!row.empty()) {
            const auto pivot = rows.find(row.front());
            if (pivot == rows.end()) {
                rows.emplace(row.front(), row);
                break;
            }
            std::vector<Index> difference;
            std::set_symmetric_difference(row.begin(), row.end(), pivot->second.begin(), pivot->second.end(),
                                          std::back_inserter(difference));
            row = std::move(difference);
        }
    }
    return static_cast<std::int64_t>(unknowns) - static_cast<std::int64_t>(rows.size());
}

}  // namespace

Topology topology(const MedialComplex& complex) {
    Topology result;
    const auto vertices = static_cast<std::int64_t>(complex.vertices.size());
    result.euler =
        vertices - static_cast<std::int64_t>(complex.edges.size()) + static_cast<std::int64_t>(complex.faces.size());
    DisjointSets components(complex.vertices.size());
    std::int64_t joins = 0;
    for (const auto& [p, q] : complex.edges) {
        joins += components.join(p, q) ? 1 : 0;
    }
    result.components = vertices - joins;
    result.voids = count_voids(complex);
    if (result.voids) {
        result.tunnels = result.components + *result.voids - result.euler;
    }
    return result;
}

}  // namespace scaleaxis
