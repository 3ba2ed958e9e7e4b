// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/creases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"

namespace scaleaxis::inline v1 {
namespace {

// The search for an edge: points ever nearer to it.
constexpr std::array kAside{0.02, 0.1, 0.5, 1.0};  // of the radius: how far from one contact to go to find the next one
constexpr int kMaxSteps = 10;

struct Plane {
    Point normal;
    Point point{kInfinity, kInfinity, kInfinity};

    double from(const Point& p) const { return dot(normal, point - p); }
};

struct Search {
    Point start;
    Point at;
    Crease crease;
    std::array<Plane, 3> planes{};
    bool is_active = true;
    bool is_found = false;
};

// The point on both planes that is nearest to `p`.
Point on_both(const Plane& a, const Plane& b, const Point& p) {
    const double cosine = dot(a.normal, b.normal);
    const double determinant = 1.0 - cosine * cosine;
    const double da = a.from(p);
    const double db = b.from(p);
    return p + ((da - cosine * db) / determinant) * a.normal + ((db - cosine * da) / determinant) * b.normal;
}

// Far away if they are nearly parallel to a line.
Point on_all(const std::array<Plane, 3>& planes, const Point& p) {
    const auto& [a, b, c] = planes;
    const Point bc = cross(b.normal, c.normal);
    const double determinant = dot(a.normal, bc);
    return p + (1.0 / determinant) *
                   (a.from(p) * bc + b.from(p) * cross(c.normal, a.normal) + c.from(p) * cross(a.normal, b.normal));
}

// Looks for sharp edges, or for corners, near points inside a solid, for all at the same time.
class CreaseSearch {
   public:
    CreaseSearch(const Solid& solid, const SharpEdgeOptions& options, bool wants_corners)
        : solid_(solid),
          most_cosine_(cosine_of_degrees(options.angle)),
          reach_(kCreaseReach * options.tolerance),
          wants_corners_(wants_corners) {}

    std::vector<std::optional<Crease>> run(std::span<const Point> points) {
        for (const Point& p : points) {
            searches_.push_back({p, p, {p, {}, {}}});
        }
        for (int step = 0; step < kMaxSteps; ++step) {
            stop_if_cancelled();
            find_planes();
            for (Search& search : searches_) {
                if (search.is_active) {
                    approach(search);
                }
            }
        }
        return creases_on_edges();
    }

   private:
    // The tangent planes of the contacts: the nearest point, and those that are nearest from a little aside.
    void find_planes() {
        ask(
            0, [](const Search&) { return true; }, [](const Search& search) { return search.at; });
        find_plane(1, [](const Search& search) { return search.planes[0].normal; });
        if (wants_corners_) {
            find_plane(2, [](const Search& search) { return unit(search.planes[0].normal + search.planes[1].normal); });
        }
    }

    // Asks for the point of the boundary nearest to `point_of(search)` for each active search that is `is_wanted`, and
    // for the tangent plane there.
    template <class IsWanted, class PointOf>
    void ask(std::size_t number, const IsWanted& is_wanted, const PointOf& point_of) {
        std::vector<Search*> asking;
        std::vector<Point> points;
        std::vector<double> bounds;
        for (Search& search : searches_) {
            if (search.is_active && is_wanted(search)) {
                asking.push_back(&search);
                points.push_back(point_of(search));
                // Some point of the boundary is known: no farther one is wanted.
                bounds.push_back((1.0 + kFileRounding) * distance(points.back(), search.planes[0].point));
            }
        }
        const std::vector<std::optional<Point>> answers = nearest_of(solid_, points, bounds);
        for (std::size_t i = 0; i < asking.size(); ++i) {
            asking[i]->is_active = answers[i] && *answers[i] != points[i];
            if (asking[i]->is_active) {
                asking[i]->planes[number] = {unit(*answers[i] - points[i]), *answers[i]};
            }
        }
    }

    // The plane that is nearest from a point farther from those before. Little farther first: in thin parts the
    // opposite side is not far.
    template <class NormalOf>
    void find_plane(std::size_t number, const NormalOf& normal_of) {
        const auto is_missing = [&](const Search& search) {
            return std::any_of(search.planes.begin(), search.planes.begin() + number, [&](const Plane& before) {
                return !(dot(before.normal, search.planes[number].normal) < most_cosine_);
            });
        };
        for (Search& search : searches_) {
            search.planes[number] = search.planes[0];
        }
        for (const double part : kAside) {
            ask(number, is_missing, [&](const Search& search) {
                const double radius = distance(search.at, search.planes[0].point);
                return search.at - (part * radius) * normal_of(search);
            });
        }
        for (Search& search : searches_) {
            search.is_active = search.is_active && !is_missing(search);
        }
    }

    void approach(Search& search) const {
        const auto& [a, b, c] = search.planes;
        const Point place = wants_corners_ ? on_all(search.planes, search.at) : on_both(a, b, search.at);
        const double way = distance(place, search.start);
        const double change = distance(place, search.crease.place);
        search.crease = {place, wants_corners_ ? Point() : unit(cross(a.normal, b.normal)), {a.normal, b.normal}};
        search.at = place + kApproach * (search.at - place);
        search.is_found = way <= reach_ && change <= kNegligible * way;
        search.is_active = way <= reach_ && change > kFileRounding * way;
    }

    // On a convex edge the solid ends: it is entered a little before, and left a little behind.
    std::vector<std::optional<Crease>> creases_on_edges() const {
        const std::vector<Index> found =
            indices_where(searches_.size(), [&](Index i) { return searches_[i].is_found; });
        std::vector<Point> points;
        for (const Index i : found) {
            const Point& place = searches_[i].crease.place;
            const Point little = kNegligible * (place - searches_[i].start);
            append(points, {place - little, place + little});
        }
        const std::vector<std::uint8_t> sides = sides_of(solid_, points);
        std::vector<std::optional<Crease>> result(searches_.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
            if (sides[2 * k] != 0 && sides[2 * k + 1] == 0) {
                result[found[k]] = searches_[found[k]].crease;
            }
        }
        return result;
    }

    const Solid& solid_;
    double most_cosine_;
    double reach_;
    bool wants_corners_;
    std::vector<Search> searches_;
};

}  // namespace

std::vector<std::optional<Crease>> creases_near(const Solid& solid, std::span<const Point> points,
                                                const SharpEdgeOptions& options, bool wants_corners) {
    return CreaseSearch(solid, options, wants_corners).run(points);
}

}  // namespace scaleaxis::inline v1
