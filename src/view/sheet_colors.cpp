// SPDX-License-Identifier: Apache-2.0
#include "view/sheet_colors.hpp"

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "spatial/mesh_parts.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::view {
namespace {

/// The faces of an axis as triangles.
struct Sheets {
    TriangleMesh mesh;
    std::vector<Index> sheet_of;  ///< #T
};

Sheets sheets_of(const MedialComplex& axis) {
    Sheets sheets{{axis.vertices, {}}, {}};
    for (std::size_t f = 0; f < axis.faces.size(); ++f) {
        const std::span<const Index> corners = axis.faces[f];
        for (std::size_t k = 2; k < corners.size(); ++k) {
            sheets.mesh.triangles.push_back({corners[0], corners[k - 1], corners[k]});
            sheets.sheet_of.push_back(axis.face_sheets[f]);
        }
    }
    return sheets;
}

/// For each triangle of `sheets`, which are those of `axis`, the sheet of `before` that its middle lies on, or `kNone`.
std::vector<Index> sheets_beneath(const Sheets& sheets, const MedialComplex& axis, const Sheets& before) {
    std::vector<Index> beneath(sheets.sheet_of.size(), kNone);
    if (before.sheet_of.empty()) {
        return beneath;
    }
    const Bvh bvh = build_bvh(before.mesh);
    const TriangleBounds bounds = triangle_bounds(bvh);
    for_each_index(beneath.size(), [&](std::size_t t) {
        const auto& [a, b, c] = sheets.mesh.triangles[t];
        const Point middle = (1.0 / 3.0) * (axis.vertices[a] + axis.vertices[b] + axis.vertices[c]);
        const double reach = (axis.radii[a] + axis.radii[b] + axis.radii[c]) / 6.0;
        if (const NearTriangle near = nearest_triangle(bvh, bounds, middle, reach); near.triangle != kNone) {
            beneath[t] = before.sheet_of[bvh.order[near.triangle]];
        }
    });
    return beneath;
}

/// A sheet of another axis, and the area that lies on it.
struct Overlap {
    Index sheet = kNone;
    double area = 0.0;
};

/// For each sheet what most of its area lies on; `kNone` if that is no sheet.
std::vector<Overlap> largest_overlaps(const Sheets& sheets, const MedialComplex& axis, const Sheets& before) {
    const std::vector<Index> beneath = sheets_beneath(sheets, axis, before);
    std::map<std::pair<Index, Index>, double> areas;  // of a sheet on a sheet before
    for (std::size_t t = 0; t < beneath.size(); ++t) {
        const auto& [a, b, c] = sheets.mesh.triangles[t];
        const std::vector<Point>& x = axis.vertices;
        areas[{sheets.sheet_of[t], beneath[t]}] += triangle_area(x[a], x[b], x[c]);
    }
    std::vector<Overlap> largest(axis.sheets);
    for (const auto& [both, area] : areas) {
        const auto& [sheet, other] = both;
        if (area > largest[sheet].area) {
            largest[sheet] = {other, area};
        }
    }
    return largest;
}

/// For each sheet before the one that has its colour, or `kNone`.
std::vector<Index> successors(const std::vector<Overlap>& overlaps, std::size_t sheets_before) {
    std::vector<Index> result(sheets_before, kNone);
    for (Index s = 0; s < std::ssize(overlaps); ++s) {
        if (const Index other = overlaps[s].sheet; other != kNone) {
            Index& successor = result[other];
            successor = successor == kNone || overlaps[s].area > overlaps[successor].area ? s : successor;
        }
    }
    return result;
}

}  // namespace

std::vector<std::vector<Index>> sheet_colors(std::span<const MedialComplex* const> axes) {
    std::vector<std::vector<Index>> colors;
    Sheets before;
    std::vector<Index> colors_before;
    Index next = 0;
    for (const MedialComplex* axis : axes) {
        Sheets sheets = sheets_of(*axis);
        const std::vector<Overlap> overlaps = largest_overlaps(sheets, *axis, before);
        const std::vector<Index> successor = successors(overlaps, colors_before.size());
        std::vector<Index> own;
        for (Index s = 0; s < axis->sheets; ++s) {
            const Index other = overlaps[s].sheet;
            own.push_back(other != kNone && successor[other] == s ? colors_before[other] : next++);
        }
        colors.push_back(own);
        colors_before = std::move(own);
        before = std::move(sheets);
    }
    return colors;
}

}  // namespace scaleaxis::view
