// SPDX-License-Identifier: Apache-2.0
/// \file
/// A medial mesh as a solid: the envelope of its balls.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "scaleaxis/topology.hpp"

namespace scaleaxis::inline v1 {

class EnvelopeData;  // not public

/// The union of the balls at all points of a medial mesh. Centres and radii are interpolated linearly between the
/// corners: along an edge they make a cone, in a triangle a slab (P. Li et al., "Q-MAT: computing medial axis transform
/// by quadratic error minimization", 2015). Larger polygons are cut into triangles. Where radii are not linear
/// (`shrink`), edges are halved until linear ones are right to within 1e-4 of the diagonal.
///
/// Copies share what is kept for the questions, which may be asked from several threads at once.
class SCALEAXIS_EXPORT Envelope {
   public:
    /// \throws UnusableInput (see `check`; no vertices)
    explicit Envelope(const MedialComplex& complex);

    /// The box around all balls.
    Box bounds() const;

    /// Topology of the medial mesh: also that of the envelope, unless balls meet where the mesh does not.
    Topology topology() const;

    /// For each point the least |p - centre| - radius over the balls: negative inside, 0 on the boundary. Outside it is
    /// the distance to the envelope. Inside its magnitude is the depth in the one ball in which the point is deepest:
    /// the distance to the boundary, or less, where that is nearest in a re-entrant edge.
    /// \param points #P \returns #P, in units of the complex
    std::vector<double> signed_distances(std::span<const Point> points, const Execution& execution = {}) const;

    /// Does each point lie in the envelope or on its boundary?
    /// \param points #P \returns #P, 1 or 0
    std::vector<std::uint8_t> inside(std::span<const Point> points, const Execution& execution = {}) const;

    // For the stages of the library.
    const EnvelopeData& data() const { return *data_; }

   private:
    std::shared_ptr<const EnvelopeData> data_;
};

/// The envelope as a solid: its sides and crossings are those of the balls, its nearest points those of
/// `function_solid`, which is made when they are first asked for.
/// \param smallest_feature for that: `FunctionOptions::smallest_feature`
/// \throws UnusableInput if all radii are 0, InvalidOption if the feature is negative or not finite
SCALEAXIS_EXPORT std::unique_ptr<Solid> envelope_solid(const Envelope& envelope, double smallest_feature = 0.0,
                                                       const Execution& execution = {});

/// `Envelope::signed_distances` on a cubic grid; everything else as for a union of balls (field.hpp).
SCALEAXIS_EXPORT Image signed_distance_image(const Envelope& envelope, Index resolution,
                                             const Execution& execution = {});

}  // namespace scaleaxis::inline v1
