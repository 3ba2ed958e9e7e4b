// SPDX-License-Identifier: GPL-3.0-or-later
#include "medial_axis/complex.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "kernel/disjoint_sets.hpp"
#include "kernel/parallel.hpp"

namespace scaleaxis {
namespace {

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
    const Point direction = b - a;
    const double length = squared_norm(direction);
    const double t = length > 0.0 ? std::clamp(dot(p - a, direction) / length, 0.0, 1.0) : 0.0;
    return distance(p, a + t * direction);
}

std::vector<Index> prefix_sums(std::vector<Index> counts) {
    Index sum = 0;
    for (Index& count : counts) {
        sum += std::exchange(count, sum);
    }
    counts.push_back(sum);
    return counts;
}

}  // namespace

void build_edges(MedialComplex& complex, std::span<const std::array<Index, 2>> more_edges) {
    // Every side of a face, and every further edge, is put into the bucket of its smaller end; buckets are short.
    struct Side {
        Index larger_end;
        Index position;  // in `faces.items`, or behind them for a further edge
    };
    const IndexLists& faces = complex.faces;
    const auto corners = static_cast<Index>(faces.items.size());
    const auto for_each_side = [&](const auto& use) {  // use(smaller end, larger end, position)
        for (std::size_t f = 0; f < faces.size(); ++f) {
            Index previous = faces[f].back();
            Index position = faces.offsets[f + 1] - 1;
            for (Index next = faces.offsets[f]; next < faces.offsets[f + 1]; ++next) {
                use(std::min(previous, faces.items[next]), std::max(previous, faces.items[next]), position);
                previous = faces.items[next];
                position = next;
            }
        }
        for (std::size_t e = 0; e < more_edges.size(); ++e) {
            const auto& [p, q] = more_edges[e];
            use(std::min(p, q), std::max(p, q), corners + static_cast<Index>(e));
        }
    };

    std::vector<Index> counts(complex.vertices.size());
    for_each_side([&](Index smaller, Index, Index) { ++counts[smaller]; });
    const std::vector<Index> begins = prefix_sums(std::move(counts));
    std::vector<Side> sides(corners + more_edges.size());
    std::vector<Index> next(begins.begin(), begins.end() - 1);
    for_each_side([&](Index smaller, Index larger, Index position) { sides[next[smaller]++] = {larger, position}; });

    std::vector<Index> distinct(complex.vertices.size());
    kernel::for_each_index(complex.vertices.size(), [&](std::size_t v) {
        const std::span<Side> bucket(sides.data() + begins[v], sides.data() + begins[v + 1]);
        std::sort(bucket.begin(), bucket.end(),
                  [](const Side& a, const Side& b) { return a.larger_end < b.larger_end; });
        for (std::size_t k = 0; k < bucket.size(); ++k) {
            distinct[v] += k == 0 || bucket[k].larger_end != bucket[k - 1].larger_end ? 1 : 0;
        }
    });
    const std::vector<Index> first_edges = prefix_sums(std::move(distinct));

    complex.edges.resize(first_edges.back());
    complex.face_edges.offsets = faces.offsets;
    complex.face_edges.items.resize(corners);
    kernel::for_each_index(static_cast<Index>(complex.vertices.size()), [&](Index v) {
        Index edge = first_edges[v] - 1;
        for (Index s = begins[v]; s < begins[v + 1]; ++s) {
            if (s == begins[v] || sides[s].larger_end != sides[s - 1].larger_end) {
                complex.edges[++edge] = {v, sides[s].larger_end};
            }
            if (sides[s].position < corners) {
                complex.face_edges.items[sides[s].position] = edge;
            }
        }
    });
}

double object_angle(std::span<const Point> vertices, std::span<const Index> polygon, const Point& contact_a,
                    const Point& contact_b) {
    const Point axis = contact_b - contact_a;
    const Point foot = midpoint(contact_a, contact_b);
    double nearest = std::numeric_limits<double>::infinity();
    bool has_left = false;
    bool has_right = false;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Point& p = vertices[polygon[k]];
        const Point& q = vertices[polygon[k + 1 < polygon.size() ? k + 1 : 0]];
        const double side = dot(cross(q - p, foot - p), axis);
        has_left = has_left || side > 0.0;
        has_right = has_right || side < 0.0;
        nearest = std::min(nearest, distance_to_segment(foot, p, q));
    }
    if (!(has_left && has_right)) {
        nearest = 0.0;  // the midpoint of the contacts lies in the polygon
    }
    return std::atan2(0.5 * norm(axis), nearest) * (180.0 / std::numbers::pi);
}

