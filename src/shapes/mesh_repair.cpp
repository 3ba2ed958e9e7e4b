// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scaleaxis/mesh.hpp"
#include "shapes/part_winding.hpp"
#include "shapes/self_intersections.hpp"
#include "shapes/weld.hpp"

namespace scaleaxis {
namespace {

using Triangle = std::array<Index, 3>;

// Below this part of the largest coordinate, differences of coordinates have too few digits left.
constexpr double kSmallestRelativeSize = 1e-9;
// Products of five lengths, as the predicates form them, have to stay within the range of a double.
constexpr double kSmallestSize = 1e-40;
constexpr double kLargestSize = 1e40;
// Below this mean thickness relative to the diagonal, the volume is rounding error.
constexpr double kSmallestRelativeThickness = 1e-12;

// ---------------------------------------------------------------------------------------------------------------------
// Words
// ---------------------------------------------------------------------------------------------------------------------

std::string counted(std::int64_t count, std::string_view one, std::string_view many) {
    return std::to_string(count) + ' ' + std::string(count == 1 ? one : many);
}

std::string to_text(const Point& p) {
    std::string result;
    for (const double coordinate : {p.x, p.y, p.z}) {
        constexpr int kDigits = 9;
        std::array<char, 32> digits;
        const auto end = std::to_chars(digits.begin(), digits.end(), coordinate, std::chars_format::general, kDigits).ptr;
        result += (result.empty() ? "(" : " ") + std::string(digits.begin(), end);
    }
    return result + ')';
}

// ---------------------------------------------------------------------------------------------------------------------
// Vertices and triangles
// ---------------------------------------------------------------------------------------------------------------------

std::size_t slot(Index i) { return static_cast<std::size_t>(i); }

/// Why the arrays are no mesh at all; empty if they are.
std::string find_bad_data(const TriangleMesh& mesh) {
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (!is_finite(mesh.vertices[v])) {
            return "vertex " + std::to_string(v) + " (from 0) has a coordinate that is not a finite number; remove it";
        }
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const Index v : mesh.triangles[t]) {
            if (v < 0 || slot(v) >= mesh.vertices.size()) {
                return "triangle " + std::to_string(t) + " (from 0) refers to vertex " + std::to_string(v) +
                       ", but there are " + std::to_string(mesh.vertices.size()) + "; correct its indices";
            }
        }
    }
    return {};
}

/// Removes the vertices that no triangle has. Returns how many.
std::int64_t drop_isolated_vertices(TriangleMesh& mesh) {
    std::vector<Index> position(mesh.vertices.size(), kNone);
    for (const Triangle& triangle : mesh.triangles) {
        for (const Index v : triangle) {
            position[slot(v)] = 0;
        }
    }
    std::size_t kept = 0;
    for (std::size_t v = 0; v < position.size(); ++v) {
        if (position[v] != kNone) {
            mesh.vertices[kept] = mesh.vertices[v];
            position[v] = static_cast<Index>(kept++);
        }
    }
    for (Triangle& triangle : mesh.triangles) {
        for (Index& v : triangle) {
            v = position[slot(v)];
        }
    }
    const auto dropped = static_cast<std::int64_t>(mesh.vertices.size() - kept);
    mesh.vertices.resize(kept);
    return dropped;
}

/// Removes the triangles with two equal corners. Returns how many.
std::int64_t drop_collapsed_triangles(std::vector<Triangle>& triangles) {
    return static_cast<std::int64_t>(
        std::erase_if(triangles, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }));
}

