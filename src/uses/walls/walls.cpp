// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/nearest.hpp"
#include "scaleaxis/thickness.hpp"
#include "spatial/point_tree.hpp"
#include "uses/ascent.hpp"
#include "uses/divided_edges.hpp"
#include "uses/flat_faces.hpp"
#include "uses/uphill.hpp"
#include "uses/walls/opposite_sides.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kWallsStage = "walls";

// Of a value: its accuracy, which `uphill` and rims leave out.
constexpr double kValueTolerance = 3e-3;

// Balls are looked for up to this multiple of a limit of thin walls and gaps, so that what is thinner shows beside its
// thinnest place, too.
constexpr double kCapLimits = 2.0;

// Edges where something thin may be are halved until they are shorter than this part of the limit, or than the radius
// of the ball there; sharp edges in any case.
constexpr double kEdgeOfLimit = 0.3;

constexpr int kRefinements = 10;               // an edge of 2 limits is halved three times
constexpr std::size_t kMostAdded = 2'000'000;  // triangles; values between vertices are interpolated then

constexpr std::ptrdiff_t kMostDescents = 4;  // from the lowest vertices of a finding that have none lower beside them

// Appends to which vertices point to one side: the surface falls back around them, on sharp edges and where its radius
// of curvature is small.
void add_tips(const TriangleMesh& mesh, const std::vector<Point>& normals, double sign, double radius,
              std::vector<char>& tips) {
    const auto known = static_cast<Index>(tips.size());
    tips.resize(mesh.vertices.size(), 0);
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        if (std::ranges::max(triangle) < known) {
            continue;
        }
        for (int k = 0; k < 3; ++k) {
            const Index v = triangle[k];
            for (const Index w : {triangle[(k + 1) % 3], triangle[(k + 2) % 3]}) {
                const Point along = mesh.vertices[w] - mesh.vertices[v];
                const double fall = -sign * dot(along, normals[v]);
                const double length = norm(along);
                if (v >= known && fall > 0.5 * length * length / radius) {
                    tips[v] = 1;
                }
            }
        }
    }
}

// One side of the surface, and the balls there.
struct SurfaceSide {
    const Solid& solid;
    double sign;                  // of normals that lead to it
    double most;                  // radius
    std::optional<double> limit;  // below which walls are findings
    std::vector<Ball> balls;      // #V, of those vertices that are known
    std::vector<char> is_tip;     // #V: the surface falls back around it

    double value(Index v) const { return 2.0 * balls[v].radius; }
};

class WallSearch {
   public:
    WallSearch(const Solid& solid, TriangleMesh surface, const WallOptions& options, const Execution& execution)
        : solid_(solid),
          outside_(solid),
          options_(options),
          execution_(execution),
          diagonal_(solid.bounds().diagonal()),
          slope_(cosine_of_degrees(0.5 * options.angle)) {
        walls_.surface = with_short_edges(with_delaunay_faces(std::move(surface)), options.edge * diagonal_, execution);
        walls_.tolerance = kValueTolerance;
        if (options.min_wall || options.max_wall) {
            walls_.wall_cap = std::max(kCapLimits * options.min_wall.value_or(0.0),
                                       (1.0 + kSmallPart) * options.max_wall.value_or(0.0));
            sides_.push_back({solid_, -1.0, 0.5 * walls_.wall_cap, options.min_wall, {}, {}});
        }
        if (options.min_gap) {
            walls_.gap_cap = kCapLimits * *options.min_gap;
            sides_.push_back({outside_, 1.0, 0.5 * walls_.gap_cap, options.min_gap, {}, {}});
        }
    }

