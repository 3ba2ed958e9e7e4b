// SPDX-License-Identifier: Apache-2.0
#include "spatial/extent.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Below this part of the largest coordinate, differences of coordinates have too few digits left.
constexpr double kSmallestRelativeSize = 1e-9;
// Products of five lengths, as the predicates form them, have to stay within the range of a double.
constexpr double kSmallestSize = 1e-40;
// Sizes are distances between coordinates.
constexpr double kLargestSize = kLargestCoordinate;

}  // namespace

bool is_usable(const Point& p) {
    return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
           std::abs(p.z) <= kLargestCoordinate;
}

Diagnostic extent_fault(const Box& box, std::string_view elements) {
    const double diagonal = box.diagonal();
    const Point& low = box.min;
    const Point& high = box.max;
    const double farthest = std::max(
        {std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x), std::abs(high.y), std::abs(high.z)});
    const std::string name(elements);
    const auto fault = [&](const char* code, const std::string& message) {
        return Diagnostic{.code = code, .message = message, .place = low};
    };
    if (low == high) {
        return fault("size.none", "no extent: all " + name + " lie at " + to_text(low));
    }
    if (!(diagonal > kSmallestSize && diagonal < kLargestSize)) {
        return fault(diagonal > kSmallestSize ? "size.too_large" : "size.too_small",
                     "too small or too large to compute with, from " + to_text(low) + " to " + to_text(high) +
                         "; scale the model");
    }
    if (diagonal < kSmallestRelativeSize * farthest) {
        return fault("size.too_far", "too far from the origin for its size: the coordinates of its " + name +
                                         ", near " + to_text(low) +
                                         ", have too few digits to tell them apart; translate the model to the origin "
                                         "before it is saved");
    }
    return {};
}

Box box_around(std::span<const Point> points) {
    Box box;
    for (const Point& p : points) {
        box.extend(p);
    }
    return box;
}

}  // namespace scaleaxis::inline v1
