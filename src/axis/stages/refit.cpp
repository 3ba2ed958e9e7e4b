// SPDX-License-Identifier: Apache-2.0
#include "axis/stages/refit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/halving.hpp"
#include "axis/stages/stages.hpp"
#include "scaleaxis/centering.hpp"
#include "scaleaxis/simplification.hpp"
#include "spatial/extent.hpp"
#include "spatial/slab.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr double kLeastEdge = 0.25;  // tolerances: shorter ones are not halved
constexpr int kMostHalvings = 6;     // of halving
constexpr double kMostRefitGrowth =
    3.0;                       // so many times the vertices of the result may be needed before edges collapse
constexpr double kHalf = 0.5;  // of the error: how far from touching balls may be; edges collapse within the rest
constexpr double kMostHalved = 0.75;  // of the vertices: so many edges to halve at once take too many
constexpr double kFarContact = 1e6;   // diagonals

// Gives each triangle the directions in which its slab touches tangent planes as contacts far away: all of its corners
// see them in the same directions. (Where a slab has none, what is taken instead sees no contact, and does not count.)
void add_directions(MedialComplex& complex) {
    const Box box = box_around(complex.vertices);
    const double far = kFarContact * box.diagonal();
    complex.boundary_vertices.clear();
    complex.face_contacts.clear();
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        const std::array balls{ball_at(complex, corners[0]), ball_at(complex, corners[1]),
                               ball_at(complex, corners[2])};
        const auto directions = contact_directions(Slab(balls)).value_or(std::array<Point, 2>{});
        std::array<Index, 2> contacts{};
        for (int side = 0; side < 2; ++side) {
            contacts[side] = static_cast<Index>(complex.boundary_vertices.size());
            complex.boundary_vertices.push_back(balls[0].center + far * directions[side]);
        }
        complex.face_contacts.push_back(contacts);
    }
    complex.boundary_vertex_balls.assign(complex.boundary_vertices.size(), {kNone, kNone, kNone});
}

void clear_directions(MedialComplex& complex) {
    complex.boundary_vertices.clear();
    complex.boundary_vertex_balls.clear();
    complex.face_contacts.clear();
}

}  // namespace

std::optional<MedialComplex> refitted(MedialComplex complex, const Solid& solid, const RefitOptions& options,
                                      const Execution& execution) {
    const double error = kHalf * options.error;
    const auto most = static_cast<std::size_t>(kMostRefitGrowth * static_cast<double>(options.most_vertices));
    for (int round = 0; complex.vertices.size() <= most; ++round) {
        add_directions(complex);
        complex =
            centered_as_it_is(std::move(complex), solid, {.tolerance = options.tolerance}, options.feet, execution)
                .complex;
        clear_directions(complex);
        const Halving halving =
            edges_to_halve(complex, solid, {.error = error, .least_length = kLeastEdge * options.tolerance});
        const std::size_t count = halving.count();
        if (count == 0 || round == kMostHalvings) {
            complex = simplify(complex, {.error = error}, execution).complex;
            return std::ssize(complex.vertices) <= options.most_vertices ? std::optional(std::move(complex))
                                                                         : std::nullopt;
        }
        if (static_cast<double>(count) > kMostHalved * static_cast<double>(complex.vertices.size())) {
            break;  // all is curved
        }
        complex = halved(complex, halving);
    }
    return std::nullopt;
}

}  // namespace scaleaxis::inline v1