/// Does the triangle have no area but what rounding may make of none?
bool has_no_area(const std::vector<Point>& vertices, const Triangle& t) {
    const Point& a = vertices[slot(t[0])];
    const Point& b = vertices[slot(t[1])];
    const Point& c = vertices[slot(t[2])];
    const double longest = std::max({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
    return norm(cross(b - a, c - a)) <= 4.0 * std::numeric_limits<double>::epsilon() * longest;
}

// ---------------------------------------------------------------------------------------------------------------------
// Edges. Side `3 t + k` of triangle `t` runs from its corner `k` to the next.
// ---------------------------------------------------------------------------------------------------------------------

Index next_side(Index side) { return side % 3 == 2 ? side - 2 : side + 1; }
Index start_of(const std::vector<Triangle>& triangles, Index side) { return triangles[slot(side / 3)][slot(side % 3)]; }
Index end_of(const std::vector<Triangle>& triangles, Index side) { return start_of(triangles, next_side(side)); }
Index apex_of(const std::vector<Triangle>& triangles, Index side) { return end_of(triangles, next_side(side)); }

/// The sides of the triangles that run along each edge, in ascending order.
IndexLists sides_of_edges(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
    struct Side {
        Index far_end;
        Index id;
        auto operator<=>(const Side&) const = default;
    };
    // Sorted by the smaller end by counting, and by the larger one among these few.
    const auto side_count = static_cast<Index>(3 * triangles.size());
    std::vector<Index> first(vertex_count + 1, 0);
    for (Index s = 0; s < side_count; ++s) {
        ++first[slot(std::min(start_of(triangles, s), end_of(triangles, s))) + 1];
    }
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Index> end(first.begin(), first.end() - 1);
    std::vector<Side> sides(slot(side_count));
    for (Index s = 0; s < side_count; ++s) {
        const auto [low, high] = std::minmax({start_of(triangles, s), end_of(triangles, s)});
        sides[slot(end[slot(low)]++)] = {high, s};
    }
    IndexLists edges;
    edges.offsets.reserve(sides.size() / 2 + 1);
    edges.items.resize(sides.size());
    for (std::size_t v = 0; v < vertex_count; ++v) {
        const auto begin = sides.begin() + first[v];
        std::sort(begin, sides.begin() + first[v + 1]);
        for (Index i = first[v]; i < first[v + 1]; ++i) {
            edges.items[slot(i)] = sides[slot(i)].id;
            if (i + 1 == first[v + 1] || sides[slot(i)].far_end != sides[slot(i) + 1].far_end) {
                edges.offsets.push_back(i + 1);
            }
        }
    }
    return edges;
}

// ---------------------------------------------------------------------------------------------------------------------
// Copies of triangles
// ---------------------------------------------------------------------------------------------------------------------

/// Decides which triangles to drop of those that have the same three corners. A copy too many is one thing (drop it), a
/// wall between two parts of the solid, or a fin, which has a triangle for either side, another (drop both). So one of
/// each is kept at first; those with an even number of copies are then dropped as long as an edge of theirs has an odd
/// number of triangles. If that does not leave a closed surface, they stay.
std::vector<char> copies_to_drop(const std::vector<Triangle>& triangles, const IndexLists& edges) {
    std::vector<char> is_dropped(triangles.size(), 0);
    std::vector<char> may_go(triangles.size(), 0);
    std::vector<Index> candidates;
    std::vector<std::array<Index, 2>> by_apex;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        // Each triangle appears once: at the edge opposite to its largest corner.
        by_apex.clear();
        for (const Index s : edges[e]) {
            const Index apex = apex_of(triangles, s);
            if (apex > start_of(triangles, s) && apex > end_of(triangles, s)) {
                by_apex.push_back({apex, s / 3});
            }
        }
        std::ranges::sort(by_apex);
        for (std::size_t begin = 0, end = 0; begin < by_apex.size(); begin = end) {
            for (end = begin + 1; end < by_apex.size() && by_apex[end][0] == by_apex[begin][0]; ++end) {
                is_dropped[slot(by_apex[end][1])] = 1;
            }
            if ((end - begin) % 2 == 0) {
                may_go[slot(by_apex[begin][1])] = 1;
                candidates.push_back(by_apex[begin][1]);
            }
        }
    }
    if (candidates.empty()) {
        return is_dropped;
    }

    std::vector<Index> edge_of_side(edges.items.size());
    std::vector<Index> triangles_left(edges.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        for (const Index s : edges[e]) {
            edge_of_side[slot(s)] = static_cast<Index>(e);
            triangles_left[e] += is_dropped[slot(s / 3)] ? 0 : 1;
        }
    }
    const auto is_odd = [&](Index side) { return triangles_left[slot(edge_of_side[slot(side)])] % 2 == 1; };
    std::vector<char> is_dropped_too = is_dropped;
    while (!candidates.empty()) {
        const Index t = candidates.back();
        candidates.pop_back();
        if (!may_go[slot(t)] || !(is_odd(3 * t) || is_odd(3 * t + 1) || is_odd(3 * t + 2))) {
            continue;
        }
        may_go[slot(t)] = 0;
        is_dropped_too[slot(t)] = 1;
        for (const Index side : {3 * t, 3 * t + 1, 3 * t + 2}) {
            const std::size_t e = slot(edge_of_side[slot(side)]);
            --triangles_left[e];
            for (const Index s : edges[e]) {
                if (may_go[slot(s / 3)]) {
                    candidates.push_back(s / 3);
                }
            }
        }
    }
    const bool is_closed = std::ranges::all_of(triangles_left, [](Index count) { return count % 2 == 0; });
    return is_closed ? is_dropped_too : is_dropped;
}

// ---------------------------------------------------------------------------------------------------------------------
// Cleaning and welding
// ---------------------------------------------------------------------------------------------------------------------

/// Triangles with three different corners, none twice, and their edges.
struct Surface {
    std::vector<Triangle> triangles;
    IndexLists edges;
    std::int64_t collapsed = 0;  ///< triangles that were left out because of equal corners
    std::int64_t copies = 0;     ///< and as copies
};

Surface clean_surface(std::vector<Triangle> triangles, std::size_t vertex_count) {
    Surface surface;
    surface.collapsed = drop_collapsed_triangles(triangles);
    surface.edges = sides_of_edges(triangles, vertex_count);
    const std::vector<char> is_dropped = copies_to_drop(triangles, surface.edges);
    surface.copies = std::ranges::count(is_dropped, 1);
    if (surface.copies > 0) {
        std::size_t t = 0;
        std::erase_if(triangles, [&](const Triangle&) { return is_dropped[t++] != 0; });
        surface.edges = sides_of_edges(triangles, vertex_count);
    }
    surface.triangles = std::move(triangles);
    return surface;
}

/// Ends of the edges with a single triangle, each once.
std::vector<Index> boundary_vertices(const Surface& surface) {
    std::vector<Index> result;
    for (std::size_t e = 0; e < surface.edges.size(); ++e) {
        if (surface.edges[e].size() == 1) {
            result.push_back(start_of(surface.triangles, surface.edges[e][0]));
            result.push_back(end_of(surface.triangles, surface.edges[e][0]));
        }
    }
    std::ranges::sort(result);
    const auto repeated = std::ranges::unique(result);
    result.erase(repeated.begin(), repeated.end());
    return result;
}

/// Makes one of those of the given vertices that lie at the same place. Returns how many others that leaves unused.
std::int64_t weld_vertices(TriangleMesh& mesh, const std::vector<Index>& vertices) {
    std::vector<Point> points;
    points.reserve(vertices.size());
    for (const Index v : vertices) {
        points.push_back(mesh.vertices[slot(v)]);
    }
    const std::vector<Index> place = weld(points);
    std::vector<Index> at_place(points.size(), kNone);
    std::vector<Index> replacement(mesh.vertices.size());
    std::iota(replacement.begin(), replacement.end(), 0);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        Index& first = at_place[slot(place[i])];
        first = first == kNone ? vertices[i] : first;
        replacement[slot(vertices[i])] = first;
    }
    for (Triangle& triangle : mesh.triangles) {
        for (Index& v : triangle) {
            v = replacement[slot(v)];
        }
    }
    return static_cast<std::int64_t>(vertices.size() - points.size());
}

