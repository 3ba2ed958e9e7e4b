// SPDX-License-Identifier: Apache-2.0
#include "sampling/labelled_triangulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/disjoint_sets.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "sampling/inner_cells.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Circumcentres farther away than this many diagonals are only known by their direction.
constexpr double kFarAway = 1e4;

// Dual edges are cut off at this many diagonals: the solid is nearer than that.
constexpr double kLongestEdge = 3.0;

// Crossings may lie outside the solid's box by a rounding error.
Box widened(const Box& box, double margin) {
    const Point by{margin, margin, margin};
    return {box.min - by, box.max + by};
}

void check_bounds(const std::vector<Point>& points, const Box& box) {
    for (const Point& p : points) {
        if (!box.contains(p)) {
            Words text;
            text << "the solid contradicts itself: it has a point of its boundary at (" << p.x << ", " << p.y << ", "
                 << p.z << "), which is outside of its bounds, (" << box.min.x << ", " << box.min.y << ", " << box.min.z
                 << ") to (" << box.max.x << ", " << box.max.y << ", " << box.max.z << ")";
            throw UnusableInput(Diagnostic{"solid.contradiction", text.str(), "", -1, p});
        }
    }
}

std::array<Index, 4> sorted(std::array<Index, 4> vertices) {
    std::ranges::sort(vertices);
    return vertices;
}

}  // namespace

/// As `balls_of_cells` wants them.
struct LabelledTriangulation::Cells {
    const LabelledTriangulation& all;

    Index size() const { return all.builder_.slots(); }
    bool is_inside(Index cell) const { return all.sides_[cell] == Side::kInside; }
    const std::array<Index, 4>& vertices(Index cell) const { return all.builder_.vertices(cell); }
    Ball ball(Index cell) const { return {all.spheres_[cell].center, all.spheres_[cell].radius}; }
    bool is_larger(Index cell, Index other) const { return all.is_deeper(cell, other); }
};

LabelledTriangulation::LabelledTriangulation(const Solid& solid, double margin, double covering)
    : solid_(solid),
      box_(solid.bounds()),
      margin_(margin),
      covering_(covering),
      builder_(widened(box_, margin), false) {}

void LabelledTriangulation::insert(const std::vector<Point>& points) {
    check_bounds(points, widened(box_, margin_));
    builder_.insert(points);
    points_ += points.size();
    ++round_;
    make_spheres();
    label_fresh_cells();
}

void LabelledTriangulation::make_spheres() {
    const Index slots = builder_.slots();
    spheres_.resize(slots);
    sides_.resize(slots, Side::kOutside);
    made_in_.resize(slots);
    fresh_ = collect<std::vector<Index>>(slots, [&](Index cell, std::vector<Index>& fresh) {
        if (!builder_.is_cell(cell)) {
            sides_[cell] = Side::kOutside;
        } else if (builder_.is_fresh(cell)) {
            spheres_[cell] = circumsphere(cell);
            sides_[cell] = may_be_inside(cell) ? Side::kUnknown : Side::kOutside;
            made_in_[cell] = round_;
            fresh.push_back(cell);
        }
    });
}

// A circumball of radius R holds a concentric ball of radius R - covering that the surface does not meet. Where two of
// these overlap, both centres lie on the same side: one question for each connected group is enough.
void LabelledTriangulation::label_fresh_cells() {
    std::vector<Side> known(sides_.size(), Side::kUnknown);  // the side of a group, where a neighbor tells
    using Pair = std::array<Index, 2>;
    const auto pairs = collect<std::vector<Pair>>(fresh_.size(), [&](std::size_t i, std::vector<Pair>& out) {
        const Index cell = fresh_[i];
        if (sides_[cell] != Side::kUnknown || spheres_[cell].radius <= covering_) {
            return;
        }
        for (int k = 0; k < 4; ++k) {
            const Index neighbor = builder_.neighbor(cell, k);
            if (neighbor == kNone) {
                continue;
            }
            const bool is_known = sides_[neighbor] != Side::kUnknown;
            if ((is_known || neighbor < cell) && are_on_one_side(cell, neighbor)) {
                if (is_known) {
                    known[cell] = std::max(known[cell], sides_[neighbor]);
                } else {
                    out.push_back({cell, neighbor});
                }
            }
        }
    });
    DisjointSets groups(builder_.slots());
    for (const auto& [cell, neighbor] : pairs) {
        groups.join(cell, neighbor);
    }
    CancellationPoint cancellation_point;
    std::vector<Index> deepest(sides_.size(), kNone);  // of a group
    std::vector<Index> unlabelled;                     // groups
    for (const Index cell : fresh_) {
        cancellation_point();
        if (sides_[cell] == Side::kUnknown) {
            const Index group = groups.find(cell);
            if (deepest[group] == kNone) {
                unlabelled.push_back(group);
            }
            if (deepest[group] == kNone || is_deeper(cell, deepest[group])) {
                deepest[group] = cell;
            }
            known[group] = std::max(known[group], known[cell]);
        }
    }
    std::erase_if(unlabelled, [&](Index group) { return known[group] != Side::kUnknown; });
    const auto asked = each_of<Index>(unlabelled, [&](Index group) { return deepest[group]; });
    const std::vector<Side> answers = ask(asked);
    for (std::size_t i = 0; i < asked.size(); ++i) {
        known[unlabelled[i]] = answers[i];
    }
    for (const Index cell : fresh_) {
        if (sides_[cell] == Side::kUnknown) {
            sides_[cell] = known[groups.find(cell)];
        }
    }
}

