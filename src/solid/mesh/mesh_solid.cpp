// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "base/angles.hpp"
#include "base/built_once.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "base/random.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/solid.hpp"
#include "solid/mesh/boundary_part.hpp"
#include "solid/mesh/repair/patches.hpp"
#include "solid/mesh/segment_crossing.hpp"
#include "solid/mesh/self_intersections.hpp"
#include "solid/mesh/triangle_edges.hpp"
#include "solid/mesh/winding.hpp"
#include "solid/pointwise_solid.hpp"
#include "solid/seeds.hpp"
#include "spatial/extent.hpp"
#include "spatial/mesh_parts.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Candidates for each square of the spacing: enough for a maximal Poisson-disk sample to leave no gaps.
constexpr double kSeedsPerSquare = 9.0;

// Vertices of each component that are seeds in any case.
constexpr Index kLandmarks = 20;

// Of the cosine of an angle between normals, whatever their rounding.
constexpr double kCosineRounding = 1e-12;

/// The first vertices of each component, ascending.
std::vector<Index> find_landmarks(const Patches& components) {
    std::vector<Index> landmarks;
    std::vector<Index> counts(components.patches.size());
    for (std::size_t v = 0; v < components.of_vertex.size(); ++v) {
        const Index component = components.of_vertex[v];
        if (component != kNone && counts[component]++ < kLandmarks) {
            landmarks.push_back(static_cast<Index>(v));
        }
    }
    return landmarks;
}

/// What of the surface bounds the solid.
struct Boundary {
    std::vector<Index> landmarks;
    std::optional<Topology> topology;
    bool is_whole_surface = false;  ///< all of it bounds the solid; then what follows is left out

    Patches patches;
    double gap = 0.0;                       ///< between walls that touch, at most
    std::vector<std::uint8_t> is_cut;       ///< #F: does another triangle meet or touch it? empty: none does
    std::vector<Index> triangle_of_vertex;  ///< #V: one of its triangles
};

Boundary find_boundary(const Bvh& bvh, const Box& box, const MeshReport& report) {
    Boundary boundary;
    const Patches components = find_patches(bvh, box, {});
    boundary.landmarks = find_landmarks(components);
    // Whether exact arithmetic finds a gap or an intersection between walls that touch askew to the axes is chance.
    const bool has_parts =
        components.patches.size() > 1 || report.self_intersections > 0 || report.non_manifold_edges > 0;
    Contacts contacts = has_parts ? find_contacts(bvh, box) : Contacts{};
    const bool meets_itself = report.self_intersections > 0 || !contacts.is_touching.empty();
    if (!meets_itself) {
        const auto bounds_solid = [](const Patch& component) { return is_boundary(component.winding_outside); };
        boundary.topology = solid_topology(components.patches);
        boundary.is_whole_surface = std::all_of(components.patches.begin(), components.patches.end(), bounds_solid);
    }
    if (boundary.is_whole_surface) {
        return boundary;
    }
    if (meets_itself) {
        boundary.gap = contacts.gap;
        boundary.is_cut = std::move(contacts.is_touching);
        const std::vector<std::uint8_t> is_crossed = self_intersections(bvh).is_cut;
        boundary.is_cut.resize(is_crossed.size());
        std::ranges::transform(is_crossed, boundary.is_cut, boundary.is_cut.begin(), std::bit_or<>());
    }
    boundary.patches = find_patches(bvh, box, boundary.is_cut);
    boundary.triangle_of_vertex.resize(bvh.mesh.vertices.size());
    for (std::size_t t = 0; t < bvh.mesh.triangles.size(); ++t) {
        for (const Index v : bvh.mesh.triangles[t]) {
            boundary.triangle_of_vertex[v] = static_cast<Index>(t);
        }
    }
    return boundary;
}

/// A place where a segment crosses the surface.
struct Hit {
    double position = 0.0;
    int sign = 0;
    Point point;
    double across = 0.0;  ///< how much of the segment may lie between walls that touch here
};

