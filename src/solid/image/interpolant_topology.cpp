// SPDX-License-Identifier: Apache-2.0
#include "solid/image/interpolant_topology.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "base/disjoint_sets.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "solid/image/interpolant_euler.hpp"
#include "solid/zero_set/trilinear.hpp"

// The Euler characteristic is additive. Cells, faces and edges of the lattice are closed; where two cells meet, their
// common face was counted twice, and so on: the sum over the lattice of `(-1)^(3 - dimension)` times the characteristic
// of the part of the solid in each element is that of the solid. The interpolant has no extrema within an edge, a face
// or a cell, so that every piece of the solid in one holds a corner. CubeValues on one side are connected along edges,
// through the saddle of a face, or through one of the two critical points that a cell can have (Chernyaev, "Marching
// Cubes 33", 1995). Those that are connected inside form one piece, which is a ball unless a connection outside goes
// through it.

namespace scaleaxis::inline v1 {
namespace {

/// The values at the corners of a cell, positive inside.
using CubeValues = std::array<double, 8>;

class Values {
   public:
    Values(const std::array<Index, 3>& sizes, std::span<const float> values) : sizes_(sizes), values_(values) {}

    const std::array<Index, 3>& sizes() const { return sizes_; }
    std::size_t place(const Cell& cell) const {
        return (static_cast<std::size_t>(cell[2]) * sizes_[1] + cell[1]) * sizes_[0] + cell[0];
    }
    bool is_inside(std::size_t place) const { return values_[place] < 0.0F; }

    std::array<std::size_t, 8> places(const Cell& cell) const {
        const std::size_t first = place(cell);
        std::array<std::size_t, 8> places{};
        for (std::size_t k = 0; k < 8; ++k) {
            places[k] = first + (k & 1) + (k >> 1 & 1) * sizes_[0] + (k >> 2) * std::size_t(sizes_[0]) * sizes_[1];
        }
        return places;
    }
    CubeValues corners(const Cell& cell) const {
        CubeValues corners{};
        const std::array<std::size_t, 8> at = places(cell);
        std::ranges::transform(at, corners.begin(), [&](std::size_t place) { return -double{values_[place]}; });
        return corners;
    }

   private:
    std::array<Index, 3> sizes_;
    std::span<const float> values_;
};

/// The corners of the face across `axis` at the lower end or at the upper one; the first is opposite to the last.
std::array<std::size_t, 4> face_of(std::size_t axis, std::size_t end) {
    const std::size_t u = std::size_t{1} << (axis + 1) % 3;
    const std::size_t v = std::size_t{1} << (axis + 2) % 3;
    const std::size_t first = end << axis;
    return {first, first + u, first + v, first + u + v};
}

/// The ends of the diagonal of a face that its saddle connects; nothing if there are not two corners inside, opposite
/// to each other.
std::optional<std::array<std::size_t, 2>> connected_diagonal(const CubeValues& v,
                                                             const std::array<std::size_t, 4>& face) {
    const auto [a, b, c, d] = face;
    const bool is_inside = v[a] > 0.0;
    if ((v[d] > 0.0) != is_inside || (v[b] > 0.0) == is_inside || (v[c] > 0.0) == is_inside) {
        return std::nullopt;
    }
    const double product = v[a] * v[d] - v[b] * v[c];
    const bool is_saddle_inside = is_inside ? product > 0.0 : product < 0.0;
    return is_saddle_inside == is_inside ? std::array{a, d} : std::array{b, c};
}

/// A point within a cell where the gradient of the interpolant is 0.
struct Saddle {
    Point point;
    double value = 0.0;
    bool has_one_ascent = false;  ///< it grows along one line and falls across it; else it is the other way round
};

/// Coefficients of the interpolant as a polynomial.
struct Polynomial {
    double x, y, z, xy, xz, yz, xyz;

    explicit Polynomial(const CubeValues& v)
        : x(v[1] - v[0]),
          y(v[2] - v[0]),
          z(v[4] - v[0]),
          xy(v[3] - v[2] - v[1] + v[0]),
          xz(v[5] - v[4] - v[1] + v[0]),
          yz(v[6] - v[4] - v[2] + v[0]),
          xyz(v[7] - v[6] - v[5] - v[3] + v[4] + v[2] + v[1] - v[0]) {}

