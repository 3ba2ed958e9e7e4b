// SPDX-License-Identifier: Apache-2.0

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/built_once.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/solid.hpp"
#include "solid/function/inquiry.hpp"
#include "solid/zero_set/bracketed_root.hpp"
#include "solid/zero_set/foot_search.hpp"
#include "solid/zero_set/lattice.hpp"
#include "solid/zero_set/near_cells.hpp"
#include "solid/zero_set/near_points.hpp"
#include "solid/zero_set/surface_net.hpp"
#include "solid/zero_set/trilinear.hpp"
#include "spatial/extent.hpp"
#include "spatial/poisson_disk.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr double kDefaultFeature = 1.0 / 128.0;  // of the diagonal of the bounds
constexpr double kFunctionMargin = 0.45;         // of the solid's box, in steps: a sharp tip hides between samples
constexpr double kExtentSpacing = 0.5;           // of points that show how far the solid goes, in steps
constexpr double kMostValue = 1e100;             // values are cut off there, so that places can be interpolated
// Gradients are differences over this fraction of the step, or this multiple of the rounding of coordinates.
constexpr double kDifference = 1e-5;
constexpr double kDifferenceOfRounding = 1e6;

constexpr double kMostPoints = 0x1p34;  // of the lattice

// How many places a function is asked for together: enough of them to share what a call costs, or few, so that threads
// can share the work.
constexpr std::size_t kFewPlaces = 256;
constexpr std::size_t kManyPlaces = 1 << 13;

// And at most: between calls, work can be cancelled.
constexpr std::size_t kMostPlaces = 1 << 14;

std::string text_of(const Point& p) {
    Words text;
    text << '(' << p.x << ", " << p.y << ", " << p.z << ')';
    return text.str();
}

// Where a segment from a point of the box leaves it, 1 if it does not.
double exit_of(const Box& box, const Point& from, const Point& to) {
    double exit = 1.0;
    const auto clip = [&](double a, double b, double low, double high) {
        if (b > high) {
            exit = std::min(exit, (high - a) / (b - a));
        } else if (b < low) {
            exit = std::min(exit, (low - a) / (b - a));
        }
    };
    clip(from.x, to.x, box.min.x, box.max.x);
    clip(from.y, to.y, box.min.y, box.max.y);
    clip(from.z, to.z, box.min.z, box.max.z);
    return exit;
}

/// Can be called from several threads at once if `function` can.
BatchFunction point_by_point(std::function<double(const Point&)> function) {
    return [function = std::move(function)](std::span<const Point> points, std::span<double> values) {
        for (std::size_t i = 0; i < points.size(); ++i) {
            values[i] = function(points[i]);
        }
    };
}

/// How far `p` lies outside of the box; negative: inside.
double distance_beyond(const Box& box, const Point& p) {
    return std::max(
        {box.min.x - p.x, p.x - box.max.x, box.min.y - p.y, p.y - box.max.y, box.min.z - p.z, p.z - box.max.z});
}

/// Negative where the function is and the box reaches. The function is asked within the box only.
BatchFunction clipped(BatchFunction function, const Box& box) {
    return [function = std::move(function), box](std::span<const Point> points, std::span<double> values) {
        std::vector<Point> within;
        for (std::size_t i = 0; i < points.size(); ++i) {
            values[i] = distance_beyond(box, points[i]);
            if (values[i] <= 0.0) {
                within.push_back(points[i]);
            }
        }
        std::vector<double> answers(within.size());
        if (!within.empty()) {
            function(within, answers);
        }
        auto answer = answers.begin();
        for (double& value : values) {
            if (value <= 0.0) {
                value = std::max(*answer++, value);  // the answer if it is not a number
            }
        }
    };
}

