// SPDX-License-Identifier: Apache-2.0
#include "balls/union/union_complex.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/grouped.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "delaunay/tetrahedron.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/errors.hpp"
#include "spatial/extent.hpp"
#include "spatial/spheres.hpp"

namespace scaleaxis::inline v1 {

std::vector<Ball> in_general_position(std::span<const Ball> balls) {
    return perturbed(scaled(balls, 1.0 + 2.0 * kGeneralPosition), kGeneralPosition, 1);
}

BoundaryVertices boundary_vertices(const DualComplex& complex, std::span<const Ball> balls) {
    struct Side {
        Index cell;
        int facet;
        bool is_second;  // of a triangle with two boundary vertices
    };
    const Triangulation& t = complex.triangulation;
    const auto sides =
        collect<std::vector<Side>>(static_cast<Index>(t.size()), [&](Index cell, std::vector<Side>& out) {
            for (int k = 0; k < 4; ++k) {
                const Index neighbor = t.cells[cell].neighbors[k];
                if ((complex.facets[cell] >> k & 1) == 0 || neighbor < cell) {
                    continue;
                }
                const auto& back = t.cells[neighbor].neighbors;
                const int mirror = static_cast<int>(std::find(back.begin(), back.end(), cell) - back.begin());
                const bool is_free_here = complex.has_cell[cell] == 0;
                const bool is_free_there = complex.has_cell[neighbor] == 0;
                if (is_free_here) {
                    out.push_back({cell, k, false});
                }
                if (is_free_there) {
                    out.push_back({neighbor, mirror, is_free_here});
                }
            }
        });

    BoundaryVertices vertices;
    vertices.points.resize(sides.size());
    vertices.balls.resize(sides.size());
    for_each_index(sides.size(), [&](std::size_t i) {
        const std::array<Index, 3> facet = facet_of_cell(t.cells[sides[i].cell].vertices, sides[i].facet);
        const Ball& p = balls[facet[0]];
        const Ball& q = balls[facet[1]];
        const Ball& r = balls[facet[2]];
        const OrthogonalSphere sphere = orthogonal_sphere(p, q, r);
        const Point normal = cross(q.center - p.center, r.center - p.center);
        vertices.points[i] = sphere.center + (std::sqrt(std::max(0.0, -sphere.power)) / norm(normal)) * normal;
        vertices.balls[i] = facet;
        std::sort(vertices.balls[i].begin(), vertices.balls[i].end());
    });
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (sides[i].is_second) {
            vertices.pairs.push_back({static_cast<Index>(i) - 1, static_cast<Index>(i)});
        }
    }
    return vertices;
}

void check_union(std::span<const Ball> balls) {
    if (balls.empty()) {
        throw UnusableInput(Diagnostic{"balls.none", "there are no balls: a union needs one at least"});
    }
    check_balls(balls);
    if (Diagnostic fault = extent_fault(bounds(balls), "balls"); !fault.empty()) {
        throw UnusableInput(std::move(fault));
    }
}

UnionComplex union_complex(std::span<const Ball> balls) {
    UnionComplex complex;
    complex.given = distinct_positions(balls);
    const auto distinct = each_of<Ball>(complex.given, [&](Index i) { return balls[i]; });
    if (distinct.size() == balls.size()) {
        complex.given.clear();
    }
    complex.balls = in_general_position(distinct);
    complex.dual = dual_complex(complex.balls);
    complex.vertices = boundary_vertices(complex.dual, complex.balls);
    return complex;
}

UnionAdjacency union_adjacency(const UnionComplex& complex) {
    const std::size_t balls = complex.balls.size();
    UnionAdjacency adjacency;
    adjacency.neighbors = grouped_both_ways(balls, complex.dual.edges);
    stop_if_cancelled();
    adjacency.vertices = grouped(balls, [&](const auto& add) {
        for (Index v = 0; v < static_cast<Index>(complex.vertices.balls.size()); ++v) {
            for (const Index ball : complex.vertices.balls[v]) {
                add(ball, v);
            }
        }
    });
    stop_if_cancelled();
    adjacency.visible = complex.dual.singular_vertices;
    for (Index ball = 0; ball < static_cast<Index>(balls); ++ball) {
        if (!adjacency.neighbors[ball].empty()) {
            adjacency.visible.push_back(ball);
        }
    }
    return adjacency;
}

}  // namespace scaleaxis::inline v1