    /// The second derivatives that are not 0: by y and z, by x and z, by x and y.
    Point mixed(const Point& p) const { return {yz + xyz * p.x, xz + xyz * p.y, xy + xyz * p.z}; }
};

/// At most two.
std::vector<Saddle> saddles_in(const CubeValues& corners) {
    const Polynomial f(corners);
    // Two of the equations give x and y, and the third becomes quadratic in z.
    const double common = f.z * f.xyz - f.xz * f.yz;
    const double a = f.xyz * common;
    const double half_b = f.xy * common;
    const double c = f.z * f.xy * f.xy - f.xz * f.y * f.xy - f.yz * f.x * f.xy + f.xyz * f.x * f.y;
    const auto zeros = quadratic_zeros(a, half_b, c);
    if (!zeros) {
        return {};
    }
    std::vector<Saddle> result;
    for (const double z : *zeros) {
        const double by_xy = f.xy + f.xyz * z;
        const Point p{-(f.y + f.yz * z) / by_xy, -(f.x + f.xz * z) / by_xy, z};
        const auto is_within = [](double t) { return t > 0.0 && t < 1.0; };
        if (is_within(p.x) && is_within(p.y) && is_within(p.z)) {
            const Point mixed = f.mixed(p);
            // The three eigenvalues have the sum 0 and the product 2 mixed.x mixed.y mixed.z.
            result.push_back({p, interpolated(corners, p), mixed.x * mixed.y * mixed.z > 0.0});
        }
    }
    return result;
}

/// The corner of a cell that the interpolant grows towards from a point, or falls towards.
std::size_t corner_towards(const CubeValues& corners, Point p, double sign) {
    constexpr double kStep = 1.0 / 64.0;
    constexpr int kMostSteps = 1024;
    for (int i = 0; i < kMostSteps; ++i) {
        Point slope = sign * gradient(corners, p);
        const auto stop_at_face = [](double at, double& along) {
            along = (at <= 0.0 && along < 0.0) || (at >= 1.0 && along > 0.0) ? 0.0 : along;
        };
        stop_at_face(p.x, slope.x);
        stop_at_face(p.y, slope.y);
        stop_at_face(p.z, slope.z);
        const double length = norm(slope);
        if (!(length > 0.0)) {
            break;
        }
        p = p + (kStep / length) * slope;
        p = {std::clamp(p.x, 0.0, 1.0), std::clamp(p.y, 0.0, 1.0), std::clamp(p.z, 0.0, 1.0)};
    }
    return (p.x > 0.5 ? 1 : 0) | (p.y > 0.5 ? 2 : 0) | (p.z > 0.5 ? 4 : 0);
}

/// The two corners that a critical point connects: those uphill, or those downhill.
std::array<std::size_t, 2> connected_corners(const CubeValues& corners, const Saddle& at) {
    const Point m = Polynomial(corners).mixed(at.point);
    Eigen::Matrix3d hessian;
    hessian << 0.0, m.z, m.y, m.z, 0.0, m.x, m.y, m.x, 0.0;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(hessian);  // values ascending
    const Eigen::Vector3d line = eigen.eigenvectors().col(at.has_one_ascent ? 2 : 0);
    constexpr double kStart = 1e-3;
    const Point start = kStart * Point{line.x(), line.y(), line.z()};
    const double sign = at.has_one_ascent ? 1.0 : -1.0;
    return {corner_towards(corners, at.point + start, sign), corner_towards(corners, at.point - start, sign)};
}

using Pair = std::array<std::size_t, 2>;  ///< corners, or places, on the same side that are connected

/// CubeValues of a cell that are connected.
class CornerSets {
   public:
    CornerSets() : sets_(8) {}
    void join(std::size_t a, std::size_t b) { sets_.join(static_cast<Index>(a), static_cast<Index>(b)); }
    bool are_joined(std::size_t a, std::size_t b) {
        return sets_.find(static_cast<Index>(a)) == sets_.find(static_cast<Index>(b));
    }
    /// How many sets lie inside, and outside.
    std::array<int, 2> count(const CubeValues& v) {
        std::array<int, 2> counts{};
        for (Index k = 0; k < 8; ++k) {
            counts[v[k] > 0.0 ? 0 : 1] += sets_.find(k) == k ? 1 : 0;
        }
        return counts;
    }

