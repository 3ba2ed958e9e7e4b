// SPDX-License-Identifier: Apache-2.0
#include "solid/zero_set/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "base/disjoint_sets.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "solid/seeds.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr Index kLatticeLandmarks = 20;

bool is_before(const Cell& a, const Cell& b) { return std::tie(a[2], a[1], a[0]) < std::tie(b[2], b[1], b[0]); }

Box box_of(const Lattice& lattice, const Cell& cell) {
    Box box;
    for (int i = 0; i < 8; ++i) {
        box.extend(lattice.at({1.0 * cell[0] + (i & 1), 1.0 * cell[1] + (i >> 1 & 1), 1.0 * cell[2] + (i >> 2)}));
    }
    return box;
}

/// Does the surface pass the side of a cell where its neighbor before it along `axis` is?
bool passes_side(const SurfaceCell& cell, int axis) {
    constexpr std::array<int, 3> kCorners{0b01010101, 0b00110011, 0b00001111};
    const int inside = cell.inside & kCorners[axis];
    return inside != 0 && inside != kCorners[axis];
}

/// Some cells of each part of the surface.
std::vector<SurfaceCell> landmarks(const std::vector<SurfaceCell>& cells) {
    DisjointSets parts(cells.size());
    CancellationPoint cancellation_point;
    for (int axis = 0; axis < 3; ++axis) {
        std::size_t behind = 0;  // the cells are sorted, so those behind them come in the same order
        for (std::size_t i = 0; i < cells.size(); ++i) {
            cancellation_point();
            if (passes_side(cells[i], axis)) {
                Cell wanted = cells[i].cell;
                --wanted[axis];
                while (is_before(cells[behind].cell, wanted)) {
                    ++behind;
                }
                if (cells[behind].cell == wanted) {
                    parts.join(static_cast<Index>(i), static_cast<Index>(behind));
                }
            }
        }
    }
    std::vector<SurfaceCell> result;
    std::vector<Index> counts(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        if (counts[parts.find(static_cast<Index>(i))]++ < kLatticeLandmarks) {
            result.push_back(cells[i]);
        }
    }
    return result;
}

/// The cells that are within one cell from a side of `box`.
std::vector<SurfaceCell> cells_at_sides(const Lattice& lattice, const std::vector<SurfaceCell>& cells, const Box& box) {
    std::vector<SurfaceCell> result;
    std::copy_if(cells.begin(), cells.end(), std::back_inserter(result), [&](const SurfaceCell& cell) {
        const Box of_cell = box_of(lattice, cell.cell);
        const Point side = of_cell.max - of_cell.min;
        const Point low = of_cell.min - box.min - 1.01 * side;
        const Point high = box.max - of_cell.max - 1.01 * side;
        return std::min({low.x, low.y, low.z, high.x, high.y, high.z}) < 0.0;
    });
    return result;
}

/// The edges of cells.
std::vector<LineInCell> edges_of(const std::vector<SurfaceCell>& cells) {
    std::vector<LineInCell> edges;
    for (const auto& [cell, inside] : cells) {
        for (int edge = 0; edge < 12; ++edge) {
            const int axis = edge / 4;
            std::array<double, 3> p{1.0 * cell[0], 1.0 * cell[1], 1.0 * cell[2]};
            p[(axis + 1) % 3] += edge & 1;
            p[(axis + 2) % 3] += edge >> 1 & 1;
            edges.push_back({cell, axis, {p[0], p[1], p[2]}});
        }
    }
    return edges;
}

/// Where lines in cells cross the surface.
std::vector<Point> points_on(const Lattice& lattice, const std::vector<LineInCell>& lines, const RootInCell& root) {
    std::vector<Point> points;
    for (const auto& [cell, axis, p] : lines) {
        if (const std::optional<double> position = root(cell, axis, p)) {
            std::array<double, 3> index{p.x, p.y, p.z};
            index[axis] = *position;
            points.push_back(lattice.at({index[0], index[1], index[2]}));
        }
    }
    return points;
}

}  // namespace

