// SPDX-License-Identifier: Apache-2.0
#include "surface/beam_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "base/angles.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Sides of a beam, a multiple of 4. The surface lies within the beam, by up to 0.5 % of its radius, or 3.4 % for
// lattices with too many beams: finer ones would have tens of millions of triangles.
constexpr int kFineSides = 32;
constexpr int kCoarseSides = 12;
constexpr std::size_t kMostFineBeams = 2000;

/// A circle around a beam: how far behind its first end, and how wide.
struct Ring {
    double along;
    double radius;
};

/// From the first end to the second, without the tips.
std::vector<Ring> rings_of(const Beam& beam, double length, int sides) {
    std::vector<Ring> rings;
    const auto add = [&](int end, int step) {
        const auto [cosine, sine] = on_circle(beam.is_round[end] ? 1.0 * step / sides : 0.0);  // from the widest on
        const double out = beam.radii[end] * sine;
        rings.push_back({end == 0 ? -out : length + out, beam.radii[end] * cosine});
    };
    for (int step = beam.is_round[0] ? sides / 4 - 1 : 0; step >= 0; --step) {
        add(0, step);
    }
    for (int step = 0; step < (beam.is_round[1] ? sides / 4 : 1); ++step) {
        add(1, step);
    }
    return rings;
}

void append_beam(const Beam& beam, int sides, TriangleMesh& to) {
    const double length = distance(beam.ends[0], beam.ends[1]);
    const Point along = unit(beam.ends[1] - beam.ends[0]);
    const auto [u, v] = across(along);
    const std::vector<Ring> rings = rings_of(beam, length, sides);
    const auto first = static_cast<Index>(to.vertices.size());
    for (const Ring& ring : rings) {
        for (int side = 0; side < sides; ++side) {
            const auto [cosine, sine] = on_circle(1.0 * side / sides);
            to.vertices.push_back(beam.ends[0] + ring.along * along + ring.radius * cosine * u +
                                  ring.radius * sine * v);
        }
    }
    const auto tip = static_cast<Index>(to.vertices.size());
    to.vertices.push_back(beam.ends[0] - (beam.is_round[0] ? beam.radii[0] : 0.0) * along);
    to.vertices.push_back(beam.ends[1] + (beam.is_round[1] ? beam.radii[1] : 0.0) * along);
    const Index last = first + static_cast<Index>(rings.size() - 1) * sides;
    for (Index side = 0; side < sides; ++side) {
        const Index next = (side + 1) % sides;
        to.triangles.push_back({tip, first + next, first + side});
        to.triangles.push_back({tip + 1, last + side, last + next});
        for (Index ring = first; ring < last; ring += sides) {
            to.triangles.push_back({ring + side, ring + next, ring + next + sides});
            to.triangles.push_back({ring + side, ring + next + sides, ring + side + sides});
        }
    }
}

/// The end of a beam.
struct BeamEnd {
    std::size_t beam;
    int end;
};

/// Leaves one of the balls in which beams end at the same point: the other beams then end in discs inside it. Balls
/// that coincide intersect in all of their triangles. A beam that widens from there on holds the far half of the ball;
/// where none as wide does, all balls stay.
void share_balls(std::vector<Beam>& beams) {
    std::vector<BeamEnd> ends;
    for (std::size_t b = 0; b < beams.size(); ++b) {
        for (const int end : {0, 1}) {
            if (beams[b].is_round[end]) {
                ends.push_back({b, end});
            }
        }
    }
    const auto place_of = [&](const BeamEnd& e) {
        const Point& p = beams[e.beam].ends[e.end];
        return std::array{p.x, p.y, p.z};
    };
    const auto radius_of = [&](const BeamEnd& e) { return beams[e.beam].radii[e.end]; };
    std::ranges::stable_sort(ends, {}, place_of);
    for (auto begin = ends.begin(); begin != ends.end();) {
        const auto end =
            std::find_if(begin, ends.end(), [&](const BeamEnd& e) { return place_of(e) != place_of(*begin); });
        const double widest = radius_of(*std::max_element(
            begin, end, [&](const BeamEnd& a, const BeamEnd& b) { return radius_of(a) < radius_of(b); }));
        const auto keeper = std::find_if(begin, end, [&](const BeamEnd& e) {
            return radius_of(e) == widest && beams[e.beam].radii[1 - e.end] >= widest;
        });
        for (auto other = begin; keeper != end && other != end; ++other) {
            beams[other->beam].is_round[other->end] = other == keeper;
        }
        begin = end;
    }
}

}  // namespace

TriangleMesh beam_mesh(std::span<const Beam> given) {
    std::vector<Beam> beams(given.begin(), given.end());
    share_balls(beams);
    TriangleMesh mesh;
    for (const Beam& beam : beams) {
        append_beam(beam, beams.size() <= kMostFineBeams ? kFineSides : kCoarseSides, mesh);
    }
    return mesh;
}

}  // namespace scaleaxis::inline v1
