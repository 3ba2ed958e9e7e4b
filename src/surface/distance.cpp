// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "balls/union/union_data.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "sampling/restricted_facets.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/solid.hpp"
#include "spatial/extent.hpp"
#include "spatial/mesh_parts.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/triangle_tree.hpp"
#include "surface/envelope_boundary.hpp"

namespace scaleaxis::inline v1 {
namespace {

// In spacings: triangles larger than this, of a few thousand points, are divided before threads share them.
constexpr double kLarge = 32.0;

/// The distance of a point to a surface.
using DistanceTo = std::function<double(const Point&)>;

/// Of an envelope, made once for both directions.
using Boundary = std::shared_ptr<const EnvelopeBoundary>;

/// A surface as it is measured.
using Target = std::variant<const TriangleMesh*, BallUnion, Boundary>;

Target target_of(const Surface& surface, double spacing) {
    if (const auto* envelope = std::get_if<Envelope>(&surface)) {
        return std::make_shared<const EnvelopeBoundary>(*envelope, spacing);
    }
    if (const auto* balls = std::get_if<BallUnion>(&surface)) {
        return *balls;
    }
    return &std::get<TriangleMesh>(surface);
}

DistanceTo distance_function(const TriangleMesh* mesh) {
    struct Tree {
        Bvh bvh;
        TriangleBounds bounds;

        explicit Tree(const TriangleMesh& mesh) : bvh(build_bvh(mesh)), bounds(triangle_bounds(bvh)) {}
    };
    return [tree = std::make_shared<const Tree>(*mesh)](const Point& p) {
        return std::sqrt(nearest_triangle(tree->bvh, tree->bounds, p).squared_distance);
    };
}

DistanceTo distance_function(const BallUnion& balls) {
    return [balls, &boundary = balls.data().boundary()](const Point& p) { return nearest_point(boundary, p).distance; };
}

DistanceTo distance_function(const Boundary& boundary) {
    return [boundary](const Point& p) { return boundary->distance(p); };
}

/// A part of a surface: all of its points are within `radius` of `point`.
struct Piece {
    std::array<Point, 3> corners;
    Point point;
    double radius = 0.0;
    double distance = 0.0;  ///< of the point

    double most() const { return distance + radius; }
};

Piece piece_of(const std::array<Point, 3>& corners) {
    const auto& [a, b, c] = corners;
    Piece piece{corners, (1.0 / 3.0) * (a + b + c), 0.0, 0.0};
    for (const Point& corner : corners) {
        piece.radius = std::max(piece.radius, distance(piece.point, corner));
    }
    return piece;
}

std::array<Piece, 2> halves(const Piece& piece) {
    std::array<Point, 3> p = piece.corners;
    const auto side = [&](int k) { return squared_distance(p[(k + 1) % 3], p[(k + 2) % 3]); };
    const int longest = side(0) >= side(1) ? (side(0) >= side(2) ? 0 : 2) : (side(1) >= side(2) ? 1 : 2);
    const Point& apex = p[longest];
    const Point& first = p[(longest + 1) % 3];
    const Point& second = p[(longest + 2) % 3];
    const Point middle = midpoint(first, second);
    return {piece_of({apex, first, middle}), piece_of({apex, middle, second})};
}

double area_of(const Piece& piece) {
    const auto& [a, b, c] = piece.corners;
    return triangle_area(a, b, c);
}

/// What is known of the distances of many points.
struct Tally {
    double area = 0.0;
    double sum = 0.0;
    double square_sum = 0.0;
    double max = -1.0;
    Point farthest;
    std::int64_t samples = 0;
    std::vector<Piece> pieces;  ///< that may hold a point farther than `max`