// ---------------------------------------------------------------------------------------------------------------------
// Orientation
// ---------------------------------------------------------------------------------------------------------------------

/// For each side the one on the other side of its edge; `kNone` where the edge has not exactly two.
std::vector<Index> opposite_sides(const IndexLists& edges) {
    std::vector<Index> opposite(edges.items.size(), kNone);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (const auto sides = edges[e]; sides.size() == 2) {
            opposite[slot(sides[0])] = sides[1];
            opposite[slot(sides[1])] = sides[0];
        }
    }
    return opposite;
}

/// Connected components, and what it takes to orient each coherently.
struct Orientation {
    std::vector<Index> component;   ///< #F
    std::vector<char> is_reversed;  ///< #F; to be turned: the minority in its component
    Index components = 0;
    Index one_sided = kNone;  ///< a triangle of a component that cannot be oriented
};

Orientation orient(const std::vector<Triangle>& triangles, const std::vector<Index>& opposite) {
    Orientation result{std::vector<Index>(triangles.size(), kNone), std::vector<char>(triangles.size(), 0)};
    std::vector<Index> members;
    for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
        if (result.component[seed] != kNone) {
            continue;
        }
        const Index component = result.components++;
        result.component[seed] = component;
        members.assign(1, static_cast<Index>(seed));
        std::size_t reversed = 0;
        for (std::size_t i = 0; i < members.size(); ++i) {
            const Index t = members[i];
            reversed += result.is_reversed[slot(t)] ? 1 : 0;
            for (const Index side : {3 * t, 3 * t + 1, 3 * t + 2}) {
                const Index other_side = opposite[slot(side)];
                if (other_side == kNone) {
                    continue;
                }
                const Index other = other_side / 3;
                const bool agree = start_of(triangles, side) == end_of(triangles, other_side);
                const char is_reversed = agree ? result.is_reversed[slot(t)] : !result.is_reversed[slot(t)];
                if (result.component[slot(other)] == kNone) {
                    result.component[slot(other)] = component;
                    result.is_reversed[slot(other)] = is_reversed;
                    members.push_back(other);
                } else if (result.is_reversed[slot(other)] != is_reversed && result.one_sided == kNone) {
                    result.one_sided = other;
                }
            }
        }
        if (2 * reversed > members.size()) {
            for (const Index t : members) {
                result.is_reversed[slot(t)] = !result.is_reversed[slot(t)];
            }
        }
    }
    return result;
}

