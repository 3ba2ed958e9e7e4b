// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/boundary_part.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/parallel.hpp"
#include "solid/mesh/winding.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Points nearer than this (fraction of the diagonal of the box) to a plane or a line lie in it.
constexpr double kOnTrianglePlane = 1e-10;

// And so far beside a segment the pieces on both sides of it are looked at; where there are gaps, ten of them.
constexpr double kBeside = 1e-7;
constexpr double kGapsBeside = 10.0;

// Walls that touch are no farther apart (fraction of the diagonal of the box): single precision moves planes askew to
// the axes by up to 3e-7 of it, in a box as far from the origin as it is large. A tenth of the least δ.
constexpr double kContact = 1e-6;

/// A point of a triangle's plane.
struct Flat {
    double x = 0.0;
    double y = 0.0;
};

Flat operator+(const Flat& a, const Flat& b) { return {a.x + b.x, a.y + b.y}; }
Flat operator-(const Flat& a, const Flat& b) { return {a.x - b.x, a.y - b.y}; }
Flat operator*(double s, const Flat& a) { return {s * a.x, s * a.y}; }
double dot(const Flat& a, const Flat& b) { return a.x * b.x + a.y * b.y; }
double cross(const Flat& a, const Flat& b) { return a.x * b.y - a.y * b.x; }
double norm(const Flat& a) { return std::sqrt(dot(a, a)); }

struct FlatSegment {
    Flat begin;
    Flat end;

    Flat at(double t) const { return begin + t * (end - begin); }
    double length() const { return norm(end - begin); }
};

/// A triangle as the coordinate system of its plane.
struct FlatTriangle {
    Point origin;
    Point along, across, normal;  ///< unit vectors
    std::array<Flat, 3> corners;  ///< counter-clockwise

    Flat flat(const Point& p) const {
        const Point d = p - origin;
        return {scaleaxis::dot(d, along), scaleaxis::dot(d, across)};
    }
    double height(const Point& p) const { return scaleaxis::dot(p - origin, normal); }
    Point at(const Flat& p) const { return origin + p.x * along + p.y * across; }

    /// How far beyond the side where it is farthest; negative: inside.
    double distance_beyond(const Flat& p) const {
        double beyond = -std::numeric_limits<double>::infinity();
        for (int k = 0; k < 3; ++k) {
            const Flat side = corners[(k + 1) % 3] - corners[k];
            beyond = std::max(beyond, cross(p - corners[k], side) / norm(side));
        }
        return beyond;
    }

    /// The part of a segment in the triangle.
    std::optional<FlatSegment> clipped(const FlatSegment& segment, double tolerance) const {
        double enter = 0.0;
        double leave = 1.0;
        for (int k = 0; k < 3; ++k) {
            const Flat side = corners[(k + 1) % 3] - corners[k];
            const double length = norm(side);
            const double from = cross(segment.begin - corners[k], side) / length - tolerance;
            const double to = cross(segment.end - corners[k], side) / length - tolerance;
            if (from > 0.0 && to > 0.0) {
                return std::nullopt;
            }
            if (from > 0.0) {
                enter = std::max(enter, from / (from - to));
            } else if (to > 0.0) {
                leave = std::min(leave, from / (from - to));
            }
        }
        const FlatSegment part{segment.at(enter), segment.at(leave)};
        return enter < leave && part.length() > tolerance ? std::optional(part) : std::nullopt;
    }
};

std::optional<FlatTriangle> flat_triangle(const TriangleMesh& mesh, Index t) {
    const auto& [u, v, w] = mesh.triangles[t];
    const std::vector<Point>& p = mesh.vertices;
    const Point side = p[v] - p[u];
    const Point normal = cross(side, p[w] - p[u]);
    if (!(norm(normal) > 0.0)) {
        return std::nullopt;
    }
    FlatTriangle flat{p[u], (1.0 / norm(side)) * side, {}, (1.0 / norm(normal)) * normal, {}};
    flat.across = cross(flat.normal, flat.along);
    flat.corners = {flat.flat(p[u]), flat.flat(p[v]), flat.flat(p[w])};
    return flat;
}

/// Where other triangles cut, touch or cover one: segments in its plane.
class Cuts {
   public:
    Cuts(const Bvh& bvh, Index t, const FlatTriangle& flat, double tolerance)
        : mesh_(bvh.mesh), t_(t), flat_(flat), tolerance_(tolerance) {
        Box box;
        for (const Index v : mesh_.triangles[t]) {
            box.extend(mesh_.vertices[v]);
        }
        const Point by{tolerance, tolerance, tolerance};
        for_each_near_box(bvh, {box.min - by, box.max + by}, [&](Index other) {
            if (other != t) {
                add(other);
            }
        });
    }

    /// The segments, divided where they meet each other.
    std::vector<FlatSegment> divided() const {
        std::vector<FlatSegment> result;
        std::vector<double> places;
        for (const FlatSegment& segment : segments_) {
            places = {0.0, 1.0};
            for (const FlatSegment& other : segments_) {
                if (&other != &segment) {
                    add_places(segment, other, places);
                }
            }
            std::ranges::sort(places);
            double begin = 0.0;
            for (const double end : places) {
                if ((end - begin) * segment.length() > tolerance_) {
                    result.push_back({segment.at(begin), segment.at(end)});
                    begin = end;
                }
            }
        }
        return result;
    }

