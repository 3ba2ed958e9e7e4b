// SPDX-License-Identifier: Apache-2.0
/// \file
/// Solids that answer their questions one by one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// A solid whose answers have nothing in common, so that there is nothing to gain from a batch.
class PointwiseSolid : public Solid, public NearestPoints {
   public:
    using Solid::inside;

    void inside(std::span<const Point> points, std::span<std::uint8_t> sides) const override {
        for (std::size_t i = 0; i < points.size(); ++i) {
            sides[i] = is_inside(points[i]) ? 1 : 0;
        }
    }

    void crossings(std::span<const Chord> chords, std::span<std::optional<Point>> points) const final {
        for (std::size_t i = 0; i < chords.size(); ++i) {
            const auto& [inside_end, outside_end, reference] = chords[i];
            points[i] = crossing_of(inside_end, outside_end, reference);
        }
    }

    const NearestPoints* nearest_points() const final { return this; }

    void find(std::span<const Point> points, std::span<const double> bounds,
              std::span<std::optional<Point>> nearest) const override {
        for (std::size_t i = 0; i < points.size(); ++i) {
            nearest[i] = nearest_to(points[i], bounds[i]);
        }
    }

    /// Few: threads share the work evenly.
    std::size_t batch_size() const final { return 128; }

   private:
    virtual bool is_inside(const Point& p) const = 0;
    virtual std::optional<Point> crossing_of(const Point& inside_end, const Point& outside_end,
                                             const Point& reference) const = 0;
    virtual std::optional<Point> nearest_to(const Point& p, double bound) const = 0;
};

}  // namespace scaleaxis::inline v1
