// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "kernel/parallel.hpp"
#include "kernel/random.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/shape.hpp"
#include "shapes/bvh.hpp"
#include "shapes/mesh_orientation.hpp"
#include "shapes/part_winding.hpp"
#include "shapes/segment_crossing.hpp"
#include "shapes/self_intersections.hpp"
#include "shapes/triangle_edges.hpp"

namespace scaleaxis {
namespace {

// Candidates for each point that is needed in the end: more of them make the sample hardly denser.
constexpr double kSeedsPerDisk = 12.0;

// More vertices than this multiple of the candidates are of no use: a random part of them is taken.
constexpr double kMaxVertexShare = 1.0;

// How far from the surface the two sides of a point are looked at, in diagonals.
constexpr double kBeside = 1e-8;

double triangle_area(const TriangleMesh& mesh, const Triangle& t) {
    const Point& a = mesh.vertices[t[0]];
    return 0.5 * norm(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
}

// A point beyond the nearest side of the box, in a direction in which no edge of a usual mesh runs.
Point towards_nearest_side(const Box& box, const Point& p) {
    const std::array<double, 6> gaps{p.x - box.min.x, box.max.x - p.x, p.y - box.min.y,
                                     box.max.y - p.y, p.z - box.min.z, box.max.z - p.z};
    const auto nearest = std::min_element(gaps.begin(), gaps.end()) - gaps.begin();
    const double length = gaps[nearest] + 0.01 * box.diagonal();
    const double sign = nearest % 2 == 0 ? -1.0 : 1.0;
    const double tilt = 0.0137 * length;
    const double tilt_too = 0.0071 * length;
    switch (nearest / 2) {
        case 0:
            return p + Point{sign * length, tilt, tilt_too};
        case 1:
            return p + Point{tilt_too, sign * length, tilt};
        default:
            return p + Point{tilt, tilt_too, sign * length};
    }
}

class MeshShape : public Shape {
   public:
    MeshShape(TriangleMesh mesh, bool may_overlap, std::optional<Topology> topology)
        : bvh_(build_bvh(std::move(mesh))), topology_(topology) {
        for (const Point& p : bvh_.mesh.vertices) {
            box_.extend(p);
        }
        if (may_overlap) {
            find_hidden_triangles();
        }
        first_triangle_.assign(bvh_.mesh.vertices.size(), kNone);
        for (Index t = 0; t < static_cast<Index>(bvh_.mesh.triangles.size()); ++t) {
            for (const Index v : bvh_.mesh.triangles[t]) {
                if (first_triangle_[v] == kNone && !is_hidden(t)) {
                    first_triangle_[v] = t;
                }
            }
        }
    }

    Box bounds() const override { return box_; }

    bool inside(const Point& p) const override {
        if (!(p.x > box_.min.x && p.y > box_.min.y && p.z > box_.min.z && p.x < box_.max.x && p.y < box_.max.y &&
              p.z < box_.max.z)) {
            return false;
        }
        int winding = 0;
        for_each_crossing(p, towards_nearest_side(box_, p),
                          [&](Index, const SegmentCrossing& crossing) { winding += crossing.sign; });
        return winding != 0;
    }

    std::optional<Point> crossing(const Point& inside_end, const Point& outside_end,
                                  const Point& reference) const override {
        struct Step {
            double position;
            Index triangle;
            SegmentCrossing crossing;
        };
        // From outside to inside, so that the winding number is known to begin with 0. Nearly always there is one step.
        constexpr std::size_t kFew = 8;
        std::array<Step, kFew> few;
        std::vector<Step> many;
        std::size_t count = 0;
        for_each_crossing(outside_end, inside_end, [&](Index triangle, const SegmentCrossing& crossing) {
            const Step step{crossing.position, triangle, crossing};
            if (count < kFew) {
                few[count] = step;
            } else {
                if (count == kFew) {
                    many.assign(few.begin(), few.end());
                }
                many.push_back(step);
            }
            ++count;
        });
        Step* const steps = count <= kFew ? few.data() : many.data();
        std::sort(steps, steps + count, [](const Step& a, const Step& b) {
            return a.position != b.position ? a.position < b.position : a.triangle < b.triangle;
        });

        std::optional<Point> farthest;
        int winding = 0;
        int changes = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const bool was_inside = winding != 0;
            winding -= steps[i].crossing.sign;
            if (was_inside == (winding != 0)) {
                continue;
            }
            ++changes;
            const Point p = point_of(steps[i].triangle, steps[i].crossing);
            if (!farthest || squared_distance(p, reference) > squared_distance(*farthest, reference)) {
                farthest = p;
            }
        }
        return changes % 2 == 1 ? farthest : std::nullopt;
    }

    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        return kernel::in_arena(execution, [&] {
            const auto triangles = static_cast<Index>(bvh_.mesh.triangles.size());
            std::vector<double> areas(triangles);
            kernel::for_each_index(triangles, [&](Index t) {
                areas[t] = is_hidden(t) ? 0.0 : triangle_area(bvh_.mesh, bvh_.mesh.triangles[t]);
            });
            // Stratified: triangle t gets those of the equidistant marks that lie in its stretch of the total area.
            std::vector<double> sums(triangles + 1, 0.0);
            for (Index t = 0; t < triangles; ++t) {
                sums[t + 1] = sums[t] + areas[t];
            }
            const double wanted = kSeedsPerDisk * sums[triangles] / (spacing * spacing);
            const double density = sums[triangles] > 0.0 ? wanted / sums[triangles] : 0.0;
            const double vertex_share =
                std::min(1.0, kMaxVertexShare * wanted / static_cast<double>(bvh_.mesh.vertices.size()));
            return kernel::collect<std::vector<Point>>(triangles, [&](Index t, std::vector<Point>& out) {
                if (!is_hidden(t)) {
                    add_seeds(t, static_cast<std::int64_t>(std::ceil(sums[t] * density)),
                              static_cast<std::int64_t>(std::ceil(sums[t + 1] * density)), vertex_share, seed, out);
                }
            });
        });
    }