    Walls run() && {
        solid_.prepare_nearest();
        find_balls();
        refine();
        for (SurfaceSide& side : sides_) {
            insert_thin_places(side);
        }
        for (const SurfaceSide& side : sides_) {
            const bool is_gap = &side.solid == &outside_;
            std::vector<double>& values = is_gap ? walls_.gap : walls_.wall;
            values.resize(side.balls.size());
            std::ranges::transform(side.balls, values.begin(),
                                   [&](const Ball& b) { return std::min(2.0 * b.radius, 2.0 * side.most); });
            (is_gap ? walls_.gap_findings : walls_.wall_findings).assign(values.size(), kNone);
            if (side.limit) {
                add_findings(side, is_gap ? FindingKind::kNarrowGap : FindingKind::kThinWall, *side.limit);
            }
            if (!is_gap && options_.max_wall) {
                add_findings(side, FindingKind::kThickWall, *options_.max_wall);
            }
        }
        report(execution_, kWallsStage, 1.0);
        return std::move(walls_);
    }

   private:
    // Finds those of vertices that have none yet.
    void find_balls() {
        const TriangleMesh& mesh = walls_.surface;
        add_normals(mesh, normals_);
        for (SurfaceSide& side : sides_) {
            const std::size_t known = side.balls.size();
            side.balls.resize(mesh.vertices.size());
            add_tips(mesh, normals_, side.sign, side.limit.value_or(0.0), side.is_tip);
            for_each_index(
                mesh.vertices.size() - known,
                [&](std::size_t i) {
                    const std::size_t v = known + i;
                    side.balls[v] =
                        ball_between_sides(side.solid, mesh.vertices[v], side.sign * normals_[v], slope_, side.most);
                },
                std::size_t{64});
        }
    }

    // May something thin lie on an edge, or on one side of it? Where sharp edges cross it shows nowhere else; what
    // else points to a wall has vertices of its own.
    bool is_doubtful(const SurfaceSide& side, Index a, Index b) const {
        if (!side.limit) {
            return false;
        }
        const double limit = *side.limit;
        const double low = std::min(side.value(a), side.value(b));
        const double high = std::max(side.value(a), side.value(b));
        const double length = distance(walls_.surface.vertices[a], walls_.surface.vertices[b]);
        if (side.is_tip[a] != 0 && side.is_tip[b] != 0) {
            return length > kEdgeOfLimit * limit;
        }
        return low < kCapLimits * limit && length > std::max(0.5 * low, kEdgeOfLimit * limit) &&
               high - low > kSmallPart * limit;
    }

    void refine() {
        TriangleMesh& mesh = walls_.surface;
        const std::size_t given = mesh.triangles.size();
        for (int round = 0; round < kRefinements; ++round) {
            report(execution_, kWallsStage, 0.2 + 0.6 * round / kRefinements);
            const std::vector<MeshEdge> edges = edges_of(mesh, [&](Index a, Index b) {
                return std::ranges::any_of(sides_, [&](const SurfaceSide& side) { return is_doubtful(side, a, b); });
            });
            if (edges.empty() || mesh.triangles.size() > given + kMostAdded) {
                return;
            }
            halve(mesh, edges);
            find_balls();
        }
    }

    double accuracy_of(double value) const { return std::max(kFileRounding * diagonal_, kValueTolerance * value); }

    // Vertices with no lower one beside them, the lowest first. \param sign -1: with no higher one, the highest first
    // \param rise part by which another beside them must be higher
    template <class Wanted>
    std::vector<Index> lowest_vertices(const SurfaceSide& side, double sign, double rise,
                                       const Wanted& is_wanted) const {
        std::vector<char> has_lower(side.balls.size(), 0);
        std::vector<char> has_higher(side.balls.size(), 0);
        for (const std::array<Index, 3>& triangle : walls_.surface.triangles) {
            for (int k = 0; k < 3; ++k) {
                const Index a = triangle[k];
                for (const Index b : {triangle[(k + 1) % 3], triangle[(k + 2) % 3]}) {
                    if (sign * side.value(b) < sign * side.value(a) - accuracy_of(side.value(a))) {
                        has_lower[a] = 1;
                    }
                    if (sign * side.value(b) >= sign * side.value(a) + rise * side.value(a)) {
                        has_higher[a] = 1;
                    }
                }
            }
        }
        auto lowest = indices_where(side.balls.size(), [&](Index v) {
            return has_lower[v] == 0 && (has_higher[v] != 0 || rise == 0.0) && is_wanted(v);
        });
        std::ranges::stable_sort(lowest, {}, [&](Index v) { return sign * side.value(v); });
        return lowest;
    }