/// The places where a segment enters or leaves the solid, out of all where it crosses the surface.
std::vector<Hit> boundary_hits(std::vector<Hit> hits, int winding_at_end) {
    std::stable_sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.position > b.position; });
    std::vector<Hit> result;
    int winding = winding_at_end;
    for (std::size_t i = 0; i < hits.size();) {
        const Hit& first = hits[i];
        const int before = winding;
        for (; i < hits.size() && first.position - hits[i].position <= std::max(kSamePlace, first.across); ++i) {
            winding += hits[i].sign;
        }
        if ((before == 0) != (winding == 0)) {
            result.push_back(first);
        }
    }
    return result;
}

/// The area of each triangle and all before it.
std::vector<double> running_areas(const TriangleMesh& mesh) {
    std::vector<double> areas;
    areas.reserve(mesh.triangles.size());
    double sum = 0.0;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        sum += triangle_area(mesh, triangle);
        areas.push_back(sum);
    }
    return areas;
}

/// What the search for the nearest point of the boundary needs.
struct NearestSearch {
    TriangleBounds bounds;
    // Where the boundary is not the whole surface:
    std::vector<Share> shares;  ///< #F
    Bvh borders;                ///< of the part that is the boundary; without nodes if there are none
    TriangleBounds border_bounds;
};

/// So far beside a place, as a part of the size, another one tells what is there. Far more than rounding.
constexpr double kAside = 1e-6;

class MeshSolid final : public PointwiseSolid {
   public:
    MeshSolid(TriangleMesh mesh, const MeshReport& report)
        : bvh_(build_bvh(std::move(mesh))),
          box_(box_around(bvh_.mesh.vertices)),
          boundary_(find_boundary(bvh_, box_, report)),
          warnings_(report.warnings()) {}

    Box bounds() const override { return box_; }

    using PointwiseSolid::inside;

    void inside(std::span<const Point> points, std::span<std::uint8_t> sides) const override {
        std::vector<int> windings(points.size());
        winding_numbers(bvh_, box_, points, windings);
        std::ranges::transform(windings, sides.begin(), [](int winding) { return winding != 0 ? 1 : 0; });
    }

    bool is_inside(const Point& p) const override { return winding_number(bvh_, box_, p) != 0; }

    std::optional<Point> crossing_of(const Point& inside_end, const Point& outside_end,
                                     const Point& reference) const override {
        std::vector<Hit> hits;
        for_each_crossing(bvh_, inside_end, outside_end, [&](Index t, const SegmentCrossing& crossing) {
            const auto& [u, v, w] = bvh_.mesh.triangles[t];
            const std::vector<Point>& p = bvh_.mesh.vertices;
            hits.push_back({crossing.position, crossing.sign,
                            crossing.weights[0] * p[u] + crossing.weights[1] * p[v] + crossing.weights[2] * p[w],
                            way_across(t, outside_end - inside_end)});
        });
        if (!boundary_.is_whole_surface) {
            hits = boundary_hits(std::move(hits), winding_number(bvh_, box_, outside_end));
        }
        if (hits.size() % 2 == 0) {
            return std::nullopt;
        }
        return std::max_element(hits.begin(), hits.end(),
                                [&](const Hit& a, const Hit& b) {
                                    return squared_distance(a.point, reference) < squared_distance(b.point, reference);
                                })
            ->point;
    }

    void prepare() const override { search(); }

