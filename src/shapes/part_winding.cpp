// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/part_winding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace scaleaxis {
namespace {

/// How an edge of a triangle, seen along x, contributes to the winding number of the triangle's outline around `p`.
/// The two triangles of an edge get opposite results, however the arithmetic rounds: so nothing leaks between them.
int outline_step(const Point& a, const Point& b, const Point& p) {
    const bool is_upward = a.z <= b.z;
    const Point& low = is_upward ? a : b;
    const Point& high = is_upward ? b : a;
    if (!(low.z <= p.z && p.z < high.z)) {
        return 0;
    }
    const bool is_ahead = (high.y - low.y) * (p.z - low.z) - (high.z - low.z) * (p.y - low.y) >= 0.0;
    return !is_ahead ? 0 : is_upward ? 1 : -1;
}

/// How often the ray from `p` in the direction of x leaves the solid through the triangle: 1, 0 or -1 (it enters).
int exits(const std::array<Point, 3>& corner, const Point& p) {
    const auto& [a, b, c] = corner;
    const int outline = outline_step(a, b, p) + outline_step(b, c, p) + outline_step(c, a, p);
    if (outline == 0) {
        return 0;
    }
    const double volume = dot(a - p, cross(b - p, c - p));
    return volume * outline > 0.0 ? outline : 0;
}

/// Queries in a square grid over y and z, row by row.
class QueryGrid {
   public:
    explicit QueryGrid(std::span<const WindingQuery> queries)
        : size_(1 + static_cast<std::size_t>(std::sqrt(static_cast<double>(queries.size())))) {
        for (const WindingQuery& query : queries) {
            bounds_.extend(query.point);
        }
        offsets_.assign(size_ * size_ + 1, 0);
        for (const WindingQuery& query : queries) {
            ++offsets_[cell(query.point) + 1];
        }
        for (std::size_t i = 1; i < offsets_.size(); ++i) {
            offsets_[i] += offsets_[i - 1];
        }
        ids_.resize(queries.size());
        std::vector<std::size_t> end = offsets_;
        for (std::size_t i = 0; i < queries.size(); ++i) {
            ids_[end[cell(queries[i].point)]++] = i;
        }
    }

    /// Calls `use(id)` for the queries around the box, seen along x.
    template <class Use>
    void for_each_in(const Box& box, const Use& use) const {
        const std::size_t first_column = column(box.min.y);
        const std::size_t last_column = column(box.max.y);
        for (std::size_t r = row(box.min.z); r <= row(box.max.z); ++r) {
            for (std::size_t i = offsets_[r * size_ + first_column]; i < offsets_[r * size_ + last_column + 1]; ++i) {
                use(ids_[i]);
            }
        }
    }

   private:
    std::size_t step(double value, double min, double max) const {
        const double part = (value - min) / (max - min) * static_cast<double>(size_);
        return part > 0.0 ? static_cast<std::size_t>(std::min(part, static_cast<double>(size_ - 1))) : 0;
    }
    std::size_t column(double y) const { return step(y, bounds_.min.y, bounds_.max.y); }
    std::size_t row(double z) const { return step(z, bounds_.min.z, bounds_.max.z); }
    std::size_t cell(const Point& p) const { return row(p.z) * size_ + column(p.y); }

    std::size_t size_;
    Box bounds_;
    std::vector<std::size_t> offsets_;
    std::vector<std::size_t> ids_;
};

}  // namespace

std::vector<int> winding_numbers(const TriangleMesh& mesh, std::span<const Index> part_of_triangle,
                                 std::span<const WindingQuery> queries) {
    const QueryGrid grid(queries);
    std::vector<int> result(queries.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        std::array<Point, 3> corner;
        Box box;
        for (std::size_t k = 0; k < 3; ++k) {
            corner[k] = mesh.vertices[mesh.triangles[t][k]];
            box.extend(corner[k]);
        }
        grid.for_each_in(box, [&](std::size_t i) {
            if (queries[i].excluded_part != part_of_triangle[t]) {
                result[i] += exits(corner, queries[i].point);
            }
        });
    }
    return result;
}

}  // namespace scaleaxis