std::uint64_t stream_of(const Cell& cell, std::uint64_t seed) {
    return random_bits(seed, (static_cast<std::uint64_t>(cell[2]) << 42) ^ (static_cast<std::uint64_t>(cell[1]) << 21) ^
                                 static_cast<std::uint64_t>(cell[0]));
}

std::array<double, 3> lines_through_cell(const Lattice& lattice, double density) {
    std::array<double, 3> lines{};
    for (int axis = 0; axis < 3; ++axis) {
        lines[axis] = density * norm(cross(lattice.steps[(axis + 1) % 3], lattice.steps[(axis + 2) % 3]));
    }
    return lines;
}

void check_number_of_lines(const Lattice& lattice, std::size_t cells, double density) {
    const std::array<double, 3> lines = lines_through_cell(lattice, density);
    check_number_of_seeds((lines[0] + lines[1] + lines[2]) * static_cast<double>(cells));
}

std::vector<Point> points_on_lines(const Lattice& lattice, const std::vector<SurfaceCell>& cells, double density,
                                   std::uint64_t seed, const RootInCell& root) {
    const std::array<double, 3> lines = lines_through_cell(lattice, density);
    check_number_of_lines(lattice, cells.size(), density);
    return collect<std::vector<Point>>(
        cells.size(),
        [&](std::size_t i, std::vector<Point>& out) {
            const Cell& cell = cells[i].cell;
            const std::uint64_t bits = stream_of(cell, seed);
            for (int axis = 0; axis < 3; ++axis) {
                const std::uint64_t stream = mixed(bits + axis);
                const auto count = static_cast<std::uint64_t>(lines[axis] + random_unit(stream, 0));
                for (std::uint64_t line = 1; line <= count; ++line) {
                    std::array<double, 3> p{1.0 * cell[0], 1.0 * cell[1], 1.0 * cell[2]};
                    p[(axis + 1) % 3] += random_unit(stream, line, 0);
                    p[(axis + 2) % 3] += random_unit(stream, line, 1);
                    if (const std::optional<double> position = root(cell, axis, Point{p[0], p[1], p[2]})) {
                        p[axis] = *position;
                        out.push_back(lattice.at({p[0], p[1], p[2]}));
                    }
                }
            }
        },
        std::size_t{256});
}

std::vector<LineInCell> landmark_edges(const std::vector<SurfaceCell>& cells) { return edges_of(landmarks(cells)); }

std::vector<Point> landmark_points(const Lattice& lattice, const std::vector<SurfaceCell>& cells,
                                   const RootInCell& root) {
    return points_on(lattice, landmark_edges(cells), root);
}

Box extent_of(const Lattice& lattice, const std::vector<SurfaceCell>& cells, const std::vector<Point>& landmarks,
              const RootInCell& root, double margin) {
    constexpr double kFewLines = 0.5;  // for each of the smallest faces of a cell
    constexpr double kManyLines = 8.0;
    const auto& [a, b, c] = lattice.steps;
    const double face = std::min({norm(cross(a, b)), norm(cross(b, c)), norm(cross(c, a))});
    Box box;
    const auto extend = [&](const std::vector<Point>& points) {
        for (const Point& p : points) {
            box.extend(p);
        }
    };
    extend(landmarks);
    // Other cells lie within the box already.
    extend(points_on_lines(lattice, cells_at_sides(lattice, cells, box), kFewLines / face, 0, root));
    const std::vector<SurfaceCell> outermost = cells_at_sides(lattice, cells, box);
    extend(points_on_lines(lattice, outermost, kManyLines / face, 1, root));
    extend(points_on(lattice, edges_of(outermost), root));
    const Point by =
        margin * Point{std::abs(a.x) + std::abs(b.x) + std::abs(c.x), std::abs(a.y) + std::abs(b.y) + std::abs(c.y),
                       std::abs(a.z) + std::abs(b.z) + std::abs(c.z)};
    return {box.min - by, box.max + by};
}

}  // namespace scaleaxis::inline v1
