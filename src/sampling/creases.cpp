// SPDX-License-Identifier: Apache-2.0
#include "sampling/creases.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {
namespace {

// The longest piece, in tolerances.
constexpr double kLongest = 0.8;

// Other samples keep this distance, in tolerances, from those of creases at first: more than the 0.57 at which a point
// can lie in the diametral ball of the longest piece.
constexpr double kApart = 0.6;

// Shorter pieces, in tolerances, are not cut: where creases meet at an acute angle that would have no end.
constexpr double kShortest = 1.0 / 16.0;

double length(const Segment& piece) { return distance(piece[0], piece[1]); }

bool is_in_diametral_ball(const Point& p, const Segment& piece) { return dot(p - piece[0], p - piece[1]) < 0.0; }

std::tuple<double, double, double> coordinates(const Point& p) { return {p.x, p.y, p.z}; }

void sort_unique(std::vector<Point>& points) {
    std::ranges::sort(points, {}, coordinates);
    points.erase(std::unique(points.begin(), points.end()), points.end());
}

}  // namespace

template <class Visit>
std::vector<Index> Creases::crowded_by(const PointTree& tree, const Visit& visit) const {
    std::vector<Index> crowded;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
        const Segment& piece = pieces_[k];
        bool is_crowded = false;
        for_each_point_near(tree, midpoint(piece[0], piece[1]), 0.5 * length(piece), [&](Index position, double) {
            if (is_in_diametral_ball(tree.points[position], piece)) {
                is_crowded = true;
                visit(position);
            }
        });
        if (is_crowded) {
            crowded.push_back(static_cast<Index>(k));
        }
    }
    return crowded;
}

Creases::Creases(std::span<const Segment> segments, double tolerance) : tolerance_(tolerance) {
    for (const auto& [a, b] : segments) {
        samples_.push_back(a);
        const double whole = distance(a, b);
        const int parts = static_cast<int>(std::ceil(whole / (kLongest * tolerance)));
        for (int i = 0; i < parts; ++i) {
            const Point& from = samples_.back();
            const Point to = i + 1 < parts ? a + ((i + 1.0) / parts) * (b - a) : b;
            pieces_.push_back({from, to});
            samples_.push_back(to);
        }
    }
    sort_unique(samples_);
    do {
        stop_if_cancelled();
    } while (!cut(crowded_by(build_point_tree(samples_), [](Index) {})).empty());
}

Index Creases::position_of(const Point& p) const {
    const auto place = std::ranges::lower_bound(samples_, coordinates(p), {}, coordinates);
    return place != samples_.end() && *place == p ? static_cast<Index>(place - samples_.begin()) : kNone;
}

std::vector<Point> Creases::cut(const std::vector<Index>& pieces) {
    std::vector<Point> middles;
    for (const Index k : pieces) {
        const auto [a, b] = pieces_[k];
        if (distance(a, b) > kShortest * tolerance_) {
            const Point middle = midpoint(a, b);
            pieces_[k] = {a, middle};
            pieces_.push_back({middle, b});
            middles.push_back(middle);
        }
    }
    if (!middles.empty()) {
        append(samples_, middles);
        sort_unique(samples_);
    }
    return middles;
}

std::vector<Point> Creases::apart(const std::vector<Point>& points) const {
    if (samples_.empty()) {
        return points;
    }
    const PointTree tree = build_point_tree(samples_);
    const double least = kApart * tolerance_;
    return collect<std::vector<Point>>(points.size(), [&](std::size_t i, std::vector<Point>& out) {
        if (nearest_point(tree, points[i]).squared_distance >= least * least) {
            out.push_back(points[i]);
        }
    });
}

std::vector<Point> Creases::making_way(const std::vector<Point>& points) {
    if (pieces_.empty() || points.empty()) {
        return points;
    }
    const PointTree tree = build_point_tree(points);
    std::vector<char> is_crowding(points.size(), 0);
    std::vector<Point> result = cut(crowded_by(tree, [&](Index position) { is_crowding[tree.order[position]] = 1; }));
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (is_crowding[i] == 0) {
            result.push_back(points[i]);
        }
    }
    return result;
}

}  // namespace scaleaxis::inline v1
