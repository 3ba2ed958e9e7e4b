// SPDX-License-Identifier: Apache-2.0
#include "axis/complex.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>

#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/grouped.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "spatial/mesh_parts.hpp"

namespace scaleaxis::inline v1 {
namespace {

std::vector<Index> prefix_sums(std::vector<Index> counts) {
    Index sum = 0;
    for (Index& count : counts) {
        sum += std::exchange(count, sum);
    }
    counts.push_back(sum);
    return counts;
}

// The elements that are kept, and the number that each then has (`kNone`: it is not kept).
struct Kept {
    std::vector<Index> elements;
    std::vector<Index> numbers;
};

Kept kept(const std::vector<std::uint8_t>& keeps) {
    Kept result;
    result.numbers.assign(keeps.size(), kNone);
    for (std::size_t i = 0; i < keeps.size(); ++i) {
        if (keeps[i] != 0) {
            result.numbers[i] = static_cast<Index>(result.elements.size());
            result.elements.push_back(static_cast<Index>(i));
        }
    }
    return result;
}

template <class T>
std::vector<T> gathered(const std::vector<T>& all, const Kept& kept) {
    return mapped<T>(kept.elements.size(), [&](std::size_t i) { return all[kept.elements[i]]; });
}

IndexLists gathered(const IndexLists& all, const Kept& lists, const Kept& items) {
    IndexLists result;
    result.offsets.reserve(lists.elements.size() + 1);
    for (const Index list : lists.elements) {
        result.offsets.push_back(result.offsets.back() + static_cast<Index>(all[list].size()));
    }
    result.items.resize(result.offsets.back());
    for_each_index(lists.elements.size(), [&](std::size_t i) {
        std::ranges::transform(all[lists.elements[i]], result.items.begin() + result.offsets[i],
                               [&](Index item) { return items.numbers[item]; });
    });
    return result;
}

}  // namespace

Ball mean_ball(const MedialComplex& complex, std::span<const Index> vertices) {
    const double part = 1.0 / static_cast<double>(vertices.size());
    Ball mean{};
    for (const Index v : vertices) {
        mean = {mean.center + part * complex.vertices[v], mean.radius + part * complex.radii[v]};
    }
    return mean;
}

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
    for_each_index(complex.vertices.size(), [&](std::size_t v) {
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
    for_each_index(static_cast<Index>(complex.vertices.size()), [&](Index v) {
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
        nearest = std::min(nearest, segment_distance(foot, p, q));
    }
    if (!(has_left && has_right)) {
        nearest = 0.0;  // the midpoint of the contacts lies in the polygon
    }
    return angle_of(nearest, 0.5 * norm(axis)) * (180.0 / std::numbers::pi);
}

double radius_between(double radius_a, double radius_b, double squared_length, double t) {
    const double square = (1.0 - t) * radius_a * radius_a + t * radius_b * radius_b - t * (1.0 - t) * squared_length;
    return std::sqrt(std::max(square, 0.0));
}

std::optional<double> deepest_dip(double radius_a, double radius_b, double squared_length) {
    // Where the radius grows as fast as a linear one.
    const double rise = radius_b - radius_a;
    const double bend = rise * (radius_a + radius_b) - squared_length;
    const double height = 4.0 * radius_a * radius_a * squared_length - bend * bend;  // 0 where the balls touch
    const double slack = squared_length - rise * rise;
    if (!(height > 0.0) || !(slack > 0.0)) {
        return std::nullopt;
    }
    return (rise * std::sqrt(height / slack) - bend) / (2.0 * squared_length);
}

MedialComplex grown(MedialComplex complex) {
    for (double& radius : complex.radii) {
        radius *= complex.scale;
    }
    complex.scale = 1.0;
    return complex;
}

void check_scale(double scale) {
    require(scale >= 1.0 && std::isfinite(scale), "the scale must be a number of at least 1");
}

std::vector<Ball> balls_at_vertices(const MedialComplex& complex) {
    std::vector<Ball> balls(complex.vertices.size());
    for (std::size_t v = 0; v < balls.size(); ++v) {
        balls[v] = {complex.vertices[v], complex.radii[v]};
    }
    return balls;
}

Box box_of_balls(const MedialComplex& complex) {
    Box box;
    for (std::size_t v = 0; v < complex.vertices.size(); ++v) {
        const double r = complex.radii[v];
        box.extend(complex.vertices[v] - Point{r, r, r});
        box.extend(complex.vertices[v] + Point{r, r, r});
    }
    return box;
}

Point area_vector(const MedialComplex& complex, Index face) {
    const std::span<const Index> corners = complex.faces[face];
    Point sum{};
    for (std::size_t k = 2; k < corners.size(); ++k) {
        const Point& origin = complex.vertices[corners[0]];
        sum = sum + cross(complex.vertices[corners[k - 1]] - origin, complex.vertices[corners[k]] - origin);
    }
    return 0.5 * sum;
}

double segment_distance(const Point& p, const Point& a, const Point& b) {
    return distance(p, nearest_on_segment(a, b, p));
}

Point center_of_face(const MedialComplex& complex, Index face) {
    const std::span<const Index> corners = complex.faces[face];
    Point center{};
    for (const Index v : corners) {
        center = center + (1.0 / static_cast<double>(corners.size())) * complex.vertices[v];
    }
    return center;
}

double face_area(const MedialComplex& complex, Index face) { return norm(area_vector(complex, face)); }

Point inward(const MedialComplex& complex, Index face, Index edge) {
    const Point& from = complex.vertices[complex.edges[edge][0]];
    const Point in = cross(area_vector(complex, face), complex.vertices[complex.edges[edge][1]] - from);
    return dot(in, center_of_face(complex, face) - from) < 0.0 ? -1.0 * in : in;
}

// The squared radius is ρ² + (t - t₀)² at position t of the edge, so the radii at both ends give the circle.
CurveSize curve_size(const MedialComplex& complex, const std::array<Index, 2>& edge) {
    const double length = distance(complex.vertices[edge[0]], complex.vertices[edge[1]]);
    const double r0 = complex.scale * complex.radii[edge[0]];
    const double r1 = complex.scale * complex.radii[edge[1]];
    if (is_linear(complex, edge)) {  // a cone
        const double cosine = length > 0.0 ? std::min(1.0, std::abs(r0 - r1) / length) : 1.0;
        return {angle_of_cosine(cosine) * (180.0 / std::numbers::pi),
                std::max(r0, r1) * std::sqrt(1.0 - cosine * cosine)};
    }
    const double position = 0.5 * ((r0 - r1) * (r0 + r1) / length + length);
    const double circle = std::sqrt(std::max(0.0, r0 * r0 - position * position));
    const double nearest = std::max({0.0, -position, position - length});
    return {angle_of(nearest, circle) * (180.0 / std::numbers::pi), circle};
}

FaceValues values_of(const MedialComplex& complex, Index face) {
    FaceValues values{complex.face_angles[face], complex.face_sheets[face]};
    if (complex.has_contacts()) {
        values.contacts = complex.face_contacts[face];
    }
    return values;
}

void add_face(MedialComplex& complex, std::span<const Index> corners, const FaceValues& values) {
    complex.faces.push_back(corners);
    complex.face_angles.push_back(values.angle);
    complex.face_sheets.push_back(values.sheet);
    if (values.contacts) {
        complex.face_contacts.push_back(*values.contacts);
    }
}

MedialComplex vertices_of(const MedialComplex& complex) {
    MedialComplex result;
    result.vertices = complex.vertices;
    result.radii = complex.radii;
    result.scale = complex.scale;
    result.vertex_origins = complex.vertex_origins;
    result.sheets = complex.sheets;
    result.boundary_vertices = complex.boundary_vertices;
    result.boundary_vertex_balls = complex.boundary_vertex_balls;
    return result;
}

std::vector<Index> face_counts(const MedialComplex& complex) {
    std::vector<Index> counts(complex.edges.size());
    for (const Index e : complex.face_edges.items) {
        ++counts[e];
    }
    return counts;
}

std::vector<std::uint8_t> edges_with_faces(const MedialComplex& complex) {
    std::vector<std::uint8_t> has_face(complex.edges.size());
    for (const Index e : complex.face_edges.items) {
        has_face[e] = 1;
    }
    return has_face;
}

std::vector<std::array<Index, 2>> curve_edges(const MedialComplex& complex) {
    const std::vector<std::uint8_t> has_face = edges_with_faces(complex);
    std::vector<std::array<Index, 2>> curves;
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (has_face[e] == 0) {
            curves.push_back(complex.edges[e]);
        }
    }
    return curves;
}

IndexLists faces_at_edges(const MedialComplex& complex) {
    return grouped(complex.edges.size(), [&](const auto& add) {
        for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
            std::ranges::for_each(complex.face_edges[f], [&](Index e) { add(e, f); });
        }
    });
}

IndexLists faces_at_vertices(const MedialComplex& complex) {
    return grouped(complex.vertices.size(), [&](const auto& add) {
        for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
            std::ranges::for_each(complex.faces[f], [&](Index v) { add(v, f); });
        }
    });
}