Index LabelledTriangulation::relabel(std::span<const Index> cells) {
    std::vector<Index> asked;
    std::ranges::copy_if(cells, std::back_inserter(asked), [&](Index cell) { return may_be_inside(cell); });
    const std::vector<Side> answers = ask(asked);
    Index corrected = 0;
    for (std::size_t i = 0; i < asked.size(); ++i) {
        corrected += sides_[asked[i]] != answers[i] ? 1 : 0;
        sides_[asked[i]] = answers[i];
    }
    return corrected;
}

std::vector<Side> LabelledTriangulation::ask(std::span<const Index> cells) {
    inside_queries_ += static_cast<std::int64_t>(cells.size());
    const auto centers = each_of<Point>(cells, [&](Index cell) { return spheres_[cell].center; });
    const std::vector<std::uint8_t> is_inside = sides_of(solid_, centers);
    std::vector<Side> sides(cells.size());
    std::ranges::transform(is_inside, sides.begin(),
                           [](std::uint8_t i) { return i != 0 ? Side::kInside : Side::kOutside; });
    return sides;
}

std::vector<std::uint8_t> LabelledTriangulation::vertices_changed_since(Index round) const {
    std::vector<std::uint8_t> is_changed(points_);
    CancellationPoint cancellation_point;
    for (Index cell = 0; cell < builder_.slots(); ++cell) {
        cancellation_point();
        for (int k = 0; made_in_[cell] > round && builder_.is_cell(cell) && k < 4; ++k) {
            if (const Index v = builder_.vertices(cell)[k]; !is_ghost(v)) {
                is_changed[v] = 1;
            }
        }
    }
    return is_changed;
}

std::vector<RestrictedFacet> LabelledTriangulation::restricted_facets() const {
    return collect<std::vector<RestrictedFacet>>(builder_.slots(), [&](Index cell, std::vector<RestrictedFacet>& out) {
        for (int k = 0; sides_[cell] == Side::kInside && k < 4; ++k) {
            if (is_restricted(cell, k)) {
                out.push_back({cell, k});
            }
        }
    });
}

std::vector<RestrictedFacet> LabelledTriangulation::fresh_restricted_facets() const {
    return collect<std::vector<RestrictedFacet>>(fresh_.size(), [&](std::size_t i, std::vector<RestrictedFacet>& out) {
        const Index cell = fresh_[i];
        for (int k = 0; k < 4; ++k) {
            if (sides_[cell] == Side::kInside) {
                if (is_restricted(cell, k)) {
                    out.push_back({cell, k});
                }
            } else if (const Index neighbor = builder_.neighbor(cell, k);
                       neighbor != kNone && sides_[neighbor] == Side::kInside && !builder_.is_fresh(neighbor)) {
                out.push_back({neighbor, builder_.mirror(cell, k)});
            }
        }
    });
}

Facet LabelledTriangulation::vertices(const RestrictedFacet& facet) const {
    const std::array<Index, 4>& v = builder_.vertices(facet.cell);
    Facet result{v[(facet.opposite + 1) & 3], v[(facet.opposite + 2) & 3], v[(facet.opposite + 3) & 3]};
    std::ranges::sort(result);
    return result;
}

Chord LabelledTriangulation::dual_edge(const RestrictedFacet& facet) const {
    const auto& [cell, k] = facet;
    const Point& center = spheres_[cell].center;
    const double longest = kLongestEdge * box_.diagonal();
    const Index beyond = neighbor(facet);
    Point direction;
    if (beyond != kNone && std::isfinite(spheres_[beyond].radius)) {
        direction = spheres_[beyond].center - center;
    } else {
        const std::array<Index, 4>& v = builder_.vertices(cell);
        const Point a = point(v[(k + 1) & 3]);
        const Point normal = cross(point(v[(k + 2) & 3]) - a, point(v[(k + 3) & 3]) - a);
        const Point outward = dot(normal, point(v[k]) - a) > 0.0 ? -1.0 * normal : normal;
        direction = (2.0 * longest / norm(outward)) * outward;
    }
    const double length = norm(direction);
    const Point end = length <= longest ? center + direction : center + (longest / length) * direction;
    return {center, end, point(vertices(facet)[0])};
}

