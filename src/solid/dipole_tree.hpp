// SPDX-License-Identifier: Apache-2.0
/// \file
/// Generalized winding numbers of pieces of a surface in a tree.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "spatial/box_tree.hpp"

namespace scaleaxis::inline v1 {

/// Pieces of a surface, seen from far away: one dipole.
struct SurfacePart {
    double area = 0.0;
    Point moment;  ///< of the centroids, by area
    Point normal;  ///< sum of the normals, as long as the areas
    Box box;

    void add(const SurfacePart& other) {
        area += other.area;
        moment = moment + other.moment;
        normal = normal + other.normal;
        box.extend(other.box);
    }
};

/// The solid angle of a small piece of a surface, seen from a place far away. \param normal as long as its area
/// \param d from that place to the piece; not 0
inline double dipole_angle(const Point& normal, const Point& d) {
    const double square = squared_norm(d);
    return dot(normal, d) / (square * std::sqrt(square));
}

/// The part of the full sphere that the pieces of a surface hide, seen from a point: 1 inside and 0 outside a closed
/// surface, in between around an open one (A. Jacobson, L. Kavan, O. Sorkine-Hornung, "Robust inside-outside
/// segmentation using generalized winding numbers", 2013). Those far away count together, as one dipole (G. Barill, N.
/// Dickson, R. Schmidt, D. Levin, A. Jacobson, "Fast winding numbers for soups and clouds", 2018).
class DipoleTree {
   public:
    DipoleTree() = default;

    /// \param part_of `SurfacePart` of an item of the tree
    template <class PartOf>
    DipoleTree(const BoxTree& tree, const PartOf& part_of) : dipoles_(tree.nodes.size()) {
        std::vector<SurfacePart> of_node(tree.nodes.size());
        for (std::size_t n = tree.nodes.size(); n-- > 0;) {  // children come after their parents
            const BoxTree::Node& node = tree.nodes[n];
            for (int k = 0; k < BoxTree::kWidth; ++k) {
                SurfacePart part;
                for (Index i = node.first[k]; i < node.first[k] + node.count[k]; ++i) {
                    part.add(part_of(i));
                }
                if (node.count[k] == 0 && node.first[k] > 0 && !(node.bounds[0][0][k] > node.bounds[1][0][k])) {
                    part = of_node[n + node.first[k]];
                }
                if (!part.box.is_empty()) {
                    dipoles_[n][k] = dipole_of(part);
                    of_node[n].add(part);
                }
            }
        }
    }

    /// \param tree that of the constructor \param angle_of the solid angle of an item, seen from `p`
    template <class AngleOf>
    double winding_number(const BoxTree& tree, const Point& p, const AngleOf& angle_of) const {
        return below(tree, 0, p, angle_of) / (4.0 * std::numbers::pi);
    }

   private:
    // Beyond this distance, in radii, items count as one: an error below 1e-2 near them, of 1e-3 on average.
    static constexpr double kFarRadii = 2.5;

    struct Dipole {
        Point center;         ///< mean of the items, by area
        Point normal;         ///< as long as their area
        double reach = -1.0;  ///< squared distance from the center from which on they count together; < 0: no child
    };

    static Dipole dipole_of(const SurfacePart& part) {
        const Point center = part.area > 0.0 ? (1.0 / part.area) * part.moment : midpoint(part.box.min, part.box.max);
        const Point farthest{std::max(center.x - part.box.min.x, part.box.max.x - center.x),
                             std::max(center.y - part.box.min.y, part.box.max.y - center.y),
                             std::max(center.z - part.box.min.z, part.box.max.z - center.z)};
        return {center, part.normal, kFarRadii * kFarRadii * squared_norm(farthest)};
    }

    template <class AngleOf>
    double below(const BoxTree& tree, Index n, const Point& p, const AngleOf& angle_of) const {
        const BoxTree::Node& node = tree.nodes[n];
        double angle = 0.0;
        for (int k = 0; k < BoxTree::kWidth; ++k) {
            const Dipole& dipole = dipoles_[n][k];
            if (dipole.reach < 0.0) {
                continue;
            }
            const Point d = dipole.center - p;
            if (squared_norm(d) > dipole.reach) {
                angle += dipole_angle(dipole.normal, d);
            } else if (node.count[k] > 0) {
                for (Index i = node.first[k]; i < node.first[k] + node.count[k]; ++i) {
                    angle += angle_of(i);
                }
            } else {
                angle += below(tree, n + node.first[k], p, angle_of);
            }
        }
        return angle;
    }

    std::vector<std::array<Dipole, BoxTree::kWidth>> dipoles_;  ///< of the children of each node
};

}  // namespace scaleaxis::inline v1
