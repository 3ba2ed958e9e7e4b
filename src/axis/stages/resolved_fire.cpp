// SPDX-License-Identifier: Apache-2.0
#include "axis/stages/resolved_fire.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

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
    RidgeCuts(const BurntComplex& burnt, const std::function<bool(const RidgeCrossing&)>& is_missed)
        : burnt_(burnt), is_missed_(is_missed) {}

    Halving run() const {
        const std::size_t count = burnt_.complex.edges.size();
        Halving cuts{std::vector<std::uint8_t>(count), std::vector<double>(count), std::vector<double>(count)};
        for_each_index(static_cast<Index>(count), [&](Index e) {
            if (const std::optional<double> at = burnt_.sides.is_regular(e) ? meeting_of(e) : std::nullopt) {
                note_cut(burnt_, e, *at, cuts);
            }
        });
        return cuts;
    }

   private:
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
            const double from_p = arrival_beside(fire, at_p, at).first.time;
            const double from_q = arrival_beside(fire, at_q, at).first.time;
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
    const std::function<bool(const RidgeCrossing&)>& is_missed_;
};

// A complex with its radii, sides and sectors.
BurntComplex before_the_fire(MedialComplex complex) {
    BurntComplex result{std::move(complex), {}, {}, {}, {}};
    result.radii = each_of<double>(result.complex.radii, [&](double radius) { return result.complex.scale * radius; });
    result.sides = sides_of(result.complex);
    result.sectors = sectors_of(result.complex, result.sides);
    return result;
}

// The sector of a vertex at a face, or `kNone`.
Index sector_in(const BurntComplex& burnt, Index face, Index v) {
    const std::span<const Index> corners = burnt.complex.faces[face];
    const auto corner = std::ranges::find(corners, v);
    return corner == corners.end()
               ? kNone
               : burnt.sectors
                     .of_corner[burnt.complex.faces.offsets[face] + static_cast<Index>(corner - corners.begin())];
}

// The first arrival at a point of a face that comes by one of its corners, and from which front.
std::pair<Arrival, Index> arrival_in_face(const BurntComplex& burnt, Index face, const Point& x) {
    std::pair<Arrival, Index> first{{}, kNone};
    for (Index c = burnt.complex.faces.offsets[face]; c < burnt.complex.faces.offsets[face + 1]; ++c) {
        const Index sector = burnt.sectors.of_corner[c];
        if (burnt.fire.sector_fronts[sector] != kNone) {
            const auto found = arrival_beside(burnt.fire, sector, x);
            first = found.first.time < first.first.time ? found : first;
        }
    }
    return first;
}

// The fire on a complex that was cut, in no seams or curves: it burns as before, and comes by the new vertices.
Fire fire_on_parts(const BurntComplex& before, const BurntComplex& parts, std::span<const Index> parents) {
    Fire fire;
    fire.fronts = before.fire.fronts;
    fire.fronts_at = before.fire.fronts_at;
    fire.fronts_at.resize(parts.complex.vertices.size());
    fire.sector_times.assign(parts.sectors.vertices.size(), kInfinity);
    fire.sector_paths.assign(parts.sectors.vertices.size(), kInfinity);
    fire.sector_fronts.assign(parts.sectors.vertices.size(), kNone);
    fire.vertex_times = before.fire.vertex_times;
    fire.vertex_times.insert(fire.vertex_times.end(), parts.radii.begin() + before.radii.size(), parts.radii.end());
    std::vector<Index> sheets(before.complex.sheets);
    for (Index f = 0; f < static_cast<Index>(parents.size()); ++f) {
        const Index parent = parents[f];
        sheets[before.complex.face_sheets[parent]] = parts.complex.face_sheets[f];
        for (Index c = parts.complex.faces.offsets[f]; c < parts.complex.faces.offsets[f + 1]; ++c) {
            const Index v = parts.complex.faces.items[c];
            const Index sector = parts.sectors.of_corner[c];
            if (const Index old = sector_in(before, parent, v); old != kNone) {
                fire.sector_times[sector] = before.fire.sector_times[old];
                fire.sector_paths[sector] = before.fire.sector_paths[old];
                fire.sector_fronts[sector] = before.fire.sector_fronts[old];
                continue;
            }
            const auto [arrival, front] = arrival_in_face(before, parent, parts.complex.vertices[v]);
            if (arrival.time < fire.sector_times[sector]) {
                fire.sector_times[sector] = arrival.time;
                fire.sector_paths[sector] = arrival.path;
                fire.sector_fronts[sector] = front;
            }
        }
    }
    for (Index s = 0; s < static_cast<Index>(parts.sectors.vertices.size()); ++s) {
        double& time = fire.vertex_times[parts.sectors.vertices[s]];
        time = std::max(time, fire.sector_times[s]);
    }
    for (Front& front : fire.fronts) {
        front.sheet = front.sheet == kNone ? kNone : sheets[front.sheet];
    }
    return fire;
}

}  // namespace

