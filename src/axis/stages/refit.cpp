// SPDX-License-Identifier: Apache-2.0
#include "axis/stages/refit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "axis/edit/halving.hpp"
#include "axis/stages/stages.hpp"
#include "scaleaxis/centering.hpp"
#include "scaleaxis/simplification.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr int kMostHalvings = 6;
constexpr double kMostRefitGrowth =
    3.0;  // so many times the vertices of the result may be needed before edges collapse

}  // namespace

std::optional<MedialComplex> refitted(MedialComplex complex, const Solid& solid, const RefitOptions& options,
                                      const Execution& execution) {
    const double error = 0.5 * options.error;  // from touching balls, and as much once edges have collapsed
    const auto most = static_cast<std::size_t>(kMostRefitGrowth * static_cast<double>(options.most_vertices));
    for (int round = 0; complex.vertices.size() <= most; ++round) {
        complex =
            centered_as_it_is(std::move(complex), solid, {.tolerance = options.tolerance}, options.feet, execution)
                .complex;
        const Halving halving = edges_to_halve(complex, solid, {.error = error});
        const std::size_t count = halving.count();
        if (count == 0 || round == kMostHalvings) {
            complex = simplify(complex, {.error = error}, execution).complex;
            return std::ssize(complex.vertices) <= options.most_vertices ? std::optional(std::move(complex))
                                                                         : std::nullopt;
        }
        complex = halved(complex, halving);
    }
    return std::nullopt;
}

}  // namespace scaleaxis::inline v1
