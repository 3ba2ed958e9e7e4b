// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/creases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/angles.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "sampling/questions.hpp"

namespace scaleaxis::inline v1 {
namespace {

// The search for an edge: points ever nearer to it.
constexpr std::array kAside{0.02, 0.1, 0.5, 1.0};  // of the radius: how far from one contact to go to find the next one
constexpr int kMaxSteps = 10;

struct Plane {
    Point normal;
    Point point;

    double from(const Point& p) const { return dot(normal, point - p); }
};

// The tangent plane of the boundary at the point that is nearest to `p`.
Plane tangent_plane(const Point& p, const Point& nearest) { return {unit(nearest - p), nearest}; }

struct Search {
    Point start;
    Point at;
    double radius = 0.0;
    std::array<Plane, 3> planes{};
    Crease crease;
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
        searches_.resize(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            searches_[i].start = points[i];
            searches_[i].at = points[i];
        }
        for (int step = 0; step < kMaxSteps; ++step) {
            stop_if_cancelled();
            find_planes(step == 0);
            for_each_active([&](Search& search) { approach(search, step); });
        }
        check_places();
        std::vector<std::optional<Crease>> result(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (searches_[i].is_found) {
                result[i] = searches_[i].crease;
            }
        }
        return result;
    }

   private:
    template <class Work>
    void for_each_active(const Work& work) {
        for (Search& search : searches_) {
            if (search.is_active) {
                work(search);
            }
        }
    }

    // A question for the nearest point of the boundary.
    struct Question {
        Point point;
        double bound = std::numeric_limits<double>::infinity();
    };

    // Asks `question_of(search)` for each active search that `is_wanted`, and has `take(search, point, nearest)` take
    // the answer.
    template <class IsWanted, class QuestionOf, class Take>
    void ask(const IsWanted& is_wanted, const QuestionOf& question_of, const Take& take) {
        std::vector<Search*> asking;
        std::vector<Point> points;
        std::vector<double> bounds;
        for_each_active([&](Search& search) {
            if (is_wanted(search)) {
                const Question question = question_of(search);
                asking.push_back(&search);
                points.push_back(question.point);
                bounds.push_back(question.bound);
            }
        });
        const std::vector<std::optional<Point>> answers = nearest_of(solid_, points, bounds);
        for (std::size_t i = 0; i < asking.size(); ++i) {
            if (answers[i]) {
                take(*asking[i], points[i], *answers[i]);
            } else {
                asking[i]->is_active = false;
            }
        }
    }

    // The tangent planes of the contacts: the nearest point, and those that are nearest from a little aside.
    void find_planes(bool is_first) {
        ask([](const Search&) { return true; },
            [&](const Search& search) {
                return is_first ? Question{search.at} : question_near(search.at, search.planes[0].point);
            },
            [&](Search& search, const Point& p, const Point& nearest) {
                search.planes[0] = tangent_plane(p, nearest);
                search.radius = distance(p, nearest);
                if (!(search.radius > 0.0 && search.radius <= reach_)) {
                    search.is_active = false;
                    search.is_found = false;
                }
            });
        const auto is_second = [&](const Search& search) {
            return dot(search.planes[0].normal, search.planes[1].normal) < most_cosine_;
        };
        find_plane(
            1, [](const Search& search) { return search.planes[0].normal; }, is_second);
        if (wants_corners_) {
            find_plane(
                2, [](const Search& search) { return unit(search.planes[0].normal + search.planes[1].normal); },
                [&](const Search& search) {
                    const auto& [a, b, c] = search.planes;
                    return dot(c.normal, a.normal) < most_cosine_ && dot(c.normal, b.normal) < most_cosine_;
                });
        }
    }

    // Some point of the boundary is known: no farther one is wanted.
    static Question question_near(const Point& p, const Point& known) {
        return {p, (1.0 + kFileRounding) * distance(p, known)};
    }

    // The plane that is nearest from a point farther from those before. Little farther first: in thin parts the
    // opposite side is not far.
    template <class NormalOf, class IsFound>
    void find_plane(std::size_t number, const NormalOf& normal_of, const IsFound& is_found) {
        for (Search& search : searches_) {
            search.planes[number] = search.planes[0];
        }
        for (const double part : kAside) {
            ask([&](const Search& search) { return !is_found(search); },
                [&](const Search& search) {
                    return question_near(search.at - (part * search.radius) * normal_of(search),
                                         search.planes[0].point);
                },
                [&](Search& search, const Point& p, const Point& nearest) {
                    search.planes[number] = tangent_plane(p, nearest);
                });
        }
        for_each_active([&](Search& search) { search.is_active = is_found(search); });
    }

    void approach(Search& search, int step) const {
        const auto& [a, b, c] = search.planes;
        const Point place = wants_corners_ ? on_all(search.planes, search.at) : on_both(a, b, search.at);
        const double way = distance(place, search.start);
        if (!(way <= reach_)) {
            search.is_active = false;
            search.is_found = false;
            return;
        }
        const double change = step == 0 ? way : distance(place, search.crease.place);
        search.crease = {place, wants_corners_ ? Point() : unit(cross(a.normal, b.normal)), {a.normal, b.normal}};
        search.at = place + kApproach * (search.at - place);
        search.is_found = change <= kNegligible * way;
        search.is_active = change > kFileRounding * way;
    }

    // On a convex edge the solid ends: it is entered a little before, and left a little behind.
    void check_places() {
        std::vector<Search*> found;
        std::vector<Point> points;
        for (Search& search : searches_) {
            if (search.is_found) {
                const Point& place = search.crease.place;
                const Point little = kNegligible * (place - search.start);
                found.push_back(&search);
                append(points, {place - little, place + little});
            }
        }
        const std::vector<std::uint8_t> sides = sides_of(solid_, points);
        for (std::size_t i = 0; i < found.size(); ++i) {
            found[i]->is_found = sides[2 * i] != 0 && sides[2 * i + 1] == 0;
        }
    }

    const Solid& solid_;
    double most_cosine_;
    double reach_;
    bool wants_corners_;
    std::vector<Search> searches_;
};

}  // namespace

double angle_between(const Point& a, const Point& b) {
    return angle_of_cosine(std::clamp(dot(a, b), -1.0, 1.0)) / kDegree;
}

std::vector<std::optional<Crease>> creases_near(const Solid& solid, std::span<const Point> points,
                                                const SharpEdgeOptions& options, bool wants_corners) {
    return CreaseSearch(solid, options, wants_corners).run(points);
}

}  // namespace scaleaxis::inline v1
