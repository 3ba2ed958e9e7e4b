// SPDX-License-Identifier: Apache-2.0
/// \file
/// Closed triangle meshes of known solids.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "surface/polygon_triangles.hpp"

namespace scaleaxis::test {

/// The box from `low` to `high`, each face divided into `n × n` squares of two triangles.
inline TriangleMesh box_mesh(const Point& low, const Point& high, int n = 1) {
    TriangleMesh mesh;
    std::map<std::array<int, 3>, Index> ids;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [it, is_new] = ids.emplace(at, static_cast<Index>(mesh.vertices.size()));
        if (is_new) {
            const auto coordinate = [&](double a, double b, int i) { return a + (b - a) * i / n; };
            mesh.vertices.push_back(
                {coordinate(low.x, high.x, at[0]), coordinate(low.y, high.y, at[1]), coordinate(low.z, high.z, at[2])});
        }
        return it->second;
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {0, n}) {
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    const auto corner = [&](int di, int dj) {
                        std::array<int, 3> at{};
                        at[axis] = side;
                        at[(axis + 1) % 3] = i + di;
                        at[(axis + 2) % 3] = j + dj;
                        return vertex(at);
                    };
                    std::array<std::array<Index, 3>, 2> pair{
                        {{corner(0, 0), corner(1, 0), corner(1, 1)}, {corner(0, 0), corner(1, 1), corner(0, 1)}}};
                    for (std::array<Index, 3>& t : pair) {
                        if (side == 0) {
                            std::swap(t[1], t[2]);
                        }
                        mesh.triangles.push_back(t);
                    }
                }
            }
        }
    }
    return mesh;
}

/// A regular icosahedron, each triangle divided into four `levels` times, with all vertices on the sphere.
inline TriangleMesh sphere_mesh(const Point& center, double radius, int levels) {
    constexpr double g = std::numbers::phi;
    TriangleMesh mesh;
    mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                     {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    for (int level = 0; level < levels; ++level) {
        std::map<std::pair<Index, Index>, Index> middles;
        const auto middle = [&](Index a, Index b) {
            const auto [it, is_new] = middles.emplace(std::minmax(a, b), static_cast<Index>(mesh.vertices.size()));
            if (is_new) {
                mesh.vertices.push_back(mesh.vertices[a] + mesh.vertices[b]);
            }
            return it->second;
        };
        std::vector<std::array<Index, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = std::move(finer);
        for (Point& p : mesh.vertices) {
            p = (1.0 / norm(p)) * p;
        }
    }
    for (Point& p : mesh.vertices) {
        p = center + (radius / norm(p)) * p;
    }
    return mesh;
}

/// A torus around the z axis, of `n × m` quadrilaterals.
inline TriangleMesh torus_mesh(double major, double minor, int n, int m) {
    TriangleMesh mesh;
    const auto id = [&](int i, int j) { return static_cast<Index>((i % n) * m + j % m); };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            const double u = 2.0 * std::numbers::pi * i / n, v = 2.0 * std::numbers::pi * j / m;
            const double distance = major + minor * std::cos(v);
            mesh.vertices.push_back({distance * std::cos(u), distance * std::sin(u), minor * std::sin(v)});
            mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
            mesh.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
        }
    }
    return mesh;
}

