// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/centering.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "base/grouped.hpp"
#include "base/parallel.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/fit.hpp"

namespace scaleaxis {
namespace {

constexpr std::string_view kStage = "centering";
constexpr double kDegree = std::numbers::pi / 180.0;

// Contacts that are seen at less than this angle from each other count as one.
const double kSameDirection = std::cos(10.0 * kDegree);
constexpr std::size_t kMostDirections = 12;

// A curve is seen from a circle around it.
constexpr int kDirectionsOfCurve = 8;

// How far from a contact the solid is asked for its tangent plane there, as a part of the radius.
constexpr double kDepth = 0.2;

// A plane is one of a contact if its normal is not farther than this from the direction of the contact.
const double kSameSide = std::cos(45.0 * kDegree);

// Steps of a move; a step shorter than this part of the tolerance is the last.
constexpr int kSteps = 4;
constexpr double kSettled = 1e-4;

// Of the radius: a centre that moves by less stays in the solid.
constexpr double kMostMove = 0.5;

// Of the tolerance: balls that stick out of the solid by more are to do so. The perturbation of the balls of a union,
// and rounding, are less.
constexpr double kMostShrinking = 0.1;

// A bound of a distance that this is added to, as a part, does not cut it off by rounding.
constexpr double kRounding = 1e-9;

// Keeps a move from following directions in which the planes hardly differ. In units of squared sines.
constexpr double kDamping = 0.01;

struct Vertex {
    Index vertex = kNone;
    Point center;
    double radius = 0.0;            // of the largest ball in the solid around the centre
    std::vector<Point> directions;  // to its contacts
    bool is_moving = true;
};

void add_direction(std::vector<Point>& directions, const Point& direction) {
    const auto is_same = [&](const Point& other) { return dot(direction, other) > kSameDirection; };
    if (squared_norm(direction) > 0.0 && directions.size() < kMostDirections &&
        std::ranges::none_of(directions, is_same)) {
        directions.push_back(direction);
    }
}

void add_circle(std::vector<Point>& directions, const Point& tangent) {
    const double x = std::abs(tangent.x);
    const double y = std::abs(tangent.y);
    const double z = std::abs(tangent.z);
    const Point least = x <= y && x <= z ? Point{1, 0, 0} : y <= z ? Point{0, 1, 0} : Point{0, 0, 1};
    const Point u = unit(cross(tangent, least));
    const Point v = cross(tangent, u);
    for (int i = 0; i < kDirectionsOfCurve; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kDirectionsOfCurve;
        add_direction(directions, std::cos(angle) * u + std::sin(angle) * v);
    }
}

// Where the contacts of the balls are, as seen from the vertices.
class Directions {
   public:
    explicit Directions(const MedialComplex& complex) : complex_(complex) {
        faces_ = grouped(complex.vertices.size(), [&](const auto& add) {
            for (std::size_t f = 0; f < complex.faces.size(); ++f) {
                for (const Index v : complex.faces[f]) {
                    add(v, static_cast<Index>(f));
                }
            }
        });
        neighbors_ = grouped_both_ways(complex.vertices.size(), curve_edges(complex));
    }

    std::vector<Point> at(Index v) const {
        std::vector<Point> result;
        const Point& p = complex_.vertices[v];
        for (const Index f : faces_[v]) {
            for (const Index contact : complex_.face_contacts[f]) {
                add_direction(result, unit(complex_.boundary_vertices[contact] - p));
            }
        }
        const std::span<const Index> along = neighbors_[v];
        if (result.empty() && along.size() == 2) {
            add_circle(result, unit(complex_.vertices[along[1]] - complex_.vertices[along[0]]));
        }
        return result;
    }

   private:
    const MedialComplex& complex_;
    IndexLists faces_;
    IndexLists neighbors_;  // along curves
};

struct Plane {
    Point normal;
    double distance = 0.0;
};

// The move to the ball that touches all planes, or comes closest to it (least squares).
Point move_to_middle(std::span<const Plane> planes) {
    const double part = 1.0 / static_cast<double>(planes.size());
    Eigen::Vector4d mean = Eigen::Vector4d::Zero();
    for (const auto& [n, d] : planes) {
        mean += part * Eigen::Vector4d(n.x, n.y, n.z, d);
    }
    Eigen::Matrix3d a = kDamping * Eigen::Matrix3d::Identity();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const auto& [n, d] : planes) {
        const Eigen::Vector3d normal = Eigen::Vector3d(n.x, n.y, n.z) - mean.head<3>();
        a += part * normal * normal.transpose();
        b += part * (d - mean[3]) * normal;
    }
    const Eigen::Vector3d move = a.ldlt().solve(b);
    return {move.x(), move.y(), move.z()};
}

class Centering {
   public:
    Centering(const MedialComplex& complex, const Solid& solid, double tolerance)
        : complex_(complex), solid_(solid), tolerance_(tolerance) {
        start();
    }

