// SPDX-License-Identifier: Apache-2.0
//
// At which scale is a ball covered by larger ones? Seen from its centre and divided by s, the ball B itself is fixed,
// and another one has a fixed radius too, with its centre at t times its place, t = 1 / s. For t from 1 to 0 balls that
// are larger than B come closer, and what they cover of B stays covered (|y - t d| is convex in t, and at most the
// radius at t = 0). So each point y of B has a t from which on it is covered, and B vanishes at the least of them.
//
// That least one is found by cutting planes: some of the larger balls, the active ones, cover all of B, or leave a
// point, the witness, that they do not cover. A tree of all balls then tells another one that covers the witness, which
// becomes active, or that none does, and B is not covered before the t of the witness.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/balls.hpp"
#include "scaleaxis/filtration.hpp"
#include "scaleaxis/ranges.hpp"
#include "spatial/ball_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kVanishingStage = "vanishing scales";
constexpr int kMostCuttingRounds = 200;  // of cutting planes, then a ball is kept; five are usual
// A convex polyhedron around the origin, a box from which half-spaces are cut: the part of a power diagram that belongs
// to B. Of the planes through a corner it knows three; corners that share two of them have an edge.
class Cell {
   public:
    static constexpr int kMostPlanes = 64;

    void start(double half_side) {
        corners_.clear();
        feet_.clear();
        for (int axis = 0; axis < 3; ++axis) {
            for (const double side : {-1.0, 1.0}) {
                Point foot;
                (axis == 0 ? foot.x : axis == 1 ? foot.y : foot.z) = side * half_side;
                feet_.push_back(foot);
            }
        }
        for (int corner = 0; corner < 8; ++corner) {
            const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
            corners_.push_back({Point{feet_[x].x, feet_[2 + y].y, feet_[4 + z].z},
                                std::uint64_t{1} << x | std::uint64_t{4} << y | std::uint64_t{16} << z});
        }
    }

    bool is_full() const { return feet_.size() == kMostPlanes; }

    // Keeps the points x with x·normal ≤ offset, of which the length of the normal is 1.
    void clip(const Point& normal, double offset) {
        const std::uint64_t plane = std::uint64_t{1} << feet_.size();
        feet_.push_back(offset * normal);
        heights_.resize(corners_.size());
        bool is_cut = false;
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            heights_[c] = dot(corners_[c].at, normal) - offset;
            is_cut = is_cut || heights_[c] > 0.0;
        }
        if (!is_cut) {
            return;
        }
        kept_.clear();
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            if (heights_[c] > 0.0) {
                continue;
            }
            kept_.push_back(corners_[c]);
            for (std::size_t d = 0; d < corners_.size(); ++d) {
                const std::uint64_t edge = corners_[c].planes & corners_[d].planes;
                if (heights_[d] > 0.0 && is_edge(edge)) {
                    const double part = heights_[c] / (heights_[c] - heights_[d]);
                    kept_.push_back({corners_[c].at + part * (corners_[d].at - corners_[c].at), edge | plane});
                }
            }
        }
        corners_.swap(kept_);
    }

    bool is_empty() const { return corners_.empty(); }

    struct Corner {
        Point at;
        std::uint64_t planes;
    };
    const std::vector<Corner>& corners() const { return corners_; }

    const Point& farthest_corner() const {
        return std::ranges::max_element(corners_, {}, [](const Corner& c) { return squared_norm(c.at); })->at;
    }

    // The point of the cell nearest to the origin, which is not in the cell.
    Point nearest_point() const {
        Point nearest = corners_.front().at;
        const auto use = [&](const Point& p) {
            if (squared_norm(p) < squared_norm(nearest)) {
                nearest = p;
            }
        };
        std::uint64_t used = 0;
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            const Point& a = corners_[c].at;
            use(a);
            used |= corners_[c].planes;
            for (std::size_t d = 0; d < c; ++d) {
                if (is_edge(corners_[c].planes & corners_[d].planes)) {
                    const Point along = corners_[d].at - a;
                    const double square = squared_norm(along);
                    const double part = square > 0.0 ? std::clamp(-dot(a, along) / square, 0.0, 1.0) : 0.0;
                    use(a + part * along);
                }
            }
        }
        for (std::size_t f = 0; f < feet_.size(); ++f) {
            if ((used >> f & 1) != 0 && squared_norm(feet_[f]) < squared_norm(nearest) && is_in_face(f)) {
                nearest = feet_[f];
            }
        }
        return nearest;
    }

   private:
    // Does the foot of a plane lie in the face on it? It is on the inner side of all of the face's edges then.
    bool is_in_face(std::size_t plane) const {
        const std::uint64_t bit = std::uint64_t{1} << plane;
        Point middle{};
        double count = 0.0;
        for (const Corner& corner : corners_) {
            if ((corner.planes & bit) != 0) {
                middle = middle + corner.at;
                count += 1.0;
            }
        }
        middle = (1.0 / count) * middle;
        const Point& foot = feet_[plane];
        for (std::size_t c = 0; c < corners_.size(); ++c) {
            for (std::size_t d = 0; d < c; ++d) {
                const std::uint64_t edge = corners_[c].planes & corners_[d].planes;
                if ((edge & bit) == 0 || !is_edge(edge)) {
                    continue;
                }
                const Point along = corners_[d].at - corners_[c].at;
                const Point normal = cross(along, foot);  // in the plane, across the edge
                if (dot(normal, middle - corners_[c].at) * dot(normal, foot - corners_[c].at) < 0.0) {
                    return false;
                }
            }
        }
        return true;
    }

    static bool is_edge(std::uint64_t shared_planes) {  // two of them
        const std::uint64_t second = shared_planes & (shared_planes - 1);
        return second != 0 && (second & (second - 1)) == 0;
    }

    std::vector<Corner> corners_;
    std::vector<Point> feet_;  // of each plane, the point nearest to the origin
    std::vector<Corner> kept_;
    std::vector<double> heights_;
};

