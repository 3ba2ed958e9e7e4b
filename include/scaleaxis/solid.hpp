// SPDX-License-Identifier: Apache-2.0
/// \file
/// A solid as the stages see it: an oracle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

/// A segment that is taken to leave a solid.
struct Chord {
    Point inside_end;
    Point outside_end;
    Point reference;  ///< of several crossings the one farthest from here is wanted
};

/// A place where a solid, or a gap in it, is thin.
struct ThinPart {
    Point place;
    double thickness = 0.0;
    bool is_gap = false;
};

/// A part of a sharp edge of a solid.
struct SharpEdge {
    std::array<Point, 2> ends;
    std::array<Point, 2> normals;  ///< of length 1, outwards, of the two sides
};

/// The search for nearest points of the boundary `∂S` of a solid: exact for meshes and unions of balls, for others a
/// local search from the nearest of known places (docs/dev/solids.md).
class SCALEAXIS_EXPORT NearestPoints {
   public:
    /// Makes what the search needs, with all threads; `find` does so at its first call, where others may have to wait.
    virtual void prepare() const {}

    /// The point of `∂S` nearest to each of some points, inside, outside or on the boundary. Of several that are
    /// equally near it is always the same one.
    /// \param points #Q
    /// \param bounds #Q; only points of `∂S` that are closer than this are wanted; infinity: wherever it is. A bound
    ///     near the distance makes the answer cheap.
    /// \param nearest #Q; `nearest[i]` becomes the point of `∂S`, or nothing if none is closer than `bounds[i]`
    virtual void find(std::span<const Point> points, std::span<const double> bounds,
                      std::span<std::optional<Point>> nearest) const = 0;

   protected:
    ~NearestPoints() = default;  // no one owns a solid by it
};

/// A bounded solid `S` with boundary `∂S`, asked in batches. Every question may be asked from several threads at once,
/// each with its own spans, unless an implementation says otherwise. The same question always has the same answer,
/// whatever else is in the batch.
class SCALEAXIS_EXPORT Solid {
   public:
    Solid() = default;
    Solid(const Solid&) = delete;
    Solid& operator=(const Solid&) = delete;
    virtual ~Solid() = default;

    /// The bounding box of `S`.
    virtual Box bounds() const = 0;

    /// Which points lie in `S`.
    /// \param points #Q
    /// \param sides #Q; `sides[i]` becomes 1 if `points[i]` lies in `S`, 0 otherwise
    virtual void inside(std::span<const Point> points, std::span<std::uint8_t> sides) const = 0;

    /// Where segments leave `S`.
    /// \param chords #Q segments from a point of `S` to a point outside
    /// \param points #Q; `points[i]` becomes the crossing of `chords[i]` and `∂S`. Of several crossings (an odd number)
    /// it is the one farthest from the reference. Nothing if there is no crossing, or an even number of them: then one
    /// of the ends is not where the caller takes it to be.
    virtual void crossings(std::span<const Chord> chords, std::span<std::optional<Point>> points) const = 0;

    /// The search for the points of `∂S` nearest to given ones; null: the solid has none.
    virtual const NearestPoints* nearest_points() const { return nullptr; }

    /// How many questions of a kind a call should hold where there are as many to ask; ≥ 1. Few where an answer takes
    /// long, so that threads can share the work; many where a call has a cost of its own.
    virtual std::size_t batch_size() const { return 1024; }

    /// Points of `∂S`, dense enough for a Poisson-disk sample of radius `spacing` to be chosen from them: about ten
    /// for each `spacing²` of area, the solid's own vertices among them; or almost such a sample itself. Every
    /// component of `∂S` gets some. Empty where the solid has no cheap way to find any.
    virtual std::vector<Point> seeds(double spacing, std::uint64_t seed, const Execution& execution) const = 0;

    /// The convex edges of `∂S` at which the normals differ by `angle` degrees at least, in segments whose common ends
    /// are equal. Others may be among them, inside `S`. Nothing where the solid has no list of its edges: meshes alone
    /// have one.
    virtual std::optional<std::vector<SharpEdge>> sharp_edges([[maybe_unused]] double angle) const {
        return std::nullopt;
    }

    /// Topology of the solid, if it is known.
    virtual std::optional<Topology> topology() const { return std::nullopt; }

    /// A part, or a gap, that is as thin as any that such a solid can have, if it knows of one: of images one that is a
    /// voxel thick.
    virtual std::optional<ThinPart> thin_part() const { return std::nullopt; }

    /// Does `p` lie in `S`?
    bool inside(const Point& p) const {
        std::uint8_t side = 0;
        inside({&p, 1}, {&side, 1});
        return side != 0;
    }

    /// The crossing of one chord.
    std::optional<Point> crossing(const Point& inside_end, const Point& outside_end, const Point& reference) const {
        const Chord chord{inside_end, outside_end, reference};
        std::optional<Point> point;
        crossings({&chord, 1}, {&point, 1});
        return point;
    }

    /// Does the solid have `nearest_points`?
    bool knows_nearest() const { return nearest_points() != nullptr; }

    /// `NearestPoints::prepare`, where there is such a search.
    void prepare_nearest() const {
        if (const NearestPoints* search = nearest_points()) {
            search->prepare();
        }
    }

    /// `NearestPoints::find`. \throws UnusableInput if the solid has no such search
    void nearest(std::span<const Point> points, std::span<const double> bounds,
                 std::span<std::optional<Point>> nearest) const;

    /// The point of `∂S` nearest to one point, if there is one closer than the bound. \throws as above
    std::optional<Point> nearest(const Point& p, double bound = std::numeric_limits<double>::infinity()) const {
        std::optional<Point> point;
        nearest({&p, 1}, {&bound, 1}, {&point, 1});
        return point;
    }

    /// What was repaired in the input that the solid was made from, and what is odd about it; empty: nothing.
    virtual std::vector<Diagnostic> warnings() const { return {}; }
};

}  // namespace scaleaxis::inline v1