   private:
    bool has_corner(Index v) const { return std::ranges::find(mesh_.triangles[t_], v) != mesh_.triangles[t_].end(); }

    void add(const Point& a, const Point& b) {
        if (const auto part = flat_.clipped({flat_.flat(a), flat_.flat(b)}, tolerance_)) {
            segments_.push_back(*part);
        }
    }

    void add(Index other) {
        const std::array<Index, 3>& corners = mesh_.triangles[other];
        std::array<double, 3> heights;
        int in_plane = 0;
        for (int k = 0; k < 3; ++k) {
            const double height = flat_.height(mesh_.vertices[corners[k]]);
            heights[k] = std::abs(height) > tolerance_ ? height : 0.0;
            in_plane += heights[k] == 0.0 ? 1 : 0;
        }
        std::vector<Point> ends;
        for (int k = 0; k < 3; ++k) {
            const Index u = corners[k], v = corners[(k + 1) % 3];
            const double from = heights[k], to = heights[(k + 1) % 3];
            if (from == 0.0 && to == 0.0) {
                if (!(has_corner(u) && has_corner(v))) {
                    add(mesh_.vertices[u], mesh_.vertices[v]);
                }
                continue;
            }
            if (from == 0.0) {
                ends.push_back(mesh_.vertices[u]);
            } else if (to != 0.0 && (from < 0.0) != (to < 0.0)) {
                const double t = from / (from - to);
                ends.push_back((1.0 - t) * mesh_.vertices[u] + t * mesh_.vertices[v]);
            }
        }
        if (in_plane < 2 && ends.size() == 2) {
            add(ends[0], ends[1]);
        }
    }

    /// Where along a segment another one meets it.
    void add_places(const FlatSegment& segment, const FlatSegment& other, std::vector<double>& places) const {
        const Flat d = segment.end - segment.begin;
        const Flat e = other.end - other.begin;
        const double square = dot(d, d);
        for (const Flat& end : {other.begin, other.end}) {
            if (std::abs(cross(d, end - segment.begin)) <= 10.0 * tolerance_ * std::sqrt(square)) {
                places.push_back(std::clamp(dot(d, end - segment.begin) / square, 0.0, 1.0));
            }
        }
        const double area = cross(d, e);
        if (std::abs(area) > 1e-14 * std::sqrt(square * dot(e, e))) {
            const Flat to = other.begin - segment.begin;
            const double here = cross(to, e) / area, there = cross(to, d) / area;
            if (here > 0.0 && here < 1.0 && there >= 0.0 && there <= 1.0) {
                places.push_back(here);
            }
        }
    }

    const TriangleMesh& mesh_;
    Index t_;
    const FlatTriangle& flat_;
    double tolerance_;
    std::vector<FlatSegment> segments_;
};

/// The area that a triangle has in common with another one, which is projected to its plane.
double common_area(const FlatTriangle& triangle, const std::array<Flat, 3>& other) {
    std::vector<Flat> part(other.begin(), other.end());
    for (int k = 0; k < 3; ++k) {
        const Flat& corner = triangle.corners[k];
        const Flat side = triangle.corners[(k + 1) % 3] - corner;
        std::vector<Flat> clipped;
        for (std::size_t i = 0; i < part.size(); ++i) {
            const Flat& p = part[i];
            const Flat& q = part[(i + 1) % part.size()];
            const double at_p = cross(side, p - corner), at_q = cross(side, q - corner);
            if (at_p >= 0.0) {
                clipped.push_back(p);
            }
            if ((at_p >= 0.0) != (at_q >= 0.0)) {
                clipped.push_back(p + (at_p / (at_p - at_q)) * (q - p));
            }
        }
        part = std::move(clipped);
    }
    double area = 0.0;
    for (std::size_t i = 0; i < part.size(); ++i) {
        area += 0.5 * cross(part[i], part[(i + 1) % part.size()]);
    }
    return std::abs(area);
}

/// How far the corners of triangle `t` are from a plane, at most.
double farthest_corner(const TriangleMesh& mesh, Index t, const FlatTriangle& plane) {
    double farthest = 0.0;
    for (const Index v : mesh.triangles[t]) {
        farthest = std::max(farthest, std::abs(plane.height(mesh.vertices[v])));
    }
    return farthest;
}

/// A cut triangle.
struct CutTriangle {
    Share share = Share::kNothing;
    std::vector<std::array<Point, 2>> borders;
};