    void add(const Point& p, double distance, double weight) {
        area += weight;
        sum += weight * distance;
        square_sum += weight * distance * distance;
        add(p, distance);
    }
    void add(const Point& p, double distance) {
        ++samples;
        if (distance > max) {
            max = distance;
            farthest = p;
        }
    }
    void add(const Tally& other) {
        area += other.area;
        sum += other.sum;
        square_sum += other.square_sum;
        samples += other.samples;
        if (other.max > max) {
            max = other.max;
            farthest = other.farthest;
        }
    }
    void forget_pieces(double accuracy) {
        std::erase_if(pieces, [&](const Piece& piece) { return piece.most() <= max + accuracy; });
    }
};

/// Found by argument-dependent look-up for `collect`.
Tally join(std::vector<Tally>& parts) {
    Tally all;
    for (const Tally& part : parts) {
        all.add(part);
    }
    all.pieces = joined(parts, &Tally::pieces);
    return all;
}

/// Divides a piece until no part of it is larger than `size`, and calls `visit` for each.
template <class Visit>
void for_each_part(const Piece& piece, double size, const Visit& visit) {
    if (!(piece.radius > size)) {
        visit(piece);
        return;
    }
    for (const Piece& half : halves(piece)) {
        for_each_part(half, size, visit);
    }
}

OneSidedDistance result_of(const Tally& tally, double error) {
    OneSidedDistance result;
    result.max = tally.max;
    result.error = error;
    result.mean = tally.area > 0.0 ? tally.sum / tally.area : tally.max;
    result.rms = tally.area > 0.0 ? std::sqrt(tally.square_sum / tally.area) : tally.max;
    result.farthest = tally.farthest;
    result.samples = tally.samples;
    return result;
}

void check_number_of_samples(double area, double spacing) {
    constexpr double kMost = 1e10;
    require(area / (spacing * spacing) < kMost, "the spacing would take more than 1e10 points; choose a larger one");
}

OneSidedDistance one_sided(const TriangleMesh* target, const DistanceTo& distance, const DistanceOptions& options,
                           const Execution&) {
    const TriangleMesh& mesh = *target;
    double area = 0.0;
    for (const auto& [u, v, w] : mesh.triangles) {
        area += area_of({{mesh.vertices[u], mesh.vertices[v], mesh.vertices[w]}, {}, 0.0, 0.0});
    }
    check_number_of_samples(area, options.spacing);
    const auto piece_at = [&](std::size_t t) {
        const auto& [u, v, w] = mesh.triangles[t];
        return piece_of({mesh.vertices[u], mesh.vertices[v], mesh.vertices[w]});
    };
    const double large = kLarge * options.spacing;
    std::vector<Piece> parts;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (const Piece piece = piece_at(t); piece.radius > large) {
            for_each_part(piece, large, [&](const Piece& part) { parts.push_back(part); });
        }
    }
    const auto add = [&](const Piece& piece, Tally& out) {
        for_each_part(piece, options.spacing, [&](Piece part) {
            stop_if_cancelled();
            part.distance = distance(part.point);
            out.add(part.point, part.distance, area_of(part));
            if (part.most() > out.max + options.accuracy) {
                out.pieces.push_back(part);
            }
        });
    };
    Tally tally = collect<Tally>(
        mesh.triangles.size(),
        [&](std::size_t t, Tally& out) {
            if (const Piece piece = piece_at(t); !(piece.radius > large)) {
                add(piece, out);
            }
        },
        std::size_t{256});
    Tally of_large = collect<Tally>(
        parts.size(), [&](std::size_t i, Tally& out) { add(parts[i], out); }, std::size_t{1});
    tally.add(of_large);
    append(tally.pieces, of_large.pieces);
    tally.forget_pieces(options.accuracy);