namespace {

// 1 for the vertices of edges with such a number of faces, else 0.
template <class IsWanted>
std::vector<std::uint8_t> vertices_of_edges(const MedialComplex& complex, const IsWanted& is_wanted) {
    const std::vector<Index> faces_at = face_counts(complex);
    std::vector<std::uint8_t> result(complex.vertices.size());
    for (std::size_t e = 0; e < faces_at.size(); ++e) {
        if (is_wanted(faces_at[e])) {
            result[complex.edges[e][0]] = 1;
            result[complex.edges[e][1]] = 1;
        }
    }
    return result;
}

}  // namespace

std::vector<std::uint8_t> vertices_at_borders(const MedialComplex& complex) {
    return vertices_of_edges(complex, [](Index faces) { return faces == 1; });
}

std::vector<std::uint8_t> vertices_at_seams(const MedialComplex& complex) {
    return vertices_of_edges(complex, [](Index faces) { return faces > 2; });
}

IndexLists faces_of_sheets(const MedialComplex& complex) {
    return grouped(static_cast<std::size_t>(complex.sheets), [&](const auto& add) {
        for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
            add(complex.face_sheets[f], f);
        }
    });
}

std::vector<Index> isolated_vertices(const MedialComplex& complex) {
    std::vector<std::uint8_t> has_edge(complex.vertices.size());
    for (const auto& [a, b] : complex.edges) {
        has_edge[a] = 1;
        has_edge[b] = 1;
    }
    return indices_where(complex.vertices.size(), [&](Index v) { return has_edge[v] == 0; });
}

