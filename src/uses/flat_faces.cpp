// SPDX-License-Identifier: Apache-2.0
#include "uses/flat_faces.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "solid/mesh/triangle_edges.hpp"
#include "spatial/extent.hpp"
#include "spatial/mesh_parts.hpp"
#include "uses/divided_edges.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::size_t kMostFlips = 30;  // for each edge; a fan of n needles takes about log n

// Side `k` of triangle `t`, from its corner `k` to the next one, is 3 t + k.
class FaceFlips {
   public:
    explicit FaceFlips(TriangleMesh mesh)
        : mesh_(std::move(mesh)), others_(opposite_sides(sides_of_edges(mesh_.triangles, mesh_.vertices.size()))) {
        height_ = kFileRounding * box_around(mesh_.vertices).diagonal();
        for (Index s = 0; s < static_cast<Index>(others_.size()); ++s) {
            if (others_[s] != kNone && from(s) == from(others_[s])) {  // the triangles do not agree
                others_[s] = others_[others_[s]] = kNone;
            }
        }
    }

    TriangleMesh run() && {
        std::vector<Index> open(others_.size());
        for (std::size_t s = 0; s < open.size(); ++s) {
            open[s] = static_cast<Index>(s);
        }
        CancellationPoint check;
        for (std::size_t flips = 0; !open.empty() && flips < kMostFlips * others_.size();) {
            check();
            const Index s = open.back();
            open.pop_back();
            if (others_[s] != kNone && is_to_flip(s)) {
                ++flips;
                const std::array<Index, 2> triangles{s / 3, others_[s] / 3};
                flip(s);
                for (const Index t : triangles) {
                    open.insert(open.end(), {3 * t, 3 * t + 1, 3 * t + 2});
                }
            }
        }
        return std::move(mesh_);
    }

   private:
    Index from(Index side) const { return start_of(mesh_.triangles, side); }
    const Point& place(Index vertex) const { return mesh_.vertices[vertex]; }

    bool is_to_flip(Index s) const {
        const Point& a = place(from(s));
        const Point& b = place(from(next_side(s)));
        const Point& c = place(from(next_side(next_side(s))));
        const Point& d = place(from(next_side(next_side(others_[s]))));
        const Point up = cross(b - a, c - a);
        const Point down = cross(a - b, d - b);
        // Do the angles at c and d have a sum of more than 180 degrees?
        const double c_cosine = dot(a - c, b - c);
        const double d_cosine = dot(a - d, b - d);
        const double size = distance(a, c) * distance(b, c) * distance(a, d) * distance(b, d);
        if (c_cosine * norm(down) + d_cosine * norm(up) >= -kRelativeRounding * size) {
            return false;
        }
        // Is it flat, seen from its larger half, and do both halves face as the new ones do?
        const bool is_up_larger = squared_norm(up) >= squared_norm(down);
        const Point normal = unit(is_up_larger ? up : down);
        const double off = is_up_larger ? dot(d - a, normal) : dot(c - a, normal);
        if (std::abs(off) > height_ || dot(is_up_larger ? down : up, normal) < 0.0) {
            return false;
        }
        const auto faces_so = [&](const Point& p, const Point& q, const Point& r) {
            return dot(cross(q - p, r - p), normal) > kRelativeRounding * distance(p, q) * distance(p, r);
        };
        return faces_so(c, a, d) && faces_so(d, b, c);
    }

    // Triangles abc and bad become cad and dbc.
    void flip(Index s) {
        const Index o = others_[s];
        const Index a = from(s);
        const Index b = from(next_side(s));
        const Index c = from(next_side(next_side(s)));
        const Index d = from(next_side(next_side(o)));
        const Index bc = others_[next_side(s)];
        const Index ca = others_[next_side(next_side(s))];
        const Index ad = others_[next_side(o)];
        const Index db = others_[next_side(next_side(o))];
        const Index t = s / 3;
        const Index u = o / 3;
        mesh_.triangles[t] = {c, a, d};
        mesh_.triangles[u] = {d, b, c};
        join(3 * t, ca);
        join(3 * t + 1, ad);
        join(3 * t + 2, 3 * u + 2);
        join(3 * u, db);
        join(3 * u + 1, bc);
    }

    void join(Index side, Index other) {
        others_[side] = other;
        if (other != kNone) {
            others_[other] = side;
        }
    }

    TriangleMesh mesh_;
    std::vector<Index> others_;  // the side of the neighbour, or `kNone`
    double height_ = 0.0;
};

}  // namespace

TriangleMesh with_delaunay_faces(TriangleMesh mesh) {
    check_triangles(mesh);
    return FaceFlips(std::move(mesh)).run();
}

}  // namespace scaleaxis::inline v1