void reverse(Triangle& triangle) { std::swap(triangle[1], triangle[2]); }

/// Gives every fan of triangles around a vertex a vertex of its own. Returns the number of vertices with several fans.
/// The surface has to be closed, manifold at the edges and coherently oriented.
std::int64_t split_vertices(TriangleMesh& mesh, const std::vector<Index>& opposite) {
    const std::size_t vertex_count = mesh.vertices.size();
    enum class Fans : char { kNone, kOne, kSeveral };
    std::vector<Fans> fans(vertex_count, Fans::kNone);
    std::vector<char> is_visited(opposite.size(), 0);
    std::int64_t split = 0;
    for (std::size_t first = 0; first < opposite.size(); ++first) {
        if (is_visited[first]) {
            continue;
        }
        const auto side = static_cast<Index>(first);
        const Index v = start_of(mesh.triangles, side);
        Index own = v;
        if (fans[slot(v)] == Fans::kNone) {
            fans[slot(v)] = Fans::kOne;
        } else {
            split += fans[slot(v)] == Fans::kOne ? 1 : 0;
            fans[slot(v)] = Fans::kSeveral;
            own = static_cast<Index>(mesh.vertices.size());
            mesh.vertices.push_back(mesh.vertices[slot(v)]);
        }
        for (Index s = side; !is_visited[slot(s)]; s = next_side(opposite[slot(s)])) {
            is_visited[slot(s)] = 1;
            mesh.triangles[slot(s / 3)][slot(s % 3)] = own;
        }
    }
    return split;
}

/// The signed volume within each component.
std::vector<double> component_volumes(const TriangleMesh& mesh, const Orientation& orientation) {
    std::vector<double> volumes(slot(orientation.components), 0.0);
    std::vector<Index> origin(volumes.size(), kNone);  // a near one, or small components drown in rounding errors
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const std::size_t component = slot(orientation.component[t]);
        if (origin[component] == kNone) {
            origin[component] = a;
        }
        const Point& o = mesh.vertices[slot(origin[component])];
        volumes[component] +=
            dot(mesh.vertices[slot(a)] - o, cross(mesh.vertices[slot(b)] - o, mesh.vertices[slot(c)] - o)) / 6.0;
    }
    return volumes;
}

/// For each component, does it lie within a solid that others bound? 1: yes; -1: yes, and these are oriented inward;
/// 0: no, or only in part.
std::vector<int> sides_within_others(const TriangleMesh& mesh, const Orientation& orientation) {
    constexpr std::size_t kSamples = 8;
    std::vector<std::size_t> size(slot(orientation.components), 0);
    for (const Index c : orientation.component) {
        ++size[slot(c)];
    }
    std::vector<WindingQuery> queries;
    std::vector<std::size_t> passed(size.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Index c = orientation.component[t];
        if (passed[slot(c)]++ % (size[slot(c)] / kSamples + 1) == 0) {
            // A corner might be where components touch.
            const auto& [i, j, k] = mesh.triangles[t];
            const Point center = (1.0 / 3.0) * (mesh.vertices[slot(i)] + mesh.vertices[slot(j)] + mesh.vertices[slot(k)]);
            queries.push_back({center, c});
        }
    }
    const std::vector<int> windings = winding_numbers(mesh, orientation.component, queries);
    std::vector<int> lowest(size.size(), std::numeric_limits<int>::max());
    std::vector<int> highest(size.size(), std::numeric_limits<int>::min());
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const std::size_t c = slot(queries[i].excluded_part);
        lowest[c] = std::min(lowest[c], windings[i]);
        highest[c] = std::max(highest[c], windings[i]);
    }
    std::vector<int> result(size.size());
    for (std::size_t c = 0; c < result.size(); ++c) {
        result[c] = lowest[c] > 0 ? 1 : highest[c] < 0 ? -1 : 0;
    }
    return result;
}

