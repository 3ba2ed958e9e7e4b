// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/shells.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>
#include <span>
#include <tuple>
#include <utility>

#include "axis/complex.hpp"
#include "axis/envelope_data.hpp"
#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "solid/mesh/triangle_edges.hpp"
#include "spatial/mesh_parts.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/point_tree.hpp"
#include "uses/ascent.hpp"
#include "uses/boundary_ahead.hpp"
#include "uses/shells/remeshing.hpp"
#include "uses/wide_parts.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Growth of the radius along the way that a draft angle of 10 degrees has, but hardly the balls in a bend.
constexpr double kDraft = 0.1;

using TriangleFlags = std::vector<std::uint8_t>;

struct Topside {
    Point place;
    Point normal;
    double thickness = 0.0;
};

Point area_vector_of(const TriangleMesh& mesh, std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return 0.5 * cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]);
}

Point centroid_of(const TriangleMesh& mesh, std::size_t t) {
    const auto& [a, b, c] = mesh.triangles[t];
    return (1.0 / 3.0) * (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]);
}

double thickness_of(const Midsurface& surface, std::size_t t) {
    const auto& [a, b, c] = surface.mesh.triangles[t];
    return (surface.thickness[a] + surface.thickness[b] + surface.thickness[c]) / 3.0;
}

// The midsurface and which triangles of it meet.
struct Neighbourhood {
    IndexLists sides;              // of edges
    std::vector<Index> opposites;  // of sides

    explicit Neighbourhood(const TriangleMesh& mesh)
        : sides(sides_of_edges(mesh.triangles, mesh.vertices.size())), opposites(opposite_sides(sides)) {}
};

// Vertices so near to a seam that their balls may be larger than the wall is thick: balls that touch more than two
// sides. Around a seam these are the balls with a contact in a re-entrant edge, which the ball of the seam touches, so
// that they are less than its radius away.
TriangleFlags near_seams(const Midsurface& surface, const Neighbourhood& neighbours) {
    const std::vector<Point>& places = surface.mesh.vertices;
    std::vector<std::array<Index, 2>> edges;
    TriangleFlags is_near(places.size());
    std::vector<Index> seam;
    for (std::size_t e = 0; e < neighbours.sides.size(); ++e) {
        const Index side = neighbours.sides[e].front();
        const std::array<Index, 2> ends{start_of(surface.mesh.triangles, side), end_of(surface.mesh.triangles, side)};
        edges.push_back(ends);
        if (neighbours.sides[e].size() > 2) {
            seam.insert(seam.end(), ends.begin(), ends.end());
        }
    }
    const IndexLists at = grouped_both_ways(places.size(), edges);
    sort_unique(seam);
    std::vector<Index> last(places.size(), kNone);  // seam vertex from which it was reached
    std::vector<Index> next;
    for (const Index start : seam) {
        const double reach = (1.0 + kRadiusError) * 0.5 * surface.thickness[start];
        next = {start};
        last[start] = start;
        while (!next.empty()) {
            const Index v = next.back();
            next.pop_back();
            is_near[v] = 1;
            for (const Index w : at[v]) {
                if (last[w] != start && distance(places[w], places[start]) < reach) {
                    last[w] = start;
                    next.push_back(w);
                }
            }
        }
    }
    return is_near;
}

// Parts of these triangles that hang together, and are wide enough if they have to: the part of each triangle, or
// `kNone`.
std::vector<Index> parts_in(const Midsurface& surface, const Neighbourhood& neighbours, const TriangleFlags& counts,
                            bool are_wide) {
    const TriangleMesh& mesh = surface.mesh;
    SurfaceParts found = parts_of_faces(
        counts, [&](Index t) { return triangle_area(mesh, mesh.triangles[t]); },
        [&](Index t) {
            return Ball{centroid_of(mesh, t), 0.5 * thickness_of(surface, t)};
        },
        [&](Index t, const auto& use) {
            for (Index k = 0; k < 3; ++k) {
                const Index side = neighbours.opposites[3 * t + k];
                const std::array<Index, 3>& corners = mesh.triangles[t];
                use(side == kNone ? kNone : side / 3, mesh.vertices[corners[k]], mesh.vertices[corners[(k + 1) % 3]]);
            }
        });
    for (Index& part : found.numbers) {
        part = part != kNone && (!are_wide || found.parts[part].is_wide()) ? part : kNone;
    }
    return found.numbers;
}

