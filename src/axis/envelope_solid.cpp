// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "axis/envelope_data.hpp"
#include "base/angles.hpp"
#include "base/built_once.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/solid.hpp"
#include "solid/pointwise_solid.hpp"
#include "solid/seeds.hpp"
#include "solid/zero_set/bracketed_root.hpp"
#include "solid/zero_set/farthest_point.hpp"
#include "spatial/box_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

// How often a quarter of a circle, and a quarter of a side of the cube of all directions, are halved to see which of
// their directions are exposed. Patches are then as large as they are to within a twentieth of the radius; finer ones
// are no faster, and coarse ones overlap across thin sheets.
constexpr int kArcHalvings = 4;
constexpr int kCellHalvings = 3;

/// A part of the boundary of a simplex's balls, all that other simplices leave exposed of it, and perhaps more.
struct Patch {
    Index part = kNone;
    int side = 0;  ///< of a slab: which of its two planes
    Box box;       ///< around it

    void extend(const Ball& ball, const Point& direction, double within) {
        const double slack = ball.radius * (within + kRelativeRounding);
        const Point contact = ball.center + ball.radius * direction;
        box.extend(contact - Point{slack, slack, slack});
        box.extend(contact + Point{slack, slack, slack});
    }
};

void add_exposed_cell(const EnvelopePart& part, const std::array<Point, 3>& axes, double x, double y, double half,
                      int halvings, Patch& patch) {
    const auto direction_at = [&](double u, double v) { return unit(u * axes[0] + v * axes[1] + axes[2]); };
    const Point direction = direction_at(x, y);
    double within = 0.0;
    for (const double u : {x - half, x + half}) {
        for (const double v : {y - half, y + half}) {
            within = std::max(within, distance(direction, direction_at(u, v)));
        }
    }
    if (!is_exposed(part, direction, within)) {
        return;
    }
    if (halvings == 0) {
        patch.extend(part.slab.corners[0], direction, within);
        return;
    }
    for (const double u : {x - 0.5 * half, x + 0.5 * half}) {
        for (const double v : {y - 0.5 * half, y + 0.5 * half}) {
            add_exposed_cell(part, axes, u, v, 0.5 * half, halvings - 1, patch);
        }
    }
}

void add_if_exposed(const Patch& patch, std::vector<Patch>& patches) {
    if (!patch.box.is_empty()) {
        patches.push_back(patch);
    }
}