MedialComplex subcomplex(const MedialComplex& complex, const std::vector<std::uint8_t>& keeps_vertex,
                         const std::vector<std::uint8_t>& keeps_edge, const std::vector<std::uint8_t>& keeps_face) {
    Kept vertices;
    Kept edges;
    Kept faces;
    Kept sheets;
    run_together([&] { vertices = kept(keeps_vertex); }, [&] { edges = kept(keeps_edge); },
                 [&] {
                     faces = kept(keeps_face);
                     std::vector<std::uint8_t> keeps_sheet(complex.sheets);
                     for (const Index f : faces.elements) {
                         keeps_sheet[complex.face_sheets[f]] = 1;
                     }
                     sheets = kept(keeps_sheet);
                 });

    MedialComplex result;
    result.vertices = gathered(complex.vertices, vertices);
    result.radii = gathered(complex.radii, vertices);
    result.scale = complex.scale;
    result.vertex_origins = gathered(complex.vertex_origins, vertices);
    result.edges = gathered(complex.edges, edges);
    for_each_index(result.edges.size(), [&](std::size_t e) {
        auto& [p, q] = result.edges[e];
        p = vertices.numbers[p];
        q = vertices.numbers[q];
    });
    result.faces = gathered(complex.faces, faces, vertices);
    result.face_edges = gathered(complex.face_edges, faces, edges);
    result.face_angles = gathered(complex.face_angles, faces);
    result.face_sheets = gathered(complex.face_sheets, faces);
    for (Index& sheet : result.face_sheets) {
        sheet = sheets.numbers[sheet];
    }
    result.sheets = static_cast<Index>(sheets.elements.size());
    if (complex.has_contacts()) {
        result.face_contacts = gathered(complex.face_contacts, faces);
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
    std::tie(complex.face_sheets, complex.sheets) = sheets.numbered();
}

void append_labelled(MedialComplex& all, const MedialComplex& axis, Index label) {
    const auto vertex = static_cast<Index>(all.vertices.size());
    const auto edge = static_cast<Index>(all.edges.size());
    all.scale = vertex == 0 || all.scale == axis.scale ? axis.scale : 1.0;
    append(all.vertices, axis.vertices);
    append(all.radii, axis.radii);
    append(all.vertex_origins, axis.vertex_origins);
    all.vertex_labels.resize(all.vertices.size(), label);
    for (const auto& [a, b] : axis.edges) {
        all.edges.push_back({a + vertex, b + vertex});
    }
    const auto append_lists = [](IndexLists& lists, const IndexLists& more, Index shift) {
        for (std::size_t i = 0; i < more.size(); ++i) {
            for (const Index item : more[i]) {
                lists.items.push_back(item + shift);
            }
            lists.offsets.push_back(static_cast<Index>(lists.items.size()));
        }
    };
    append_lists(all.faces, axis.faces, vertex);
    append_lists(all.face_edges, axis.face_edges, edge);
    append(all.face_angles, axis.face_angles);
    for (const Index sheet : axis.face_sheets) {
        all.face_sheets.push_back(sheet + all.sheets);
    }
    all.sheets += axis.sheets;
}

}  // namespace scaleaxis::inline v1
