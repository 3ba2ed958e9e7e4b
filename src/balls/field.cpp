// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/field.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "balls/distance_image.hpp"
#include "balls/union/union_data.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "spatial/ball_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr Index kLeastResolution = 8;
constexpr double kFieldMargin = 2.0;  // in spacings

Image empty_image(const Box& box, Index resolution) {
    const Point extent = box.max - box.min;
    const double longest = std::max({extent.x, extent.y, extent.z});
    Image image;
    const double spacing = longest / (resolution - 1 - 2.0 * kFieldMargin);
    image.steps = {Point{spacing, 0, 0}, Point{0, spacing, 0}, Point{0, 0, spacing}};
    const std::array<double, 3> sides{extent.x, extent.y, extent.z};
    double points = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
        image.sizes[axis] = static_cast<Index>(std::ceil(sides[axis] / spacing - 1e-9) + 2.0 * kFieldMargin) + 1;
        points *= image.sizes[axis];
    }
    require(points * sizeof(float) < 0x1p40,
            "an image of resolution " + std::to_string(resolution) + " would have more than 2^38 points");
    const auto begin = [&](int axis) { return 0.5 * spacing * (image.sizes[axis] - 1); };
    image.origin = midpoint(box.min, box.max) - Point{begin(0), begin(1), begin(2)};
    image.values.resize(static_cast<std::size_t>(points));
    return image;
}

}  // namespace

Image distance_image(const Box& box, Index resolution, const DistanceWithin& distance, const Execution& execution) {
    require(resolution >= kLeastResolution,
            "the resolution of an image must be at least " + std::to_string(kLeastResolution));
    return in_arena(execution, [&] {
        Image image = empty_image(box, resolution);
        const auto [width, height, depth] = image.sizes;
        const double spacing = image.steps[0].x;
        const auto value_of_row = [&, width = width](Index j, Index k, float* row) {
            // From one point to the next the distance grows by the spacing at most.
            double limit = std::numeric_limits<double>::infinity();
            for (Index i = 0; i < width; ++i) {
                const Point p = image.origin + spacing * Point{1.0 * i, 1.0 * j, 1.0 * k};
                const double value = distance(p, limit);
                limit = value + spacing * (1.0 + 1e-6);
                row[i] = static_cast<float>(value);
            }
        };
        for (Index k = 0; k < depth; ++k) {
            report(execution, "field", static_cast<double>(k) / depth);
            for_each_index(
                height,
                [&, width = width, height = height](Index j) {
                    const std::size_t begin = (static_cast<std::size_t>(k) * height + j) * width;
                    value_of_row(j, k, image.values.data() + begin);
                },
                Index{1});
        }
        report(execution, "field", 1.0);
        return image;
    });
}

Image signed_distance_image(const BallUnion& balls, Index resolution, const Execution& execution) {
    return in_arena(execution, [&] {
        const BallTree& tree = balls.data().tree();
        return distance_image(
            balls.bounds(), resolution,
            [&](const Point& p, double limit) { return nearest_ball(tree, p, limit).distance; }, execution);
    });
}

}  // namespace scaleaxis::inline v1