    std::optional<Topology> topology() const override { return topology_; }

   private:
    enum class Place : std::uint8_t { kBoundary, kHidden, kMixed };

    template <class Visit>
    void for_each_crossing(const Point& a, const Point& b, const Visit& visit) const {
        const SegmentProbe probe(a, b);
        for_each_near_segment(bvh_, a, b, [&](Index t) {
            const Triangle& v = bvh_.mesh.triangles[t];
            const SegmentCrossing crossing =
                probe.crossing(bvh_.mesh.vertices[v[0]], bvh_.mesh.vertices[v[1]], bvh_.mesh.vertices[v[2]]);
            if (crossing.sign != 0) {
                visit(t, crossing);
            }
        });
    }

    Point point_of(Index triangle, const SegmentCrossing& crossing) const {
        const Triangle& v = bvh_.mesh.triangles[triangle];
        // The weights are as good as the triangle is; all corners are near each other, so the point is on it anyway.
        const Point& a = bvh_.mesh.vertices[v[0]];
        return a + crossing.weights[1] * (bvh_.mesh.vertices[v[1]] - a) +
               crossing.weights[2] * (bvh_.mesh.vertices[v[2]] - a);
    }

    bool is_hidden(Index triangle) const { return !places_.empty() && places_[triangle] == Place::kHidden; }

    // Is the solid on one side of this point of a triangle, and not on the other?
    bool is_on_boundary(Index triangle, const Point& p) const {
        const Triangle& v = bvh_.mesh.triangles[triangle];
        const Point& a = bvh_.mesh.vertices[v[0]];
        const Point normal = cross(bvh_.mesh.vertices[v[1]] - a, bvh_.mesh.vertices[v[2]] - a);
        const double length = norm(normal);
        if (!(length > 0.0)) {
            return false;
        }
        const Point step = (kBeside * box_.diagonal() / length) * normal;
        return inside(p - step) != inside(p + step);
    }

    // Components that overlap or lie in one another have parts inside the solid, which are no part of its boundary. A
    // triangle that meets no other one is so as a whole.
    void find_hidden_triangles() {
        const SelfIntersections cuts = self_intersections(bvh_);
        std::vector<Place> places(bvh_.mesh.triangles.size());
        kernel::for_each_index(places.size(), [&](std::size_t t) {
            const Triangle& v = bvh_.mesh.triangles[t];
            const Point center =
                (1.0 / 3.0) * (bvh_.mesh.vertices[v[0]] + bvh_.mesh.vertices[v[1]] + bvh_.mesh.vertices[v[2]]);
            places[t] = cuts.is_cut[t] != 0                             ? Place::kMixed
                        : is_on_boundary(static_cast<Index>(t), center) ? Place::kBoundary
                                                                        : Place::kHidden;
        });
        places_ = std::move(places);
    }

