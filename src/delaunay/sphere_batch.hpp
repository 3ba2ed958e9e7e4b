// SPDX-License-Identifier: Apache-2.0
/// \file
/// The spheres of many tetrahedra at once, with vector instructions.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "scaleaxis/geometry.hpp"

namespace scaleaxis::inline v1 {

/// The spheres through a common point and the corners a, b, c of triangles, all relative to that point: c.f. `Cell`.
class SphereBatch {
   public:
    void start(std::size_t count) {
        if (capacity_ < count) {
            capacity_ = 2 * count;
            values_.assign(17 * capacity_, 0.0);
        }
    }
    void set(std::size_t i, const Point& a, const Point& b, const Point& c) {
        double* const v = values_.data() + i;
        v[0] = a.x;
        v[capacity_] = a.y;
        v[2 * capacity_] = a.z;
        v[3 * capacity_] = b.x;
        v[4 * capacity_] = b.y;
        v[5 * capacity_] = b.z;
        v[6 * capacity_] = c.x;
        v[7 * capacity_] = c.y;
        v[8 * capacity_] = c.z;
    }
    /// Weights relative to that of the common point; 0 by default.
    void set_weights(std::size_t i, double a, double b, double c) {
        value(9, i) = a;
        value(10, i) = b;
        value(11, i) = c;
    }
    void make_spheres(std::size_t count);

    std::array<double, 3> center(std::size_t i) const { return {value(12, i), value(13, i), value(14, i)}; }
    float error(std::size_t i) const {
        const double error = value(15, i);
        return value(16, i) > 0 && error < 1e38 ? static_cast<float>(1.000001 * error + 1e-37)
                                                : std::numeric_limits<float>::infinity();
    }

   private:
    double value(std::size_t k, std::size_t i) const { return values_[k * capacity_ + i]; }
    double& value(std::size_t k, std::size_t i) { return values_[k * capacity_ + i]; }
    std::vector<double> values_;
    std::size_t capacity_ = 0;
};

}  // namespace scaleaxis::inline v1
