// SPDX-License-Identifier: Apache-2.0
#include "solid/zero_set/surface_net.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "solid/zero_set/near_points.hpp"
#include "solid/zero_set/trilinear.hpp"

namespace scaleaxis::inline v1 {
namespace {

// A face this near (fraction of the step) to where the zero crosses its edge needs no vertex there.
constexpr double kFlat = 0.01;

bool is_inside(const SurfaceCell& cell, int corner) { return (cell.inside >> corner & 1) != 0; }

Point corner_at(int corner) { return {1.0 * (corner & 1), 1.0 * (corner >> 1 & 1), 1.0 * (corner >> 2)}; }

Point clamped(const Point& p) {
    return {std::clamp(p.x, 0.0, 1.0), std::clamp(p.y, 0.0, 1.0), std::clamp(p.z, 0.0, 1.0)};
}

/// The middle of the places where edges of the cell cross zero, moved towards the zero of the interpolant. From 0 to 1.
Point vertex_in(const SurfaceCell& cell, const CornerValues& values) {
    constexpr int kSteps = 3;
    Point sum;
    int count = 0;
    for (int corner = 0; corner < 8; ++corner) {
        for (const int bit : {1, 2, 4}) {
            const int other = corner | bit;
            if (other != corner && is_inside(cell, corner) != is_inside(cell, other)) {
                const double t = values[corner] / (values[corner] - values[other]);
                sum = sum + corner_at(corner) + t * (corner_at(other) - corner_at(corner));
                ++count;
            }
        }
    }
    Point p = (1.0 / count) * sum;
    for (int step = 0; step < kSteps; ++step) {
        const Point slope = gradient(values, p);
        const double square = squared_norm(slope);
        if (!(square > 0.0)) {
            break;
        }
        p = clamped(p - (interpolated(values, p) / square) * slope);
    }
    return is_finite(p) ? p : Point{0.5, 0.5, 0.5};
}

/// Triangles of a part of the cells, and more vertices.
struct Part {
    std::vector<std::array<Index, 3>> triangles;
    std::vector<std::array<Index, 3>> fans;  ///< the last corner is one of these vertices
    std::vector<Point> vertices;
};

/// Found by argument-dependent look-up for `collect`.
Part join(std::vector<Part>& parts) {
    Part all;
    for (const Part& part : parts) {
        for (const auto& [u, v, middle] : part.fans) {
            all.fans.push_back({u, v, middle + static_cast<Index>(all.vertices.size())});
        }
        append(all.vertices, part.vertices);
    }
    all.triangles = joined(parts, &Part::triangles);
    return all;
}

/// How far a point is from both ways to divide a four-cornered face.
double distance_to_quad(const std::array<Point, 4>& q, const Point& p) {
    double farthest = 0.0;
    for (int k = 0; k < 2; ++k) {
        const double square = std::min(squared_distance(p, nearest_point(q[k], q[k + 1], q[k + 2], p)),
                                       squared_distance(p, nearest_point(q[k], q[k + 2], q[(k + 3) % 4], p)));
        farthest = std::max(farthest, square);
    }
    return std::sqrt(farthest);
}

Point index_of(const Cell& cell) { return {1.0 * cell[0], 1.0 * cell[1], 1.0 * cell[2]}; }

}  // namespace

TriangleMesh surface_net(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                         const std::function<CornerValues(std::size_t)>& values) {
    TriangleMesh mesh;
    mesh.vertices.resize(cells.size());
    for_each_index(cells.size(), [&](std::size_t i) {
        mesh.vertices[i] = lattice.at(index_of(cells[i].cell) + vertex_in(cells[i], values(i)));
    });
    const auto find = [&](const Cell& cell) {
        const auto key = [](const SurfaceCell& c) { return std::array{c.cell[2], c.cell[1], c.cell[0]}; };
        return static_cast<Index>(std::ranges::lower_bound(cells, std::array{cell[2], cell[1], cell[0]}, {}, key) -
                                  cells.begin());
    };
    const double step = shortest_step(lattice);
    const Part part = collect<Part>(cells.size(), [&](std::size_t i, Part& out) {
        // Each edge belongs to the cell that it is the first one of along its axis.
        for (int axis = 0; axis < 3; ++axis) {
            if (is_inside(cells[i], 0) == is_inside(cells[i], 1 << axis)) {
                continue;
            }
            const auto around = [&](int back_x, int back_y) {
                Cell cell = cells[i].cell;
                cell[(axis + 1) % 3] -= back_x;
                cell[(axis + 2) % 3] -= back_y;
                return find(cell);
            };
            const auto a = static_cast<Index>(i);
            const Index b = around(1, 0), c = around(1, 1), d = around(0, 1);
            const std::vector<Point>& p = mesh.vertices;
            const CornerValues at = values(i);
            Point crossing{1.0 * (axis == 0), 1.0 * (axis == 1), 1.0 * (axis == 2)};
            crossing = lattice.at(index_of(cells[i].cell) + (at[0] / (at[0] - at[1 << axis])) * crossing);
            if (distance_to_quad({p[a], p[b], p[c], p[d]}, crossing) > kFlat * step) {
                const auto middle = static_cast<Index>(out.vertices.size());
                out.vertices.push_back(crossing);
                for (const auto& [u, v] : {std::array{a, b}, {b, c}, {c, d}, {d, a}}) {
                    out.fans.push_back({u, v, middle});
                }
            } else if (squared_distance(p[a], p[c]) <= squared_distance(p[b], p[d])) {
                out.triangles.push_back({a, b, c});
                out.triangles.push_back({a, c, d});
            } else {
                out.triangles.push_back({a, b, d});
                out.triangles.push_back({b, c, d});
            }
        }
    });
    append(mesh.triangles, part.triangles);
    for (const auto& [u, v, middle] : part.fans) {
        mesh.triangles.push_back({u, v, middle + static_cast<Index>(mesh.vertices.size())});
    }
    append(mesh.vertices, part.vertices);
    return mesh;
}

NetTree net_tree(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                 const std::function<CornerValues(std::size_t)>& values) {
    NetTree tree;
    tree.bvh = build_bvh(surface_net(lattice, cells, values));
    tree.bounds = triangle_bounds(tree.bvh);
    tree.margin = distance(lattice.at({}), lattice.at({1.0, 1.0, 1.0}));
    for (const auto& [x, y, z] : {Point{1, 1, -1}, Point{1, -1, 1}, Point{-1, 1, 1}}) {
        tree.margin = std::max(tree.margin, distance(lattice.at({}), lattice.at({x, y, z})));
    }
    return tree;
}

}  // namespace scaleaxis::inline v1