// The balls that are larger than one of them.
class LargerBalls {
   public:
    LargerBalls(const BallTree& tree, std::span<const Ball> balls, Index ball)
        : tree_(tree),
          balls_(balls),
          ball_(ball),
          least_radius_(static_cast<float>(balls[ball].radius * tree.scale) * (1.0F - 0x1p-20F)) {}

    bool includes(Index other) const {
        const double radius = balls_[other].radius;
        const double own = balls_[ball_].radius;
        return radius > own || (radius == own && other < ball_);
    }

    // The one that, times the scale, covers a point deepest. `kNone` if none does.
    Index covering(const Point& p, double scale) const {
        const FramedPoint framed(tree_, p);
        const auto in_frame = [&](double distance) {
            const auto framed_distance = static_cast<float>(distance * tree_.scale);
            return framed_distance + BoxTree::kPadding * (1.0F + std::abs(framed_distance));
        };
        const auto factor = static_cast<float>(scale) * (1.0F + 0x1p-20F);
        const auto bound = [&](const BoxTree::Node& node) {
            const Float4 square = squared_distances(node, framed);
            const Float4 distance = {std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2]),
                                     std::sqrt(square[3])};
            const Float4& radii = tree_.radii[&node - tree_.nodes.data()];
            return with_larger(radii, distance * (1.0F - 0x1p-20F) - factor * radii - framed.slack);
        };
        NearestBall found{kNone, 0.0};
        float best = in_frame(0.0);
        for_each_better_leaf(tree_, bound, best, [&](Index first, Index count) {
            for (Index i = first; i < first + count; ++i) {
                const double distance = norm(p - tree_.balls[i].center) - scale * tree_.balls[i].radius;
                const Index other = tree_.order[i];
                if (distance <= found.distance && includes(other)) {
                    found = {other, distance};
                }
            }
            if (found.ball != kNone) {
                best = in_frame(found.distance);
            }
        });
        return found.ball;
    }

    // The one that covers the ball alone at the smallest scale, or of those that never do the one that comes closest to
    // it: of which the difference of the radii divided by the distance is largest.
    Index steepest() const {
        const Point center = balls_[ball_].center;
        const double radius = balls_[ball_].radius;
        const FramedPoint framed(tree_, center);
        const auto own = static_cast<float>(radius * tree_.scale);
        const auto bound = [&](const BoxTree::Node& node) {
            const Float4 square = squared_distances(node, framed);
            const Float4& radii = tree_.radii[&node - tree_.nodes.data()];
            Float4 result{};
            for (int k = 0; k < BoxTree::kWidth; ++k) {
                const float distance = std::sqrt(square[k]) - framed.slack;
                const float difference = radii[k] - own * (1.0F - 0x1p-20F);
                result[k] = std::isinf(distance) ? distance  // there is no child
                            : distance > 0.0F    ? -(1.0F + 0x1p-20F) * difference / distance
                                                 : -std::numeric_limits<float>::max();
            }
            return with_larger(radii, result);
        };
        Index found = kNone;
        double most = -kInfinity;
        float best = std::numeric_limits<float>::infinity();
        for_each_better_leaf(tree_, bound, best, [&](Index first, Index count) {
            for (Index i = first; i < first + count; ++i) {
                const Index other = tree_.order[i];
                if (!includes(other)) {
                    continue;
                }
                const double away = norm(center - tree_.balls[i].center);
                const double slope = away > 0.0 ? (tree_.balls[i].radius - radius) / away : kInfinity;
                if (slope > most || (slope == most && (found == kNone || other < found))) {
                    most = slope;
                    found = other;
                }
            }
            if (found != kNone) {
                best = static_cast<float>(std::max(-most, -3e38)) * (1.0F - 0x1p-20F);
            }
        });
        return found;
    }

   private:
    // Infinite where all balls are smaller.
    Float4 with_larger(const Float4& radii, Float4 bounds) const {
        for (int k = 0; k < BoxTree::kWidth; ++k) {
            bounds[k] = radii[k] < least_radius_ ? std::numeric_limits<float>::infinity() : bounds[k];
        }
        return bounds;
    }

    const BallTree& tree_;
    std::span<const Ball> balls_;
    Index ball_;
    float least_radius_;
};