// The squared radius is ρ² + (t - t₀)² at position t of the edge, so the radii at both ends give the circle.
CurveSize curve_size(const MedialComplex& complex, const std::array<Index, 2>& edge) {
    const double length = distance(complex.vertices[edge[0]], complex.vertices[edge[1]]);
    const double r0 = complex.radii[edge[0]];
    const double r1 = complex.radii[edge[1]];
    const double position = 0.5 * ((r0 - r1) * (r0 + r1) / length + length);
    const double circle = std::sqrt(std::max(0.0, r0 * r0 - position * position));
    const double nearest = std::max({0.0, -position, position - length});
    return {std::atan2(circle, nearest) * (180.0 / std::numbers::pi), circle};
}

MedialComplex subcomplex(const MedialComplex& complex, const std::vector<std::uint8_t>& keeps_vertex,
                         const std::vector<std::uint8_t>& keeps_edge, const std::vector<std::uint8_t>& keeps_face) {
    MedialComplex result;
    const auto renumber = [](const std::vector<std::uint8_t>& keeps) {
        std::vector<Index> numbers(keeps.size(), kNone);
        Index next = 0;
        for (std::size_t i = 0; i < keeps.size(); ++i) {
            if (keeps[i] != 0) {
                numbers[i] = next++;
            }
        }
        return numbers;
    };
    const std::vector<Index> vertices = renumber(keeps_vertex);
    const std::vector<Index> edges = renumber(keeps_edge);
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        if (vertices[v] != kNone) {
            result.vertices.push_back(complex.vertices[v]);
            result.radii.push_back(complex.radii[v]);
            result.vertex_balls.push_back(complex.vertex_balls[v]);
        }
    }
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (edges[e] != kNone) {
            result.edges.push_back({vertices[complex.edges[e][0]], vertices[complex.edges[e][1]]});
        }
    }
    std::vector<std::uint8_t> keeps_sheet(complex.sheets);
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (keeps_face[f] != 0) {
            keeps_sheet[complex.face_sheets[f]] = 1;
        }
    }
    const std::vector<Index> sheets = renumber(keeps_sheet);
    result.sheets = static_cast<Index>(std::count(keeps_sheet.begin(), keeps_sheet.end(), 1));
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (keeps_face[f] == 0) {
            continue;
        }
        for (const Index v : complex.faces[f]) {
            result.faces.items.push_back(vertices[v]);
        }
        for (const Index e : complex.face_edges[f]) {
            result.face_edges.items.push_back(edges[e]);
        }
        result.faces.offsets.push_back(static_cast<Index>(result.faces.items.size()));
        result.face_edges.offsets.push_back(static_cast<Index>(result.face_edges.items.size()));
        result.face_contacts.push_back(complex.face_contacts[f]);
        result.face_angles.push_back(complex.face_angles[f]);
        result.face_sheets.push_back(sheets[complex.face_sheets[f]]);
    }
    result.boundary_vertices = complex.boundary_vertices;
    result.boundary_vertex_balls = complex.boundary_vertex_balls;
    return result;
}

void label_sheets(MedialComplex& complex) {
    constexpr Index kSeveral = -2;
    const auto faces = static_cast<Index>(complex.faces.size());
    // The two faces of every edge that has exactly two.
    std::vector<std::array<Index, 2>> faces_of_edge(complex.edges.size(), {kNone, kNone});
    for (Index f = 0; f < faces; ++f) {
        for (const Index e : complex.face_edges[f]) {
            auto& [first, second] = faces_of_edge[e];
            if (first == kNone) {
                first = f;
            } else {
                second = second == kNone ? f : kSeveral;
            }
        }
    }
    DisjointSets sheets(faces);
    for (const auto& [first, second] : faces_of_edge) {
        if (second >= 0) {
            sheets.join(first, second);
        }
    }
    complex.sheets = 0;
    complex.face_sheets.resize(faces);
    for (Index f = 0; f < faces; ++f) {
        // A set's representative is its smallest face, so it has its number before the others ask for it.
        const Index representative = sheets.find(f);
        complex.face_sheets[f] = representative == f ? complex.sheets++ : complex.face_sheets[representative];
    }
}

}  // namespace scaleaxis