    void find(std::span<const Point> points, std::span<const double> bounds,
              std::span<std::optional<Point>> nearest) const override {
        const NearestSearch& search = this->search();
        if (!boundary_.is_whole_surface) {
            PointwiseSolid::find(points, bounds, nearest);
            return;
        }
        NearestTriangles ask(bvh_, search.bounds);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const NearTriangle found = ask(points[i], bounds[i]);
            nearest[i] = found.triangle != kNone ? std::optional(found.point) : std::nullopt;
        }
    }

    /// Exact to rounding where the boundary is the whole surface. Otherwise triangles that others cut are divided with
    /// rounding, and points of the surface within 10⁻⁶ of the box of where it bounds the solid may count.
    std::optional<Point> nearest_to(const Point& p, double bound) const override {
        const NearestSearch& search = this->search();
        if (boundary_.is_whole_surface) {
            const NearTriangle found = nearest_triangle(bvh_, search.bounds, p, bound);
            return found.triangle != kNone ? std::optional(found.point) : std::nullopt;
        }
        NearTriangle border;
        if (!search.borders.nodes.empty()) {
            border = nearest_triangle(search.borders, search.border_bounds, p, bound);
        }
        const double least = border.triangle != kNone ? std::sqrt(border.squared_distance) : bound;
        const NearTriangle found = nearest_triangle(bvh_, search.bounds, p, least, [&](Index t, const Point& q) {
            return search.shares[t] == Share::kAll || bounds_near(t, q);
        });
        if (found.triangle != kNone) {
            return found.point;
        }
        return border.triangle != kNone ? std::optional(border.point) : std::nullopt;
    }

    std::optional<std::vector<SharpEdge>> sharp_edges(double angle) const override {
        const double most_cosine = cosine_of_degrees(angle);
        const std::vector<Point>& points = bvh_.mesh.vertices;
        const auto normal_of = [&](const Triangle& t) {
            return unit(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
        };
        const std::vector<Triangle> triangles = triangles_at_ridges(normal_of, angle);
        const auto normals = each_of<Point>(triangles, normal_of);
        const std::vector<Index> opposite = opposite_sides(sides_of_edges(triangles, points.size()));
        std::vector<SharpEdge> edges;
        for (Index side = 0; side < static_cast<Index>(opposite.size()); ++side) {
            if (opposite[side] < side) {
                continue;
            }
            const Point& start = points[start_of(triangles, side)];
            const Point& n = normals[side / 3];
            const Point& m = normals[opposite[side] / 3];
            if (dot(n, m) > most_cosine) {
                continue;
            }
            const bool is_convex = dot(n, points[apex_of(triangles, opposite[side])] - start) < 0.0;
            if (is_convex) {
                append_on_boundary({{start, points[end_of(triangles, side)]}, {n, m}}, edges);
            }
        }
        return edges;
    }

    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        return in_arena(execution, [&] {
            const std::vector<double> areas = running_areas(bvh_.mesh);
            const double wanted = std::ceil(kSeedsPerSquare * areas.back() / (spacing * spacing));
            check_number_of_seeds(wanted);
            const double vertices = static_cast<double>(bvh_.mesh.vertices.size());
            std::vector<Point> points = vertex_seeds(std::min(1.0, wanted / vertices), seed);
            append(points,
                   area_seeds(areas, static_cast<std::size_t>(std::max(wanted - vertices, 0.5 * wanted)), mixed(seed)));
            return points;
        });
    }

    std::optional<Topology> topology() const override { return boundary_.topology; }

    std::vector<Diagnostic> warnings() const override { return warnings_; }

   private:
    /// How much of a segment may lie between triangle `t` and one that touches it; twice that for rounding.
    double way_across(Index t, const Point& segment) const {
        if (!(boundary_.gap > 0.0) || boundary_.is_cut[t] == 0) {
            return 0.0;
        }
        constexpr double kLeastCosine = 1e-3;  // flatter segments end before they get across
        const auto& [u, v, w] = bvh_.mesh.triangles[t];
        const std::vector<Point>& p = bvh_.mesh.vertices;
        const double cosine = std::abs(dot(unit(segment), unit(cross(p[v] - p[u], p[w] - p[u]))));
        return 2.0 * boundary_.gap / (norm(segment) * std::max(cosine, kLeastCosine));
    }

    /// Appends what of a convex edge is an edge of the solid: where parts overlap or touch, there may be solid beyond
    /// it, or beyond one of its sides.
    void append_on_boundary(const SharpEdge& edge, std::vector<SharpEdge>& edges) const {
        if (boundary_.is_whole_surface) {
            edges.push_back(edge);
            return;
        }
        const Point start = edge.ends[0];
        const Point end = edge.ends[1];
        const auto& [n, m] = edge.normals;
        // Ahead of the edge, and above both sides.
        std::array<Point, 3> aside{unit(n + m), n - unit(m - dot(m, n) * n), m - unit(n - dot(m, n) * m)};
        std::vector<double> positions{0.0, 1.0};
        for (Point& way : aside) {
            way = (kAside * box_.diagonal() + 2.0 * boundary_.gap) * way;
            for_each_crossing(bvh_, start + way, end + way,
                              [&](Index, const SegmentCrossing& crossing) { positions.push_back(crossing.position); });
        }
        std::ranges::sort(positions);
        const auto at = [&](double position) { return start + position * (end - start); };
        bool goes_on = false;
        for (std::size_t i = 0; i + 1 < positions.size(); ++i) {
            if (positions[i + 1] - positions[i] <= kAside) {
                continue;
            }
            const Point middle = at(0.5 * (positions[i] + positions[i + 1]));
            const bool is_edge = std::ranges::all_of(
                aside, [&](const Point& way) { return winding_number(bvh_, box_, middle + way) == 0; });
            if (is_edge && goes_on) {
                edges.back().ends[1] = at(positions[i + 1]);
            } else if (is_edge) {
                edges.push_back({{at(positions[i]), at(positions[i + 1])}, edge.normals});
            }
            goes_on = is_edge;
        }
    }

    /// The triangles that have all edges this sharp as sides, and others: those with two corners around which the
    /// surface turns by half the angle or more from the normal of the first triangle there.
    template <class NormalOf>
    std::vector<Triangle> triangles_at_ridges(const NormalOf& normal_of, double angle) const {
        const std::vector<Triangle>& all = bvh_.mesh.triangles;
        const double least_cosine = cosine_of_degrees(0.5 * angle) + kCosineRounding;
        const auto normals = mapped<Point>(all.size(), [&](std::size_t t) { return normal_of(all[t]); });
        std::vector<Index> first(bvh_.mesh.vertices.size(), kNone);
        std::vector<std::uint8_t> turns(first.size());
        for (std::size_t t = 0; t < all.size(); ++t) {
            for (const Index v : all[t]) {
                first[v] = first[v] == kNone ? static_cast<Index>(t) : first[v];
                turns[v] = turns[v] != 0 || dot(normals[t], normals[first[v]]) < least_cosine ? 1 : 0;
            }
        }
        std::vector<Triangle> result;
        std::ranges::copy_if(all, std::back_inserter(result),
                             [&](const Triangle& t) { return turns[t[0]] + turns[t[1]] + turns[t[2]] > 1; });
        return result;
    }

    /// Does triangle `t` bound the solid at its point `p`?
    bool is_on_boundary(Index t, const Point& p) const {
        if (boundary_.is_whole_surface) {
            return true;
        }
        if (boundary_.is_cut.empty() || boundary_.is_cut[t] == 0) {
            const Index patch = boundary_.patches.of_vertex[bvh_.mesh.triangles[t][0]];
            return is_boundary(boundary_.patches.patches[patch].winding_outside);
        }
        return is_boundary_at(bvh_, box_, t, p, boundary_.gap);
    }

    /// The same at a point nearby that is not on a side of the triangle.
    bool bounds_near(Index t, const Point& p) const {
        const auto& [u, v, w] = bvh_.mesh.triangles[t];
        const std::vector<Point>& x = bvh_.mesh.vertices;
        return is_on_boundary(t, (1.0 - kAside) * p + (kAside / 3.0) * (x[u] + x[v] + x[w]));
    }

    const NearestSearch& search() const {
        return search_.get([&] {
            NearestSearch search;
            if (boundary_.is_whole_surface) {
                search.bounds = triangle_bounds(bvh_);
            } else {
                BoundaryPart part = boundary_part(bvh_, box_, boundary_.is_cut, boundary_.gap, boundary_.patches);
                search.shares = std::move(part.shares);
                // Where parts touch, hundreds of triangles may lie nearer than the boundary does.
                search.bounds = triangle_bounds(bvh_, mapped<std::uint8_t>(search.shares.size(), [&](std::size_t t) {
                                                    return search.shares[t] != Share::kNothing ? 1 : 0;
                                                }));
                if (!part.borders.triangles.empty()) {
                    search.borders = build_bvh(std::move(part.borders));
                    search.border_bounds = triangle_bounds(search.borders);
                }
            }
            return search;
        });
    }

    bool is_on_boundary(Index vertex) const {
        if (boundary_.is_whole_surface) {
            return true;
        }
        if (const Index patch = boundary_.patches.of_vertex[vertex]; patch != kNone) {
            return is_boundary(boundary_.patches.patches[patch].winding_outside);
        }
        // All around it is cut. Then the answer is that for a point nearby.
        const Index t = boundary_.triangle_of_vertex[vertex];
        const auto& [u, v, w] = bvh_.mesh.triangles[t];
        const std::vector<Point>& p = bvh_.mesh.vertices;
        return is_on_boundary(t, 0.999 * p[vertex] + (0.001 / 3.0) * (p[u] + p[v] + p[w]));
    }

    /// Each vertex with the given probability.
    std::vector<Point> vertex_seeds(double probability, std::uint64_t seed) const {
        return collect<std::vector<Point>>(bvh_.mesh.vertices.size(), [&](std::size_t v, std::vector<Point>& out) {
            const auto vertex = static_cast<Index>(v);
            const bool is_chosen = random_unit(seed, v) < probability ||
                                   std::binary_search(boundary_.landmarks.begin(), boundary_.landmarks.end(), vertex);
            if (is_chosen && is_on_boundary(vertex)) {
                out.push_back(bvh_.mesh.vertices[v]);
            }
        });
    }

    /// Random points, one in each of `count` equal parts of the area.
    std::vector<Point> area_seeds(const std::vector<double>& areas, std::size_t count, std::uint64_t seed) const {
        constexpr std::size_t kChunk = 4096;
        return collect<std::vector<Point>>(
            (count + kChunk - 1) / kChunk,
            [&](std::size_t chunk, std::vector<Point>& out) {
                const std::size_t begin = chunk * kChunk;
                const auto area_before = [&](std::size_t i) {
                    return areas.back() / static_cast<double>(count) *
                           (static_cast<double>(i) + random_unit(seed, i, 0));
                };
                std::size_t t = std::upper_bound(areas.begin(), areas.end() - 1, area_before(begin)) - areas.begin();
                for (std::size_t i = begin; i < std::min(count, begin + kChunk); ++i) {
                    for (const double area = area_before(i); t + 1 < areas.size() && areas[t] <= area;) {
                        ++t;
                    }
                    const auto& [u, v, w] = bvh_.mesh.triangles[t];
                    const Point p =
                        point_of_triangle(bvh_.mesh.vertices[u], bvh_.mesh.vertices[v], bvh_.mesh.vertices[w],
                                          random_unit(seed, i, 1), random_unit(seed, i, 2));
                    if (is_on_boundary(static_cast<Index>(t), p)) {
                        out.push_back(p);
                    }
                }
            },
            std::size_t{1});
    }

    Bvh bvh_;
    Box box_;
    Boundary boundary_;
    std::vector<Diagnostic> warnings_;
    BuiltOnce<NearestSearch> search_;
};

}  // namespace

std::unique_ptr<Solid> mesh_solid(RepairedMesh mesh, const Execution& execution) {
    if (!mesh.report.fault.empty()) {
        throw UnusableInput(mesh.report.fault);
    }
    if (mesh.mesh.triangles.empty()) {
        throw UnusableInput("the mesh has no triangles");
    }
    return in_arena(execution, [&] {
        report(execution, "search tree", 0.0);
        auto solid = std::make_unique<MeshSolid>(std::move(mesh.mesh), mesh.report);
        report(execution, "search tree", 1.0);
        return solid;
    });
}

std::unique_ptr<Solid> mesh_solid(TriangleMesh mesh, const Execution& execution) {
    return mesh_solid(repair(std::move(mesh), part_of(execution, 0.0, 0.9)), part_of(execution, 0.9, 1.0));
}

std::unique_ptr<Solid> mesh_solid(const MeshView& mesh, const Execution& execution) {
    return mesh_solid(repair(mesh, part_of(execution, 0.0, 0.9)), part_of(execution, 0.9, 1.0));
}

}  // namespace scaleaxis::inline v1
