// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "axis/edit/split_triangle.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/thickness.hpp"
#include "spatial/mesh_parts.hpp"
#include "uses/divided_edges.hpp"

namespace scaleaxis::inline v1 {
namespace {

// How far the boundary is from the middle of an edge, in lengths of the edge, for this to be the bulge of an arc: that
// of a cylinder with 39 edges around, whose volume 0.4 % are missing to.
constexpr double kLeastBulge = 0.02;

// Of a mesh with short edges. While it is made it takes 2 GB, and to measure it takes minutes.
constexpr int kMostTriangles = 20'000'000;

// The boundary of a mask is known to half a voxel, so that a wall of two voxels may be thinner or thicker by half.
constexpr double kResolvedVoxels = 2.0;
constexpr double kUnresolvedPart = 0.2;  // of the area: the rim of a plate ten times as wide as thick has 17 %

void check_values(const TriangleMesh& mesh, std::span<const double> values) {
    if (values.size() != mesh.vertices.size()) {
        throw UnusableInput("there are " + std::to_string(values.size()) + " values for " +
                            std::to_string(mesh.vertices.size()) + " vertices: one is needed for each");
    }
    check_triangles(mesh);
}

// The part of a triangle's area where a linear function is below a limit.
double part_below(std::array<double, 3> values, double limit) {
    std::ranges::sort(values);
    const auto& [a, b, c] = values;
    if (limit <= a) {
        return 0.0;
    }
    if (limit >= c) {
        return 1.0;
    }
    return limit <= b ? (limit - a) * (limit - a) / ((b - a) * (c - a))
                      : 1.0 - (c - limit) * (c - limit) / ((c - a) * (c - b));
}

}  // namespace

void divide(TriangleMesh& mesh, const std::vector<MeshEdge>& edges, const std::vector<Point>& points) {
    const auto first = static_cast<Index>(mesh.vertices.size());
    append(mesh.vertices, points);
    std::vector<std::array<Index, 3>> triangles;
    const auto place_of = [&](Index v) { return mesh.vertices[v]; };
    const auto add = [&](Index a, Index b, Index c) { triangles.push_back({a, b, c}); };
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        const auto middle_of = [&](int k) -> std::optional<Index> {
            const auto [a, b] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
            const auto found = std::ranges::lower_bound(edges, MeshEdge{a, b});
            if (found == edges.end() || *found != MeshEdge{a, b}) {
                return std::nullopt;
            }
            return first + static_cast<Index>(found - edges.begin());
        };
        if (!split_triangle(triangle, middle_of, place_of, add)) {
            triangles.push_back(triangle);
        }
    }
    mesh.triangles = std::move(triangles);
}

void halve(TriangleMesh& mesh, const std::vector<MeshEdge>& edges) {
    divide(mesh, edges, each_of<Point>(edges, [&](const MeshEdge& edge) {
               return midpoint(mesh.vertices[edge[0]], mesh.vertices[edge[1]]);
           }));
}

SurfaceValues surface_values(const TriangleMesh& mesh, std::span<const double> values) {
    check_values(mesh, values);
    SurfaceValues result;
    double square = 0.0;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        const double area = triangle_area(mesh, triangle);
        const double a = values[triangle[0]];
        const double b = values[triangle[1]];
        const double c = values[triangle[2]];
        result.area += area;
        result.mean += area * (a + b + c) / 3.0;
        square += area * (a * a + b * b + c * c + a * b + b * c + c * a) / 6.0;
    }
    if (result.area > 0.0) {
        result.mean /= result.area;
        result.deviation = std::sqrt(std::max(0.0, square / result.area - result.mean * result.mean));
    }
    if (!values.empty()) {
        const auto [min, max] = std::ranges::minmax_element(values);
        result.min = *min;
        result.max = *max;
        result.min_vertex = static_cast<Index>(min - values.begin());
        result.max_vertex = static_cast<Index>(std::ranges::max_element(values) - values.begin());
    }
    return result;
}

AreaHistogram area_histogram(const TriangleMesh& mesh, std::span<const double> values, Index bins) {
    require(bins >= 1, "a histogram has at least one bin");
    check_values(mesh, values);
    AreaHistogram histogram{0.0, std::vector<double>(static_cast<std::size_t>(bins), 0.0)};
    const double largest = values.empty() ? 0.0 : *std::ranges::max_element(values);
    histogram.width = largest / bins;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        const double area = triangle_area(mesh, triangle);
        for (const Index v : triangle) {
            const double bin = largest > 0.0 ? std::floor(bins * (values[v] / largest)) : 0.0;
            histogram.areas[static_cast<std::size_t>(std::clamp(bin, 0.0, bins - 1.0))] += area / 3.0;
        }
    }
    return histogram;
}