// The search for the scale at which one ball vanishes.
class Vanishing {
   public:
    Vanishing(const BallTree& tree, std::span<const Ball> balls, Index ball, const FiltrationOptions& options)
        : balls_(balls),
          ball_(ball),
          radius_(balls[ball].radius),
          larger_(tree, balls, ball),
          tolerance_(options.tolerance),
          smallest_(1.0 / options.largest_scale) {}

    double scale() {
        const Index steepest = larger_.steepest();
        if (steepest == kNone) {
            return kNeverVanishes;
        }
        active_.push_back(steepest);
        // What the steepest one alone covers last is a good first witness.
        const Point to_steepest = direction(steepest);
        double upper = std::min(1.0, covering_time(-radius_ * unit(to_steepest)));  // B is covered at no larger t
        double lower = (balls_[steepest].radius - radius_) / norm(to_steepest);     // covered by the steepest one
        if (upper == 1.0) {
            if (!(lower < 1.0) || is_covered_at(1.0)) {
                return 1.0;
            }
            upper = uncovered_time_;
        }
        if (upper < smallest_) {
            return kNeverVanishes;
        }
        if (lower < smallest_) {
            if (!is_covered_at(smallest_)) {
                return kNeverVanishes;
            }
            lower = smallest_;
        }
        while (upper > (1.0 + tolerance_) * lower) {
            const double t = std::sqrt(lower * upper);
            if (is_covered_at(t)) {
                lower = t;
            } else {
                upper = uncovered_time_;
            }
        }
        return std::max(1.0, 1.0 / lower);
    }

   private:
    Point direction(Index other) const { return balls_[other].center - balls_[ball_].center; }

    bool is_active(Index other) const { return std::ranges::find(active_, other) != active_.end(); }