// The parts of walls where balls are as large as the wall is thick. A sheet that has none, as a short one between two
// seams, is taken with the ends of its walls, or whole; one that tapers to an edge of the solid is taken whole, too: up
// to its seam it has no thickness but that of its balls.
std::vector<Index> known_parts(const Midsurface& surface, const Neighbourhood& neighbours) {
    const MedialComplex complex = complex_of(surface);
    const TriangleFlags is_steep = steep_vertices(complex, complex.edges, kDraft);
    const TriangleFlags is_near = near_seams(surface, neighbours);
    std::vector<Index> parts(surface.mesh.triangles.size(), kNone);
    TriangleFlags is_done(surface.sheets.size());
    const TriangleFlags is_wedge = each_of<std::uint8_t>(
        surface.sheets, [](const MidsurfaceSheet& sheet) { return sheet.min < kNearby * sheet.max ? 1 : 0; });
    for (int level = 0; level < 3; ++level) {
        const auto is_known = [&](Index v) {
            return (level > 0 || is_steep[v] == 0) && (level > 1 || is_near[v] == 0);
        };
        TriangleFlags counts(parts.size());
        for (std::size_t t = 0; t < parts.size(); ++t) {
            const Index sheet = surface.triangle_sheets[t];
            const bool is_asked = is_done[sheet] == 0 && (level != 1 || is_wedge[sheet] == 0);
            counts[t] = is_asked && std::ranges::all_of(surface.mesh.triangles[t], is_known) ? 1 : 0;
        }
        const std::vector<Index> found = parts_in(surface, neighbours, counts, level < 2);
        for (std::size_t t = 0; t < parts.size(); ++t) {
            if (found[t] != kNone) {
                parts[t] = found[t];
                is_done[surface.triangle_sheets[t]] = 1;
            }
        }
    }
    return parts;
}

// For each triangle the nearest one within its sheet that has a part.
std::vector<Index> nearest_known(const TriangleMesh& mesh, const Neighbourhood& neighbours,
                                 const std::vector<Index>& parts) {
    using Entry = std::tuple<double, Index, Index>;  // the way, the triangle, from where
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    std::vector<Index> sources(parts.size(), kNone);
    for (std::size_t t = 0; t < parts.size(); ++t) {
        if (parts[t] != kNone) {
            front.emplace(0.0, static_cast<Index>(t), static_cast<Index>(t));
        }
    }
    while (!front.empty()) {
        const auto [way, t, source] = front.top();
        front.pop();
        if (sources[t] != kNone) {
            continue;
        }
        sources[t] = source;
        for (int k = 0; k < 3; ++k) {
            const Index side = neighbours.opposites[3 * t + k];
            if (side != kNone && sources[side / 3] == kNone) {
                front.emplace(way + distance(centroid_of(mesh, t), centroid_of(mesh, side / 3)), side / 3, source);
            }
        }
    }
    return sources;
}

// The walls that triangles belong to: the nearest known part, and those that go on into each other without a bend.
std::vector<Index> walls_of(const TriangleMesh& mesh, const Neighbourhood& neighbours,
                            const std::vector<Index>& parts) {
    struct Meeting {
        double length = 0.0;
        double agreement = 0.0;  // length × cosine
    };
    const std::vector<Index> sources = nearest_known(mesh, neighbours, parts);
    std::map<std::array<Index, 2>, Meeting> meetings;
    for (std::size_t side = 0; side < neighbours.opposites.size(); ++side) {
        const Index other = neighbours.opposites[side];
        if (other == kNone || static_cast<Index>(side) > other) {
            continue;
        }
        const Index one = sources[side / 3];
        const Index two = sources[other / 3];
        if (parts[one] != parts[two]) {
            const auto [a, b] = std::minmax(parts[one], parts[two]);
            const double length = distance(mesh.vertices[start_of(mesh.triangles, static_cast<Index>(side))],
                                           mesh.vertices[end_of(mesh.triangles, static_cast<Index>(side))]);
            Meeting& meeting = meetings[{a, b}];
            meeting.length += length;
            meeting.agreement += length * dot(unit(area_vector_of(mesh, one)), unit(area_vector_of(mesh, two)));
        }
    }
    DisjointSets walls(mesh.triangles.size());
    for (const auto& [pair, meeting] : meetings) {
        if (meeting.agreement > kSameDirection * meeting.length) {
            walls.join(pair[0], pair[1]);
        }
    }
    std::vector<Index> result;
    std::map<Index, Index> numbers;
    for (const Index source : sources) {
        result.push_back(
            numbers.try_emplace(walls.find(parts[source]), static_cast<Index>(numbers.size())).first->second);
    }
    return result;
}