bool LabelledTriangulation::is_left(const RestrictedFacet& facet) const {
    if (!builder_.is_cell(facet.cell) || builder_.is_fresh(facet.cell)) {
        return false;
    }
    const Index beyond = neighbor(facet);
    return beyond == kNone || !builder_.is_fresh(beyond);
}

LabelledTriangulation::PoleDistances LabelledTriangulation::pole_distances() const {
    PoleDistances poles{std::vector<double>(points_), std::vector<double>(points_)};
    CancellationPoint cancellation_point;
    for (Index cell = 0; cell < builder_.slots(); ++cell) {
        cancellation_point();
        if (builder_.is_cell(cell)) {
            std::vector<double>& of_side = sides_[cell] == Side::kInside ? poles.inner : poles.outer;
            for (const Index v : builder_.vertices(cell)) {
                if (!is_ghost(v)) {
                    of_side[v] = std::max(of_side[v], spheres_[cell].radius);
                }
            }
        }
    }
    for (std::vector<double>* const of_side : {&poles.inner, &poles.outer}) {
        std::ranges::replace(*of_side, 0.0, kInfinity);
    }
    return poles;
}

std::vector<std::uint8_t> LabelledTriangulation::vertices_of_inside_cells() const {
    std::vector<std::uint8_t> result(points_);
    CancellationPoint cancellation_point;
    for (Index cell = 0; cell < builder_.slots(); ++cell) {
        cancellation_point();
        for (int k = 0; sides_[cell] == Side::kInside && k < 4; ++k) {
            result[builder_.vertices(cell)[k]] = 1;
        }
    }
    return result;
}

std::vector<Ball> LabelledTriangulation::inner_balls() const { return balls_of_cells(Cells{*this}, points_); }

Samples LabelledTriangulation::finish() && {
    Samples samples;
    std::vector<Index> slots;
    Triangulation triangulation = builder_.finish(&slots);
    // Cells with a ghost come first in the canonical order.
    const auto ghosts = static_cast<Index>(
        std::ranges::find_if(triangulation.cells, [](const auto& cell) { return !is_ghost(cell.vertices[0]); }) -
        triangulation.cells.begin());
    const Index count = static_cast<Index>(triangulation.size()) - ghosts;
    samples.tetrahedra.resize(count);
    samples.neighbors.resize(count);
    samples.centers.resize(count);
    samples.radii.resize(count);
    samples.inside.resize(count);
    for_each_index(count, [&](Index t) {
        const Index slot = slots[ghosts + t];
        samples.tetrahedra[t] = triangulation.cells[ghosts + t].vertices;
        for (int k = 0; k < 4; ++k) {
            const Index neighbor = triangulation.cells[ghosts + t].neighbors[k];
            samples.neighbors[t][k] = neighbor < ghosts ? kNone : neighbor - ghosts;
        }
        samples.centers[t] = spheres_[slot].center;
        samples.radii[t] = spheres_[slot].radius;
        samples.inside[t] = sides_[slot] == Side::kInside ? 1 : 0;
    });
    samples.points = std::move(triangulation.points);
    return samples;
}

// Rounding depends on the order of the vertices, so there is one order.
Circumsphere LabelledTriangulation::circumsphere(Index cell) const {
    const std::array<Index, 4> v = sorted(builder_.vertices(cell));
    return scaleaxis::circumsphere(point(v[0]), point(v[1]), point(v[2]), point(v[3]), kFarAway * box_.diagonal());
}

// A centre inside is at most half a diagonal from the surface, and so hardly farther from a sample.
bool LabelledTriangulation::may_be_inside(Index cell) const {
    return std::ranges::none_of(builder_.vertices(cell), is_ghost) &&
           spheres_[cell].radius <= 0.5 * box_.diagonal() + margin_ && box_.contains(spheres_[cell].center);
}

bool LabelledTriangulation::are_on_one_side(Index cell, Index neighbor) const {
    const Circumsphere& a = spheres_[cell];
    const Circumsphere& b = spheres_[neighbor];
    const double overlap = a.radius + b.radius - 2.0 * covering_;
    return b.radius > covering_ && std::isfinite(b.radius) && squared_distance(a.center, b.center) < overlap * overlap;
}

bool LabelledTriangulation::is_deeper(Index cell, Index other) const {
    const double a = spheres_[cell].radius;
    const double b = spheres_[other].radius;
    return a != b ? a > b : sorted(builder_.vertices(cell)) < sorted(builder_.vertices(other));
}

/// Is facet `opposite` of a cell inside a restricted one?
bool LabelledTriangulation::is_restricted(Index cell, int opposite) const {
    const Index neighbor = builder_.neighbor(cell, opposite);
    return neighbor == kNone || sides_[neighbor] != Side::kInside;
}

}  // namespace scaleaxis::inline v1