/// Calls `function` from one thread at a time, and with so few points that cancellation need not wait for long.
BatchFunction one_call_at_a_time(BatchFunction function) {
    return [function = std::move(function), mutex = std::make_shared<std::mutex>()](std::span<const Point> points,
                                                                                    std::span<double> values) {
        for (std::size_t begin = 0; begin < points.size(); begin += kMostPlaces) {
            const std::size_t count = std::min(kMostPlaces, points.size() - begin);
            const std::lock_guard lock(*mutex);
            stop_if_cancelled();
            // A parallel loop in the function must not take up another task of ours, which would wait for the mutex.
            tasks::this_task_arena::isolate(
                [&] { function(points.subspan(begin, count), values.subspan(begin, count)); });
        }
    };
}

class FunctionSolid final : public Solid, public NearestPoints {
   public:
    /// \param batch how many places the function is asked for at once where there are as many
    FunctionSolid(BatchFunction function, std::size_t batch, const FunctionOptions& options, const Execution& execution)
        : function_(options.is_clipped ? clipped(std::move(function), options.bounds) : std::move(function)),
          batch_(batch),
          bounds_(options.bounds),
          step_(options.smallest_feature),
          is_distance_(options.is_distance) {
        make_lattice();
        if (options.is_clipped) {  // the solid is to end within the lattice
            const Point margin{step_, step_, step_};
            bounds_ = {bounds_.min - margin, bounds_.max + margin};
            make_lattice();
        }
        near_ = find_near_cells(counts_, is_distance_ ? layers_of_distance(execution) : layers(execution));
        if (near_.cells.empty()) {
            throw UnusableInput(
                "the function is nowhere negative (inside) within the bounds, as far as a grid of step " +
                std::to_string(step_) + " tells: check its sign, the bounds, and the smallest feature");
        }
        const std::vector<LineInCell> edges = landmark_edges(near_.crossed());
        landmarks_ = points_found(edges.size(), [&](std::size_t i) { return crossing_of_line(edges[i]); });
        box_ = surface_box();
    }

    Box bounds() const override { return box_; }

    std::size_t batch_size() const override { return batch_; }