// The middle of one wall and its thickness, from its known parts.
class WallMiddle {
   public:
    WallMiddle(const Midsurface& surface, const std::vector<Index>& triangles) {
        TriangleMesh mesh{surface.mesh.vertices, {}};
        double area = 0.0;
        double volume = 0.0;
        Point sum;
        for (const Index t : triangles) {
            mesh.triangles.push_back(surface.mesh.triangles[t]);
            const double part = triangle_area(surface.mesh, surface.mesh.triangles[t]);
            area += part;
            volume += part * thickness_of(surface, t);
            sum = sum + part * centroid_of(surface.mesh, t);
            normal_ = normal_ + area_vector_of(surface.mesh, t);
        }
        thickness_ = volume / area;
        origin_ = (1.0 / area) * sum;
        find_plane(mesh);
        is_even_ = std::ranges::all_of(mesh.triangles, [&](const std::array<Index, 3>& triangle) {
            return std::ranges::all_of(triangle, [&](Index v) {
                return std::abs(surface.thickness[v] - thickness_) <= kSmallPart * thickness_;
            });
        });
        if (!is_flat_ || !is_even_) {
            bvh_ = build_bvh(std::move(mesh));
            bounds_ = triangle_bounds(*bvh_);
            for (const Index k : bvh_->order) {
                const auto& [a, b, c] = surface.mesh.triangles[triangles[k]];
                thicknesses_.push_back({surface.thickness[a], surface.thickness[b], surface.thickness[c]});
            }
            find_normals();
        }
    }

    Topside at(const Point& p) const {
        Topside result{p - dot(p - origin_, normal_) * normal_, normal_, thickness_};
        if (bvh_) {
            const NearTriangle near = nearest_triangle(*bvh_, bounds_, p);
            if (!is_flat_) {
                result.place = near.point;
                result.normal = normals_[near.triangle];
            }
            if (!is_even_) {
                result.thickness = thickness_at(near);
            }
        }
        return result;
    }

    bool is_even() const { return is_even_; }
    double thickness() const { return thickness_; }