double radius_on_edge(const MedialComplex& complex, const std::vector<double>& radii, Index edge, double t) {
    const auto& [p, q] = complex.edges[edge];
    return is_linear(complex, {p, q})
               ? (1.0 - t) * radii[p] + t * radii[q]
               : radius_between(radii[p], radii[q], squared_distance(complex.vertices[p], complex.vertices[q]), t);
}

std::vector<double> edge_times(const BurntComplex& burnt, const MedialComplex& parts, const Sides& sides,
                               const std::vector<double>& radii, std::span<const Index> parents,
                               std::span<const std::uint8_t> counts) {
    std::vector<double> times(parts.edges.size(), kInfinity);
    for_each_index(static_cast<Index>(times.size()), [&](Index e) {
        const std::span<const Index> at = sides.of_edge[e];
        if (at.size() == 1 && counts[sides.face_of[at[0]]] != 0) {
            times[e] = radius_on_edge(parts, radii, e, 0.5);
        }
        const auto& [p, q] = parts.edges[e];
        for (const Index side : at) {
            if (counts[sides.face_of[side]] == 0) {
                continue;
            }
            const Index face = parents[sides.face_of[side]];
            const double middle =
                arrival_in_face(burnt, face, midpoint(parts.vertices[p], parts.vertices[q])).first.time;
            const auto time_at = [&](Index v) {
                const Index sector = sector_in(burnt, face, v);
                return sector == kNone ? arrival_in_face(burnt, face, parts.vertices[v]).first.time
                                       : burnt.fire.sector_times[sector];
            };
            times[e] = std::min({times[e], middle, 0.5 * (time_at(p) + time_at(q))});
        }
    });
    return times;
}

BurntComplex burnt_complex(MedialComplex complex, double tolerance) {
    BurntComplex result = before_the_fire(std::move(complex));
    result.fire = burn(result.complex, result.radii, result.sides, result.sectors, tolerance);
    return result;
}

bool cut(BurntComplex& burnt, const Halving& cuts) {
    if (cuts.count() == 0) {
        return false;
    }
    auto [complex, parents] = halved_with_parents(burnt.complex, cuts);
    BurntComplex parts = before_the_fire(std::move(complex));
    parts.fire = fire_on_parts(burnt, parts, parents);
    burnt = std::move(parts);
    return true;
}

void note_cut(const BurntComplex& burnt, Index edge, double at, Halving& cuts) {
    cuts.is_halved[edge] = 1;
    cuts.radii[edge] = radius_on_edge(burnt.complex, burnt.radii, edge, at) / burnt.complex.scale;
    cuts.parts[edge] = at;
}

Halving cuts_at_ridges(const BurntComplex& burnt, const std::function<bool(const RidgeCrossing&)>& is_missed) {
    return RidgeCuts(burnt, is_missed).run();
}

}  // namespace scaleaxis::inline v1
