// SPDX-License-Identifier: Apache-2.0
#include "uses/walls/opposite_sides.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base/angles.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "scaleaxis/ranges.hpp"
#include "uses/ascent.hpp"
#include "uses/uphill.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Of the distance of its centre: how much smaller a ball may be that touches there, at the facets of a curved surface,
// and how far contacts are beside those of the centre. Directions whose cosine differs from 1 by less are of one
// contact. A ball that touches is found in five trials about, unless the point is on a sharp edge.
constexpr double kFacetPart = 0.01;
constexpr int kTouchingTrials = 6;

constexpr int kMostTrials = 40;  // at a sharp edge each shrinks by a half: down to 1e-12

constexpr int kCenterings = 8;  // a ball near a rim, off the middle, takes three

constexpr std::size_t kMostContacts = 5;

constexpr int kMostDownSteps = 60;  // a wedge is left by a tenth of its width or more with each step
constexpr int kDownTrials = 4;      // halvings of a step

Point nearest_within(const Solid& solid, const Point& p, double way) {
    if (const auto near = solid.nearest(p, (1.0 + kFileRounding) * way)) {
        return *near;
    }
    return solid.nearest(p).value_or(p);
}

struct Probe {
    Ball ball;      // the largest on the way; of those as large the one nearest to its start
    Point nearest;  // to the end of the way
    bool is_seen = false;
};

// The balls along a way from `p`, and whether nothing lies in between.
Probe probe(const Solid& solid, const Point& p, const Point& inwards, double length) {
    const Point end = p + length * inwards;
    Probe result{{}, nearest_within(solid, end, length), false};
    result.ball = {end, distance(result.nearest, end)};
    double left = length - result.ball.radius;
    if (result.ball.radius < kSmallPart * length) {
        return result;
    }
    while (left > kSmallPart * length) {
        const Point at = p + left * inwards;
        const double step = distance(nearest_within(solid, at, left), at);
        if (step < kSmallPart * left) {
            return result;
        }
        if (step > (1.0 - kFileRounding) * result.ball.radius) {
            result.ball = {at, step};
        }
        left -= step;
    }
    result.is_seen = solid.inside(end);
    return result;
}

// The ball with its centre moved away from the nearest contact to where the opposite side is as near.
Ball centered_between(const Solid& solid, const Ball& ball) {
    if (!(ball.radius > 0.0)) {
        return ball;
    }
    const Point a = nearest_within(solid, ball.center, ball.radius);
    const double radius = distance(a, ball.center);
    const Point from_a = unit(ball.center - a);
    const Point beyond = ball.center + kSmallPart * radius * from_a;
    const Point b = nearest_within(solid, beyond, (1.0 + kSmallPart) * radius);
    const Point from_b = unit(beyond - b);
    // Far, or nowhere, if both contacts are of one side.
    const double way = (dot(ball.center - b, from_b) - radius) / (1.0 - dot(from_a, from_b));
    if (!(std::abs(way) <= kSmallPart * radius)) {
        return ball;
    }
    const Point center = ball.center + way * from_a;
    const double better = distance(nearest_within(solid, center, radius + std::abs(way)), center);
    return better > radius ? Ball{center, better} : Ball{ball.center, radius};
}

// The same from one contact after the other: `uphill` leaves out the last thousandth.
Ball centered(const Solid& solid, Ball ball) {
    for (int round = 0; round < kCenterings; ++round) {
        const Ball next = centered_between(solid, ball);
        const bool is_larger = next.radius > (1.0 + kFileRounding) * ball.radius;
        ball = next;
        if (!is_larger) {
            break;
        }
    }
    return ball;
}

// Up to where two contacts are opposite each other. In a spike of three faces or a sharp edge that ends at a face the
// radius grows slowly, but no two contacts are.
Ball on_ridge(const Solid& solid, const Ball& start, double slope, double most) {
    Ball ball = start;
    for (const double part : {1.0, 0.5, 0.25}) {
        ball = uphill(solid, ball, part * slope, most);
        if (!(ball.radius < most)) {
            break;
        }
        ball = centered(solid, ball);
        // Half the angle between the contacts has this cosine.
        const auto [a, b] = opposite_contacts(solid, ball);
        const double half = 0.5 * distance(a, b);
        if (half * half >= (1.0 - (1.0 + 2.0 * kFacetPart) * slope * slope) * ball.radius * ball.radius) {
            break;
        }
    }
    return ball;
}

}  // namespace

void check_wall_angle(double angle) {
    require(kWallAngleRange.contains(angle),
            "the angle between the contacts of a wall must lie between 60 and 179 degrees");
}

void add_normals(const TriangleMesh& mesh, std::vector<Point>& normals) {
    const auto known = static_cast<Index>(normals.size());
    normals.resize(mesh.vertices.size());
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        if (std::ranges::max(triangle) < known) {
            continue;
        }
        const auto corner = [&](int k) { return mesh.vertices[triangle[k % 3]]; };
        const Point normal = unit(cross(corner(1) - corner(0), corner(2) - corner(0)));
        for (int k = 0; k < 3; ++k) {
            if (triangle[k] >= known) {
                const Point a = unit(corner(k + 1) - corner(k));
                const Point b = unit(corner(k + 2) - corner(k));
                normals[triangle[k]] = normals[triangle[k]] + angle_of(dot(a, b), norm(cross(a, b))) * normal;
            }
        }
    }
    std::for_each(normals.begin() + known, normals.end(), [](Point& normal) { normal = unit(normal); });
}