    // The largest t at which a ball covers a point y of B.
    double covering_time(const Point& y, Index other) const {
        const Point d = direction(other);
        const double square = squared_norm(d);
        const double radius = balls_[other].radius;
        const double along = dot(y, d);
        const double rest = std::max(0.0, (radius - norm(y)) * (radius + norm(y)));
        return square > 0.0 ? (along + std::sqrt(along * along + square * rest)) / square : kInfinity;
    }

    // The largest t at which any ball covers y, or more than 1. The ball becomes active.
    double covering_time(const Point& y) {
        double t = 0.0;
        for (const Index other : active_) {
            t = std::max(t, covering_time(y, other));
        }
        Index last = kNone;
        while (t < 1.0) {
            const Index other = covering_ball(y, std::max(t, 0.5 * smallest_));
            const double next = other != kNone ? covering_time(y, other) : 0.0;
            if (!(next > t)) {
                break;
            }
            t = next;
            last = other;
        }
        if (last != kNone && !is_active(last)) {
            active_.push_back(last);
        }
        return t;
    }

    Index covering_ball(const Point& y, double t) const {
        return larger_.covering(balls_[ball_].center + (1.0 / t) * y, 1.0 / t);
    }

    // Do the larger balls cover B at t? If not, `uncovered_time_` is a t at most as large, and B is not covered before.
    bool is_covered_at(double t) {
        for (int round = 0; round < kMostCuttingRounds; ++round) {
            const std::optional<Point> witness = uncovered_point(t);
            if (!witness) {
                return true;
            }
            const Index other = covering_ball(*witness, t);
            // An active one does not cover the witness for certain.
            if (other == kNone || is_active(other)) {
                uncovered_time_ = std::min(t, covering_time(*witness));
                return false;
            }
            active_.push_back(other);
        }
        uncovered_time_ = t;
        return false;
    }

    // A point of B that the active balls do not cover at t.
    std::optional<Point> uncovered_point(double t) {
        if (radius_ == 0.0) {
            const auto covers = [&](Index other) { return covering_time({}, other) >= t; };
            return std::ranges::any_of(active_, covers) ? std::nullopt : std::optional(Point{});
        }
        cut_cell(t);
        if (cell_.is_empty()) {
            return std::nullopt;
        }
        // The cell is what B has more of than the others: there its sphere is not covered.
        const Point& far = cell_.farthest_corner();
        if (norm(far) > (1.0 - kRelativeRounding) * radius_) {
            const Point near = is_center_in_cell_ ? Point{} : cell_.nearest_point();
            if (norm(near) >= (1.0 - kRelativeRounding) * radius_) {
                return std::nullopt;  // all of B belongs to others
            }
            return on_sphere(near, far);
        }
        return point_of_void(t);
    }

    // The point of the sphere between a point of the cell in B and one outside, off the sides of the cell: what lies on
    // them an active ball covers.
    Point on_sphere(Point near, Point far) const {
        Point middle{};
        for (const Cell::Corner& corner : cell_.corners()) {
            middle = middle + corner.at;
        }
        middle = (1.0 / static_cast<double>(cell_.corners().size())) * middle;
        for (double part = 0.5; part > kRelativeRounding; part *= 0.5) {
            const Point inner = near + part * (middle - near);
            const Point outer = far + part * (middle - far);
            if (norm(inner) < radius_ && norm(outer) > radius_) {
                near = inner;
                far = outer;
                break;
            }
        }
        const Point way = far - near;
        const double a = squared_norm(way), b = dot(near, way), c = (norm(near) - radius_) * (norm(near) + radius_);
        return near + std::clamp((-b + std::sqrt(std::max(0.0, b * b - a * c))) / a, 0.0, 1.0) * way;
    }

    struct HalfSpace {
        Point normal;
        double offset;
    };
    // Where the power of ball i is not larger than that of ball j, with centres t·d.
    static std::optional<HalfSpace> half_space(const Point& di, double ri, const Point& dj, double rj, double t) {
        const Point between = dj - di;
        const double length = t * norm(between);
        if (!(length > 0.0)) {
            return std::nullopt;
        }
        const Point normal = (t / length) * between;
        const double from_i = 0.5 * (length - (rj - ri) * (rj + ri) / length);
        return HalfSpace{normal, from_i + t * dot(di, normal)};
    }