   private:
    void find_plane(const TriangleMesh& mesh) {
        Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            for (const Index v : mesh.triangles[t]) {
                const Point p = mesh.vertices[v] - origin_;
                const Eigen::Vector3d d(p.x, p.y, p.z);
                spread += triangle_area(mesh, mesh.triangles[t]) * d * d.transpose();
            }
        }
        const Eigen::Vector3d least = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
        const Point normal{least.x(), least.y(), least.z()};
        normal_ = unit((dot(normal, normal_) < 0.0 ? -1.0 : 1.0) * normal);
        is_flat_ = std::ranges::all_of(mesh.triangles, [&](const std::array<Index, 3>& triangle) {
            return std::ranges::all_of(triangle, [&](Index v) {
                return std::abs(dot(mesh.vertices[v] - origin_, normal_)) <= kSmallPart * thickness_;
            });
        });
    }

    // Means over near triangles, but for slivers, whose normals say nothing: those of all that come near tell which
    // ones these are. At the rim of a curved wall means are one-sided, the less so the nearer the triangles are.
    void find_normals() {
        const TriangleMesh& mesh = bvh_->mesh;
        normals_.resize(mesh.triangles.size());
        for_each_index(
            normals_.size(),
            [&](std::size_t t) {
                const Point center = centroid_of(mesh, t);
                const double reach = kNearby * 0.5 * thickness_;
                Box box;
                box.extend(center - Point{reach, reach, reach});
                box.extend(center + Point{reach, reach, reach});
                Point around;
                for_each_near_box(*bvh_, box, [&](Index other) { around = around + area_vector_of(mesh, other); });
                around = unit(around);
                Point near;
                for_each_near_box(*bvh_, box, [&](Index other) {
                    const Point vector = area_vector_of(mesh, other);
                    if (distance(centroid_of(mesh, other), center) < reach &&
                        dot(vector, around) > kSameDirection * norm(vector)) {
                        near = near + vector;
                    }
                });
                normals_[t] = norm(near) > 0.0 ? unit(near) : around;
            },
            std::size_t{64});
    }

    double thickness_at(const NearTriangle& near) const {
        const auto& [a, b, c] = bvh_->mesh.triangles[near.triangle];
        const std::vector<Point>& x = bvh_->mesh.vertices;
        const std::array<double, 3> parts{norm(cross(x[b] - near.point, x[c] - near.point)),
                                          norm(cross(x[c] - near.point, x[a] - near.point)),
                                          norm(cross(x[a] - near.point, x[b] - near.point))};
        const double all = parts[0] + parts[1] + parts[2];
        const std::array<double, 3>& values = thicknesses_[near.triangle];
        return all > 0.0 ? std::inner_product(parts.begin(), parts.end(), values.begin(), 0.0) / all : values[0];
    }

    Point origin_;
    Point normal_;
    double thickness_ = 0.0;
    bool is_flat_ = false;
    bool is_even_ = false;
    std::optional<Bvh> bvh_;
    TriangleBounds bounds_;
    std::vector<Point> normals_;
    std::vector<std::array<double, 3>> thicknesses_;
};

// Where a wall ends: a point of the surface of the solid ahead of an edge of the border, and the normal there.
struct RimSample {
    Index wall = kNone;
    Point base;  // in the middle of the edge
    double length = 0.0;
    double radius = 0.0;  // of the wall
    Point place;
    Point normal;
};

std::vector<RimSample> rim_samples(const TriangleMesh& mesh, const std::vector<Index>& walls,
                                   const std::vector<WallMiddle>& middles, const Neighbourhood& neighbours,
                                   const DistanceInside& distance_inside) {
    return collect<std::vector<RimSample>>(
        neighbours.sides.size(),
        [&](std::size_t e, std::vector<RimSample>& out) {
            if (neighbours.sides[e].size() != 1) {
                return;
            }
            const Index side = neighbours.sides[e].front();
            const Point& a = mesh.vertices[start_of(mesh.triangles, side)];
            const Point& b = mesh.vertices[end_of(mesh.triangles, side)];
            RimSample sample{walls[side / 3], midpoint(a, b), distance(a, b), 0.0, {}, {}};
            const Topside middle = middles[sample.wall].at(sample.base);
            const Point from = sample.base - dot(sample.base - middle.place, middle.normal) * middle.normal;
            const Point direction = unit(cross(b - a, middle.normal));
            sample.radius = 0.5 * middle.thickness;
            const std::optional<double> way = way_to_boundary(from, direction, sample.radius, distance_inside);
            if (!way) {
                return;
            }
            sample.place = from + *way * direction;
            const Point inside = sample.place - kRadiusError * sample.radius * direction;
            const double step = 0.25 * kRadiusError * sample.radius;
            const auto slope = [&](const Point& axis) {
                return distance_inside(inside - step * axis) - distance_inside(inside + step * axis);
            };
            sample.normal = unit({slope({1.0, 0.0, 0.0}), slope({0.0, 1.0, 0.0}), slope({0.0, 0.0, 1.0})});
            if (dot(sample.normal, direction) > 0.0) {
                out.push_back(sample);
            }
        },
        std::size_t{16});
}