    // Makes the contacts of those balls vertices that are below the limit and lie between others that are not.
    void insert_thin_places(SurfaceSide& side) {
        if (!side.limit) {
            return;
        }
        const double limit = *side.limit - accuracy_of(*side.limit);
        const std::vector<Index> beside = lowest_vertices(side, 1.0, kSmallPart, [&](Index v) {
            return side.value(v) >= limit && side.value(v) < kCapLimits * *side.limit;
        });
        auto found = mapped<Ball>(
            beside.size(), [&](std::size_t i) { return downhill(side.solid, side.balls[beside[i]], slope_); },
            std::size_t{8});
        std::erase_if(found, [&](const Ball& ball) { return !(2.0 * ball.radius < limit); });
        std::ranges::stable_sort(found, {}, &Ball::radius);
        std::vector<Ball> balls;
        std::vector<Point> points;
        for (const Ball& ball : found) {
            if (std::ranges::none_of(balls, [&](const Ball& other) { return are_of_one_wall(ball, other); })) {
                balls.insert(balls.end(), 2, ball);
                for (const Point& contact : opposite_contacts(side.solid, ball)) {
                    points.push_back(contact);
                }
            }
        }
        insert(side, points, balls);
    }

    // Is the centre of either nearer to the other one than the mean radius?
    static bool are_of_one_wall(const Ball& a, const Ball& b) {
        return 2.0 * distance(a.center, b.center) <= a.radius + b.radius;
    }

