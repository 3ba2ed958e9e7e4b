// SPDX-License-Identifier: Apache-2.0
/// \file
/// The Delaunay triangulation of samples, with the side of every circumcentre.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "delaunay/triangulation.hpp"
#include "sampling/restricted_facets.hpp"
#include "sampling/umbrellas.hpp"
#include "scaleaxis/sampling.hpp"
#include "scaleaxis/solid.hpp"
#include "spatial/spheres.hpp"

namespace scaleaxis::inline v1 {

/// Where the circumcentre of a cell lies. Of two sides that neighbours tell, the larger one counts.
enum class Side : std::uint8_t { kUnknown, kOutside, kInside };

/// A growing Delaunay triangulation of samples of `∂S` whose cells are labelled by the side of their circumcentres.
/// All that it tells depends on the set of its cells alone, and not on the slots that they live in.
class LabelledTriangulation {
   public:
    /// \param margin how far samples may lie outside the bounds of the solid
    /// \param covering no point of `∂S` is taken to be farther than this from a sample: neighbouring circumballs that
    /// overlap by more have their centres on the same side. Infinite: nothing is known, and every cell is asked for.
    LabelledTriangulation(const Solid& solid, double margin, double covering);

    /// Inserts samples and labels the new cells.
    /// \throws UnusableInput if a sample lies farther outside of the bounds than the margin
    void insert(const std::vector<Point>& points);

    /// Asks the solid for the sides of these cells, and returns how many labels were wrong.
    Index relabel(std::span<const Index> cells);

    const Solid& solid() const { return solid_; }
    std::size_t points() const { return points_; }
    const Point& point(Index vertex) const { return builder_.point(vertex); }

    /// How often samples were inserted.
    Index rounds() const { return round_; }
    /// The cells made by the last `insert`.
    const std::vector<Index>& fresh_cells() const { return fresh_; }
    /// Which vertices belong to a cell made after round `round`, 1 for each that does.
    std::vector<std::uint8_t> vertices_changed_since(Index round) const;

    double radius(Index cell) const { return spheres_[cell].radius; }
    /// The cell beyond a facet, `kNone` at the hull.
    Index neighbor(const RestrictedFacet& facet) const { return builder_.neighbor(facet.cell, facet.opposite); }

    /// All restricted facets.
    std::vector<RestrictedFacet> restricted_facets() const;
    /// Those beside a cell made by the last `insert`, each once.
    std::vector<RestrictedFacet> fresh_restricted_facets() const;
    /// The vertices of a facet, ascending.
    Facet vertices(const RestrictedFacet& facet) const;
    /// The dual Voronoi edge of a restricted facet, with a corner of the facet for reference.
    Chord dual_edge(const RestrictedFacet& facet) const;

    /// Is a facet of before the last `insert` still there, with the same dual edge?
    bool is_left(const RestrictedFacet& facet) const;

    /// Distances of the samples to their poles, the farthest centres of their cells, inside and outside; infinite where
    /// there are none.
    struct PoleDistances {
        std::vector<double> inner;
        std::vector<double> outer;
    };
    PoleDistances pole_distances() const;
    /// Which samples belong to a cell inside, 1 for each that does.
    std::vector<std::uint8_t> vertices_of_inside_cells() const;
    /// The balls of the union that the samples give (`balls_of_cells`).
    std::vector<Ball> inner_balls() const;

    std::int64_t inside_queries() const { return inside_queries_; }

    /// Samples and tetrahedra in the canonical order, without statistics and tolerance.
    Samples finish() &&;

   private:
    struct Cells;

    void make_spheres();
    void label_fresh_cells();
    Circumsphere circumsphere(Index cell) const;
    bool may_be_inside(Index cell) const;
    bool are_on_one_side(Index cell, Index neighbor) const;
    bool is_deeper(Index cell, Index other) const;
    bool is_restricted(Index cell, int opposite) const;
    std::vector<Side> ask(std::span<const Index> cells);

    const Solid& solid_;
    Box box_;
    double margin_;
    double covering_;
    TriangulationBuilder builder_;
    std::size_t points_ = 0;
    Index round_ = 0;
    // By slot:
    std::vector<Circumsphere> spheres_;
    std::vector<Side> sides_;
    std::vector<Index> made_in_;  // the round that made the cell
    std::vector<Index> fresh_;    // the cells made by the last `insert`
    std::int64_t inside_queries_ = 0;
};

}  // namespace scaleaxis::inline v1