// The rims of the walls, each a side of the solid or a smooth series of them.
class Rims {
   public:
    Rims(std::vector<RimSample> samples, std::size_t walls) : samples_(std::move(samples)), of_walls_(walls) {
        label();
        std::vector<std::vector<Point>> looked_for(walls);
        std::vector<std::vector<Point>> places(count_);
        of_rims_.resize(count_);
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            if (labels_[i] == kNone) {
                continue;
            }
            const RimSample& sample = samples_[i];
            for (const Point& p : {sample.base, sample.place}) {
                looked_for[sample.wall].push_back(p);
                of_walls_[sample.wall].samples.push_back(static_cast<Index>(i));
            }
            places[labels_[i]].push_back(sample.place);
            of_rims_[labels_[i]].samples.push_back(static_cast<Index>(i));
        }
        for (std::size_t w = 0; w < walls; ++w) {
            of_walls_[w].build(looked_for[w]);
        }
        for (std::size_t r = 0; r < count_; ++r) {
            of_rims_[r].build(places[r]);
        }
    }

    Index at(Index wall, const Point& p) const {
        const Index sample = of_walls_[wall].nearest(p);
        return sample == kNone ? kNone : labels_[sample];
    }
    const RimSample& of(Index rim, const Point& p) const { return samples_[of_rims_[rim].nearest(p)]; }

   private:
    struct Lookup {
        std::vector<Index> samples;
        PointTree tree;

        void build(const std::vector<Point>& places) {
            if (!places.empty()) {
                tree = build_point_tree(places);
            }
        }
        Index nearest(const Point& p) const {
            return samples.empty() ? kNone : samples[tree.order[nearest_point(tree, p).position]];
        }
    };

    // Rims go on up to a thickness away where normals differ little; what is shorter than a radius is an error of
    // single normals. Around a re-entrant edge of the solid, as in the corner of a hole, normals turn from one side to
    // the other at one place: they are of no rim, which has some length.
    void label() {
        labels_.assign(samples_.size(), kNone);
        if (samples_.empty()) {
            return;
        }
        const auto places = each_of<Point>(samples_, &RimSample::place);
        const PointTree tree = build_point_tree(places);
        const auto for_each_beside = [&](Index i, const auto& use) {
            const RimSample& sample = samples_[i];
            for_each_point_near(tree, sample.place, 2.0 * sample.radius, [&](Index position, double) {
                const Index other = tree.order[position];
                if (samples_[other].wall == sample.wall &&
                    dot(samples_[other].normal, sample.normal) > kSameDirection) {
                    use(other);
                }
            });
        };
        const auto count = static_cast<Index>(samples_.size());
        const std::vector<std::uint8_t> has_length = mapped<std::uint8_t>(count, [&](Index i) {
            double most = 0.0;
            for_each_beside(
                i, [&](Index other) { most = std::max(most, distance(samples_[i].place, samples_[other].place)); });
            return most > kRadiusError * samples_[i].radius ? 1 : 0;
        });
        DisjointSets rims(samples_.size());
        for (Index i = 0; i < count; ++i) {
            for_each_beside(i, [&](Index other) {
                if (has_length[i] != 0 && has_length[other] != 0) {
                    rims.join(i, other);
                }
            });
        }
        std::vector<double> lengths(samples_.size());
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            lengths[rims.find(static_cast<Index>(i))] += samples_[i].length;
        }
        std::map<Index, Index> numbers;
        for (std::size_t i = 0; i < samples_.size(); ++i) {
            const Index rim = rims.find(static_cast<Index>(i));
            if (lengths[rim] >= samples_[i].radius) {
                labels_[i] = numbers.try_emplace(rim, static_cast<Index>(numbers.size())).first->second;
            }
        }
        count_ = numbers.size();
    }

    std::vector<RimSample> samples_;
    std::vector<Index> labels_;
    std::size_t count_ = 0;
    std::vector<Lookup> of_walls_;
    std::vector<Lookup> of_rims_;
};

struct Plane {
    Point place;
    Point normal;
};