CutTriangle cut_triangle(const Bvh& bvh, const Box& box, Index t, double gap) {
    const std::optional<FlatTriangle> flat = flat_triangle(bvh.mesh, t);
    if (!flat) {
        return {};  // its neighbours have all of its points
    }
    const auto is_on_boundary = [&](const Flat& p) { return is_boundary_at(bvh, box, t, flat->at(p), gap); };
    const double step = std::max(kBeside * box.diagonal(), kGapsBeside * gap);
    const double tolerance = std::max(kOnTrianglePlane * box.diagonal(), gap);
    CutTriangle result;
    for (const FlatSegment& segment : Cuts(bvh, t, *flat, tolerance).divided()) {
        const Flat middle = segment.at(0.5);
        const Flat d = segment.end - segment.begin;
        const Flat beside = (step / norm(d)) * Flat{-d.y, d.x};
        int sides = 0;
        int boundaries = 0;
        for (const Flat& p : {middle + beside, middle - beside}) {
            if (flat->distance_beyond(p) < 0.0) {
                ++sides;
                boundaries += is_on_boundary(p) ? 1 : 0;
            }
        }
        if (boundaries == 1 && sides == 2) {
            result.share = Share::kSome;
            result.borders.push_back({flat->at(segment.begin), flat->at(segment.end)});
        }
    }
    if (result.borders.empty()) {
        // Any point inside tells. Near sides, where other triangles touch this one, rounding may.
        const auto& [a, b, c] = flat->corners;
        int boundaries = 0;
        for (const auto& [x, y, z] : {std::array{0.34, 0.33, 0.33}, {0.41, 0.23, 0.36}, {0.27, 0.45, 0.28}}) {
            boundaries += is_on_boundary(x * a + y * b + z * c) ? 1 : 0;
        }
        result.share = boundaries > 1 ? Share::kAll : Share::kNothing;
    }
    return result;
}

}  // namespace

BoundaryPart boundary_part(const Bvh& bvh, const Box& box, const std::vector<std::uint8_t>& is_cut, double gap,
                           const Patches& patches) {
    const std::size_t count = bvh.mesh.triangles.size();
    BoundaryPart result;
    result.shares.resize(count);
    const auto borders = collect<std::vector<std::array<Point, 2>>>(
        count,
        [&](std::size_t i, std::vector<std::array<Point, 2>>& out) {
            if (is_cut.empty() || is_cut[i] == 0) {
                const Index patch = patches.of_vertex[bvh.mesh.triangles[i][0]];
                result.shares[i] = is_boundary(patches.patches[patch].winding_outside) ? Share::kAll : Share::kNothing;
                return;
            }
            stop_if_cancelled();
            const CutTriangle cut = cut_triangle(bvh, box, static_cast<Index>(i), gap);
            result.shares[i] = cut.share;
            append(out, cut.borders);
        },
        std::size_t{64});
    for (const auto& [begin, end] : borders) {
        const auto first = static_cast<Index>(result.borders.vertices.size());
        result.borders.vertices.push_back(begin);
        result.borders.vertices.push_back(end);
        result.borders.triangles.push_back({first, first + 1, first + 1});
    }
    return result;
}

Contacts find_contacts(const Bvh& bvh, const Box& box) {
    const TriangleMesh& mesh = bvh.mesh;
    const double reach = kContact * box.diagonal();
    struct Contact {
        Index triangle = kNone;
        double gap = 0.0;
    };
    const auto contacts = collect<std::vector<Contact>>(
        mesh.triangles.size(),
        [&](std::size_t i, std::vector<Contact>& out) {
            const auto t = static_cast<Index>(i);
            const std::optional<FlatTriangle> flat = flat_triangle(mesh, t);
            if (!flat) {
                return;
            }
            Box around = box_of_triangle(mesh, t);
            around = {around.min - Point{reach, reach, reach}, around.max + Point{reach, reach, reach}};
            for_each_near_box(bvh, around, [&](Index other) {
                const auto& [u, v, w] = mesh.triangles[other];
                const std::vector<Point>& p = mesh.vertices;
                if (scaleaxis::dot(flat->normal, cross(p[v] - p[u], p[w] - p[u])) >= 0.0 ||
                    !overlap(box_of_triangle(mesh, other), around)) {
                    return;
                }
                const std::optional<FlatTriangle> beside = flat_triangle(mesh, other);
                if (!beside) {
                    return;
                }
                // The plane of the smaller one may be far off at the corners of the larger one.
                const double gap = std::min(farthest_corner(mesh, other, *flat), farthest_corner(mesh, t, *beside));
                if (gap > reach) {
                    return;
                }
                std::array<Flat, 3> corners;
                double longest = 0.0;
                for (int k = 0; k < 3; ++k) {
                    corners[k] = flat->flat(mesh.vertices[mesh.triangles[other][k]]);
                    longest = std::max(longest, norm(corners[k] - corners[(k + 2) % 3]));
                }
                if (common_area(*flat, corners) > reach * longest) {
                    out.push_back({t, gap});
                }
            });
        },
        std::size_t{256});
    Contacts result;
    if (!contacts.empty()) {
        result.is_touching.resize(mesh.triangles.size());
    }
    for (const auto& [triangle, gap] : contacts) {
        result.is_touching[triangle] = 1;
        result.gap = std::max(result.gap, gap);
    }
    return result;
}

}  // namespace scaleaxis::inline v1
