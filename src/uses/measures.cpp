// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/measures.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "axis/complex.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/grouped.hpp"
#include "base/progress.hpp"
#include "base/vectors.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Pieces of a skeleton, and which of them its nodes belong to.
struct Pieces {
    Index count = 1;
    std::vector<Index> of_node;  // `kNone`: none
};

// Branches, and after them what is connected of the nodes that lie on none: single balls, and sheets.
Pieces parts_of(const Skeleton& skeleton) {
    const std::vector<Index>& branches = skeleton.node_branches;
    Pieces parts{static_cast<Index>(skeleton.branches.size()), branches};
    DisjointSets sets(branches.size());
    for (const auto& [a, b] : skeleton.edges) {
        if (branches[a] == kNone && branches[b] == kNone) {
            sets.join(a, b);
        }
    }
    for (Index n = 0; n < static_cast<Index>(branches.size()); ++n) {
        if (branches[n] == kNone) {
            Index& part = parts.of_node[sets.find(n)];
            part = part == kNone ? parts.count++ : part;
            parts.of_node[n] = part;
        }
    }
    return parts;
}

Pieces pieces_of(const Skeleton& skeleton, MeasuredPieces kind) {
    switch (kind) {
        case MeasuredPieces::kComponents: {
            const std::vector<Index>& components = skeleton.node_components;
            return {components.empty() ? 0 : std::ranges::max(components) + 1, components};
        }
        case MeasuredPieces::kParts:
            return parts_of(skeleton);
        default:
            return {1, std::vector<Index>(skeleton.nodes.size(), 0)};
    }
}

double enclosed_volume(const TriangleMesh& mesh) {
    // From a point of the mesh: far from the origin nothing would be left of a small volume.
    const Point origin = mesh.vertices.empty() ? Point{} : mesh.vertices.front();
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        sum += dot(mesh.vertices[a] - origin, cross(mesh.vertices[b] - origin, mesh.vertices[c] - origin));
    }
    return sum / 6.0;
}

// The triangles of each piece with their vertices, and which vertices of the surface these are.
struct PieceOfSurface {
    TriangleMesh mesh;
    std::vector<Index> vertices;
};

std::vector<PieceOfSurface> divided(const TriangleMesh& surface, Index pieces, std::span<const Index> piece_of_vertex) {
    const IndexLists triangles = grouped(pieces, [&](const auto& add) {
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            const Index piece = piece_of_vertex[surface.triangles[t][0]];
            if (piece != kNone) {
                add(piece, static_cast<Index>(t));
            }
        }
    });
    struct Numbered {
        Index piece = kNone;   // the last one that had it, ...
        Index number = kNone;  // ... and its number there
    };
    std::vector<Numbered> numbered(surface.vertices.size());
    std::vector<PieceOfSurface> result(pieces);
    for (Index piece = 0; piece < pieces; ++piece) {
        auto& [mesh, vertices] = result[piece];
        for (const Index t : triangles[piece]) {
            std::array<Index, 3> corners = surface.triangles[t];
            for (Index& v : corners) {
                if (numbered[v].piece != piece) {
                    numbered[v] = {piece, static_cast<Index>(vertices.size())};
                    vertices.push_back(v);
                    mesh.vertices.push_back(surface.vertices[v]);
                }
                v = numbered[v].number;
            }
            mesh.triangles.push_back(corners);
        }
    }
    return result;
}

SurfaceValues values_on(const PieceOfSurface& piece, std::span<const double> values) {
    const auto here = each_of<double>(piece.vertices, [&](Index v) { return values[v]; });
    SurfaceValues result = surface_values(piece.mesh, here);
    for (Index* vertex : {&result.min_vertex, &result.max_vertex}) {
        *vertex = *vertex == kNone ? kNone : piece.vertices[*vertex];
    }
    return result;
}

// The part of a skeleton that consists of some nodes, as a complex; a single branch with its ends.
MedialComplex part_of(const Skeleton& skeleton, const MedialComplex& complex, const Pieces& pieces, Index piece,
                      MeasuredPieces kind) {
    std::vector<std::uint8_t> keeps_vertex(complex.vertices.size());
    std::vector<std::uint8_t> keeps_edge(complex.edges.size());
    std::vector<std::uint8_t> keeps_face(complex.faces.size());
    if (kind == MeasuredPieces::kParts && piece < static_cast<Index>(skeleton.branches.size())) {
        const std::span<const Index> branch = skeleton.branches[piece];
        for (std::size_t k = 0; k < branch.size(); ++k) {
            keeps_vertex[branch[k]] = 1;
            if (k > 0) {
                const std::array<Index, 2> ends{std::min(branch[k - 1], branch[k]), std::max(branch[k - 1], branch[k])};
                keeps_edge[std::ranges::lower_bound(complex.edges, ends) - complex.edges.begin()] = 1;
            }
        }
        return subcomplex(complex, keeps_vertex, keeps_edge, keeps_face);
    }
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        keeps_vertex[v] = pieces.of_node[v] == piece ? 1 : 0;
    }
    // With the nodes at which branches end on a sheet, which are theirs.
    const auto is_of_piece = [&](std::span<const Index> nodes) {
        return std::ranges::any_of(nodes, [&](Index n) { return pieces.of_node[n] == piece; });
    };
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (is_of_piece(complex.edges[e])) {
            keeps_edge[e] = 1;
            std::ranges::for_each(complex.edges[e], [&](Index v) { keeps_vertex[v] = 1; });
        }
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (is_of_piece(complex.faces[f])) {
            keeps_face[f] = 1;
            std::ranges::for_each(complex.face_edges[f], [&](Index e) { keeps_edge[e] = 1; });
        }
    }
    return subcomplex(complex, keeps_vertex, keeps_edge, keeps_face);
}