// The nearest point that lies on all planes, as far as these differ in direction, which the eigenvalues tell: 1 -
// cosine of two planes. No farther than `most` away.
Point on_planes(const Point& p, std::span<const Plane> planes, double most) {
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Plane& plane : planes) {
        const Eigen::Vector3d n(plane.normal.x, plane.normal.y, plane.normal.z);
        squares += n * n.transpose();
        sum += dot(plane.normal, plane.place - p) * n;
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(squares);
    Eigen::Vector3d step = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
        if (eigen.eigenvalues()[k] > 1.0 - kSameDirection) {
            const Eigen::Vector3d axis = eigen.eigenvectors().col(k);
            step += axis.dot(sum) / eigen.eigenvalues()[k] * axis;
        }
    }
    const double length = step.norm();
    const Point way{step.x(), step.y(), step.z()};
    return p + (length > most ? most / length : 1.0) * way;
}

// Sheets by area, and the lengths and angles.
void measure(ShellMesh& shells, const Neighbourhood& neighbours) {
    const TriangleMesh& mesh = shells.mesh;
    shells.least_angle = 180.0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const double area = triangle_area(mesh, mesh.triangles[t]);
        const std::array<double, 3>& values = shells.thickness[t];
        const auto [least, most] = std::ranges::minmax(values);
        MidsurfaceSheet& sheet = shells.sheets[shells.triangle_sheets[t]];
        sheet.min = sheet.max == 0.0 ? least : std::min(sheet.min, least);
        sheet.max = std::max(sheet.max, most);
        sheet.mean += area * (values[0] + values[1] + values[2]) / 3.0;
        sheet.area += area;
        for (int k = 0; k < 3; ++k) {
            const Point& p = mesh.vertices[mesh.triangles[t][k]];
            const Point u = mesh.vertices[mesh.triangles[t][(k + 1) % 3]] - p;
            const Point w = mesh.vertices[mesh.triangles[t][(k + 2) % 3]] - p;
            shells.least_angle = std::min(shells.least_angle, angle_of(u, w) / kDegree);
        }
    }
    for (MidsurfaceSheet& sheet : shells.sheets) {
        sheet.mean = sheet.area > 0.0 && sheet.min < sheet.max ? sheet.mean / sheet.area : sheet.min;
    }
    for (std::size_t e = 0; e < neighbours.sides.size(); ++e) {
        const std::span<const Index> sides = neighbours.sides[e];
        const double length = distance(mesh.vertices[start_of(mesh.triangles, sides[0])],
                                       mesh.vertices[end_of(mesh.triangles, sides[0])]);
        shells.mean_edge += length / static_cast<double>(neighbours.sides.size());
        shells.seam_length += sides.size() > 2 ? length : 0.0;
        shells.border_length += sides.size() == 1 ? length : 0.0;
    }
}

// Numbers of the walls, the largest first; walls without triangles have none.
std::vector<Index> numbers_by_area(const WallMesh& walls, std::size_t count, Index& used) {
    std::vector<double> areas(count);
    for (std::size_t t = 0; t < walls.walls.size(); ++t) {
        areas[walls.walls[t]] += triangle_area(walls.mesh, walls.mesh.triangles[t]);
    }
    used = static_cast<Index>(std::ranges::count_if(areas, [](double area) { return area > 0.0; }));
    return places_in(sorted_indices(
        count, [&](Index w) { return areas[w]; }, std::greater<>()));
}

ShellMesh shells_of(const WallMesh& walls, const std::vector<WallMiddle>& middles, const WallShapes& shapes) {
    ShellMesh shells;
    shells.mesh = walls.mesh;
    Index used = 0;
    const std::vector<Index> numbers = numbers_by_area(walls, middles.size(), used);
    shells.sheets.resize(static_cast<std::size_t>(used));
    for (std::size_t t = 0; t < walls.walls.size(); ++t) {
        const auto thickness = [&](int k) {
            return middles[walls.walls[t]].at(walls.mesh.vertices[walls.mesh.triangles[t][k]]).thickness;
        };
        shells.thickness.push_back({thickness(0), thickness(1), thickness(2)});
        shells.triangle_sheets.push_back(numbers[walls.walls[t]]);
    }
    const Neighbourhood neighbours(walls.mesh);
    shells.triangle_middles.resize(walls.walls.size());
    for (std::size_t e = 0; e < neighbours.sides.size(); ++e) {
        std::vector<Index> at;
        for (const Index side : neighbours.sides[e]) {
            at.push_back(walls.walls[side / 3]);
            shells.triangle_middles[side / 3][side % 3] = static_cast<Index>(e);
        }
        const Index side = neighbours.sides[e].front();
        const Point& a = walls.mesh.vertices[start_of(walls.mesh.triangles, side)];
        const Point& b = walls.mesh.vertices[end_of(walls.mesh.triangles, side)];
        std::vector<Index> rims;
        if (at.size() == 1) {
            if (const Index rim = shapes.rim_at(at[0], midpoint(a, b)); rim != kNone) {
                rims.push_back(rim);
            }
        }
        sort_unique(at);
        const Point middle = shapes.place(midpoint(a, b), at, rims);
        // More than the height of an arc of 90 degrees is an error, and would fold the element.
        const double highest = 0.5 * (std::numbers::sqrt2 - 1.0) * distance(a, b);
        shells.middles.push_back(distance(middle, midpoint(a, b)) <= highest ? middle : midpoint(a, b));
    }
    measure(shells, neighbours);
    return shells;
}

