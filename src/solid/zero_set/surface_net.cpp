// SPDX-License-Identifier: Apache-2.0
#include "solid/zero_set/surface_net.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "solid/zero_set/near_points.hpp"
#include "solid/zero_set/trilinear.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Keeps vertices in the middle of what planes leave open. Edges flatter than 4 degrees are as good as flat.
constexpr double kStay = 1e-3;

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

/// The one of the cells, which are sorted.
std::size_t find(const std::vector<SurfaceCell>& cells, const Cell& cell) {
    const auto key = [](const SurfaceCell& c) { return std::array{c.cell[2], c.cell[1], c.cell[0]}; };
    return std::ranges::lower_bound(cells, std::array{cell[2], cell[1], cell[0]}, {}, key) - cells.begin();
}

/// The place nearest to all planes. \param crossings not empty
Point meeting_of(const std::vector<EdgeCrossing>& crossings) {
    const auto count = static_cast<double>(crossings.size());
    Point middle;
    for (const EdgeCrossing& crossing : crossings) {
        middle = middle + (1.0 / count) * crossing.place;
    }
    std::array<Point, 3> rows{Point{kStay * count, 0, 0}, {0, kStay * count, 0}, {0, 0, kStay * count}};
    Point sum;
    for (const auto& [place, normal] : crossings) {
        rows[0] = rows[0] + normal.x * normal;
        rows[1] = rows[1] + normal.y * normal;
        rows[2] = rows[2] + normal.z * normal;
        sum = sum + dot(normal, place - middle) * normal;
    }
    const Point yz = cross(rows[1], rows[2]), zx = cross(rows[2], rows[0]), xy = cross(rows[0], rows[1]);
    return middle + (1.0 / dot(rows[0], yz)) * (sum.x * yz + sum.y * zx + sum.z * xy);
}

}  // namespace

std::vector<NetCell> net_of_interpolant(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                                        const std::function<CornerValues(std::size_t)>& values) {
    std::vector<NetCell> points(cells.size());
    for_each_index(cells.size(), [&](std::size_t i) {
        const CornerValues at = values(i);
        points[i].vertex = lattice.at(index_of(cells[i].cell) + vertex_in(cells[i], at));
        for (int axis = 0; axis < 3; ++axis) {
            if (is_inside(cells[i], 0) != is_inside(cells[i], 1 << axis)) {
                points[i].crossings[axis] =
                    lattice.at(index_of(cells[i].cell) + (at[0] / (at[0] - at[1 << axis])) * corner_at(1 << axis));
            }
        }
    });
    return points;
}

std::vector<NetCell> net_of_planes(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                                   const std::vector<std::array<EdgeCrossing, 3>>& crossings) {
    std::vector<NetCell> points(cells.size());
    for_each_index(cells.size(), [&](std::size_t i) {
        std::vector<EdgeCrossing> around;
        for (int axis = 0; axis < 3; ++axis) {
            points[i].crossings[axis] = crossings[i][axis].place;
            for (int corner = 0; corner < 8; ++corner) {
                const int other = corner | 1 << axis;
                if (other != corner && is_inside(cells[i], corner) != is_inside(cells[i], other)) {
                    const auto& [x, y, z] = cells[i].cell;
                    const Cell of_edge{x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2)};
                    around.push_back(crossings[find(cells, of_edge)][axis]);
                }
            }
        }
        // Where planes are all but parallel they meet anywhere; a tip that no edge of the lattice meets ends in the
        // next cell.
        const Point low = lattice.at(index_of(cells[i].cell) - Point{1, 1, 1});
        const Point high = lattice.at(index_of(cells[i].cell) + Point{2, 2, 2});
        const Point p = meeting_of(around);
        points[i].vertex = {std::clamp(p.x, low.x, high.x), std::clamp(p.y, low.y, high.y),
                            std::clamp(p.z, low.z, high.z)};
    });
    return points;
}

TriangleMesh surface_net(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                         const std::vector<NetCell>& points) {
    TriangleMesh mesh;
    mesh.vertices = each_of<Point>(points, [](const NetCell& cell) { return cell.vertex; });
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
                return static_cast<Index>(find(cells, cell));
            };
            const auto a = static_cast<Index>(i);
            const Index b = around(1, 0), c = around(1, 1), d = around(0, 1);
            const std::vector<Point>& p = mesh.vertices;
            const Point& crossing = points[i].crossings[axis];
            if (distance_to_quad({p[a], p[b], p[c], p[d]}, crossing) > kNetAccuracy * step) {
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

NetTree net_tree(const Lattice& lattice, const std::vector<SurfaceCell>& cells, const std::vector<NetCell>& points) {
    NetTree tree;
    tree.bvh = build_bvh(surface_net(lattice, cells, points));
    tree.bounds = triangle_bounds(tree.bvh);
    tree.margin = distance(lattice.at({}), lattice.at({1.0, 1.0, 1.0}));
    for (const auto& [x, y, z] : {Point{1, 1, -1}, Point{1, -1, 1}, Point{-1, 1, 1}}) {
        tree.margin = std::max(tree.margin, distance(lattice.at({}), lattice.at({x, y, z})));
    }
    return tree;
}

}  // namespace scaleaxis::inline v1
