// SPDX-License-Identifier: Apache-2.0
#include "axis/triangulated.hpp"

#include <limits>

namespace scaleaxis {

std::vector<FaceTriangle> face_triangles(const MedialComplex& complex) {
    std::vector<FaceTriangle> triangles;
    std::vector<Index> rest;
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        rest.assign(complex.faces[f].begin(), complex.faces[f].end());
        while (rest.size() > 3) {
            std::size_t ear = 0;
            double shortest = std::numeric_limits<double>::infinity();
            for (std::size_t k = 0; k < rest.size(); ++k) {
                const Point& before = complex.vertices[rest[k == 0 ? rest.size() - 1 : k - 1]];
                const Point& after = complex.vertices[rest[k + 1 < rest.size() ? k + 1 : 0]];
                const double square = squared_distance(before, after);
                if (square < shortest) {
                    shortest = square;
                    ear = k;
                }
            }
            const Index before = rest[ear == 0 ? rest.size() - 1 : ear - 1];
            const Index after = rest[ear + 1 < rest.size() ? ear + 1 : 0];
            triangles.push_back({{before, rest[ear], after}, f});
            rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        triangles.push_back({{rest[0], rest[1], rest[2]}, f});
    }
    return triangles;
}

}  // namespace scaleaxis