ThinRegions thin_regions(const TriangleMesh& mesh, std::span<const double> values, double limit) {
    check_values(mesh, values);
    DisjointSets pieces(mesh.vertices.size());
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const Index a = triangle[k];
            const Index b = triangle[(k + 1) % 3];
            if (values[a] < limit && values[b] < limit) {
                pieces.join(a, b);
            }
        }
    }
    ThinRegions result;
    std::vector<Index> numbers(mesh.vertices.size(), kNone);
    result.vertex_regions.assign(mesh.vertices.size(), kNone);
    for (Index v = 0; v < static_cast<Index>(mesh.vertices.size()); ++v) {
        if (!(values[v] < limit)) {
            continue;
        }
        Index& number = numbers[pieces.find(v)];
        if (number == kNone) {
            number = static_cast<Index>(result.regions.size());
            result.regions.push_back({0.0, values[v], v, 0});
        }
        ThinRegion& region = result.regions[number];
        ++region.vertices;
        if (values[v] < region.min) {
            region.min = values[v];
            region.min_vertex = v;
        }
        result.vertex_regions[v] = number;
    }
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        const auto below = std::ranges::find_if(triangle, [&](Index v) { return result.vertex_regions[v] != kNone; });
        if (below != triangle.end()) {  // of several they are in one piece
            result.regions[result.vertex_regions[*below]].area +=
                triangle_area(mesh, triangle) *
                part_below({values[triangle[0]], values[triangle[1]], values[triangle[2]]}, limit);
        }
    }
    const auto order = sorted_indices(result.regions.size(), [&](Index i) { return result.regions[i].min; });
    const std::vector<Index> places = places_in(order);
    result.regions = each_of<ThinRegion>(order, [&](Index i) { return result.regions[i]; });
    for (Index& region : result.vertex_regions) {
        region = region == kNone ? kNone : places[region];
    }
    return result;
}

std::optional<Diagnostic> unresolved_thickness(const TriangleMesh& surface, std::span<const double> thickness,
                                               const std::array<Point, 3>& steps) {
    check_values(surface, thickness);
    double all = 0.0;
    double unresolved = 0.0;
    double most_across = 0.0;
    Index thinnest = kNone;
    for (const auto& [a, b, c] : surface.triangles) {
        const Point& origin = surface.vertices[a];
        const Point normal = cross(surface.vertices[b] - origin, surface.vertices[c] - origin);
        const double area = norm(normal);
        all += area;
        double across = 0.0;  // twice the area times the length of a voxel
        for (const Point& step : steps) {
            across = std::max(across, std::abs(dot(step, normal)));
        }
        if ((thickness[a] + thickness[b] + thickness[c]) / 3.0 * area < kResolvedVoxels * across) {
            unresolved += area;
            most_across = std::max(most_across, across / area);
            for (const Index v : {a, b, c}) {
                thinnest = thinnest == kNone || thickness[v] < thickness[thinnest] ? v : thinnest;
            }
        }
    }
    if (!(unresolved > kUnresolvedPart * all)) {
        return std::nullopt;
    }
    Words text;
    text << "the solid is thinner than two voxels across at " << std::lround(100.0 * unresolved / all)
         << " % of its surface, as " << thickness[thinnest] << " at " << to_text(surface.vertices[thinnest])
         << ": the thickness of such parts is uncertain by the size of a voxel, which is " << most_across
         << " across them at most";
    return Diagnostic{"image.unresolved_thickness", text.str()};
}

TriangleMesh with_short_edges(TriangleMesh mesh, double length, const Execution& execution) {
    require(length > 0.0, "the length of edges must be positive");
    check_triangles(mesh);
    const auto require_few = [](double triangles) {
        require(triangles <= kMostTriangles, "edges so short take more than 2e7 triangles: choose a larger length");
    };
    double area = 0.0;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        area += triangle_area(mesh, triangle);
    }
    return in_arena(execution, [&] {
        while (true) {
            const std::vector<MeshEdge> edges = edges_of(mesh, [&](Index a, Index b) {
                return squared_distance(mesh.vertices[a], mesh.vertices[b]) > length * length;
            });
            if (edges.empty()) {
                return std::move(mesh);
            }
            // No triangle with such edges is larger than the equilateral one, and each edge that is halved makes one
            // more at least.
            require_few(area / (0.25 * std::numbers::sqrt3 * length * length));
            require_few(static_cast<double>(mesh.triangles.size() + edges.size()));
            stop_if_cancelled();
            halve(mesh, edges);
        }
    });
}

TriangleMesh with_bulging_edges(TriangleMesh mesh, const Solid& solid, const Execution& execution) {
    check_triangles(mesh);
    return in_arena(execution, [&] {
        std::vector<MeshEdge> edges = edges_of(mesh, [](Index, Index) { return true; });
        std::vector<Point> points(edges.size());
        std::vector<double> bounds(edges.size());
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const auto [a, b] = edges[i];
            points[i] = midpoint(mesh.vertices[a], mesh.vertices[b]);
            bounds[i] = 0.5 * distance(mesh.vertices[a], mesh.vertices[b]);  // the bulge of a half circle
        }
        std::vector<std::optional<Point>> nearest(edges.size());
        solid.nearest(points, bounds, nearest);
        std::size_t kept = 0;
        for (std::size_t i = 0; i < edges.size(); ++i) {
            if (nearest[i] && distance(*nearest[i], points[i]) > 2.0 * kLeastBulge * bounds[i]) {
                edges[kept] = edges[i];
                // On average over an arc a parabola lies two thirds of its height above the chord, two segments half.
                points[kept++] = points[i] + 4.0 / 3.0 * (*nearest[i] - points[i]);
            }
        }
        edges.resize(kept);
        points.resize(kept);
        divide(mesh, edges, points);
        return std::move(mesh);
    });
}

}  // namespace scaleaxis::inline v1