   private:
    DisjointSets sets_;
};

/// What a cell adds.
struct CellParts {
    int euler = 0;                  ///< of the part of the solid in the closed cell
    std::vector<Pair> connections;  ///< through saddles
};

CellParts parts_of_cell(const CubeValues& v) {
    CornerSets sets;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < 8; ++k) {
            if (const std::size_t other = k ^ std::size_t{1} << axis; (v[k] > 0.0) == (v[other] > 0.0)) {
                sets.join(k, other);
            }
        }
    }
    CellParts parts;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const std::size_t end : {0, 1}) {
            if (const auto diagonal = connected_diagonal(v, face_of(axis, end))) {
                const auto [a, b] = *diagonal;
                sets.join(a, b);
                parts.connections.push_back(*diagonal);
            }
        }
    }
    int tunnels = 0;
    if (const auto [inside, outside] = sets.count(v); inside > 1 || outside > 1) {
        for (const Saddle& point : saddles_in(v)) {
            const bool is_inside = point.value > 0.0;
            if (is_inside != point.has_one_ascent) {
                continue;
            }
            const auto [a, b] = connected_corners(v, point);
            if (!sets.are_joined(a, b)) {
                sets.join(a, b);
                parts.connections.push_back({a, b});
                tunnels += is_inside ? 0 : 1;
            }
        }
    }
    parts.euler = sets.count(v)[0] - tunnels;
    return parts;
}

/// The Euler characteristic of the part of the solid in a closed face: the number of its pieces.
int euler_in_face(const CubeValues& v, const std::array<std::size_t, 4>& face) {
    const auto is_inside = [&](std::size_t k) { return v[k] > 0.0; };
    if (const auto diagonal = connected_diagonal(v, face)) {
        return is_inside((*diagonal)[0]) ? 1 : 2;
    }
    return std::ranges::any_of(face, is_inside) ? 1 : 0;
}

/// The faces, the edges and the vertex that a cell shares with no cell before it, as they enter the sum.
int euler_of_lower_elements(const CubeValues& v) {
    int euler = v[0] > 0.0 ? -1 : 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        euler += v[0] > 0.0 || v[std::size_t{1} << axis] > 0.0 ? 1 : 0;
        euler -= euler_in_face(v, face_of(axis, 0));
    }
    return euler;
}

struct CellSum {
    std::int64_t euler = 0;
    std::vector<Pair> connections;
};

CellSum join(std::vector<CellSum>& parts) {
    std::int64_t euler = 0;
    for (const CellSum& part : parts) {
        euler += part.euler;
    }
    return {euler, joined(parts, &CellSum::connections)};
}

/// The rows of the lattice as runs of values on one side.
struct Runs {
    std::vector<std::size_t> begins;  ///< of each run, the place of its first value
    std::vector<Index> rows;          ///< of each row, its first run; and the number of runs

    Index run_at(std::size_t row, std::size_t place) const {
        const auto begin = begins.begin() + rows[row];
        const auto end = begins.begin() + rows[row + 1];
        return static_cast<Index>(std::upper_bound(begin, end, place) - begins.begin()) - 1;
    }
};

Runs runs_of(const Values& values) {
    const std::size_t width = values.sizes()[0];
    const std::size_t rows = static_cast<std::size_t>(values.sizes()[1]) * values.sizes()[2];
    Runs runs;
    runs.rows.reserve(rows + 1);
    CancellationPoint stop_if_cancelled_now_and_then;
    for (std::size_t row = 0; row < rows; ++row) {
        stop_if_cancelled_now_and_then();
        runs.rows.push_back(static_cast<Index>(runs.begins.size()));
        for (std::size_t place = row * width; place < (row + 1) * width; ++place) {
            if (place == row * width || values.is_inside(place) != values.is_inside(place - 1)) {
                runs.begins.push_back(place);
            }
        }
    }
    runs.rows.push_back(static_cast<Index>(runs.begins.size()));
    return runs;
}