/// What a polygon in the half-plane of (distance from the z axis, height) passes as it turns around that axis: `n`
/// corners around, sides of the polygon divided into pieces no longer than `length`. Counter-clockwise; two
/// neighbouring corners, the last and the first, may lie on the axis.
inline TriangleMesh revolved_mesh(const std::vector<std::array<double, 2>>& polygon, int n, double length) {
    std::vector<std::array<double, 2>> profile;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto& a = polygon[i];
        const auto& b = polygon[(i + 1) % polygon.size()];
        const bool is_on_axis = a[0] == 0.0 && b[0] == 0.0;
        const int parts =
            is_on_axis ? 1 : static_cast<int>(std::ceil(std::hypot(b[0] - a[0], b[1] - a[1]) / length - 1e-9));
        for (int k = 0; k < parts; ++k) {
            const double t = static_cast<double>(k) / parts;
            profile.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])});
        }
    }
    TriangleMesh mesh;
    std::vector<Index> first;
    for (const auto& [r, z] : profile) {
        first.push_back(static_cast<Index>(mesh.vertices.size()));
        for (int k = 0; k < (r == 0.0 ? 1 : n); ++k) {
            const double angle = 2.0 * std::numbers::pi * k / n;
            mesh.vertices.push_back({r * std::cos(angle), r * std::sin(angle), z});
        }
    }
    for (std::size_t i = 0; i < profile.size(); ++i) {
        const std::size_t j = (i + 1) % profile.size();
        const auto at = [&](std::size_t ring, int k) { return first[ring] + (profile[ring][0] == 0.0 ? 0 : k % n); };
        for (int k = 0; k < n; ++k) {
            if (profile[j][0] != 0.0) {
                mesh.triangles.push_back({at(i, k), at(j, k + 1), at(j, k)});
            }
            if (profile[i][0] != 0.0) {
                mesh.triangles.push_back({at(i, k), at(i, k + 1), at(j, k + 1)});
            }
        }
    }
    return mesh;
}

/// A prism over a polygon in the plane, counter-clockwise.
inline TriangleMesh prism(const std::vector<std::array<double, 2>>& polygon, double height) {
    TriangleMesh mesh;
    const auto n = static_cast<Index>(polygon.size());
    for (const double z : {0.0, height}) {
        for (const auto& [x, y] : polygon) {
            mesh.vertices.push_back({x, y, z});
        }
    }
    for (Index i = 0; i < n; ++i) {
        const Index next = (i + 1) % n;
        mesh.triangles.push_back({i, next, n + next});
        mesh.triangles.push_back({i, n + next, n + i});
    }
    std::vector<Index> cap(polygon.size());
    std::iota(cap.begin(), cap.end(), 0);
    std::vector<std::array<Index, 3>> triangles;
    triangulate(mesh.vertices, cap, triangles);
    for (const auto& [a, b, c] : triangles) {
        mesh.triangles.push_back({a, c, b});
        mesh.triangles.push_back({n + a, n + b, n + c});
    }
    return mesh;
}

using Segment = std::array<Point, 2>;

/// The edges of `prism`, those of corners that turn right (concave ones) left out.
inline std::vector<Segment> convex_edges(const std::vector<std::array<double, 2>>& polygon, double height) {
    std::vector<Segment> edges;
    const std::size_t n = polygon.size();
    for (std::size_t i = 0; i < n; ++i) {
        const auto& [px, py] = polygon[(i + n - 1) % n];
        const auto& [x, y] = polygon[i];
        const auto& [qx, qy] = polygon[(i + 1) % n];
        edges.push_back({Point{x, y, 0.0}, Point{qx, qy, 0.0}});
        edges.push_back({Point{x, y, height}, Point{qx, qy, height}});
        if ((x - px) * (qy - y) - (y - py) * (qx - x) > 0.0) {
            edges.push_back({Point{x, y, 0.0}, Point{x, y, height}});
        }
    }
    return edges;
}

inline bool is_in(const Point& p, const Point& low, const Point& high) {
    return p.x > low.x && p.y > low.y && p.z > low.z && p.x < high.x && p.y < high.y && p.z < high.z;
}

