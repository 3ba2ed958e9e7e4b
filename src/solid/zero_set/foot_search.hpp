// SPDX-License-Identifier: Apache-2.0
/// \file
/// The point of a function's zero that is nearest to a given one, by local search.
#pragma once

#include <optional>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "solid/zero_set/bracketed_root.hpp"

namespace scaleaxis::inline v1 {

/// A search that is told values from outside, so that many can go on together: until `is_done()`, `tell` the value at
/// `place()` and, where it `wants_gradient()`, the gradient there.
///
/// Each step goes to the point nearest to `p` of the function's tangent plane (E. Hartmann, "On the curvature of curves
/// and surfaces defined by normalforms", 1999), with a step length from how the last step changed what is left of the
/// way (J. Barzilai, J. Borwein, 1988). Where the surface bulges towards `p`, as at edges of the solid that are reflex
/// as seen from inside, it goes to the nearest point of what lies behind the last few tangent planes together. In the
/// end the sign change along the normal is bracketed: the point is on the zero to the accuracy given. Where all this
/// finds none, or one that is farther than the start, lines through the start are tried.
class FootSearch {
   public:
    /// \param start a place close to the zero, closer than half a step. Beside an edge the face that it lies on is
    /// followed; at `p` itself the function may be that of the other face.
    /// \param step no step is longer; about how fine the function's features are
    /// \param accuracy of the point along the normal
    /// \param is_smooth whether the function has no edges: then the search may start at `p`
    FootSearch(const Point& p, const Point& start, double step, double accuracy, bool is_smooth);

    bool is_done() const { return stage_ == Stage::kDone; }
    /// The point found; nothing if no sign change was.
    const std::optional<Point>& result() const { return result_; }

    const Point& place() const { return place_; }
    bool wants_gradient() const { return stage_ == Stage::kDescent; }
    /// \param gradient 0 where there is none: then a shorter step is tried
    void tell(double value, const Point& gradient);

   private:
    enum class Stage { kDescent, kStart, kBracket, kRoot, kDone };

    /// A plane that the surface touches, with its normal away from `p`.
    struct Plane {
        Point point;
        Point normal;
    };

    /// Where a step began.
    struct Step {
        Point foot;
        Point rest;  ///< what was left of the way in the tangent plane
    };

    void descend(double value, const Point& gradient);
    Point target(const Point& foot, const Point& rest);
    void step_back();
    void look_along_normal();
    void widen();
    void refine(double value);
    void finish(const std::optional<Point>& found);
    Point along(double t) const { return best_.point + t * best_.normal; }

    Point p_;
    double step_;
    double accuracy_;
    Stage stage_ = Stage::kDescent;
    Point place_;
    std::optional<Point> result_;

    Point start_;
    int attempts_ = 0;  // to find the zero on a line through the start

    // Descent.
    int count_ = 0;
    double trust_;  // no step may be longer
    std::vector<Plane> planes_;
    Plane best_;
    double least_;  // what counts for the best one
    std::optional<Step> last_;

    // Along the normal.
    double value_at_best_ = 0.0;
    double reach_ = 0.0;
    std::optional<RootFinder> root_;
};

}  // namespace scaleaxis::inline v1
