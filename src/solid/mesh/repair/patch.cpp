// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/repair/patch.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

// The time for the patch of least area is cubic.
constexpr std::size_t kLongest = 250;

// Cost of a fold, in doubled areas, per length of the fold, width of the hole, and one less the cosine of its angle.
// Area alone would close a hole that goes around most of a limb by two caps, and cut the limb off.
constexpr double kBending = 0.5;

double doubled_area(const Point& a, const Point& b, const Point& c) { return norm(cross(b - a, c - a)); }

/// 0 where there is none.
Point unit_normal(const Point& a, const Point& b, const Point& c) {
    const Point normal = cross(b - a, c - a);
    const double length = norm(normal);
    return length > 0.0 ? (1.0 / length) * normal : Point{};
}

/// Cuts corners off, those of least area first, until `kLongest` are left.
Loop shortened(const std::vector<Point>& vertices, const Loop& given, std::vector<Triangle>& triangles) {
    const std::vector<Index>& loop = given.corners;
    std::vector<Index> apexes = given.apexes;
    const std::size_t n = loop.size();
    std::vector<std::size_t> previous(n), next(n);
    std::vector<double> areas(n);
    std::set<std::pair<double, std::size_t>> corners;
    const auto update = [&](std::size_t i) {
        corners.erase({areas[i], i});
        areas[i] = doubled_area(vertices[loop[previous[i]]], vertices[loop[i]], vertices[loop[next[i]]]);
        corners.insert({areas[i], i});
    };
    for (std::size_t i = 0; i < n; ++i) {
        previous[i] = (i + n - 1) % n;
        next[i] = (i + 1) % n;
    }
    for (std::size_t i = 0; i < n; ++i) {
        update(i);
    }
    while (corners.size() > kLongest) {
        const std::size_t i = corners.begin()->second;
        corners.erase(corners.begin());
        triangles.push_back({loop[previous[i]], loop[i], loop[next[i]]});
        apexes[previous[i]] = loop[i];
        next[previous[i]] = next[i];
        previous[next[i]] = previous[i];
        update(previous[i]);
        update(next[i]);
    }
    Loop rest;
    const std::size_t first = corners.begin()->second;
    std::size_t i = first;
    do {
        rest.corners.push_back(loop[i]);
        rest.apexes.push_back(apexes[i]);
        i = next[i];
    } while (i != first);
    return rest;
}

/// The best patches of all runs of corners i … j of a rim, from the short runs to the whole.
class HolePatch {
   public:
    HolePatch(const std::vector<Point>& vertices, const Loop& rim) : vertices_(vertices), rim_(rim) {
        Box box;
        for (const Index v : rim.corners) {
            places_.push_back(vertices[v]);
            box.extend(vertices[v]);
        }
        bending_ = kBending * box.diagonal();
        const std::size_t n = places_.size();
        runs_.resize(n * n);
        for (std::size_t i = 0; i + 1 < n; ++i) {
            run(i, i + 1).normal = normal_beyond(i);
        }
        CancellationPoint cancellation(1);
        for (std::size_t length = 2; length < n; ++length) {
            cancellation();
            for (std::size_t i = 0; i + length < n; ++i) {
                fill(i, i + length);
            }
        }
    }

    void add_to(std::vector<Triangle>& triangles) const {
        std::vector<std::pair<std::size_t, std::size_t>> sides{{0, places_.size() - 1}};
        while (!sides.empty()) {
            const auto [i, j] = sides.back();
            sides.pop_back();
            if (j - i < 2) {
                continue;
            }
            const std::size_t k = run(i, j).tip;
            triangles.push_back({rim_.corners[i], rim_.corners[k], rim_.corners[j]});
            sides.emplace_back(i, k);
            sides.emplace_back(k, j);
        }
    }

   private:
    struct Run {
        double cost = 0.0;
        std::size_t tip = 0;  ///< third corner of the triangle at the side from j to i
        Point normal;         ///< of this triangle; of a single side, of the triangle beyond
    };

    Run& run(std::size_t i, std::size_t j) { return runs_[i * places_.size() + j]; }
    const Run& run(std::size_t i, std::size_t j) const { return runs_[i * places_.size() + j]; }

    Point normal_beyond(std::size_t i) const {
        const std::size_t next = (i + 1) % places_.size();
        return unit_normal(places_[next], places_[i], vertices_[rim_.apexes[i]]);
    }

    double cost_of_fold(std::size_t i, std::size_t j, const Point& one, const Point& other) const {
        return bending_ * distance(places_[i], places_[j]) * (1.0 - dot(one, other));
    }

    void fill(std::size_t i, std::size_t j) {
        const bool is_whole = j - i + 1 == places_.size();
        Run best{std::numeric_limits<double>::infinity(), i + 1, {}};
        for (std::size_t k = i + 1; k < j; ++k) {
            double cost = run(i, k).cost + run(k, j).cost;
            if (!(cost < best.cost)) {
                continue;
            }
            cost += doubled_area(places_[i], places_[k], places_[j]);
            if (!(cost < best.cost)) {
                continue;
            }
            const Point normal = unit_normal(places_[i], places_[k], places_[j]);
            cost += cost_of_fold(i, k, normal, run(i, k).normal) + cost_of_fold(k, j, normal, run(k, j).normal);
            cost += is_whole ? cost_of_fold(i, j, normal, normal_beyond(j)) : 0.0;
            if (cost < best.cost) {
                best = {cost, k, normal};
            }
        }
        run(i, j) = best;
    }

    const std::vector<Point>& vertices_;
    const Loop& rim_;
    std::vector<Point> places_;  ///< of the corners
    double bending_ = 0.0;
    std::vector<Run> runs_;
};

}  // namespace

std::vector<Triangle> patch_of(const std::vector<Point>& vertices, const Loop& loop) {
    std::vector<Triangle> triangles;
    const Loop rim = loop.corners.size() > kLongest ? shortened(vertices, loop, triangles) : loop;
    HolePatch(vertices, rim).add_to(triangles);
    return triangles;
}

}  // namespace scaleaxis::inline v1
