// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Solids whose medial axis is known, as oracles and as meshes.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "scaleaxis/shape.hpp"

namespace scaleaxis::test {

/// A solid given by a function that is negative inside. Without `seed_points` the sampler has to find its boundary alone.
class ImplicitSolid : public Shape {
   public:
    using Function = std::function<double(const Point&)>;

    ImplicitSolid(Box box, Function function, std::optional<Topology> known = std::nullopt)
        : box_(box), function_(std::move(function)), topology_(known) {}

    Box bounds() const override { return box_; }
    bool inside(const Point& p) const override { return function_(p) < 0.0; }
    std::optional<Point> crossing(const Point& inside_end, const Point& outside_end, const Point&) const override {
        Point in = inside_end;
        Point out = outside_end;
        if (!inside(in) || inside(out)) {
            return std::nullopt;
        }
        for (int step = 0; step < 80; ++step) {
            const Point middle = midpoint(in, out);
            (inside(middle) ? in : out) = middle;
        }
        return in;
    }
    std::vector<Point> seeds(double, std::uint64_t, const Execution&) const override { return {}; }
    std::optional<Topology> topology() const override { return topology_; }

   private:
    Box box_;
    Function function_;
    std::optional<Topology> topology_;
};

}  // namespace scaleaxis::test