    // Divide what may be farther, as long as that is little.
    const std::int64_t budget = 2 * tally.samples + 100'000;
    while (!tally.pieces.empty() && tally.samples + 2 * static_cast<std::int64_t>(tally.pieces.size()) <= budget) {
        const std::vector<Piece> whole = std::exchange(tally.pieces, {});
        Tally divided = collect<Tally>(
            whole.size(),
            [&](std::size_t i, Tally& out) {
                for (Piece half : halves(whole[i])) {
                    half.distance = distance(half.point);
                    out.add(half.point, half.distance);
                    out.pieces.push_back(half);
                }
            },
            std::size_t{256});
        tally.add(divided);
        tally.pieces = std::move(divided.pieces);
        tally.forget_pieces(options.accuracy);
    }
    double most = tally.max + options.accuracy;
    for (const Piece& piece : tally.pieces) {
        most = std::max(most, piece.most());
    }
    return result_of(tally, most - tally.max);
}

OneSidedDistance one_sided(const BallUnion& balls, const DistanceTo& distance, const DistanceOptions& options,
                           const Execution& execution) {
    const Samples samples =
        sample(*union_solid(balls, execution), {.tolerance = options.spacing, .seed = options.seed}, execution);
    // A third of each restricted facet belongs to each of its corners.
    std::vector<double> weights(samples.points.size());
    for (const RestrictedFacet& facet : restricted_facets(samples)) {
        const auto [a, b, c] = vertices_of(samples, facet);
        const std::vector<Point>& p = samples.points;
        const double area = area_of({{p[a], p[b], p[c]}, {}, 0.0, 0.0});
        for (const Index corner : {a, b, c}) {
            weights[corner] += area / 3.0;
        }
    }
    const Tally tally = collect<Tally>(
        samples.points.size(),
        [&](std::size_t i, Tally& out) { out.add(samples.points[i], distance(samples.points[i]), weights[i]); },
        std::size_t{256});
    return result_of(tally, options.spacing);
}

OneSidedDistance one_sided(const Boundary& boundary, const DistanceTo& distance, const DistanceOptions& options,
                           const Execution&) {
    const std::vector<SurfacePoint>& points = boundary->points();
    const Tally tally = collect<Tally>(
        points.size(),
        [&](std::size_t i, Tally& out) { out.add(points[i].point, distance(points[i].point), points[i].area); },
        std::size_t{256});
    return result_of(tally, options.spacing);
}

void validate(const Surface& surface) {
    if (const auto* mesh = std::get_if<TriangleMesh>(&surface)) {
        if (mesh->triangles.empty()) {
            throw UnusableInput("the mesh has no triangles: there is no surface to measure distances to");
        }
        if (!std::ranges::all_of(mesh->vertices, is_usable)) {
            throw UnusableInput(std::string("a vertex of the mesh ") + kUnusableCoordinate);
        }
    } else if (const auto* balls = std::get_if<BallUnion>(&surface)) {
        balls->data();  // throws if the union is empty
    }
}

}  // namespace

Box surface_bounds(const Surface& surface) {
    if (const auto* balls = std::get_if<BallUnion>(&surface)) {
        return balls->bounds();
    }
    if (const auto* envelope = std::get_if<Envelope>(&surface)) {
        return envelope->bounds();
    }
    const TriangleMesh& mesh = std::get<TriangleMesh>(surface);
    Box box;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        for (const Index v : triangle) {
            box.extend(mesh.vertices[v]);
        }
    }
    return box;
}

SurfaceDistance surface_distance(const Surface& a, const Surface& b, const DistanceOptions& options,
                                 const Execution& execution) {
    validate(a);
    validate(b);
    require(options.spacing > 0.0 && std::isfinite(options.spacing),
            "the spacing of the points on a surface must be a positive length");
    require(options.accuracy >= 0.0, "the accuracy of a distance must not be negative");
    return in_arena(execution, [&] {
        // Without the progress of the stages within, which would begin again for each side.
        const Execution inner{execution.threads, {}, execution.cancel};
        const auto measure = [&](const Target& from, const Target& to) {
            stop_if_cancelled();
            const DistanceTo distance = std::visit([](const auto& target) { return distance_function(target); }, to);
            return std::visit([&](const auto& target) { return one_sided(target, distance, options, inner); }, from);
        };
        report(execution, "distance", 0.0);
        const Target target_a = target_of(a, options.spacing);
        const Target target_b = target_of(b, options.spacing);
        SurfaceDistance result;
        result.a_to_b = measure(target_a, target_b);
        report(execution, "distance", 0.5);
        result.b_to_a = measure(target_b, target_a);
        report(execution, "distance", 1.0);
        return result;
    });
}

}  // namespace scaleaxis::inline v1