/// Turns inward-oriented components outward. A component within the solid that others bound is a cavity or an inclusion,
/// and is turned only together with them. Returns how many were turned.
std::int64_t turn_outward(TriangleMesh& mesh, const Orientation& orientation, std::vector<double>& volumes) {
    if (std::ranges::none_of(volumes, [](double volume) { return volume < 0.0; })) {
        return 0;
    }
    const std::vector<int> within =
        volumes.size() > 1 ? sides_within_others(mesh, orientation) : std::vector<int>(1, 0);
    const auto is_inward = [&](std::size_t c) { return within[c] < 0 || (within[c] == 0 && volumes[c] < 0.0); };
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (is_inward(slot(orientation.component[t]))) {
            reverse(mesh.triangles[t]);
        }
    }
    std::int64_t turned = 0;
    for (std::size_t c = 0; c < volumes.size(); ++c) {
        if (is_inward(c)) {
            volumes[c] = -volumes[c];
            ++turned;
        }
    }
    return turned;
}

// ---------------------------------------------------------------------------------------------------------------------
// Faults
// ---------------------------------------------------------------------------------------------------------------------

/// The edge that comes first in the order of the triangles among those with a number of triangles that `is_meant` takes.
template <class Predicate>
std::string first_edge(const TriangleMesh& mesh, const IndexLists& edges, const Predicate& is_meant) {
    Index first = std::numeric_limits<Index>::max();
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (is_meant(edges[e].size())) {
            first = std::min(first, edges[e][0]);
        }
    }
    return "the first from " + to_text(mesh.vertices[slot(start_of(mesh.triangles, first))]) + " to " +
           to_text(mesh.vertices[slot(end_of(mesh.triangles, first))]);
}

/// The number of connected pieces of the boundary.
std::int64_t count_loops(const std::vector<Triangle>& triangles, const IndexLists& edges, std::size_t vertex_count) {
    std::vector<Index> parent(vertex_count);
    std::iota(parent.begin(), parent.end(), 0);
    const auto root = [&](Index v) {
        while (parent[slot(v)] != v) {
            v = parent[slot(v)] = parent[slot(parent[slot(v)])];
        }
        return v;
    };
    std::int64_t loops = 0;
    std::vector<char> is_met(vertex_count, 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (edges[e].size() != 1) {
            continue;
        }
        const Index a = start_of(triangles, edges[e][0]);
        const Index b = end_of(triangles, edges[e][0]);
        for (const Index v : {a, b}) {
            loops += is_met[slot(v)] ? 0 : 1;
            is_met[slot(v)] = 1;
        }
        if (root(a) != root(b)) {
            parent[slot(root(a))] = root(b);
            --loops;
        }
    }
    return loops;
}

/// Why the surface has no inside; empty if it has one.
std::string find_topological_fault(const TriangleMesh& mesh, const IndexLists& edges, const MeshReport& report,
                                   Index one_sided) {
    std::string fault;
    const auto add = [&](const std::string& text) { fault += (fault.empty() ? "" : "; ") + text; };
    if (report.non_manifold_edges > 0) {
        add("non-manifold: " + counted(report.non_manifold_edges, "edge", "edges") + " with more than two triangles, " +
            first_edge(mesh, edges, [](std::size_t triangles) { return triangles > 2; }) +
            "; remove inner walls, and separate parts that share an edge");
    }
    if (report.boundary_edges > 0) {
        add("open: " + counted(report.boundary_edges, "boundary edge", "boundary edges") + " in " +
            counted(count_loops(mesh.triangles, edges, mesh.vertices.size()), "loop", "loops") + ", " +
            first_edge(mesh, edges, [](std::size_t triangles) { return triangles == 1; }) + "; close the holes");
    }
    if (one_sided != kNone) {
        add("one-sided: the surface through " + to_text(mesh.vertices[slot(mesh.triangles[slot(one_sided)][0])]) +
            " cannot be oriented; cut it, or remove it");
    }
    return fault;
}