/// Joins the runs of two rows that have values on one side beside each other.
void join_rows(const Runs& runs, const Values& values, std::size_t row, std::size_t other, DisjointSets& sets) {
    const std::size_t width = values.sizes()[0];
    const auto end_of = [&](std::size_t of_row, Index run) {
        return (run + 1 < runs.rows[of_row + 1] ? runs.begins[run + 1] : (of_row + 1) * width) - of_row * width;
    };
    Index a = runs.rows[row];
    Index b = runs.rows[other];
    while (a < runs.rows[row + 1] && b < runs.rows[other + 1]) {
        if (values.is_inside(runs.begins[a]) == values.is_inside(runs.begins[b])) {
            sets.join(a, b);
        }
        const std::size_t end_a = end_of(row, a);
        const std::size_t end_b = end_of(other, b);
        a += end_a <= end_b ? 1 : 0;
        b += end_b <= end_a ? 1 : 0;
    }
}

/// How many connected parts lie inside, and outside.
std::array<std::int64_t, 2> count_parts(const Values& values, std::span<const Pair> connections) {
    const Runs runs = runs_of(values);
    DisjointSets sets(runs.begins.size());
    const auto [width, height, depth] = values.sizes();
    CancellationPoint stop_if_cancelled_now_and_then;
    for (Index k = 0; k < depth; ++k) {
        for (Index j = 0; j < height; ++j) {
            stop_if_cancelled_now_and_then();
            const std::size_t row = static_cast<std::size_t>(k) * height + j;
            if (j > 0) {
                join_rows(runs, values, row - 1, row, sets);
            }
            if (k > 0) {
                join_rows(runs, values, row - height, row, sets);
            }
        }
    }
    for (const auto& [a, b] : connections) {
        sets.join(runs.run_at(a / width, a), runs.run_at(b / width, b));
    }
    std::array<std::int64_t, 2> parts{};
    for (Index run = 0; run < static_cast<Index>(runs.begins.size()); ++run) {
        if (sets.find(run) == run) {
            ++parts[values.is_inside(runs.begins[run]) ? 0 : 1];
        }
    }
    return parts;
}

CellSum sum_over(const Values& all, std::span<const SurfaceCell> cells) {
    return collect<CellSum>(cells.size(), [&](std::size_t i, CellSum& out) {
        const Cell& cell = cells[i].cell;
        const CubeValues corners = all.corners(cell);
        const std::array<std::size_t, 8> places = all.places(cell);
        const CellParts parts = parts_of_cell(corners);
        out.euler += parts.euler + euler_of_lower_elements(corners);
        for (const auto& [a, b] : parts.connections) {
            out.connections.push_back({places[a], places[b]});
        }
    });
}

}  // namespace

std::int64_t interpolant_euler(const std::array<Index, 3>& sizes, std::span<const float> values,
                               const std::array<Index, 3>& low, const std::array<Index, 3>& high) {
    const Values all(sizes, values);
    const auto cells = collect<std::vector<SurfaceCell>>(
        high[2] - low[2],
        [&](Index layer, std::vector<SurfaceCell>& out) {
            const Index k = low[2] + layer;
            for (Index j = low[1]; j < high[1]; ++j) {
                for (Index i = low[0]; i < high[0]; ++i) {
                    const auto places = all.places({i, j, k});
                    const auto inside =
                        std::ranges::count_if(places, [&](std::size_t place) { return all.is_inside(place); });
                    if (inside != 0 && inside != 8) {
                        out.push_back({{i, j, k}});
                    }
                }
            }
        },
        Index{1});
    return sum_over(all, cells).euler;
}

Topology interpolant_topology(const std::array<Index, 3>& sizes, std::span<const float> values,
                              std::span<const SurfaceCell> cells) {
    const Values all(sizes, values);
    const CellSum sum = sum_over(all, cells);
    const auto [components, outside] = count_parts(all, sum.connections);
    const std::int64_t voids = outside - 1;
    return {components, sum.euler, components + voids - sum.euler, voids};
}

}  // namespace scaleaxis::inline v1