    void inside(std::span<const Point> points, std::span<std::uint8_t> sides) const override {
        std::vector<std::size_t> asked;
        std::vector<Point> places;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const ValueAt value = value_at(points[i]);
            sides[i] = box_.contains(points[i]) && value.value < 0.0 ? 1 : 0;
            if (!value.is_known && box_.contains(points[i])) {
                asked.push_back(i);
                places.push_back(points[i]);
            }
        }
        std::vector<double> values(places.size());
        evaluate(places, values);
        for (std::size_t i = 0; i < asked.size(); ++i) {
            sides[asked[i]] = values[i] < 0.0 ? 1 : 0;
        }
    }

    void crossings(std::span<const Chord> chords, std::span<std::optional<Point>> points) const override {
        auto inquiries =
            each_of<Inquiry<std::optional<Point>>>(chords, [&](const Chord& chord) { return crossing_of(chord); });
        answer(std::span(inquiries));
        std::ranges::transform(inquiries, points.begin(), [](auto& inquiry) { return inquiry.result(); });
    }

    std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const override {
        return in_arena(execution, [&] {
            std::vector<Point> candidates = points_near(near_.cells, near_.values, spacing, seed);
            // Most of them would go anyway, and exact places take their time. Those kept stay as far apart, or almost.
            candidates = poisson_disk_subset(candidates, spacing, seed);
            std::vector<Point> points =
                points_found(candidates.size(), [&](std::size_t i) { return projected(candidates[i], spacing); });
            append(points, landmarks_);
            return points;
        });
    }

    const NearestPoints* nearest_points() const override { return this; }

    void prepare() const override { net(); }

    void find(std::span<const Point> points, std::span<const double> bounds,
              std::span<std::optional<Point>> nearest) const override {
        const NetTree& net = this->net();
        std::vector<std::size_t> asked;
        std::vector<Inquiry<std::optional<Point>>> inquiries;
        for (std::size_t i = 0; i < points.size(); ++i) {
            nearest[i] = std::nullopt;
            if (const std::optional<Point> start = net.start_of_search(points[i], bounds[i])) {
                asked.push_back(i);
                inquiries.push_back(foot_of(points[i], *start));
            }
        }
        answer(std::span(inquiries));
        for (std::size_t k = 0; k < asked.size(); ++k) {
            const std::size_t i = asked[k];
            const std::optional<Point>& found = inquiries[k].result();
            if (found && distance(points[i], *found) < bounds[i]) {
                nearest[i] = found;
            }
        }
    }

   private:
    const NetTree& net() const {
        return net_.get([&] {
            const std::vector<SurfaceCell> cells = near_.crossed();
            return net_tree(lattice_, cells, net_of_planes(lattice_, cells, edge_crossings(cells)));
        });
    }

    /// Where the boundary crosses the edges of the lattice from corner 0 of each cell, those with corners on both
    /// sides.
    std::vector<std::array<EdgeCrossing, 3>> edge_crossings(const std::vector<SurfaceCell>& cells) const {
        struct Edge {
            std::size_t cell;
            int axis;
        };
        std::vector<Edge> edges;
        for (std::size_t i = 0; i < cells.size(); ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                if ((cells[i].inside & 1) != (cells[i].inside >> (1 << axis) & 1)) {
                    edges.push_back({i, axis});
                }
            }
        }
        std::vector<std::array<EdgeCrossing, 3>> crossings(cells.size());
        for_each_index((edges.size() + batch_ - 1) / batch_,
                       [&](std::size_t part) {
                           const auto asked =
                               std::span(edges).subspan(part * batch_, std::min(batch_, edges.size() - part * batch_));
                           auto inquiries = each_of<Inquiry<EdgeCrossing>>(asked, [&](const Edge& edge) {
                               const Cell& cell = cells[edge.cell].cell;
                               const CornerValues& values = near_.values[near_.find(cell)];
                               return crossing_of_edge(cell, edge.axis, values[0], values[1 << edge.axis]);
                           });
                           answer(std::span(inquiries));
                           for (std::size_t i = 0; i < asked.size(); ++i) {
                               crossings[asked[i].cell][asked[i].axis] = inquiries[i].result();
                           }
                       },
                       std::size_t{1});
        return crossings;
    }

    /// \param before, after the values at the ends of the edge
    Inquiry<EdgeCrossing> crossing_of_edge(const Cell cell, const int axis, const double before,
                                           const double after) const {
        const Point from = corner_of(cell, 0), to = corner_of(cell, 1 << axis);
        const auto at = [&](double t) { return lattice_.at(from + t * (to - from)); };
        const Point end_inside = at(before < 0.0 ? 0.0 : 1.0);
        // Newton's method comes near enough to the zero of a smooth function.
        double t = before / (before - after);
        for (int attempt = 0;; ++attempt) {
            const bool is_last = attempt == 2 || !(t > 0.0 && t < 1.0);
            if (is_last) {
                RootFinder root(0.0, 1.0, before, after, rounding_ / step_);
                while (!root.is_found()) {
                    root.tell(co_await ValueAt{.place = at(root.place())});
                }
                t = root.root();
            }
            const Point place = at(t);
            const double value = co_await ValueAt{.place = place};
            Slope slope(*this, place, value, end_inside);
            while (!slope.is_known()) {
                slope.tell(co_await ValueAt{.place = slope.place()});
            }
            const Point way = (-value / squared_norm(slope.result())) * slope.result();
            // From where the function leaps, the zero is about half of the difference away, however near it is.
            if (norm(way) <= (is_last ? 0.1 * difference() : kNetAccuracy * step_)) {
                co_return EdgeCrossing{place + way, unit(slope.result())};
            }
            if (is_last) {
                co_return EdgeCrossing{place, {}};
            }
            t -= value / dot(slope.result(), at(1.0) - at(0.0));
        }
    }

    double difference() const {
        return std::min(std::max(kDifference * step_, kDifferenceOfRounding * rounding_), step_);
    }

    /// The gradient at a place, from differences towards another one: there the function has a slope even where it is
    /// flat behind an edge. Where it has none, from those on the other side.
    class Slope {
       public:
        Slope(const FunctionSolid& solid, const Point& place, double value, const Point& towards)
            : bounds_(solid.bounds_), difference_(solid.difference()), at_(place), value_(value), towards_(towards) {
            next();
        }

        bool is_known() const { return count_ == 6 || (count_ == 3 && squared_norm(result_) > 0.0); }
        const Point& result() const { return result_; }
        /// Where the value is wanted.
        const Point& place() const { return beside_; }
        void tell(double there) {
            double Point::*const axis = kAxes[count_ % 3];
            result_.*axis = (there - value_) / (beside_.*axis - at_.*axis);
            ++count_;
            next();
        }

       private:
        static constexpr std::array<double Point::*, 3> kAxes{&Point::x, &Point::y, &Point::z};

        void next() {
            double Point::*const axis = kAxes[count_ % 3];
            beside_ = at_;
            beside_.*axis += (towards_.*axis < at_.*axis) == (count_ < 3) ? -difference_ : difference_;
            if (!bounds_.contains(beside_)) {
                beside_.*axis = 2.0 * at_.*axis - beside_.*axis;
            }
        }

        const Box& bounds_;
        double difference_;
        Point at_;
        double value_;
        Point towards_;
        int count_ = 0;
        Point beside_;
        Point result_;
    };

    /// The point of the boundary nearest to `p`, near `start`. The gradient is that of differences.
    Inquiry<std::optional<Point>> foot_of(const Point p, const Point start) const {
        FootSearch search(p, start, shortest_step(lattice_), rounding_, false);
        while (!search.is_done()) {
            ValueAt here = value_at(search.place());
            const double value = co_await here;
            Point gradient;
            if (search.wants_gradient() && !here.is_known) {
                Slope slope(*this, search.place(), value, p);
                while (!slope.is_known()) {
                    slope.tell(co_await ValueAt{.place = slope.place()});
                }
                gradient = slope.result();
            }
            search.tell(value, gradient);
        }
        co_return search.result();
    }

    /// \throws InvalidOption
    void make_lattice() {
        const Point extent = bounds_.max - bounds_.min;
        require(is_finite(bounds_.min) && is_finite(bounds_.max) && std::min({extent.x, extent.y, extent.z}) > 0.0,
                "the bounds of an implicit function must be finite, and larger than nothing along x, y and z");
        if (Diagnostic fault = extent_fault(bounds_, "bounds"); !fault.empty()) {
            throw InvalidOption(std::move(fault));
        }
        require(step_ >= 0.0 && std::isfinite(step_),
                "the smallest feature of an implicit function must be a positive length");
        rounding_ = std::numeric_limits<double>::epsilon() * std::max(norm(bounds_.min), norm(bounds_.max));
        step_ = step_ > 0.0 ? step_ : kDefaultFeature * bounds_.diagonal();
        double points = 1.0;
        const auto cells = [&](double side) {
            const double count = std::ceil(side / step_);
            points *= count + 1.0;
            return count;
        };
        const std::array<double, 3> counts{cells(extent.x), cells(extent.y), cells(extent.z)};
        require(points < kMostPoints && *std::ranges::max_element(counts) < (1 << 20),
                "the smallest feature is too small for these bounds: the function would be evaluated at more than "
                "2^34 places to find all parts; choose a larger one");
        counts_ = {static_cast<Index>(counts[0]), static_cast<Index>(counts[1]), static_cast<Index>(counts[2])};
        lattice_ = {
            bounds_.min,
            {Point{extent.x / counts[0], 0, 0}, Point{0, extent.y / counts[1], 0}, Point{0, 0, extent.z / counts[2]}}};
    }

    /// \throws UnusableInput if a value is not a number
    void evaluate(std::span<const Point> points, std::span<double> values) const {
        evaluate_unchecked(points, values);
        const auto nan = std::ranges::find_if(values, [](double value) { return std::isnan(value); });
        if (nan != values.end()) {
            throw_not_a_number(points[nan - values.begin()]);
        }
    }

    void evaluate_unchecked(std::span<const Point> points, std::span<double> values) const {
        if (!points.empty()) {
            function_(points, values);
        }
        for (double& value : values) {
            value = std::clamp(value, -kMostValue, kMostValue);
        }
    }

    [[noreturn]] static void throw_not_a_number(const Point& p) {
        throw UnusableInput(
            Diagnostic{"function.not_a_number", "the function is not a number at " + text_of(p), "", -1, p});
    }

    template <class Result>
    void answer(std::span<Inquiry<Result>> inquiries) const {
        answer_all(inquiries,
                   [&](std::span<const Point> places, std::span<double> values) { evaluate(places, values); });
    }

    /// The points that the inquiries `start(i)` for `0 ≤ i < count` find.
    template <class Start>
    std::vector<Point> points_found(std::size_t count, const Start& start) const {
        return collect<std::vector<Point>>((count + batch_ - 1) / batch_,
                                           [&](std::size_t part, std::vector<Point>& out) {
                                               std::vector<Inquiry<std::optional<Point>>> inquiries;
                                               inquiries.reserve(batch_);
                                               for (std::size_t i = part * batch_;
                                                    i < std::min(count, (part + 1) * batch_); ++i) {
                                                   inquiries.push_back(start(i));
                                               }
                                               answer(std::span(inquiries));
                                               for (Inquiry<std::optional<Point>>& inquiry : inquiries) {
                                                   if (inquiry.result()) {
                                                       out.push_back(*inquiry.result());
                                                   }
                                               }
                                           },
                                           std::size_t{1});
    }

    /// The value at `p`. In the cells near the surface the function is asked; elsewhere the cell tells the sign, and
    /// nothing else counts.
    ValueAt value_at(const Point& p) const {
        const std::optional<Cell> cell = cell_of(p);
        const NearCells::Place place = cell ? near_.place_of(*cell) : NearCells::Place::kOutside;
        return {.place = p,
                .value = place == NearCells::Place::kInside ? -kMostValue : kMostValue,
                .is_known = place != NearCells::Place::kNear};
    }

    Inquiry<std::optional<Point>> crossing_of(const Chord& chord) const {
        const Point begin = chord.inside_end;
        if (!box_.contains(begin)) {
            co_return std::nullopt;
        }
        const Point direction = exit_of(box_, begin, chord.outside_end) * (chord.outside_end - begin);
        const double pieces = std::ceil(norm(direction) / step_);
        const double accuracy = rounding_ / norm(direction);
        const auto value_along = [&](double t) { return value_at(begin + t * direction); };
        std::optional<Point> farthest;
        const auto add = [&](const Point& p) {
            if (!farthest || squared_distance(p, chord.reference) > squared_distance(*farthest, chord.reference)) {
                farthest = p;
            }
        };
        double before = co_await value_along(0.0);
        if (!(before < 0.0)) {
            co_return std::nullopt;
        }
        for (double i = 0.0; i < pieces; ++i) {
            const double after = co_await value_along((i + 1.0) / pieces);
            if ((before < 0.0) != (after < 0.0)) {
                RootFinder root(i / pieces, (i + 1.0) / pieces, before, after, accuracy);
                while (!root.is_found()) {
                    root.tell(co_await value_along(root.place()));
                }
                add(begin + root.root() * direction);
            }
            before = after;
        }
        if (before < 0.0) {
            // The solid ends where its box does.
            if (box_.contains(chord.outside_end)) {
                co_return std::nullopt;
            }
            add(begin + direction);
        }
        co_return farthest;
    }

    Point index_of(const Point& p) const {
        const Point d = p - lattice_.origin;
        return {d.x / lattice_.steps[0].x, d.y / lattice_.steps[1].y, d.z / lattice_.steps[2].z};
    }

    /// Nothing beyond the bounds.
    std::optional<Cell> cell_of(const Point& p) const {
        if (!bounds_.contains(p)) {
            return std::nullopt;
        }
        const Point index = index_of(p);
        return Cell{std::min(static_cast<Index>(index.x), counts_[0] - 1),
                    std::min(static_cast<Index>(index.y), counts_[1] - 1),
                    std::min(static_cast<Index>(index.z), counts_[2] - 1)};
    }

    /// The box of the corners inside, and of the surface beyond it.
    Box surface_box() const {
        Box corners;  // by index
        for (const SurfaceCell& c : near_.cells) {
            for (int corner = 0; corner < 8; ++corner) {
                if ((c.inside >> corner & 1) != 0) {
                    corners.extend(corner_of(c.cell, corner));
                }
            }
        }
        std::vector<SurfaceCell> outer;
        std::vector<CornerValues> values;
        for (std::size_t i = 0; i < near_.cells.size(); ++i) {
            if (!corners.contains(corner_of(near_.cells[i].cell, 0)) ||
                !corners.contains(corner_of(near_.cells[i].cell, 7))) {
                outer.push_back(near_.cells[i]);
                values.push_back(near_.values[i]);
            }
        }
        Box box{lattice_.at(corners.min), lattice_.at(corners.max)};
        const std::vector<Point> points = points_near(outer, values, kExtentSpacing * step_, 0);
        for (const auto& list : {points, landmarks_}) {
            for (const Point& p : list) {
                box.extend(p);
            }
        }
        const Point by = kFunctionMargin * lattice_.at({1.0, 1.0, 1.0}) - kFunctionMargin * lattice_.origin;
        return {box.min - by, box.max + by};
    }

    static Point corner_of(const Cell& cell, int corner) {
        return {1.0 * cell[0] + (corner & 1), 1.0 * cell[1] + (corner >> 1 & 1), 1.0 * cell[2] + (corner >> 2)};
    }

    /// The gradient of the interpolant in the cell; 0 where there is none.
    Point slope_at(const Point& p) const {
        const std::optional<Cell> cell = cell_of(p);
        const std::size_t at = cell ? near_.find(*cell) : near_.cells.size();
        if (at == near_.cells.size()) {
            return {};
        }
        const Point by_index =
            gradient(near_.values[at], index_of(p) - Point{1.0 * (*cell)[0], 1.0 * (*cell)[1], 1.0 * (*cell)[2]});
        const auto& [a, b, c] = lattice_.steps;
        return {by_index.x / a.x, by_index.y / b.y, by_index.z / c.z};
    }

    std::vector<Point> points_near(std::span<const SurfaceCell> cells, std::span<const CornerValues> values,
                                   double spacing, std::uint64_t seed) const {
        return points_near_zero(
            lattice_, cells, values,
            [&](std::span<const Point> places, std::span<double> at_places) { evaluate(places, at_places); }, batch_,
            spacing, seed);
    }

    /// The place of the surface near `p`, which is almost there, along an axis: the one that the interpolant changes
    /// most along, if there is one so.
    Inquiry<std::optional<Point>> projected(const Point& p, double spacing) const {
        constexpr std::array<double, 2> kSides{1.0, -1.0};
        const double here = co_await value_at(p);
        if (here == 0.0) {
            co_return p;
        }
        const Point slope = slope_at(p);
        const std::array<double, 3> slopes{slope.x, slope.y, slope.z};
        std::array<int, 3> axes{0, 1, 2};
        std::ranges::stable_sort(axes, std::greater(), [&](int axis) { return std::abs(slopes[axis]); });
        for (const int axis : axes) {
            std::array<double, 3> place{p.x, p.y, p.z};
            const double begin = place[axis];
            const auto value_along = [&](double position) {
                place[axis] = position;
                return value_at({place[0], place[1], place[2]});
            };
            // A little farther than where it should be; then on both sides.
            const double expected = -1.5 * here / slopes[axis];
            double length = std::abs(expected) < spacing ? std::abs(expected) : 0.125 * spacing;
            for (; length <= spacing; length = std::max(4.0 * length, 0.125 * spacing)) {
                for (const double side : kSides) {
                    const double end = begin + std::copysign(length, side * expected);
                    const double there = co_await value_along(end);
                    if ((here < 0.0) != (there < 0.0)) {
                        RootFinder root = begin < end ? RootFinder(begin, end, here, there, rounding_)
                                                      : RootFinder(end, begin, there, here, rounding_);
                        while (!root.is_found()) {
                            root.tell(co_await value_along(root.place()));
                        }
                        place[axis] = root.root();
                        co_return Point{place[0], place[1], place[2]};
                    }
                }
            }
        }
        co_return std::nullopt;
    }

    /// Where a line crosses the boundary in a cell.
    Inquiry<std::optional<Point>> crossing_of_line(const LineInCell& line) const {
        std::array<double, 3> index{line.point.x, line.point.y, line.point.z};
        const auto value_along = [&](double position) {
            index[line.axis] = position;
            return ValueAt{.place = lattice_.at({index[0], index[1], index[2]})};
        };
        const double begin = line.cell[line.axis];
        const double before = co_await value_along(begin);
        const double after = co_await value_along(begin + 1.0);
        if ((before < 0.0) == (after < 0.0)) {
            co_return std::nullopt;
        }
        RootFinder root(begin, begin + 1.0, before, after);
        while (!root.is_found()) {
            root.tell(co_await value_along(root.place()));
        }
        index[line.axis] = root.root();
        co_return lattice_.at({index[0], index[1], index[2]});
    }

    /// The values of one layer of the lattice after the other. Several are evaluated together where they are small.
    std::function<std::vector<double>(Index)> layers(const Execution& execution) const {
        return [this, &execution, values = std::vector<double>(), end = Index{0}](Index k) mutable {
            report(execution, "looking for the surface", 1.0 * k / counts_[2]);
            const std::size_t size = points_of_layer();
            if (k == end) {
                const auto count = static_cast<Index>(std::max<std::size_t>(1, batch_ / size));
                end = std::min(k + count, counts_[2] + 1);
                values = values_of_layers(k, end);
            }
            const std::size_t place = values.size() - static_cast<std::size_t>(end - k) * size;
            std::vector<double> layer(values.begin() + static_cast<std::ptrdiff_t>(place),
                                      values.begin() + static_cast<std::ptrdiff_t>(place + size));
            check_layer(layer, k);
            return layer;
        };
    }

    /// The same of a distance. In cells beside those that the boundary crosses, values count; no corner of these is
    /// farther from the boundary than two diagonals of a cell. What is, as the layer before tells, need not be asked.
    std::function<std::vector<double>(Index)> layers_of_distance(const Execution& execution) const {
        const double height = norm(lattice_.steps[2]);
        const double near = 2.0 * (1.0 + kDifference) * norm(lattice_.at({1.0, 1.0, 1.0}) - lattice_.origin);
        return [this, &execution, height, near, before = std::vector<double>()](Index k) mutable {
            report(execution, "looking for the surface", 1.0 * k / counts_[2]);
            std::vector<double> layer(points_of_layer());
            std::vector<std::size_t> asked;
            for (std::size_t n = 0; n < layer.size(); ++n) {
                const double least = before.empty() ? 0.0 : std::abs(before[n]) - height;
                if (least > near) {
                    layer[n] = std::copysign(least, before[n]);
                } else {
                    asked.push_back(n);
                }
            }
            for_each_index((asked.size() + batch_ - 1) / batch_,
                           [&](std::size_t part) {
                               const std::size_t first = part * batch_;
                               std::vector<Point> places(std::min(batch_, asked.size() - first));
                               std::vector<double> values(places.size());
                               for (std::size_t i = 0; i < places.size(); ++i) {
                                   places[i] = point_of_layer(k, asked[first + i]);
                               }
                               evaluate_unchecked(places, values);
                               for (std::size_t i = 0; i < places.size(); ++i) {
                                   layer[asked[first + i]] = values[i];
                               }
                           },
                           std::size_t{1});
            check_layer(layer, k);
            before = layer;
            return layer;
        };
    }

    std::size_t points_of_layer() const { return static_cast<std::size_t>(counts_[0] + 1) * (counts_[1] + 1); }

    /// Point `n` of layer `k`, of layer `k + 1` where `n` is larger than a layer, and so on.
    Point point_of_layer(Index k, std::size_t n) const {
        const std::size_t width = counts_[0] + 1;
        const std::size_t in_layer = n % points_of_layer();
        const auto layer = static_cast<double>(k) + static_cast<double>(n / points_of_layer());
        return lattice_.at({static_cast<double>(in_layer % width), static_cast<double>(in_layer / width), layer});
    }

    std::vector<double> values_of_layers(Index begin, Index end) const {
        const std::size_t count = static_cast<std::size_t>(end - begin) * points_of_layer();
        std::vector<double> values(count);
        for_each_index((count + batch_ - 1) / batch_,
                       [&](std::size_t part) {
                           const std::size_t first = part * batch_;
                           std::vector<Point> places(std::min(batch_, count - first));
                           for (std::size_t i = 0; i < places.size(); ++i) {
                               places[i] = point_of_layer(begin, first + i);
                           }
                           evaluate_unchecked(places, std::span(values).subspan(first, places.size()));
                       },
                       std::size_t{1});
        return values;
    }

    /// \throws UnusableInput for the first point that is not as it should be
    void check_layer(const std::vector<double>& values, Index k) const {
        const std::size_t width = counts_[0] + 1;
        for (std::size_t n = 0; n < values.size(); ++n) {
            const auto i = static_cast<Index>(n % width);
            const auto j = static_cast<Index>(n / width);
            if (std::isnan(values[n])) {
                throw_not_a_number(point_of_layer(k, n));
            }
            const bool is_side = i == 0 || j == 0 || k == 0 || i == counts_[0] || j == counts_[1] || k == counts_[2];
            if (is_side && values[n] < 0.0) {
                throw UnusableInput(
                    Diagnostic{.code = "input",
                               .message = "the bounds cut the solid at " + text_of(point_of_layer(k, n)) +
                                          ", where the function is negative (inside): " + advice_for_cut_solid(),
                               .hints = {{"clip"}}});
            }
        }
    }

    std::string advice_for_cut_solid() const {
        const Point& a = bounds_.min;
        const Point& b = bounds_.max;
        const std::vector<Point> corners{
            a, b, {b.x, a.y, a.z}, {a.x, b.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {b.x, a.y, b.z}, {b.x, b.y, a.z}};
        std::vector<double> values(corners.size());
        evaluate_unchecked(corners, values);
        return std::ranges::all_of(values, [](double value) { return value < 0.0; })
                   ? "it is so in all corners of the bounds; if it is positive inside, change its sign, -(...), else "
                     "choose larger bounds, or clip the solid there"
                   : "choose larger bounds, or clip the solid there";
    }

    BatchFunction function_;
    std::size_t batch_;
    Box bounds_;
    double step_;
    bool is_distance_;
    double rounding_;                // of coordinates
    std::array<Index, 3> counts_{};  // cells along each axis
    Lattice lattice_;
    NearCells near_;
    std::vector<Point> landmarks_;
    Box box_;
    BuiltOnce<NetTree> net_;
};

}  // namespace

std::unique_ptr<Solid> function_solid(std::function<double(const Point&)> function, const FunctionOptions& options,
                                      const Execution& execution) {
    return in_arena(execution, [&] {
        return std::make_unique<FunctionSolid>(point_by_point(std::move(function)), kFewPlaces, options, execution);
    });
}

std::unique_ptr<Solid> function_solid(std::function<void(std::span<const Point>, std::span<double>)> function,
                                      const FunctionOptions& options, const Execution& execution) {
    return in_arena(execution, [&] {
        return std::make_unique<FunctionSolid>(one_call_at_a_time(std::move(function)), kManyPlaces, options,
                                               execution);
    });
}

}  // namespace scaleaxis::inline v1