    void cut_cell(double t) {
        cell_.start(1.0001 * radius_);
        is_center_in_cell_ = true;
        if (active_.size() + 6 > Cell::kMostPlanes) {
            active_.erase(active_.begin(), active_.begin() + active_.size() / 2);
        }
        for (const Index other : active_) {
            const auto half = half_space({}, radius_, direction(other), balls_[other].radius, t);
            if (!half) {  // the same centre: it covers all of B
                while (!cell_.is_empty()) {
                    cell_.clip({1.0, 0.0, 0.0}, -2.0 * radius_);
                }
                return;
            }
            is_center_in_cell_ = is_center_in_cell_ && half->offset >= 0.0;
            cell_.clip(half->normal, half->offset);
            if (cell_.is_empty()) {
                return;
            }
        }
    }

    // The active balls cover the sphere of B: do they leave a void inside? In the cell of B the least of their powers
    // is convex piece by piece, so that it is largest in a corner of a piece.
    std::optional<Point> point_of_void(double t) {
        const auto power = [&](const Point& y, Index other) {
            return squared_distance(y, t * direction(other)) - balls_[other].radius * balls_[other].radius;
        };
        const auto covers = [&](const Point& y, Index other) {
            return power(y, other) <= -kRelativeRounding * radius_ * radius_;
        };
        for (const Index other : active_) {
            if (std::ranges::all_of(cell_.corners(), [&](const Cell::Corner& c) { return covers(c.at, other); })) {
                return std::nullopt;
            }
        }
        for (const Index i : active_) {
            piece_.start(1.0001 * radius_);
            for (const Index j : active_) {
                if (j != i && !piece_.is_empty()) {
                    clip(piece_, half_space(direction(i), balls_[i].radius, direction(j), balls_[j].radius, t));
                }
            }
            for (const Index j : active_) {
                if (!piece_.is_empty() && !piece_.is_full()) {
                    clip(piece_, half_space({}, radius_, direction(j), balls_[j].radius, t));
                }
            }
            for (const Cell::Corner& corner : piece_.corners()) {
                if (!covers(corner.at, i)) {
                    return corner.at;
                }
            }
        }
        return std::nullopt;
    }

    static void clip(Cell& cell, const std::optional<HalfSpace>& half) {
        if (half) {
            cell.clip(half->normal, half->offset);
        }
    }

    std::span<const Ball> balls_;
    Index ball_;
    double radius_;
    LargerBalls larger_;
    double tolerance_;
    double smallest_;  // t
    std::vector<Index> active_;
    Cell cell_;
    Cell piece_;
    bool is_center_in_cell_ = true;
    double uncovered_time_ = 1.0;
};

void check_options(const FiltrationOptions& options) {
    require(kLargestScaleRange.contains(options.largest_scale), "the largest scale must lie between 1 and 1000");
    require(options.tolerance >= 1e-9 && options.tolerance <= 0.1,
            "the tolerance of the scales must lie between 1e-9 and 0.1");
}

// Balls as others have to be, but radii may be 0.
void check_balls_and_points(std::span<const Ball> balls) {
    std::vector<Ball> checked(balls.begin(), balls.end());
    for (Ball& ball : checked) {
        ball.radius = ball.radius == 0.0 ? 1.0 : ball.radius;
    }
    check_balls(checked);
}

}  // namespace

std::vector<double> vanishing_scales(std::span<const Ball> balls, const FiltrationOptions& options,
                                     const Execution& execution) {
    return in_arena(execution, [&] {
        check_options(options);
        check_balls_and_points(balls);
        report(execution, kVanishingStage, 0.0);
        std::vector<double> scales(balls.size());
        if (!balls.empty()) {
            const BallTree tree = build_ball_tree(balls);
            for_each_index(
                static_cast<Index>(balls.size()),
                [&](Index i) { scales[i] = Vanishing(tree, balls, i, options).scale(); }, Index{64});
        }
        report(execution, kVanishingStage, 1.0);
        return scales;
    });
}

}  // namespace scaleaxis::inline v1
