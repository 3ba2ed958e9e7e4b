// SPDX-License-Identifier: Apache-2.0
/// \file
/// Walls and gaps of a solid: where they are thinner, thicker or narrower than they may be.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/solid.hpp"

namespace scaleaxis::inline v1 {

/// Limits, in units of the solid; what has no limit is not looked for.
struct WallOptions {
    std::optional<double> min_wall = std::nullopt;  ///< > 0: thinner walls are findings
    std::optional<double> max_wall = std::nullopt;  ///< > `min_wall`: thicker ones are
    std::optional<double> min_gap = std::nullopt;   ///< > 0: narrower gaps outside the solid are
    /// Angle, in degrees, [60, 179], between two of the contacts of a ball, as seen from its centre, from which on they
    /// lie on opposite sides: an edge of less than 180 degrees minus this is a thin wall, a groove as sharp a gap.
    double angle = 128.0;
    /// Longest edge between places where the surface is looked at, in diagonals of the bounding box, (0, 1].
    double edge = 0.03;
};

enum class FindingKind : std::uint8_t { kThinWall, kThickWall, kNarrowGap };

/// "thin wall", "thick wall" or "narrow gap".
SCALEAXIS_EXPORT std::string_view name_of(FindingKind kind);

/// A wall or gap that passes a limit: one connected piece of the surface, both of its sides.
struct Finding {
    FindingKind kind = FindingKind::kThinWall;
    double value = 0.0;  ///< the least thickness or width, of a thick wall the largest: diameter of `ball`
    double limit = 0.0;
    Ball ball;                        ///< between the two sides
    std::array<Point, 2> contacts{};  ///< where it touches them
    Point direction;                  ///< from the first contact to the second, of length 1
    double area = 0.0;                ///< of the surface, of both sides together
    Box extent;                       ///< of that surface and the contacts
    Index vertices = 0;               ///< of `Walls::surface` in it
};

struct Walls {
    std::vector<Finding> findings;  ///< thin walls, thick walls, gaps, the worst of each kind first
    /// Of its limit: a value that misses it by no more is no finding. The accuracy of values on a mesh.
    double tolerance = 0.0;

    TriangleMesh surface;      ///< the one given, with more vertices where these are needed
    std::vector<double> wall;  ///< #V: thickness of the wall; empty without a limit of walls
    std::vector<double> gap;   ///< #V: width of the gap; empty without a limit of gaps
    double wall_cap = 0.0;     ///< stands for all larger values in `wall`: twice the limit, 1.05 of that of thick walls
    double gap_cap = 0.0;      ///< the same of `gap`
    std::vector<Index> wall_findings;  ///< #V: of `findings`, or `kNone`; empty as `wall` is
    std::vector<Index> gap_findings;   ///< #V
};

/// Walls and gaps that pass a limit. Each point of the surface is given the largest ball on one side of it that it
/// leads to, uphill out of edges as in `Thickness::at_surface`, without an axis; gaps are the walls of the outside.
/// Where values are near a limit the surface is refined, and the least value is followed down along the wall.
/// \param surface of the solid, closed \throws InvalidOption, UnusableInput (the solid does not know nearest points),
/// Cancelled
SCALEAXIS_EXPORT Walls find_walls(const Solid& solid, TriangleMesh surface, const WallOptions& options,
                                  const Execution& execution = {});

/// A wall or gap at a point: its ball, of diameter infinity where nothing lies opposite, and its contacts.
struct WallAt {
    double value = 0.0;  ///< diameter of `ball`
    Ball ball;
    std::array<Point, 2> contacts{};
};

/// The wall of a solid at points on its surface or in it, without a limit. \param angle see `WallOptions::angle`
/// \throws InvalidOption, UnusableInput as above, Cancelled
SCALEAXIS_EXPORT std::vector<WallAt> wall_at(const Solid& solid, std::span<const Point> points, double angle = 128.0,
                                             const Execution& execution = {});

/// The gap at points of its surface or outside; infinity where a ball as large as the solid fits.
SCALEAXIS_EXPORT std::vector<WallAt> gap_at(const Solid& solid, std::span<const Point> points, double angle = 128.0,
                                            const Execution& execution = {});

}  // namespace scaleaxis::inline v1