void add_skeleton(const Skeleton& skeleton, const Pieces& pieces, MeasuredPieces kind, std::vector<Measures>& rows) {
    const MedialComplex complex = complex_of(skeleton);
    for (Index piece = 0; piece < pieces.count; ++piece) {
        Measures& row = rows[piece];
        const MedialComplex part = part_of(skeleton, complex, pieces, piece, kind);
        row.topology = topology_of(part);
        std::vector<Index> degree(part.vertices.size());
        for (const auto& [a, b] : part.edges) {
            ++degree[a];
            ++degree[b];
        }
        row.ends = static_cast<Index>(std::ranges::count(degree, 1));
    }
    if (kind != MeasuredPieces::kParts) {  // within a part none meet
        const std::vector<Index> degree = branch_degrees(skeleton);
        for (std::size_t n = 0; n < degree.size(); ++n) {
            rows[pieces.of_node[n]].junctions += degree[n] > 2 ? 1 : 0;
        }
    }
    for (Index b = 0; b < static_cast<Index>(skeleton.branches.size()); ++b) {
        const Index piece = kind == MeasuredPieces::kParts ? b : pieces.of_node[skeleton.branches[b].front()];
        ++rows[piece].branches;
        rows[piece].curve_length += branch_length(skeleton, b);
    }
}

void add_sheets(const MedialComplex& axis, const Skeleton& skeleton, const Pieces& pieces,
                std::vector<Measures>& rows) {
    std::vector<std::uint8_t> is_counted(axis.sheets);
    for (Index f = 0; f < static_cast<Index>(axis.faces.size()); ++f) {
        const Index node = skeleton.vertex_nodes[axis.faces[f][0]];
        const Index piece = node == kNone ? kNone : pieces.of_node[node];
        if (piece == kNone) {
            continue;
        }
        rows[piece].sheet_area += face_area(axis, f);
        std::uint8_t& is_known = is_counted[axis.face_sheets[f]];
        rows[piece].sheets += is_known == 0 ? 1 : 0;
        is_known = 1;
    }
}

std::vector<PieceOfSurface> pieces_of_surface(const MedialComplex& axis, const Skeleton& skeleton, const Pieces& pieces,
                                              const TriangleMesh& surface, const Execution& execution) {
    const auto piece_of_vertex =
        each_of<Index>(nearest_nodes(skeleton, axis, surface.vertices, execution),
                       [&](Index node) { return node == kNone ? kNone : pieces.of_node[node]; });
    return divided(surface, pieces.count, piece_of_vertex);
}

std::vector<Measures> measured(const MedialComplex& axis, const Skeleton& skeleton, const Pieces& pieces,
                               const std::vector<PieceOfSurface>& parts, std::span<const double> thickness,
                               const MeasureOptions& options) {
    std::vector<Measures> rows;
    for (const PieceOfSurface& part : parts) {
        Measures row;
        row.thickness = values_on(part, thickness);
        if (options.pieces != MeasuredPieces::kParts) {
            row.volume = enclosed_volume(part.mesh);
        }
        rows.push_back(row);
    }
    add_skeleton(skeleton, pieces, options.pieces, rows);
    add_sheets(axis, skeleton, pieces, rows);
    return rows;
}

}  // namespace

std::vector<Measures> measures(const MedialComplex& axis, const Skeleton& skeleton, const TriangleMesh& surface,
                               const MeasureOptions& options, const Execution& execution) {
    const Pieces pieces = pieces_of(skeleton, options.pieces);
    const std::vector<PieceOfSurface> parts =
        pieces_of_surface(axis, skeleton, pieces, surface, part_of(execution, 0.0, 0.5));
    const std::vector<PointThickness> thickness =
        Thickness(axis, options.thickness).at_surface(surface, part_of(execution, 0.5, 1.0));
    const auto local = each_of<double>(thickness, &PointThickness::thickness);
    return measured(axis, skeleton, pieces, parts, local, options);
}

std::vector<Measures> measures(const MedialComplex& axis, const Skeleton& skeleton, const TriangleMesh& surface,
                               std::span<const double> thickness, const TriangleMesh& closer,
                               const MeasureOptions& options, const Execution& execution) {
    require(thickness.size() == surface.vertices.size(), "one thickness is needed for each vertex of the surface");
    const Pieces pieces = pieces_of(skeleton, options.pieces);
    std::vector<Measures> rows =
        measured(axis, skeleton, pieces,
                 pieces_of_surface(axis, skeleton, pieces, surface, part_of(execution, 0.0, 0.5)), thickness, options);
    const std::vector<PieceOfSurface> parts =
        pieces_of_surface(axis, skeleton, pieces, closer, part_of(execution, 0.5, 1.0));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const TriangleMesh& mesh = parts[i].mesh;
        rows[i].thickness.area = surface_values(mesh, std::vector<double>(mesh.vertices.size())).area;
        if (rows[i].volume) {
            rows[i].volume = enclosed_volume(mesh);
        }
    }
    return rows;
}

}  // namespace scaleaxis::inline v1