/// Why a closed surface bounds no solid that can be computed with; empty if it does.
std::string find_metric_fault(const MeshReport& report, double volume_of_components) {
    const double diagonal = report.bounds.diagonal();
    const Point& low = report.bounds.min;
    const Point& high = report.bounds.max;
    const double farthest = std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x),
                                      std::abs(high.y), std::abs(high.z)});
    if (diagonal == 0.0) {
        return "no extent: all vertices lie at " + to_text(low);
    }
    if (diagonal < kSmallestRelativeSize * farthest) {
        return "too far from the origin for its size: the coordinates of its vertices, near " + to_text(low) +
               ", have too few digits to tell them apart; translate the model to the origin before it is saved";
    }
    if (!(diagonal > kSmallestSize && diagonal < kLargestSize)) {
        return "too small or too large to compute with, from " + to_text(low) + " to " + to_text(high) + "; scale the model";
    }
    if (volume_of_components <= kSmallestRelativeThickness * report.area * diagonal) {
        return "no volume: the surface encloses nothing; give it a thickness";
    }
    return {};
}

}  // namespace

std::vector<std::string> MeshReport::warnings() const {
    std::vector<std::string> lines;
    const auto add = [&](std::int64_t count, std::string_view one, std::string_view many, std::string_view what) {
        if (count > 0) {
            lines.push_back(counted(count, one, many) + std::string(what));
        }
    };
    add(isolated_vertices, "isolated vertex", "isolated vertices", " left out");
    add(duplicate_vertices, "duplicate vertex", "duplicate vertices", " welded");
    add(degenerate_triangles, "degenerate triangle", "degenerate triangles", " (without area, or with two equal corners)");
    add(duplicate_triangles, "duplicate triangle", "duplicate triangles", " left out");
    add(split_vertices, "non-manifold vertex", "non-manifold vertices", " split");
    add(reversed_triangles, "triangle", "triangles", " turned to agree with the neighbours");
    add(reversed_components, "inward-oriented component", "inward-oriented components", " turned outward");
    add(self_intersections, "pair", "pairs",
        " of triangles that intersect: every point that the surface winds around counts as inside");
    return lines;
}

RepairedMesh repair(TriangleMesh mesh, const Execution& execution) {
    MeshReport report;
    report.vertices = static_cast<std::int64_t>(mesh.vertices.size());
    report.triangles = static_cast<std::int64_t>(mesh.triangles.size());
    report.fault = find_bad_data(mesh);
    if (!report.fault.empty()) {
        return {std::move(mesh), std::move(report)};
    }
    report.isolated_vertices = drop_isolated_vertices(mesh);
    for (const Point& p : mesh.vertices) {
        report.bounds.extend(p);
    }

    Surface surface = clean_surface(mesh.triangles, mesh.vertices.size());
    if (const std::vector<Index> boundary = boundary_vertices(surface); !boundary.empty()) {
        report.duplicate_vertices = weld_vertices(mesh, boundary);
        if (report.duplicate_vertices > 0) {
            surface = clean_surface(mesh.triangles, mesh.vertices.size());
        }
    }
    mesh.triangles = std::move(surface.triangles);
    drop_isolated_vertices(mesh);
    report.duplicate_triangles = surface.copies;
    report.degenerate_triangles = surface.collapsed;
    for (const Triangle& t : mesh.triangles) {
        report.degenerate_triangles += has_no_area(mesh.vertices, t) ? 1 : 0;
        report.area +=
            0.5 * norm(cross(mesh.vertices[slot(t[1])] - mesh.vertices[slot(t[0])],
                             mesh.vertices[slot(t[2])] - mesh.vertices[slot(t[0])]));
    }
    const IndexLists& edges = surface.edges;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        report.boundary_edges += edges[e].size() == 1 ? 1 : 0;
        report.non_manifold_edges += edges[e].size() > 2 ? 1 : 0;
    }
    return {};
}

}  // namespace scaleaxis
