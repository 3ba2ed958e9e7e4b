// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/near_points.hpp"

#include <algorithm>
#include <cmath>

#include "kernel/parallel.hpp"
#include "kernel/random.hpp"
#include "shapes/trilinear.hpp"

namespace scaleaxis {
namespace {

// The interpolant has to agree with the function to this part of the spacing, or be that of a piece with sides of at
// most the other one.
constexpr double kAgreement = 0.1;
constexpr double kFinestPiece = 0.5;

/// A cell, or one of the eight pieces of a piece.
struct Piece {
    Point low;          // an index of the lattice
    double side = 1.0;  // in cells
    std::uint64_t stream = 0;
    CornerValues values{};
};

class Finder {
   public:
    Finder(const Lattice& lattice, const std::function<double(const Point&)>& function, double spacing)
        : lattice_(lattice),
          function_(function),
          spacing_(spacing),
          lines_(lines_through_cell(lattice, kSeedLines / (spacing * spacing))),
          lengths_{norm(lattice.steps[0]), norm(lattice.steps[1]), norm(lattice.steps[2])} {}

    void find(const Piece& piece, std::vector<Point>& out) const {
        if (is_far_from_zero(piece.values)) {
            return;
        }
        if (piece.side * std::ranges::max(lengths_) > kFinestPiece * spacing_) {
            const double middle = function_(lattice_.at(piece.low + 0.5 * piece.side * Point{1.0, 1.0, 1.0}));
            if (!agrees(piece, middle)) {
                halve(piece, middle, out);
                return;
            }
        }
        draw_lines(piece, out);
    }

   private:
    bool agrees(const Piece& piece, double middle) const {
        constexpr Point kMiddle{0.5, 0.5, 0.5};
        const Point by_local = gradient(piece.values, kMiddle);
        const Point slope =
            (1.0 / piece.side) * Point{by_local.x / lengths_[0], by_local.y / lengths_[1], by_local.z / lengths_[2]};
        return std::abs(middle - interpolated(piece.values, kMiddle)) <= kAgreement * spacing_ * norm(slope);
    }

    void halve(const Piece& piece, double middle, std::vector<Point>& out) const {
        const double half = 0.5 * piece.side;
        std::array<double, 27> grid{};
        for (int i = 0; i < 27; ++i) {
            const int x = i % 3, y = i / 3 % 3, z = i / 9;
            const bool is_corner = x != 1 && y != 1 && z != 1;
            grid[i] = is_corner ? piece.values[x / 2 + y / 2 * 2 + z / 2 * 4]
                      : i == 13 ? middle
                                : function_(lattice_.at(piece.low + half * Point{1.0 * x, 1.0 * y, 1.0 * z}));
        }
        for (int part = 0; part < 8; ++part) {
            const int x = part & 1, y = part >> 1 & 1, z = part >> 2;
            Piece child{
                piece.low + half * Point{1.0 * x, 1.0 * y, 1.0 * z}, half, kernel::random_bits(piece.stream, part), {}};
            for (int c = 0; c < 8; ++c) {
                child.values[c] = grid[x + (c & 1) + 3 * (y + (c >> 1 & 1)) + 9 * (z + (c >> 2))];
            }
            find(child, out);
        }
    }

    // Along a line parallel to an axis the interpolant is linear.
    void draw_lines(const Piece& piece, std::vector<Point>& out) const {
        for (int axis = 0; axis < 3; ++axis) {
            const std::uint64_t stream = kernel::random_bits(piece.stream, 8, axis);
            const auto count =
                static_cast<std::uint64_t>(lines_[axis] * piece.side * piece.side + kernel::random_unit(stream, 0));
            for (std::uint64_t line = 1; line <= count; ++line) {
                std::array<double, 3> local{};
                local[(axis + 1) % 3] = kernel::random_unit(stream, line, 0);
                local[(axis + 2) % 3] = kernel::random_unit(stream, line, 1);
                const double begin = interpolated(piece.values, {local[0], local[1], local[2]});
                local[axis] = 1.0;
                const double end = interpolated(piece.values, {local[0], local[1], local[2]});
                if ((begin < 0.0) != (end < 0.0)) {
                    local[axis] = begin / (begin - end);
                    out.push_back(lattice_.at(piece.low + piece.side * Point{local[0], local[1], local[2]}));
                }
            }
        }
    }

    const Lattice& lattice_;
    const std::function<double(const Point&)>& function_;
    double spacing_;
    std::array<double, 3> lines_;    // of each axis for a cell
    std::array<double, 3> lengths_;  // of the lattice's steps
};

}  // namespace

Point gradient(const CornerValues& v, const Point& p) {
    return {mixed(mixed(v[1] - v[0], v[3] - v[2], p.y), mixed(v[5] - v[4], v[7] - v[6], p.y), p.z),
            mixed(mixed(v[2] - v[0], v[3] - v[1], p.x), mixed(v[6] - v[4], v[7] - v[5], p.x), p.z),
            mixed(mixed(v[4] - v[0], v[5] - v[1], p.x), mixed(v[6] - v[2], v[7] - v[3], p.x), p.y)};
}

std::vector<Point> points_near_zero(const Lattice& lattice, std::span<const SurfaceCell> cells,
                                    std::span<const CornerValues> values,
                                    const std::function<double(const Point&)>& function, double spacing,
                                    std::uint64_t seed) {
    check_number_of_lines(lattice, cells.size(), kSeedLines / (spacing * spacing));
    const Finder finder(lattice, function, spacing);
    return kernel::collect<std::vector<Point>>(
        cells.size(),
        [&](std::size_t i, std::vector<Point>& out) {
            const Cell& cell = cells[i].cell;
            const auto& [x, y, z] = cell;
            finder.find({{1.0 * x, 1.0 * y, 1.0 * z}, 1.0, stream_of(cell, seed), values[i]}, out);
        },
        std::size_t{256});
}

}  // namespace scaleaxis