void add_patches_of_ball(const EnvelopePart& part, Index number, std::vector<Patch>& patches) {
    constexpr std::array<Point, 3> kAxes{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
    for (int side = 0; side < 6; ++side) {
        const std::array axes{kAxes[(side + 1) % 3], kAxes[(side + 2) % 3], (side < 3 ? 1.0 : -1.0) * kAxes[side % 3]};
        for (const double x : {-0.5, 0.5}) {
            for (const double y : {-0.5, 0.5}) {
                Patch patch{.part = number, .side = 0, .box = {}};
                add_exposed_cell(part, axes, x, y, 0.5, kCellHalvings, patch);
                add_if_exposed(patch, patches);
            }
        }
    }
}

void add_exposed_arc(const EnvelopePart& part, const SlabShape& shape, const std::array<Point, 2>& around, double turns,
                     double half, int halvings, Patch& patch) {
    const auto [cosine, sine] = on_circle(turns);
    const Point direction = shape.flank * (cosine * around[0] + sine * around[1]) - shape.gradient;
    const double within = 2.0 * std::numbers::pi * half * shape.flank;
    if (!is_exposed(part, direction, within)) {
        return;
    }
    if (halvings == 0) {
        patch.extend(part.slab.corners[0], direction, within);
        patch.extend(part.slab.corners[1], direction, within);
        return;
    }
    add_exposed_arc(part, shape, around, turns - 0.5 * half, 0.5 * half, halvings - 1, patch);
    add_exposed_arc(part, shape, around, turns + 0.5 * half, 0.5 * half, halvings - 1, patch);
}

void add_patches_of_cone(const EnvelopePart& part, Index number, std::vector<Patch>& patches) {
    const auto shape = shape_of(part.slab);
    if (!shape) {
        return;  // one end holds the other
    }
    const auto [first, second] = across(unit(part.slab.corners[1].center - part.slab.corners[0].center));
    for (const double turns : {0.125, 0.375, 0.625, 0.875}) {
        Patch patch{.part = number, .side = 0, .box = {}};
        add_exposed_arc(part, *shape, {first, second}, turns, 0.125, kArcHalvings, patch);
        add_if_exposed(patch, patches);
    }
}

void add_patches_of_slab(const EnvelopePart& part, Index number, std::vector<Patch>& patches) {
    const auto directions = contact_directions(part.slab);
    for (int side = 0; directions && side < 2; ++side) {
        Patch patch{.part = number, .side = side, .box = {}};
        for (const Ball& ball : part.slab.corners) {
            patch.extend(ball, (*directions)[side], 0.0);
        }
        patches.push_back(patch);
    }
}

std::vector<Patch> patches_of(std::span<const EnvelopePart> parts) {
    return collect<std::vector<Patch>>(
        parts.size(),
        [&](std::size_t i, std::vector<Patch>& out) {
            const auto number = static_cast<Index>(i);
            switch (parts[i].slab.size) {
                case 1:
                    add_patches_of_ball(parts[i], number, out);
                    break;
                case 2:
                    add_patches_of_cone(parts[i], number, out);
                    break;
                default:
                    add_patches_of_slab(parts[i], number, out);
            }
        },
        std::size_t{64});
}

/// The points `from + t * direction` for `0 ≤ t ≤ 1`.
struct Segment {
    Point from;
    Point direction;

    Point at(double t) const { return from + t * direction; }
    /// Where it, or the line that it is a part of, is nearest to a point.
    double foot_of(const Point& p) const { return dot(p - from, direction) / squared_norm(direction); }
};

/// Calls `visit(t, normal)` for the places where a line meets the boundary of the balls of a part, of all that its
/// simplex would have if it went on beyond its border.
template <class Visit>
void for_each_contact_with_ball(const EnvelopePart& part, const Segment& segment, const Visit& visit) {
    const auto& [center, radius] = part.slab.corners[0];
    const double middle = segment.foot_of(center);
    const Point q = segment.at(middle) - center;
    const auto ways = quadratic_zeros(squared_norm(segment.direction), 0.0, squared_norm(q) - radius * radius);
    if (!ways) {
        return;
    }
    for (const double way : *ways) {
        visit(middle + way, unit(segment.at(middle + way) - center));
    }
}

template <class Visit>
void for_each_contact_with_cone(const EnvelopePart& part, const Segment& segment, const Visit& visit) {
    const auto& [a, b, unused] = part.slab.corners;
    const auto shape = shape_of(part.slab);
    const double length = distance(a.center, b.center);
    const Point axis = (1.0 / length) * (b.center - a.center);
    const double growth = (b.radius - a.radius) / length;
    const double square = shape->flank * shape->flank;
    const double middle = segment.foot_of(midpoint(a.center, b.center));
    const Point q = segment.at(middle) - a.center;
    // Of the line: how far along the axis it begins and how it goes on, and the same for how far beside it.
    const double along = dot(q, axis), slope = dot(segment.direction, axis);
    const Point beside = q - along * axis, drift = segment.direction - slope * axis;
    const double radius = a.radius + growth * along;
    const auto ways = quadratic_zeros(square * squared_norm(drift) - growth * growth * slope * slope,
                                      square * dot(beside, drift) - radius * growth * slope,
                                      square * squared_norm(beside) - radius * radius);
    if (!ways) {
        return;
    }
    for (const double way : *ways) {
        const double radius_there = radius + way * growth * slope;
        const double center = along + way * slope + radius_there * growth / square;
        if (radius_there > 0.0 && center >= -kRelativeRounding * length &&
            center <= (1.0 + kRelativeRounding) * length) {
            visit(middle + way, shape->flank * unit(beside + way * drift) - shape->gradient);
        }
    }
}

template <class Visit>
void for_each_contact_with_plane(const EnvelopePart& part, int side, const Segment& segment, const Visit& visit) {
    const Point normal = (*contact_directions(part.slab))[side];
    std::array<Point, 3> p;
    std::ranges::transform(part.slab.corners, p.begin(),
                           [&](const Ball& ball) { return ball.center + ball.radius * normal; });
    const double t = dot(p[0] - segment.from, normal) / dot(segment.direction, normal);
    const Point contact = segment.at(t);
    const Point area = cross(p[1] - p[0], p[2] - p[0]);
    for (int k = 0; k < 3; ++k) {
        const double weight = dot(cross(p[(k + 1) % 3] - p[k], contact - p[k]), area);
        if (!(weight >= -kRelativeRounding * squared_norm(area))) {
            return;
        }
    }
    visit(t, normal);
}

/// Asks about the balls themselves, but for the nearest points.
class EnvelopeSolid final : public PointwiseSolid {
   public:
    EnvelopeSolid(const Envelope& envelope, double smallest_feature)
        : envelope_(envelope), smallest_feature_(smallest_feature), patches_(patches_of(data().parts())) {
        tree_ = build_box_tree(each_of<Box>(patches_, &Patch::box));
    }

    Box bounds() const override { return envelope_.bounds(); }

    bool is_inside(const Point& p) const override { return slab_within(data().tree(), p, 0.0) != nullptr; }

    /// The last hit is on the boundary: balls of a part beyond it would end in another one. So is the last one before
    /// the segment comes back from outside. The distance from the reference, a convex function along the segment, tells
    /// whether it matters where that is.
    std::optional<Point> crossing_of(const Point& inside_end, const Point& outside_end,
                                     const Point& reference) const override {
        if (!is_inside(inside_end) || is_inside(outside_end)) {
            return std::nullopt;
        }
        const Segment segment{inside_end, outside_end - inside_end};
        std::vector<Hit> hits;
        for_each_near_segment(tree_, inside_end, outside_end,
                              [&](Index i) { add_hits(patches_[tree_.order[i]], segment, hits); });
        std::ranges::sort(hits, {}, &Hit::at);
        if (hits.empty() || !hits.back().is_exit) {
            return crossing_by_distance(segment);
        }
        const Point last = segment.at(hits.back().at);
        if (!(squared_distance(segment.at(hits.front().at), reference) > squared_distance(last, reference))) {
            return last;
        }
        const auto back = std::find_if(hits.begin() + 1, hits.end(), [&](const Hit& hit) {
            return !hit.is_exit && data().covering(segment.at(hit.at)) == nullptr;
        });
        FarthestPoint farthest{reference};
        farthest.add(segment.at((back - 1)->at));
        farthest.add(last);
        return farthest.point;
    }

    std::vector<Point> seeds(double spacing, std::uint64_t, const Execution& execution) const override {
        return in_arena(execution, [&] {
            const double area = spacing * spacing / kSeedsOfBalls;
            if (data().area_of_parts() / area >= std::numeric_limits<Index>::max()) {
                double visible = 0.0;
                for (const SurfacePoint& point : data().boundary_points(bounds().diagonal())) {
                    visible += point.area;
                }
                check_number_of_seeds(visible / area);
            }
            return each_of<Point>(data().boundary_points(std::sqrt(area)), &SurfacePoint::point);
        });
    }

    void prepare() const override { by_distance().prepare_nearest(); }

    std::optional<Point> nearest_to(const Point& p, double bound) const override {
        return by_distance().nearest(p, bound);
    }

   private:
    struct Hit {
        double at = 0.0;
        bool is_exit = false;
    };

    const EnvelopeData& data() const { return envelope_.data(); }

    void add_hits(const Patch& patch, const Segment& segment, std::vector<Hit>& hits) const {
        const EnvelopePart& part = data().parts()[patch.part];
        const auto add = [&](double t, const Point& normal) {
            if (t >= 0.0 && t <= 1.0 && patch.box.contains(segment.at(t)) &&
                is_exposed(part, normal, kRelativeRounding)) {
                hits.push_back({t, dot(segment.direction, normal) > 0.0});
            }
        };
        switch (part.slab.size) {
            case 1:
                for_each_contact_with_ball(part, segment, add);
                break;
            case 2:
                for_each_contact_with_cone(part, segment, add);
                break;
            default:
                for_each_contact_with_plane(part, patch.side, segment, add);
        }
    }

    /// Where rounding hides the boundary between two patches.
    std::optional<Point> crossing_by_distance(const Segment& segment) const {
        const auto distance_at = [&](double t) { return data().signed_distance(segment.at(t)); };
        const double before = distance_at(0.0), after = distance_at(1.0);
        if (!(before <= 0.0) || !(after > 0.0)) {
            return std::nullopt;
        }
        return segment.at(bracketed_root(distance_at, 0.0, 1.0, before, after));
    }

    /// The solid that knows nearest points.
    const Solid& by_distance() const {
        return *by_distance_.get([&] {
            Box box = bounds();
            const double margin = kNegligible * box.diagonal();  // beyond the envelope, which touches the box
            box = {box.min - Point{margin, margin, margin}, box.max + Point{margin, margin, margin}};
            return function_solid([envelope = envelope_](const Point& p) { return envelope.data().signed_distance(p); },
                                  {.bounds = box, .smallest_feature = smallest_feature_, .is_distance = true});
        });
    }

    Envelope envelope_;
    double smallest_feature_;
    std::vector<Patch> patches_;
    BoxTree tree_;  // of the patches
    BuiltOnce<std::unique_ptr<Solid>> by_distance_;
};

}  // namespace

std::unique_ptr<Solid> envelope_solid(const Envelope& envelope, double smallest_feature, const Execution& execution) {
    require(smallest_feature >= 0.0 && std::isfinite(smallest_feature),
            "the smallest feature of an envelope must be a positive length, or 0 for a share of its diagonal");
    if (!(std::ranges::max(envelope.data().complex().radii) > kRelativeRounding * envelope.bounds().diagonal())) {
        throw UnusableInput(
            Diagnostic{"complex.empty", "all balls of the axis have radius 0: there is nothing that it could envelop"});
    }
    return in_arena(execution, [&] {
        report(execution, "envelope", 0.0);
        std::unique_ptr<Solid> solid = std::make_unique<EnvelopeSolid>(envelope, smallest_feature);
        report(execution, "envelope", 1.0);
        return solid;
    });
}

}  // namespace scaleaxis::inline v1