    void run(const Execution& execution) {
        std::vector<Vertex> given = vertices_;
        std::vector<double> bounds;
        for (int step = 0; step < kSteps; ++step) {
            stop_if_cancelled();
            report(execution, kStage, (1.0 + step) / (kSteps + 2.0));
            move();
        }
        // The larger of the balls before and after the move. A radius grows by no more than the way of the centre.
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            const double way = distance(vertices_[i].center, given[i].center);
            bounds.push_back((1.0 + kRounding) * (given[i].radius + way));
        }
        measure(bounds);
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            if (!(vertices_[i].radius > given[i].radius)) {
                vertices_[i] = std::move(given[i]);
            }
        }
    }

    const std::vector<Vertex>& vertices() const { return vertices_; }
    std::int64_t questions() const { return questions_; }

   private:
    // Balls in the solid, not much smaller than the largest around their centres.
    void start() {
        std::vector<Point> centers;
        std::vector<double> bounds;
        for (Index v = 0; v < static_cast<Index>(complex_.vertices.size()); ++v) {
            if (complex_.radii[v] > 0.0) {
                vertices_.push_back({v, complex_.vertices[v], 0.0, {}, true});
                centers.push_back(complex_.vertices[v]);
                bounds.push_back((1.0 + kRounding) * (complex_.radii[v] + tolerance_));
            }
        }
        const std::vector<std::uint8_t> sides = sides_of(solid_, centers);
        measure(bounds);
        const Directions directions(complex_);
        std::vector<Vertex> inside;
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            Vertex& vertex = vertices_[i];
            const double growth = vertex.radius - complex_.radii[vertex.vertex];
            if (sides[i] != 0 && growth >= -kMostShrinking * tolerance_ && growth <= tolerance_) {
                vertex.directions = directions.at(vertex.vertex);
                inside.push_back(std::move(vertex));
            }
        }
        vertices_ = std::move(inside);
    }

    // The radii of the largest balls around the centres, 0 where they reach their bounds.
    void measure(std::span<const double> bounds) {
        std::vector<Point> centers(vertices_.size());
        std::ranges::transform(vertices_, centers.begin(), &Vertex::center);
        const auto nearest = asked(centers, bounds);
        for (std::size_t i = 0; i < vertices_.size(); ++i) {
            vertices_[i].radius = nearest[i] ? distance(centers[i], *nearest[i]) : 0.0;
        }
    }

    std::vector<std::optional<Point>> asked(std::span<const Point> points, std::span<const double> bounds) {
        questions_ += std::ssize(points);
        return nearest_of(solid_, points, bounds);
    }

    void move() {
        std::vector<Point> points;
        std::vector<double> bounds;
        for (const Vertex& vertex : vertices_) {
            for (const Point& direction : directions_of(vertex)) {
                points.push_back(vertex.center + (1.0 - kDepth) * vertex.radius * direction);
                bounds.push_back(kDepth * vertex.radius + 2.0 * tolerance_);
            }
        }
        const auto nearest = asked(points, bounds);
        std::size_t question = 0;
        std::vector<Plane> planes;
        for (Vertex& vertex : vertices_) {
            planes.clear();
            double reach = std::numeric_limits<double>::infinity();
            std::vector<Point> seen;
            for (const Point& direction : directions_of(vertex)) {
                const std::optional<Point>& place = nearest[question];
                const Point& from = points[question++];
                if (!place) {
                    continue;
                }
                reach = std::min(reach, distance(*place, vertex.center));
                const Point normal = unit(*place - from);
                const double distance = dot(normal, *place - vertex.center);
                if (dot(normal, direction) > kSameSide && std::abs(distance - vertex.radius) <= tolerance_) {
                    planes.push_back({normal, distance});
                    add_direction(seen, normal);
                }
            }
            // Where the ball has become smaller on the way, it will stay as it was.
            vertex.is_moving = vertex.is_moving && reach > (1.0 - kRounding) * vertex.radius;
            if (vertex.is_moving) {
                go(vertex, planes, std::move(seen));
            }
        }
    }

    static std::span<const Point> directions_of(const Vertex& vertex) {
        return vertex.is_moving ? vertex.directions : std::span<const Point>();
    }

    void go(Vertex& vertex, std::span<const Plane> planes, std::vector<Point> seen) const {
        vertex.is_moving = false;
        if (seen.size() < 2) {
            return;
        }
        const Point way = move_to_middle(planes);
        const Point& start = complex_.vertices[vertex.vertex];
        if (!(distance(vertex.center + way, start) <= std::min(tolerance_, kMostMove * vertex.radius))) {
            return;
        }
        vertex.center = vertex.center + way;
        vertex.directions = std::move(seen);
        vertex.is_moving = norm(way) > kSettled * tolerance_;
    }

    const MedialComplex& complex_;
    const Solid& solid_;
    double tolerance_;
    std::vector<Vertex> vertices_;
    std::int64_t questions_ = 0;
};

}  // namespace

CenteredComplex centered(MedialComplex complex, const Solid& solid, const CenterOptions& options,
                         const Execution& execution) {
    if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance)) {
        throw InvalidOption("the tolerance of centering must be a positive number");
    }
    check_knows_nearest(solid);
    return in_arena(execution, [&] {
        report(execution, kStage, 0.0);
        Centering centering(complex, solid, options.tolerance);
        centering.run(execution);
        CenteredComplex result;
        CenterStatistics& statistics = result.statistics;
        statistics.questions = centering.questions();
        for (const Vertex& vertex : centering.vertices()) {
            const Index v = vertex.vertex;
            const double move = distance(vertex.center, complex.vertices[v]);
            ++statistics.fitted;
            statistics.moved += move > 0.0 ? 1 : 0;
            statistics.largest_move = std::max(statistics.largest_move, move);
            statistics.mean_growth += (vertex.radius - complex.radii[v]) / static_cast<double>(complex.vertices.size());
            complex.vertices[v] = vertex.center;
            complex.radii[v] = vertex.radius;
            complex.vertex_balls[v] = kMoved;
        }
        result.complex = std::move(complex);
        report(execution, kStage, 1.0);
        return result;
    });
}

CenteredComplex center(MedialComplex complex, const Solid& solid, const CenterOptions& options,
                       const Execution& execution) {
    check(complex);
    return centered(std::move(complex), solid, options, execution);
}

}  // namespace scaleaxis
