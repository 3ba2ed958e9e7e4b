// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/patch.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>

#include "base/parallel.hpp"

namespace scaleaxis {
namespace {

// The time for the patch of least area is cubic.
constexpr std::size_t kLongest = 250;

double doubled_area(const Point& a, const Point& b, const Point& c) { return norm(cross(b - a, c - a)); }

/// Cuts corners off, those of least area first, until `kLongest` are left.
std::vector<Index> shortened(const std::vector<Point>& vertices, std::span<const Index> loop,
                             std::vector<Triangle>& triangles) {
    const std::size_t n = loop.size();
    std::vector<std::size_t> previous(n), next(n);
    std::vector<double> areas(n);
    std::set<std::pair<double, std::size_t>> corners;
    const auto update = [&](std::size_t i) {
        corners.erase({areas[i], i});
        areas[i] = doubled_area(vertices[loop[previous[i]]], vertices[loop[i]], vertices[loop[next[i]]]);
        corners.insert({areas[i], i});
    };
    for (std::size_t i = 0; i < n; ++i) {
        previous[i] = (i + n - 1) % n;
        next[i] = (i + 1) % n;
    }
    for (std::size_t i = 0; i < n; ++i) {
        update(i);
    }
    while (corners.size() > kLongest) {
        const std::size_t i = corners.begin()->second;
        corners.erase(corners.begin());
        triangles.push_back({loop[previous[i]], loop[i], loop[next[i]]});
        next[previous[i]] = next[i];
        previous[next[i]] = previous[i];
        update(previous[i]);
        update(next[i]);
    }
    std::vector<Index> rest;
    const std::size_t first = corners.begin()->second;
    std::size_t i = first;
    do {
        rest.push_back(loop[i]);
        i = next[i];
    } while (i != first);
    return rest;
}

}  // namespace

std::vector<Triangle> patch_of(const std::vector<Point>& vertices, std::span<const Index> loop) {
    std::vector<Triangle> triangles;
    const std::vector<Index> corners =
        loop.size() > kLongest ? shortened(vertices, loop, triangles) : std::vector<Index>(loop.begin(), loop.end());
    // least[i][j]: of the patch of corners i … j; tip[i][j]: the third corner of its triangle at the side from j to i.
    const std::size_t n = corners.size();
    std::vector<double> least(n * n, 0.0);
    std::vector<std::size_t> tip(n * n, 0);
    CancellationPoint cancellation(1);
    for (std::size_t length = 2; length < n; ++length) {
        cancellation();
        for (std::size_t i = 0; i + length < n; ++i) {
            const std::size_t j = i + length;
            double best = std::numeric_limits<double>::infinity();
            tip[i * n + j] = i + 1;
            for (std::size_t k = i + 1; k < j; ++k) {
                const double before = least[i * n + k] + least[k * n + j];
                if (before < best) {
                    const double area =
                        before + doubled_area(vertices[corners[i]], vertices[corners[k]], vertices[corners[j]]);
                    if (area < best) {
                        best = area;
                        tip[i * n + j] = k;
                    }
                }
            }
            least[i * n + j] = best;
        }
    }
    std::vector<std::pair<std::size_t, std::size_t>> sides{{0, n - 1}};
    while (!sides.empty()) {
        const auto [i, j] = sides.back();
        sides.pop_back();
        if (j - i < 2) {
            continue;
        }
        const std::size_t k = tip[i * n + j];
        triangles.push_back({corners[i], corners[k], corners[j]});
        sides.emplace_back(i, k);
        sides.emplace_back(k, j);
    }
    return triangles;
}

}  // namespace scaleaxis