    // Points of the surface as vertices; those in a triangle where there is one already are left out.
    void insert(SurfaceSide& side, const std::vector<Point>& points, const std::vector<Ball>& balls) {
        if (points.empty()) {
            return;
        }
        TriangleMesh& mesh = walls_.surface;
        const NearestOnMesh near = nearest(mesh, points, execution_);
        std::vector<std::uint8_t> is_divided(mesh.triangles.size(), 0);
        std::vector<std::pair<MeshEdge, std::size_t>> on_edges;
        const std::size_t first = mesh.vertices.size();
        std::vector<Ball> added;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Index t = near.triangles[i];
            const std::array<Index, 3> corners = mesh.triangles[t];
            const std::array<double, 3> parts = barycentric(mesh, corners, near.points[i]);
            const auto zeros = std::ranges::count_if(parts, [](double part) { return part <= kFileRounding; });
            if (zeros == 2) {
                const Index v = corners[std::ranges::max_element(parts) - parts.begin()];
                side.balls[v] = side.balls[v].radius < balls[i].radius ? side.balls[v] : balls[i];
            } else if (zeros == 1) {
                const auto opposite = std::ranges::min_element(parts) - parts.begin();
                const auto [a, b] = std::minmax(corners[(opposite + 1) % 3], corners[(opposite + 2) % 3]);
                on_edges.push_back({{a, b}, i});
            } else if (is_divided[t] == 0) {
                is_divided[t] = 1;
                const auto v = static_cast<Index>(mesh.vertices.size());
                mesh.vertices.push_back(near.points[i]);
                added.push_back(balls[i]);
                mesh.triangles[t] = {corners[0], corners[1], v};
                mesh.triangles.push_back({corners[1], corners[2], v});
                mesh.triangles.push_back({corners[2], corners[0], v});
            }
        }
        std::ranges::sort(on_edges);
        on_edges.erase(std::unique(on_edges.begin(), on_edges.end(),
                                   [](const auto& a, const auto& b) { return a.first == b.first; }),
                       on_edges.end());
        std::vector<MeshEdge> edges;
        std::vector<Point> places;
        for (const auto& [edge, i] : on_edges) {
            edges.push_back(edge);
            places.push_back(near.points[i]);
            added.push_back(balls[i]);
        }
        divide(mesh, edges, places);
        find_balls();
        for (std::size_t i = 0; i < added.size(); ++i) {
            side.balls[first + i] = added[i];
        }
    }

    static std::array<double, 3> barycentric(const TriangleMesh& mesh, const std::array<Index, 3>& corners,
                                             const Point& p) {
        const auto& [a, b, c] =
            std::array{mesh.vertices[corners[0]], mesh.vertices[corners[1]], mesh.vertices[corners[2]]};
        const Point normal = cross(b - a, c - a);
        const double square = squared_norm(normal);
        if (!(square > 0.0)) {
            return {1.0, 0.0, 0.0};
        }
        const double u = dot(cross(b - p, c - p), normal) / square;
        const double v = dot(cross(c - p, a - p), normal) / square;
        return {u, v, 1.0 - u - v};
    }

    void add_findings(const SurfaceSide& side, FindingKind kind, double limit) {
        const bool is_thick = kind == FindingKind::kThickWall;
        const double sign = is_thick ? -1.0 : 1.0;
        const auto values = each_of<double>(side.balls, [&](const Ball& b) { return sign * 2.0 * b.radius; });
        const double strict = sign * limit - accuracy_of(limit);
        const ThinRegions regions = thin_regions(walls_.surface, values, strict);
        DisjointSets joined(regions.regions.size());
        join_sides(side, regions.vertex_regions, joined);

        std::vector<Index> numbers(regions.regions.size(), kNone);
        std::vector<Finding> findings;
        for (Index r = 0; r < static_cast<Index>(regions.regions.size()); ++r) {
            Index& number = numbers[joined.find(r)];
            if (number == kNone) {
                number = static_cast<Index>(findings.size());
                findings.emplace_back();
                findings.back().kind = kind;
                findings.back().limit = limit;
            }
            numbers[r] = number;
            findings[number].area += regions.regions[r].area;
            findings[number].vertices += regions.regions[r].vertices;
        }
        std::vector<Index> vertex_findings(values.size(), kNone);
        for (std::size_t v = 0; v < values.size(); ++v) {
            if (const Index r = regions.vertex_regions[v]; r != kNone) {
                vertex_findings[v] = numbers[r];
            }
        }
        extend(findings, vertex_findings, values, strict);
        find_worst(side, findings, vertex_findings);
        number_findings(std::move(findings), vertex_findings, kind);
    }

    // Joins regions on opposite sides of a wall.
    void join_sides(const SurfaceSide& side, const std::vector<Index>& regions, DisjointSets& joined) const {
        std::vector<Index> members;
        std::vector<Point> places;
        for (Index v = 0; v < static_cast<Index>(regions.size()); ++v) {
            if (regions[v] != kNone) {
                members.push_back(v);
                places.push_back(walls_.surface.vertices[v]);
            }
        }
        if (members.empty()) {
            return;
        }
        const PointTree tree = build_point_tree(places);
        std::vector<Index> partners(members.size(), kNone);
        for_each_index(
            members.size(),
            [&](std::size_t i) {
                const Ball& ball = side.balls[members[i]];
                const auto contacts = opposite_contacts(side.solid, ball);
                const double to_first = squared_distance(contacts[0], places[i]);
                const double to_second = squared_distance(contacts[1], places[i]);
                const NearPoint near = nearest_point(tree, to_first > to_second ? contacts[0] : contacts[1]);
                const Index other = members[tree.order[near.position]];
                partners[i] = are_of_one_wall(ball, side.balls[other]) ? other : kNone;
            },
            std::size_t{64});
        for (std::size_t i = 0; i < members.size(); ++i) {
            if (partners[i] != kNone) {
                joined.join(regions[members[i]], regions[partners[i]]);
            }
        }
    }

    // The boxes around what is below the limit, between vertices, too.
    void extend(std::vector<Finding>& findings, const std::vector<Index>& vertex_findings,
                const std::vector<double>& values, double limit) const {
        const TriangleMesh& mesh = walls_.surface;
        for (const std::array<Index, 3>& triangle : mesh.triangles) {
            for (int k = 0; k < 3; ++k) {
                const Index a = triangle[k];
                const Index b = triangle[(k + 1) % 3];
                for (const auto& [low, high] : {std::pair(a, b), std::pair(b, a)}) {
                    if (vertex_findings[low] == kNone) {
                        continue;
                    }
                    Box& box = findings[vertex_findings[low]].extent;
                    box.extend(mesh.vertices[low]);
                    if (vertex_findings[high] == kNone) {
                        const double part = (limit - values[low]) / (values[high] - values[low]);
                        box.extend(mesh.vertices[low] + part * (mesh.vertices[high] - mesh.vertices[low]));
                    }
                }
            }
        }
    }

    void find_worst(const SurfaceSide& side, std::vector<Finding>& findings,
                    const std::vector<Index>& vertex_findings) const {
        if (findings.empty()) {
            return;
        }
        const bool is_thick = findings.front().kind == FindingKind::kThickWall;
        std::vector<std::vector<Index>> starts(findings.size());
        for (const Index v :
             lowest_vertices(side, is_thick ? -1.0 : 1.0, 0.0, [&](Index v) { return vertex_findings[v] != kNone; })) {
            starts[vertex_findings[v]].push_back(v);
        }
        std::vector<double> largest(findings.size(), 0.0);  // radius
        for (std::size_t v = 0; v < vertex_findings.size(); ++v) {
            if (const Index f = vertex_findings[v]; f != kNone) {
                largest[f] = std::max(largest[f], side.balls[v].radius);
            }
        }
        for_each_index(
            findings.size(),
            [&](std::size_t f) {
                Finding& finding = findings[f];
                finding.ball = is_thick ? uphill(side.solid, side.balls[starts[f].front()], kNegligible)
                                        : smallest_ball(side, chosen_starts(side, starts[f]));
                finding.value = 2.0 * finding.ball.radius;
                finding.contacts = opposite_contacts(side.solid, finding.ball);
                finding.direction =
                    direction_of(side, finding, kSmallPart * largest[f], static_cast<Index>(f), vertex_findings);
                for (const Point& contact : finding.contacts) {
                    finding.extent.extend(contact);
                }
            },
            std::size_t{1});
    }

    // Some of the lowest vertices, and some that are as low within the tolerance: `uphill` leaves out a thousandth of
    // the balls beside a rim.
    std::vector<Index> chosen_starts(const SurfaceSide& side, const std::vector<Index>& lowest) const {
        std::vector<Index> chosen(lowest.begin(), lowest.begin() + std::min(std::ssize(lowest), kMostDescents));
        const double least = side.value(lowest.front());
        const double as_low = least + accuracy_of(least);
        const auto end = std::ranges::upper_bound(lowest, as_low, {}, [&](Index v) { return side.value(v); });
        const auto count = std::min(end - lowest.begin() - std::ssize(chosen), kMostDescents);
        if (count > 0) {
            chosen.insert(chosen.end(), end - count, end);
        }
        return chosen;
    }

    // The smallest ball below the starts; among several within the tolerance the largest.
    Ball smallest_ball(const SurfaceSide& side, const std::vector<Index>& starts) const {
        auto balls = each_of<Ball>(starts, [&](Index v) { return downhill(side.solid, side.balls[v], slope_); });
        const double least = std::ranges::min(balls, {}, &Ball::radius).radius;
        Ball result{{}, -1.0};
        for (const Ball& ball : balls) {
            if (ball.radius <= least + 0.5 * accuracy_of(2.0 * least) && ball.radius > result.radius) {
                result = ball;
            }
        }
        return result;
    }

    // Across a wall; on a sharp edge, where its ball is a point, across what is beside.
    Point direction_of(const SurfaceSide& side, const Finding& finding, double point_size, Index f,
                       const std::vector<Index>& vertex_findings) const {
        if (finding.ball.radius > point_size) {
            return unit(finding.contacts[1] - finding.contacts[0]);
        }
        Ball least{{}, kInfinity};
        for (std::size_t v = 0; v < vertex_findings.size(); ++v) {
            if (vertex_findings[v] == f && side.balls[v].radius > point_size && side.balls[v].radius < least.radius) {
                least = side.balls[v];
            }
        }
        if (least.radius == kInfinity) {
            return {};
        }
        const auto [a, b] = opposite_contacts(side.solid, least);
        return unit(b - a);
    }

    // The worst first, after those of other kinds.
    void number_findings(std::vector<Finding> findings, const std::vector<Index>& vertex_findings, FindingKind kind) {
        const double sign = kind == FindingKind::kThickWall ? -1.0 : 1.0;
        const auto order = sorted_indices(findings.size(), [&](Index f) { return sign * findings[f].value; });
        std::vector<Index> numbers(findings.size());
        for (const Index f : order) {
            numbers[f] = static_cast<Index>(walls_.findings.size());
            walls_.findings.push_back(findings[f]);
        }
        std::vector<Index>& all = kind == FindingKind::kNarrowGap ? walls_.gap_findings : walls_.wall_findings;
        for (std::size_t v = 0; v < all.size(); ++v) {
            all[v] = vertex_findings[v] == kNone ? all[v] : numbers[vertex_findings[v]];
        }
    }

    const Solid& solid_;
    OutsideOf outside_;
    const WallOptions& options_;
    const Execution& execution_;
    double diagonal_;
    double slope_;
    std::vector<SurfaceSide> sides_;
    std::vector<Point> normals_;  // #V
    Walls walls_;
};