void OutsideOf::inside(std::span<const Point> points, std::span<std::uint8_t> sides) const {
    solid_.inside(points, sides);
    std::ranges::transform(sides, sides.begin(), [](std::uint8_t side) { return side == 0 ? 1 : 0; });
}

void OutsideOf::crossings(std::span<const Chord> chords, std::span<std::optional<Point>> points) const {
    std::vector<Chord> turned(chords.begin(), chords.end());
    std::ranges::for_each(turned, [](Chord& chord) { std::swap(chord.inside_end, chord.outside_end); });
    solid_.crossings(turned, points);
}

Ball ball_between_sides(const Solid& solid, const Point& p, const Point& inwards, double slope, double most) {
    const auto shrunk = [&](double length, const Point& contact) {
        const double height = dot(contact - p, inwards);
        const double touching = height > 0.0 ? squared_distance(contact, p) / (2.0 * height) : 0.0;
        return std::clamp(touching, kSmallPart * length, (1.0 - kSmallPart) * length);
    };
    double length = most;
    for (int trial = 0; trial < kTouchingTrials; ++trial) {
        const Ball ball{p + length * inwards, 0.0};
        const Point contact = nearest_within(solid, ball.center, length);
        const double radius = distance(contact, ball.center);
        if (radius >= (1.0 - kFacetPart) * length) {
            if (!solid.inside(ball.center)) {
                break;
            }
            // Between the facets of a curved surface it is a little less.
            return radius >= (1.0 - kFacetPart) * most ? Ball{ball.center, most}
                                                       : on_ridge(solid, {ball.center, radius}, slope, most);
        }
        length = shrunk(length, contact);
    }
    length = most;
    for (int trial = 0; trial < kMostTrials; ++trial) {
        const Probe found = probe(solid, p, inwards, length);
        if (found.is_seen) {
            return on_ridge(solid, found.ball, slope, most);
        }
        length = shrunk(length, found.nearest);
    }
    // Where parts overlap, the surface of one that lies in the other has nothing on its outside.
    const bool is_on_side = solid.inside(p + kFileRounding * solid.bounds().diagonal() * inwards);
    return is_on_side ? on_ridge(solid, {p, 0.0}, slope, most) : Ball{p + most * inwards, most};
}

Ball ball_between_sides(const Solid& solid, const Point& p, double slope, double most) {
    const double diagonal = solid.bounds().diagonal();
    const Point foot = solid.nearest(p).value_or(p);
    const double depth = distance(foot, p);
    if (depth > kFileRounding * diagonal && solid.inside(p)) {
        return ball_between_sides(solid, foot, unit(p - foot), slope, most);
    }
    return on_ridge(solid, {foot, 0.0}, slope, most);
}

std::array<Point, 2> opposite_contacts(const Solid& solid, const Ball& ball) {
    std::array<Point, kMostContacts> contacts{nearest_within(solid, ball.center, ball.radius)};
    std::size_t count = 1;
    Point sum = unit(contacts[0] - ball.center);
    // Away from the contacts that are known there is another, unless the ball grows that way.
    for (const double part : {0.001, 0.01, 0.01, kSmallPart}) {
        const double way = part * ball.radius;
        const Point other = nearest_within(solid, ball.center - way * unit(sum), ball.radius + way);
        const Point seen = unit(other - ball.center);
        if (std::ranges::none_of(std::span(contacts).first(count), [&](const Point& contact) {
                return dot(seen, unit(contact - ball.center)) > 1.0 - kFacetPart;
            })) {
            contacts[count++] = other;
            sum = sum + seen;
        }
    }
    std::array<Point, 2> apart{contacts[0], contacts[0]};
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t j = i + 1; j < count; ++j) {
            if (squared_distance(contacts[i], contacts[j]) > squared_distance(apart[0], apart[1])) {
                apart = {contacts[i], contacts[j]};
            }
        }
    }
    return apart;
}

Ball downhill(const Solid& solid, Ball ball, double slope) {
    for (int count = 0; count < kMostDownSteps && ball.radius > 0.0; ++count) {
        const auto [a, b] = opposite_contacts(solid, ball);
        const Point lean = unit(a - ball.center) + unit(b - ball.center);
        const double fall = 0.5 * norm(lean);
        if (fall < kNegligible) {
            break;
        }
        double step = 2.0 * ball.radius * fall;  // to the lowest place between a plane and a point
        bool is_lower = false;
        for (int trial = 0; trial < kDownTrials && !is_lower; ++trial, step *= 0.5) {
            const Point place = ball.center + step * unit(lean);
            const double depth = distance(nearest_within(solid, place, ball.radius + step), place);
            if (!solid.inside(place)) {
                continue;
            }
            const Ball next = on_ridge(solid, {place, depth}, slope, ball.radius);
            is_lower = next.radius < (1.0 - kFileRounding) * ball.radius;
            ball = is_lower ? next : ball;
        }
        if (!is_lower) {
            break;
        }
    }
    return ball;
}

}  // namespace scaleaxis::inline v1
