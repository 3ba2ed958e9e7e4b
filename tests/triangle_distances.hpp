// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"

namespace scaleaxis::test {

/// Distances to a set of triangles, by another library.
class Triangles {
   public:
    explicit Triangles(const TriangleMesh& mesh) {
        for (const auto& [a, b, c] : mesh.triangles) {
            add(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
        }
        build();
    }
    explicit Triangles(const MedialComplex& complex) {
        for (std::size_t f = 0; f < complex.faces.size(); ++f) {
            const std::span<const Index> face = complex.faces[f];
            for (std::size_t k = 2; k < face.size(); ++k) {
                add(complex.vertices[face[0]], complex.vertices[face[k - 1]], complex.vertices[face[k]]);
            }
        }
        build();
    }

    // Sorted.
    std::vector<double> distances_of(const std::vector<Point>& points) const {
        std::vector<double> result;
        for (const Point& p : points) {
            result.push_back(std::sqrt(tree_.squared_distance(to_cgal(p))));
        }
        std::sort(result.begin(), result.end());
        return result;
    }

   private:
    using Kernel = CGAL::Simple_cartesian<double>;
    using List = std::vector<Kernel::Triangle_3>;
    using Primitive = CGAL::AABB_triangle_primitive<Kernel, List::const_iterator>;

    static Kernel::Point_3 to_cgal(const Point& p) { return {p.x, p.y, p.z}; }
    void add(const Point& a, const Point& b, const Point& c) {
        triangles_.emplace_back(to_cgal(a), to_cgal(b), to_cgal(c));
    }
    void build() {
        tree_.insert(triangles_.cbegin(), triangles_.cend());
        tree_.accelerate_distance_queries();
    }

    List triangles_;
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree_;
};

}  // namespace scaleaxis::test