/// The boundary of those boxes of a grid that are solid. Neighbours must not meet in an edge or a corner alone.
inline TriangleMesh rectilinear(const std::array<std::vector<double>, 3>& planes,
                                const std::function<bool(const Point& middle)>& is_solid) {
    TriangleMesh mesh;
    std::map<std::array<int, 3>, Index> ids;
    const auto vertex = [&](const std::array<int, 3>& at) {
        const auto [it, is_new] = ids.emplace(at, static_cast<Index>(mesh.vertices.size()));
        if (is_new) {
            mesh.vertices.push_back({planes[0][at[0]], planes[1][at[1]], planes[2][at[2]]});
        }
        return it->second;
    };
    const auto is_solid_cell = [&](const std::array<int, 3>& cell) {
        Point middle;
        for (int k = 0; k < 3; ++k) {
            if (cell[k] < 0 || cell[k] + 1 >= static_cast<int>(planes[k].size())) {
                return false;
            }
            (k == 0 ? middle.x : k == 1 ? middle.y : middle.z) = 0.5 * (planes[k][cell[k]] + planes[k][cell[k] + 1]);
        }
        return is_solid(middle);
    };
    std::array<int, 3> cell{};
    for (cell[0] = 0; cell[0] + 1 < static_cast<int>(planes[0].size()); ++cell[0]) {
        for (cell[1] = 0; cell[1] + 1 < static_cast<int>(planes[1].size()); ++cell[1]) {
            for (cell[2] = 0; cell[2] + 1 < static_cast<int>(planes[2].size()); ++cell[2]) {
                for (int axis = 0; axis < 3 && is_solid_cell(cell); ++axis) {
                    for (const int side : {0, 1}) {
                        std::array<int, 3> neighbor = cell;
                        neighbor[axis] += side == 0 ? -1 : 1;
                        if (is_solid_cell(neighbor)) {
                            continue;
                        }
                        const auto corner = [&](int i, int j) {
                            std::array<int, 3> at = cell;
                            at[axis] += side;
                            at[(axis + 1) % 3] += i;
                            at[(axis + 2) % 3] += j;
                            return vertex(at);
                        };
                        const std::array quad{corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
                        mesh.triangles.push_back({quad[0], quad[side == 1 ? 1 : 2], quad[side == 1 ? 2 : 1]});
                        mesh.triangles.push_back({quad[0], quad[side == 1 ? 2 : 3], quad[side == 1 ? 3 : 2]});
                    }
                }
            }
        }
    }
    return mesh;
}

/// The same of boxes, each from a low corner to a high one, less others.
inline TriangleMesh blocks_mesh(const std::vector<std::array<Point, 2>>& boxes,
                                const std::vector<std::array<Point, 2>>& holes = {}) {
    std::array<std::vector<double>, 3> planes;
    for (const auto* list : {&boxes, &holes}) {
        for (const std::array<Point, 2>& box : *list) {
            for (const Point& p : box) {
                planes[0].push_back(p.x);
                planes[1].push_back(p.y);
                planes[2].push_back(p.z);
            }
        }
    }
    for (std::vector<double>& lines : planes) {
        std::ranges::sort(lines);
        lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    }
    return rectilinear(planes, [&](const Point& p) {
        const auto holds = [&](const std::array<Point, 2>& box) { return is_in(p, box[0], box[1]); };
        return std::ranges::any_of(boxes, holds) && std::ranges::none_of(holes, holds);
    });
}

inline TriangleMesh moved(TriangleMesh mesh, const Point& by, double scale = 1.0) {
    for (Point& p : mesh.vertices) {
        p = scale * p + by;
    }
    return mesh;
}

inline TriangleMesh inside_out(TriangleMesh mesh) {
    for (std::array<Index, 3>& t : mesh.triangles) {
        std::swap(t[1], t[2]);
    }
    return mesh;
}

inline TriangleMesh together(const std::vector<TriangleMesh>& parts) {
    TriangleMesh mesh;
    for (const TriangleMesh& part : parts) {
        const auto first = static_cast<Index>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
        for (const auto& [a, b, c] : part.triangles) {
            mesh.triangles.push_back({first + a, first + b, first + c});
        }
    }
    return mesh;
}

/// How often a closed mesh winds around a point: the solid angle of its triangles (A. van Oosterom, J. Strackee, "The
/// solid angle of a plane triangle", 1983).
inline int winding_by_solid_angle(const TriangleMesh& mesh, const Point& p) {
    double angle = 0.0;
    for (const auto& [i, j, k] : mesh.triangles) {
        const Point a = mesh.vertices[i] - p, b = mesh.vertices[j] - p, c = mesh.vertices[k] - p;
        const double la = norm(a), lb = norm(b), lc = norm(c);
        angle += 2.0 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return static_cast<int>(std::lround(angle / (4.0 * std::numbers::pi)));
}

}  // namespace scaleaxis::test