    // Points `begin` to `end` of the whole lie in this triangle; and each of its corners with some probability.
    void add_seeds(Index t, std::int64_t begin, std::int64_t end, double vertex_share, std::uint64_t seed,
                   std::vector<Point>& out) const {
        const Triangle& v = bvh_.mesh.triangles[t];
        const Point& a = bvh_.mesh.vertices[v[0]];
        const Point ab = bvh_.mesh.vertices[v[1]] - a;
        const Point ac = bvh_.mesh.vertices[v[2]] - a;
        const auto add = [&](const Point& p) {
            if (places_.empty() || places_[t] == Place::kBoundary || is_on_boundary(t, p)) {
                out.push_back(p);
            }
        };
        for (std::int64_t k = begin; k < end; ++k) {
            double x = kernel::random_unit(seed, static_cast<std::uint64_t>(k), 0);
            double y = kernel::random_unit(seed, static_cast<std::uint64_t>(k), 1);
            if (x + y > 1.0) {
                x = 1.0 - x;
                y = 1.0 - y;
            }
            add(a + x * ab + y * ac);
        }
        for (const Index corner : v) {
            if (first_triangle_[corner] == t &&
                kernel::random_unit(seed, static_cast<std::uint64_t>(corner), 2) < vertex_share) {
                add(bvh_.mesh.vertices[corner]);
            }
        }
    }

    Bvh bvh_;
    Box box_;
    std::optional<Topology> topology_;
    std::vector<Place> places_;          // of the triangles; empty: all are boundary
    std::vector<Index> first_triangle_;  // at each vertex, of those on the boundary
};

// The solid that disjoint closed surfaces bound. A component is a part of its boundary if the solid lies on one side of
// it alone, an outer one if that is the inner side, a cavity otherwise. Half the Euler characteristic of the boundary
// is that of the solid.
Topology solid_topology(const TriangleMesh& mesh, const Orientation& orientation) {
    std::vector<std::int64_t> faces(orientation.components);
    std::vector<std::int64_t> vertices(orientation.components);
    std::vector<WindingQuery> queries(orientation.components);
    std::vector<bool> is_counted(mesh.vertices.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Index c = orientation.component[t];
        ++faces[c];
        for (const Index v : mesh.triangles[t]) {
            if (!is_counted[v]) {
                is_counted[v] = true;
                ++vertices[c];
                queries[c] = {mesh.vertices[v], c};
            }
        }
    }
    const std::vector<int> windings = winding_numbers(mesh, orientation.component, queries);
    const std::vector<double> volumes = component_volumes(mesh, orientation);
    Topology topology;
    topology.voids = 0;
    std::int64_t boundary_euler = 0;
    for (Index c = 0; c < orientation.components; ++c) {
        const bool is_solid_outside = windings[c] != 0;
        const bool is_solid_inside = windings[c] + (volumes[c] > 0.0 ? 1 : -1) != 0;
        if (is_solid_outside == is_solid_inside) {
            continue;
        }
        ++(is_solid_inside ? topology.components : *topology.voids);
        boundary_euler += vertices[c] - faces[c] / 2;  // three edges for every two faces
    }
    topology.euler = boundary_euler / 2;
    topology.tunnels = topology.components + *topology.voids - topology.euler;
    return topology;
}

}  // namespace

std::unique_ptr<Shape> mesh_shape(RepairedMesh repaired, const Execution& execution) {
    if (!repaired.report.fault.empty()) {
        throw UnusableShape(repaired.report.fault);
    }
    return kernel::in_arena(execution, [&]() -> std::unique_ptr<Shape> {
        TriangleMesh& mesh = repaired.mesh;
        const bool is_cut = repaired.report.self_intersections > 0;
        const Orientation orientation =
            orient(mesh.triangles, opposite_sides(sides_of_edges(mesh.triangles, mesh.vertices.size())));
        std::optional<Topology> topology;
        if (!is_cut) {
            topology = solid_topology(mesh, orientation);
        }
        return std::make_unique<MeshShape>(std::move(mesh), is_cut || orientation.components > 1, topology);
    });
}

std::unique_ptr<Shape> mesh_shape(TriangleMesh mesh, const Execution& execution) {
    return mesh_shape(repair(std::move(mesh), execution), execution);
}

}  // namespace scaleaxis
