// SPDX-License-Identifier: Apache-2.0
#include "axis/stages/resolved_fire.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "axis/complex.hpp"
#include "axis/edit/halving.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr double kLeastRise =
    0.1;                        // of the length of an edge, of the burn time; half of it at a right angle to a ridge
constexpr int kBisections = 6;  // to a hundredth of the edge

class RidgeCuts {
   public:
    RidgeCuts(const BurntComplex& burnt, double tolerance, const std::function<bool(const RidgeCrossing&)>& is_missed)
        : burnt_(burnt), tolerance_(tolerance), is_missed_(is_missed) {}

    Halving run() const {
        const std::size_t count = burnt_.complex.edges.size();
        Halving cuts{std::vector<std::uint8_t>(count), std::vector<double>(count), std::vector<double>(count)};
        for_each_index(static_cast<Index>(count), [&](Index e) {
            if (const std::optional<double> at = cut_of(e)) {
                note_cut(burnt_, e, *at, cuts);
            }
        });
        return cuts;
    }

   private:
    std::optional<double> cut_of(Index edge) const {
        const std::size_t faces = burnt_.sides.of_edge[edge].size();
        return faces == 1 ? dip_of(edge) : faces == 2 ? meeting_of(edge) : std::nullopt;
    }

    // The middle of an edge of the border, if balls there are smaller than the fire takes them for.
    std::optional<double> dip_of(Index edge) const {
        const auto& [p, q] = burnt_.complex.edges[edge];
        const double linear = 0.5 * (burnt_.radii[p] + burnt_.radii[q]);
        const double radius = radius_on_edge(burnt_.complex, burnt_.radii, edge, 0.5);
        return radius > 0.0 && linear - radius > tolerance_ ? std::optional(0.5) : std::nullopt;
    }

    // Where fires from both ends meet, if a vertex is missed there.
    std::optional<double> meeting_of(Index edge) const {
        const auto& [complex, radii, sides, sectors, fire] = burnt_;
        const auto& [p, q] = complex.edges[edge];
        const std::array<Index, 2> corners = corners_at_ends(complex, sides, sides.of_edge[edge][0]);
        const Index at_p = sectors.of_corner[corners[0]];
        const Index at_q = sectors.of_corner[corners[1]];
        const double time_p = fire.sector_times[at_p];
        const double time_q = fire.sector_times[at_q];
        // From one front fires do not meet.
        if (std::max(time_p, time_q) == kInfinity || fire.sector_fronts[at_p] == fire.sector_fronts[at_q]) {
            return std::nullopt;
        }
        const double length = distance(complex.vertices[p], complex.vertices[q]);
        const double rise = kLeastRise * length;
        if (0.5 * (length - std::abs(time_p - time_q)) < rise) {
            return std::nullopt;
        }
        double from = 0.0;
        double to = 1.0;
        double t = 0.5;
        double time = 0.0;
        for (int k = 0; k < kBisections; ++k) {
            t = 0.5 * (from + to);
            const Point at = complex.vertices[p] + t * (complex.vertices[q] - complex.vertices[p]);
            const double from_p = time_beside(fire, at_p, at);
            const double from_q = time_beside(fire, at_q, at);
            time = std::min(from_p, from_q);
            (from_p < from_q ? from : to) = t;
            // At the place where the search ends the fire is not later than here by more than the way there.
            const double way = k + 1 < kBisections ? (to - from) * length : 0.0;
            if (time + way < std::max(time_p, time_q) + rise) {
                return std::nullopt;  // the edge runs along the border
            }
        }
        const double radius = radius_on_edge(complex, radii, edge, t);
        const RidgeCrossing crossing{
            {time_p - radii[p], time_q - radii[q]}, time - radius, {radii[p], radii[q]}, radius};
        return radius > 0.0 && is_missed_(crossing) ? std::optional(t) : std::nullopt;
    }

    const BurntComplex& burnt_;
    double tolerance_;
    const std::function<bool(const RidgeCrossing&)>& is_missed_;
};

}  // namespace

double radius_on_edge(const MedialComplex& complex, const std::vector<double>& radii, Index edge, double t) {
    const auto& [p, q] = complex.edges[edge];
    return is_linear(complex, {p, q})
               ? (1.0 - t) * radii[p] + t * radii[q]
               : radius_between(radii[p], radii[q], squared_distance(complex.vertices[p], complex.vertices[q]), t);
}

BurntComplex burnt_complex(MedialComplex complex) {
    BurntComplex result{std::move(complex), {}, {}, {}, {}};
    result.radii = each_of<double>(result.complex.radii, [&](double radius) { return result.complex.scale * radius; });
    result.sides = sides_of(result.complex);
    result.sectors = sectors_of(result.complex, result.sides);
    result.fire = burn(result.complex, result.radii, result.sides, result.sectors);
    return result;
}

bool cut(BurntComplex& burnt, const Halving& cuts) {
    if (cuts.count() == 0) {
        return false;
    }
    burnt = burnt_complex(halved(burnt.complex, cuts));
    return true;
}

void note_cut(const BurntComplex& burnt, Index edge, double at, Halving& cuts) {
    cuts.is_halved[edge] = 1;
    cuts.radii[edge] = radius_on_edge(burnt.complex, burnt.radii, edge, at) / burnt.complex.scale;
    cuts.parts[edge] = at;
}

Halving cuts_at_ridges(const BurntComplex& burnt, double tolerance,
                       const std::function<bool(const RidgeCrossing&)>& is_missed) {
    return RidgeCuts(burnt, tolerance, is_missed).run();
}

}  // namespace scaleaxis::inline v1
