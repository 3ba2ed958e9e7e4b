// SPDX-License-Identifier: Apache-2.0
#include "solid/zero_set/near_points.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "solid/zero_set/trilinear.hpp"

namespace scaleaxis::inline v1 {
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
    bool is_settled = false;  // its interpolant agrees with the function
};

/// The points of a piece at the corners, middles of edges and faces, and the middle: x first.
Point grid_point(const Piece& piece, int i) {
    return piece.low + 0.5 * piece.side * Point{1.0 * (i % 3), 1.0 * (i / 3 % 3), 1.0 * (i / 9)};
}

constexpr int kMiddle = 13;  // of the 27

bool is_corner(int i) { return i % 3 != 1 && i / 3 % 3 != 1 && i / 9 != 1; }

/// The eight pieces of a piece. \param grid its values at the points above
std::array<Piece, 8> halved(const Piece& piece, const std::array<double, 27>& grid) {
    std::array<Piece, 8> parts;
    for (int part = 0; part < 8; ++part) {
        const int x = part & 1, y = part >> 1 & 1, z = part >> 2;
        parts[part] = {grid_point(piece, x + 3 * y + 9 * z), 0.5 * piece.side, random_bits(piece.stream, part), {}};
        for (int c = 0; c < 8; ++c) {
            parts[part].values[c] = grid[x + (c & 1) + 3 * (y + (c >> 1 & 1)) + 9 * (z + (c >> 2))];
        }
    }
    return parts;
}

class Finder {
   public:
    Finder(const Lattice& lattice, const BatchFunction& function, double spacing)
        : lattice_(lattice),
          function_(function),
          spacing_(spacing),
          lines_(lines_through_cell(lattice, kSeedLines / (spacing * spacing))),
          lengths_{norm(lattice.steps[0]), norm(lattice.steps[1]), norm(lattice.steps[2])} {}

    /// The points of all pieces, in their order. Pieces of one size are halved together.
    void find(std::vector<Piece> pieces, std::vector<Point>& out) const {
        while (settle(pieces)) {
            stop_if_cancelled();
        }
        CancellationPoint ask_whether_cancelled;
        for (const Piece& piece : pieces) {
            draw_lines(piece, out, ask_whether_cancelled);
        }
    }

   private:
    bool is_fine(const Piece& piece) const {
        return !(piece.side * std::ranges::max(lengths_) > kFinestPiece * spacing_);
    }

    /// Takes out pieces that are far from zero, and halves those whose interpolants do not agree with the function.
    /// Returns whether any was halved.
    bool settle(std::vector<Piece>& pieces) const {
        std::erase_if(pieces, [](const Piece& piece) { return !piece.is_settled && is_far_from_zero(piece.values); });
        for (Piece& piece : pieces) {
            piece.is_settled = piece.is_settled || is_fine(piece);
        }
        const std::vector<double> middles = values_at(pieces, [](int i) { return i == kMiddle; });
        std::size_t next = 0;
        std::vector<double> middles_of_halved;
        for (Piece& piece : pieces) {
            if (!piece.is_settled) {
                const double middle = middles[next++];
                piece.is_settled = agrees(piece, middle);
                if (!piece.is_settled) {
                    middles_of_halved.push_back(middle);
                }
            }
        }
        if (middles_of_halved.empty()) {
            return false;
        }
        const std::vector<double> others = values_at(pieces, [](int i) { return i != kMiddle && !is_corner(i); });
        next = 0;
        std::size_t at = 0;
        std::vector<Piece> result;
        for (const Piece& piece : pieces) {
            if (piece.is_settled) {
                result.push_back(piece);
                continue;
            }
            std::array<double, 27> grid{};
            for (int i = 0; i < 27; ++i) {
                grid[i] = is_corner(i)   ? piece.values[i % 3 / 2 + i / 3 % 3 / 2 * 2 + i / 9 / 2 * 4]
                          : i == kMiddle ? middles_of_halved[at++]
                                         : others[next++];
            }
            for (const Piece& part : halved(piece, grid)) {
                result.push_back(part);
            }
        }
        pieces = std::move(result);
        return true;
    }

    /// The function at the wanted ones of the 27 points of all pieces that are not settled.
    template <class IsWanted>
    std::vector<double> values_at(const std::vector<Piece>& pieces, const IsWanted& is_wanted) const {
        std::vector<Point> places;
        for (const Piece& piece : pieces) {
            for (int i = 0; !piece.is_settled && i < 27; ++i) {
                if (is_wanted(i)) {
                    places.push_back(lattice_.at(grid_point(piece, i)));
                }
            }
        }
        std::vector<double> values(places.size());
        function_(places, values);
        return values;
    }

    bool agrees(const Piece& piece, double middle) const {
        constexpr Point kCenter{0.5, 0.5, 0.5};
        const Point by_local = gradient(piece.values, kCenter);
        const Point slope =
            (1.0 / piece.side) * Point{by_local.x / lengths_[0], by_local.y / lengths_[1], by_local.z / lengths_[2]};
        return std::abs(middle - interpolated(piece.values, kCenter)) <= kAgreement * spacing_ * norm(slope);
    }

    // Along a line parallel to an axis the interpolant is linear.
    void draw_lines(const Piece& piece, std::vector<Point>& out, CancellationPoint& ask_whether_cancelled) const {
        for (int axis = 0; axis < 3; ++axis) {
            const std::uint64_t stream = random_bits(piece.stream, 8, axis);
            const auto count =
                static_cast<std::uint64_t>(lines_[axis] * piece.side * piece.side + random_unit(stream, 0));
            for (std::uint64_t line = 1; line <= count; ++line) {
                ask_whether_cancelled();  // there are thousands of them where the spacing is far below the step
                std::array<double, 3> local{};
                local[(axis + 1) % 3] = random_unit(stream, line, 0);
                local[(axis + 2) % 3] = random_unit(stream, line, 1);
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
    const BatchFunction& function_;
    double spacing_;
    std::array<double, 3> lines_;    // of each axis for a cell
    std::array<double, 3> lengths_;  // of the lattice's steps
};

}  // namespace

std::vector<Point> points_near_zero(const Lattice& lattice, std::span<const SurfaceCell> cells,
                                    std::span<const CornerValues> values, const BatchFunction& function,
                                    std::size_t batch, double spacing, std::uint64_t seed) {
    check_number_of_lines(lattice, cells.size(), kSeedLines / (spacing * spacing));
    const Finder finder(lattice, function, spacing);
    return collect<std::vector<Point>>(
        (cells.size() + batch - 1) / batch,
        [&](std::size_t part, std::vector<Point>& out) {
            std::vector<Piece> pieces;
            for (std::size_t i = part * batch; i < std::min(cells.size(), (part + 1) * batch); ++i) {
                const Cell& cell = cells[i].cell;
                const auto& [x, y, z] = cell;
                pieces.push_back({{1.0 * x, 1.0 * y, 1.0 * z}, 1.0, stream_of(cell, seed), values[i]});
            }
            finder.find(std::move(pieces), out);
        },
        std::size_t{1});
}

}  // namespace scaleaxis::inline v1