ShellMesh shells_in(const Midsurface& surface, const ShellOptions& options, const DistanceInside& distance,
                    const Execution& execution) {
    if (surface.mesh.triangles.empty()) {
        return {};
    }
    const Neighbourhood neighbours(surface.mesh);
    const std::vector<Index> parts = known_parts(surface, neighbours);
    const std::vector<Index> walls = walls_of(surface.mesh, neighbours, parts);
    std::vector<std::vector<Index>> triangles(static_cast<std::size_t>(*std::ranges::max_element(walls)) + 1);
    for (std::size_t t = 0; t < walls.size(); ++t) {
        if (parts[t] != kNone) {
            triangles[walls[t]].push_back(static_cast<Index>(t));
        }
    }
    std::vector<WallMiddle> middles;
    double thickest = 0.0;
    for (const std::vector<Index>& of_wall : triangles) {
        middles.emplace_back(surface, of_wall);
        thickest = std::max(thickest, middles.back().thickness());
    }
    const Rims rims(rim_samples(surface.mesh, walls, middles, neighbours, distance), middles.size());
    const WallShapes shapes{.rim_at = [&](Index wall, const Point& p) { return rims.at(wall, p); },
                            .place =
                                [&](const Point& p, std::span<const Index> on_walls, std::span<const Index> on_rims) {
                                    std::vector<Plane> planes;
                                    double most = 0.0;
                                    for (const Index wall : on_walls) {
                                        const Topside middle = middles[wall].at(p);
                                        planes.push_back({middle.place, middle.normal});
                                        most = std::max(most, 2.0 * middle.thickness);
                                    }
                                    for (const Index rim : on_rims) {
                                        const RimSample& sample = rims.of(rim, p);
                                        planes.push_back({sample.place, sample.normal});
                                    }
                                    return on_planes(p, planes, most);
                                },
                            .normal = [&](Index wall, const Point& p) { return middles[wall].at(p).normal; }};
    return shells_of(remeshed({surface.mesh, walls}, options.size, thickest, shapes, execution), middles, shapes);
}

void check_shell_options(const ShellOptions& options) {
    require(options.size > 0.0 && std::isfinite(options.size),
            "the size of the elements of a shell mesh must be more than 0");
}

}  // namespace

ShellMesh shell_mesh(const MedialComplex& complex, const ShellOptions& options, const Execution& execution) {
    check_shell_options(options);
    const Midsurface surface = midsurface(complex, {options.angle, false}, execution);
    if (surface.mesh.triangles.empty()) {
        return {};
    }
    return in_arena(execution, [&] {
        const EnvelopeData envelope(complex);
        return shells_in(
            surface, options, [&](const Point& p) { return -envelope.signed_distance(p); }, execution);
    });
}

ShellMesh shell_mesh(const MedialComplex& complex, const Solid& solid, const ShellOptions& options,
                     const Execution& execution) {
    if (!solid.knows_nearest()) {
        return shell_mesh(complex, options, execution);
    }
    check_shell_options(options);
    const Midsurface surface = midsurface(complex, solid, {options.angle, false}, execution);
    return in_arena(execution, [&] { return shells_in(surface, options, distance_inside(solid), execution); });
}

}  // namespace scaleaxis::inline v1