void check_options(const WallOptions& options) {
    for (const std::optional<double>& limit : {options.min_wall, options.max_wall, options.min_gap}) {
        require(!limit || (*limit > 0.0 && std::isfinite(*limit)),
                "a limit of walls and gaps must be a positive length");
    }
    require(options.min_wall || options.max_wall || options.min_gap,
            "walls and gaps need a limit: of thin walls, thick walls, or gaps");
    require(!options.min_wall || !options.max_wall || *options.min_wall < *options.max_wall,
            "the limit of thin walls must be less than that of thick ones");
    require(options.edge > 0.0 && options.edge <= 1.0,
            "the longest edge must be more than 0, and at most the diagonal: 1");
    check_wall_angle(options.angle);
}

std::vector<WallAt> between_sides_at(const Solid& solid, std::span<const Point> points, double angle,
                                     const Execution& execution) {
    check_wall_angle(angle);
    const double slope = cosine_of_degrees(0.5 * angle);
    const double most = solid.bounds().diagonal();
    return in_arena(execution, [&] {
        solid.prepare_nearest();
        return mapped<WallAt>(
            points.size(),
            [&](std::size_t i) {
                const Ball ball = ball_between_sides(solid, points[i], slope, most);
                return WallAt{ball.radius < most ? 2.0 * ball.radius : kInfinity, ball, opposite_contacts(solid, ball)};
            },
            std::size_t{64});
    });
}

}  // namespace

std::string_view name_of(FindingKind kind) {
    return kind == FindingKind::kThinWall ? "thin wall" : kind == FindingKind::kThickWall ? "thick wall" : "narrow gap";
}

Walls find_walls(const Solid& solid, TriangleMesh surface, const WallOptions& options, const Execution& execution) {
    check_options(options);
    return in_arena(execution, [&] {
        report(execution, kWallsStage, 0.0);
        return WallSearch(solid, std::move(surface), options, execution).run();
    });
}

std::vector<WallAt> wall_at(const Solid& solid, std::span<const Point> points, double angle,
                            const Execution& execution) {
    return between_sides_at(solid, points, angle, execution);
}

std::vector<WallAt> gap_at(const Solid& solid, std::span<const Point> points, double angle,
                           const Execution& execution) {
    return between_sides_at(OutsideOf(solid), points, angle, execution);
}

}  // namespace scaleaxis::inline v1
