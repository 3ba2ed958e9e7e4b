// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/repair/closing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <limits>
#include <queue>
#include <span>
#include <utility>

#include "base/angles.hpp"
#include "base/disjoint_sets.hpp"
#include "base/grouped.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/vectors.hpp"
#include "solid/mesh/fast_winding.hpp"
#include "solid/mesh/repair/orientation.hpp"
#include "solid/mesh/repair/patch.hpp"
#include "solid/mesh/winding.hpp"
#include "spatial/extent.hpp"
#include "spatial/mesh_parts.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

/// +1 for a side from the smaller to the larger of its ends, -1 for one back.
int arrow_of(const std::vector<Triangle>& triangles, Index side) {
    return start_of(triangles, side) < end_of(triangles, side) ? 1 : -1;
}

/// The arrows of an edge that do not cancel.
int excess_of(const std::vector<Triangle>& triangles, std::span<const Index> sides) {
    int excess = 0;
    for (const Index side : sides) {
        excess += arrow_of(triangles, side);
    }
    return excess;
}

/// Of the edges of a closed line, by length.
Point centroid_of(const std::vector<Point>& points, std::span<const Index> loop) {
    Point sum;
    double length = 0.0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const Point& a = points[loop[i]];
        const Point& b = points[loop[(i + 1) % loop.size()]];
        sum = sum + distance(a, b) * midpoint(a, b);
        length += distance(a, b);
    }
    return length > 0.0 ? (1.0 / length) * sum : points[loop[0]];
}

/// \param given so many of the triangles are no patches: those are kept in `left_out`
void drop(std::vector<Triangle>& triangles, const std::vector<char>& is_dropped, std::size_t given,
          std::vector<Triangle>& left_out) {
    for (std::size_t t = 0; t < given; ++t) {
        if (is_dropped[t] != 0) {
            left_out.push_back(triangles[t]);
        }
    }
    erase_marked(triangles, is_dropped);
}

// ---------------------------------------------------------------------------------------------------------------------
// What is seen from outside
// ---------------------------------------------------------------------------------------------------------------------

/// How many of the rays from a part's triangles get out, from the side that the normals point to and from the other.
struct Visibility {
    std::int64_t front = 0;
    std::int64_t back = 0;
    std::int64_t rays = 0;  ///< that were sent

    /// Is the back clearly what is seen?
    bool is_turned() const { return back > 2 * front && 20 * back > rays; }
    std::int64_t seen() const { return front + back; }
    bool is_unseen() const { return seen() == 0; }
    bool is_hardly_seen() const { return 20 * seen() <= rays; }  ///< as through small holes
};

std::vector<Visibility> visibilities(const TriangleMesh& mesh, const Orientation& parts) {
    constexpr std::size_t kRays = 40'000;  // in all
    constexpr std::size_t kMostTriangles = 64, kFewestDirections = 8, kMostDirections = 64;
    constexpr std::uint64_t kSeed = 1;
    const std::size_t part_count = static_cast<std::size_t>(parts.components);
    const std::size_t share = std::clamp<std::size_t>(kRays / kFewestDirections / part_count, 1, kMostTriangles);
    std::vector<std::size_t> sizes(part_count, 0), passed(part_count, 0);
    for (const Index part : parts.component) {
        ++sizes[part];
    }
    std::vector<Index> chosen;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Index part = parts.component[t];
        if (passed[part]++ % (sizes[part] / share + 1) == 0) {
            chosen.push_back(static_cast<Index>(t));
        }
    }
    const std::size_t directions = std::clamp(kRays / chosen.size(), kFewestDirections, kMostDirections);
    const Bvh bvh = build_bvh(mesh);
    const Box box = box_around(mesh.vertices);
    std::vector<Visibility> of_chosen(chosen.size());
    for_each_index(
        chosen.size(),
        [&](std::size_t i) {
            const auto& [u, v, w] = mesh.triangles[chosen[i]];
            const std::vector<Point>& p = mesh.vertices;
            const Point center = (1.0 / 3.0) * (p[u] + p[v] + p[w]);
            const Point normal = cross(p[v] - p[u], p[w] - p[u]);
            for (std::size_t k = 0; k < directions; ++k) {
                // In pairs of opposite ones: as many from the front as from the back.
                const Point ray = (k % 2 == 0 ? 1.0 : -1.0) * random_unit_vector(kSeed, i, k / 2);
                bool gets_out = true;
                for_each_crossing(bvh, center, center + 2.0 * box.diagonal() * ray,
                                  [&](Index t, const SegmentCrossing&) { gets_out &= bvh.order[t] == chosen[i]; });
                if (gets_out) {
                    ++(dot(ray, normal) > 0.0 ? of_chosen[i].front : of_chosen[i].back);
                }
            }
        },
        std::size_t{16});
    std::vector<Visibility> result(part_count);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        Visibility& part = result[parts.component[chosen[i]]];
        part.front += of_chosen[i].front;
        part.back += of_chosen[i].back;
        part.rays += static_cast<std::int64_t>(directions);
    }
    return result;
}

// ---------------------------------------------------------------------------------------------------------------------
// Walls
// ---------------------------------------------------------------------------------------------------------------------

/// Which triangles make up walls: parts without which the arrows at all of their rims cancel. Where there is a choice,
/// as of the three parts of a body with a wall across, that which is least seen from outside goes. Walls that meet
/// cancel together only, whichever way each of them faces.
std::vector<char> find_walls(const std::vector<Triangle>& triangles, const IndexLists& edges, const Orientation& parts,
                             const std::vector<Visibility>& seen) {
    std::vector<int> excess(edges.size(), 0);
    std::vector<Index> rim_edges;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (edges[e].size() != 2) {
            rim_edges.push_back(static_cast<Index>(e));
            excess[e] = excess_of(triangles, edges[e]);
        }
    }
    const IndexLists rims = grouped(seen.size(), [&](const auto& add) {
        for (const Index e : rim_edges) {
            std::ranges::for_each(edges[e], [&](Index side) { add(parts.component[side / 3], e); });
        }
    });
    std::vector<char> is_gone(seen.size(), 0);
    const auto arrows_of = [&](Index e, const auto& is_counted) {
        int sum = 0;
        for (const Index side : edges[e]) {
            const Index part = parts.component[side / 3];
            sum += is_gone[part] == 0 && is_counted(part) ? arrow_of(triangles, side) : 0;
        }
        return sum;
    };
    const auto leave_out = [&](Index part) {
        is_gone[part] = 1;
        std::ranges::for_each(rims[part], [&](Index e) { excess[e] = 0; });
    };
    const auto leave_out_alone = [&](Index part) {
        const bool is_wall =
            std::ranges::any_of(rims[part], [&](Index e) { return excess[e] != 0; }) &&
            std::ranges::all_of(rims[part], [&](Index e) {
                return edges[e].size() > 2 && excess[e] == arrows_of(e, [&](Index other) { return other == part; });
            });
        if (is_wall) {
            leave_out(part);
        }
    };
    const auto leave_out_together = [&](const std::vector<Index>& some) {
        std::vector<char> is_one(seen.size(), 0);
        std::ranges::for_each(some, [&](Index part) { is_one[part] = is_gone[part] == 0 ? 1 : 0; });
        const auto counts = [&](Index part) { return is_one[part] != 0; };
        const auto first_at = [&](Index e) {
            const auto side = std::ranges::find_if(edges[e], [&](Index s) { return counts(parts.component[s / 3]); });
            return side == edges[e].end() ? kNone : parts.component[*side / 3];
        };
        DisjointSets groups(seen.size());
        for (const Index e : rim_edges) {
            const Index first = first_at(e);
            for (const Index side : edges[e]) {
                if (counts(parts.component[side / 3])) {
                    groups.join(first, parts.component[side / 3]);
                }
            }
        }
        std::vector<char> has_excess(seen.size(), 0);
        std::vector<char> cancels(seen.size(), 1);
        for (const Index e : rim_edges) {
            if (const Index first = first_at(e); first != kNone) {
                const Index group = groups.find(first);
                has_excess[group] |= excess[e] != 0;
                cancels[group] &= edges[e].size() > 2 && excess[e] == arrows_of(e, counts);
            }
        }
        for (const Index part : some) {
            const Index group = groups.find(part);
            if (counts(part) && has_excess[group] != 0 && cancels[group] != 0) {
                leave_out(part);
            }
        }
    };
    const auto by_visibility = sorted_indices(seen.size(), [&](Index part) { return seen[part].seen(); });
    for (const auto& is_asked : {&Visibility::is_unseen, &Visibility::is_hardly_seen}) {
        std::vector<Index> some;
        std::ranges::copy_if(by_visibility, std::back_inserter(some),
                             [&](Index part) { return (seen[part].*is_asked)(); });
        std::ranges::for_each(some, leave_out_alone);
        leave_out_together(some);
    }
    std::ranges::for_each(by_visibility, leave_out_alone);
    std::vector<char> is_wall(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        is_wall[t] = is_gone[parts.component[t]];
    }
    return is_wall;
}

// ---------------------------------------------------------------------------------------------------------------------
// Holes
// ---------------------------------------------------------------------------------------------------------------------

/// Arrows that are missing, as a graph, to be taken out loop by loop.
class Rims {
   public:
    Rims(const TriangleMesh& mesh, const IndexLists& edges) : vertices_(mesh.vertices) {
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const int excess = excess_of(mesh.triangles, edges[e]);
            for (const Index side : edges[e]) {
                if (excess != 0 && arrow_of(mesh.triangles, side) == (excess > 0 ? 1 : -1)) {
                    for (int i = 0; i < std::abs(excess); ++i) {
                        arrows_.push_back({end_of(mesh.triangles, side), start_of(mesh.triangles, side)});
                        apexes_.push_back(apex_of(mesh.triangles, side));
                    }
                    break;
                }
            }
        }
        is_taken_.resize(arrows_.size(), 0);
        if (!arrows_.empty()) {
            from_ = grouped(vertices_.size(), [&](const auto& add) {
                for (std::size_t i = 0; i < arrows_.size(); ++i) {
                    add(arrows_[i][0], static_cast<Index>(i));
                }
            });
            length_.resize(vertices_.size(), std::numeric_limits<double>::infinity());
            arrival_.resize(vertices_.size(), kNone);
        }
    }

    std::size_t size() const { return arrows_.size(); }

    /// The shortest loop through an arrow, without it and all others of the loop from then on; empty if it was taken.
    Loop take_loop(Index arrow) {
        if (is_taken_[arrow]) {
            return {};
        }
        const auto [start, second] = arrows_[arrow];
        is_taken_[arrow] = 1;
        find_ways(second, start);
        Loop loop{{start}, {apexes_[arrow]}};
        for (Index v = start; v != second;) {
            const Index back = arrival_[v];
            is_taken_[back] = 1;
            v = arrows_[back][0];
            loop.corners.push_back(v);
            loop.apexes.push_back(apexes_[back]);
        }
        // second … start
        std::ranges::reverse(loop.corners);
        std::ranges::reverse(loop.apexes);
        for (const Index v : reached_) {
            length_[v] = std::numeric_limits<double>::infinity();
            arrival_[v] = kNone;
        }
        reached_.clear();
        return loop;
    }

   private:
    /// Dijkstra's algorithm, until `goal` is reached.
    void find_ways(Index from, Index goal) {
        using Way = std::pair<double, Index>;
        std::priority_queue<Way, std::vector<Way>, std::greater<>> ways;
        const auto reach = [&](Index v, double length, Index arrow) {
            if (length < length_[v]) {
                length_[v] = length;
                arrival_[v] = arrow;
                reached_.push_back(v);
                ways.emplace(length, v);
            }
        };
        reach(from, 0.0, kNone);
        while (!ways.empty()) {
            const auto [length, v] = ways.top();
            ways.pop();
            if (v == goal) {
                return;
            }
            if (length > length_[v]) {
                continue;
            }
            for (const Index arrow : from_[v]) {
                if (!is_taken_[arrow]) {
                    const Index end = arrows_[arrow][1];
                    reach(end, length + distance(vertices_[v], vertices_[end]), arrow);
                }
            }
        }
    }

    const std::vector<Point>& vertices_;
    std::vector<std::array<Index, 2>> arrows_;
    std::vector<Index> apexes_;  ///< of each arrow the third corner of a triangle whose side runs back
    std::vector<char> is_taken_;
    IndexLists from_;  ///< of each vertex the arrows that start there
    // State of the search:
    std::vector<double> length_;
    std::vector<Index> arrival_;  ///< the arrow by which a vertex was reached
    std::vector<Index> reached_;
};

/// Which triangles lie on another one, the other side up: together they bound nothing.
std::vector<char> find_opposite_copies(const std::vector<Triangle>& triangles, std::size_t vertex_count) {
    std::vector<char> is_copy(triangles.size(), 0);
    const IndexLists edges = sides_of_edges(triangles, vertex_count);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto sides = edges[e];
        for (std::size_t i = 0; i < sides.size(); ++i) {
            for (std::size_t j = i + 1; j < sides.size() && !is_copy[sides[i] / 3]; ++j) {
                if (!is_copy[sides[j] / 3] && apex_of(triangles, sides[i]) == apex_of(triangles, sides[j]) &&
                    arrow_of(triangles, sides[i]) != arrow_of(triangles, sides[j])) {
                    is_copy[sides[i] / 3] = is_copy[sides[j] / 3] = 1;
                }
            }
        }
    }
    return is_copy;
}

/// Patches behind the triangles of a surface.
struct Patched {
    std::size_t given = 0;            ///< how many triangles come before them
    std::vector<Hole> holes;          ///< in the order of the patches
    std::vector<std::size_t> firsts;  ///< of each hole a triangle of its patch
};

/// Adds a patch for each rim; what is a triangle and its own patch goes.
Patched add_patches(TriangleMesh& mesh, Closing& closing) {
    struct Rim {
        std::vector<Index> loop;
        std::size_t begin, end;
    };
    std::vector<Rim> loops;
    Rims rims(mesh, sides_of_edges(mesh.triangles, mesh.vertices.size()));
    const std::size_t given = mesh.triangles.size();
    CancellationPoint cancellation(1);
    for (Index arrow = 0; arrow < static_cast<Index>(rims.size()); ++arrow) {
        cancellation();
        if (Loop loop = rims.take_loop(arrow); !loop.corners.empty()) {
            const std::size_t begin = mesh.triangles.size();
            for (const Triangle& triangle : patch_of(mesh.vertices, loop)) {
                mesh.triangles.push_back(triangle);
            }
            loops.push_back({std::move(loop.corners), begin, mesh.triangles.size()});
        }
    }
    const std::vector<char> is_copy = find_opposite_copies(mesh.triangles, mesh.vertices.size());
    std::size_t kept = 0;
    Patched result;
    for (std::size_t t = 0; t < given; ++t) {
        kept += is_copy[t] ? 0 : 1;
    }
    closing.wall_triangles += static_cast<std::int64_t>(given - kept);
    result.given = kept;
    for (const auto& [loop, begin, end] : loops) {
        Hole hole{mesh.vertices[loop[0]], 0.0, 0.0, std::ssize(loop), centroid_of(mesh.vertices, loop)};
        const std::size_t first = kept;
        for (std::size_t t = begin; t < end; ++t) {
            kept += is_copy[t] ? 0 : 1;
            hole.area += is_copy[t] ? 0.0 : triangle_area(mesh, mesh.triangles[t]);
        }
        if (kept > first) {
            Box box;
            for (const Index v : loop) {
                box.extend(mesh.vertices[v]);
            }
            hole.width = box.diagonal();
            result.holes.push_back(hole);
            result.firsts.push_back(first);
        }
    }
    drop(mesh.triangles, is_copy, given, closing.left_out);
    return result;
}

/// Leaves out sheets beside parts that have an inside; and what was open within the solid that the rest bounds, unless
/// it may be a cavity: which way a sheet faces says nothing, so it must face inward and be patched to a small extent
/// only.
void drop_sheets(TriangleMesh& mesh, Patched& patched, Closing& closing) {
    constexpr double kMostPatch = 0.25;  // of the area of a part that may be a cavity
    constexpr double kSheetPatch = 0.9;  // of the area of a sheet; less than that have lids and domes
    const IndexLists edges = sides_of_edges(mesh.triangles, mesh.vertices.size());
    const Orientation parts = orient(mesh.triangles, paired_sides(mesh, edges));
    std::vector<double> areas(parts.components, 0.0), patches(parts.components, 0.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const double area = triangle_area(mesh, mesh.triangles[t]);
        areas[parts.component[t]] += area;
        patches[parts.component[t]] += t < patched.given ? 0.0 : area;
    }
    if (areas.size() < 2 || std::ranges::none_of(patches, [](double area) { return area > 0.0; })) {
        return;
    }
    const std::vector<double> volumes = component_volumes(mesh, parts);
    const std::vector<int> within = sides_within_others(build_bvh(mesh), mesh, parts, volumes);
    std::vector<char> is_inside(areas.size()), is_sheet(areas.size());
    for (std::size_t part = 0; part < areas.size(); ++part) {
        const bool may_be_cavity = volumes[part] * within[part] < 0.0;
        is_inside[part] = within[part] != 0 && patches[part] > (may_be_cavity ? kMostPatch * areas[part] : 0.0);
        is_sheet[part] = patches[part] > kSheetPatch * (areas[part] - patches[part]);
    }
    if (std::ranges::count(is_sheet, 0) == 0) {
        is_sheet.assign(areas.size(), 0);  // for the whole to be judged
    }
    std::vector<char> is_dropped(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Index part = parts.component[t];
        is_dropped[t] = is_inside[part] || is_sheet[part];
        if (is_dropped[t] && t < patched.given) {
            ++(is_inside[part] ? closing.wall_triangles : closing.sheet_triangles);
        }
    }
    std::size_t i = 0;
    std::erase_if(patched.holes, [&](const Hole&) { return is_dropped[patched.firsts[i++]] != 0; });
    drop(mesh.triangles, is_dropped, patched.given, closing.left_out);
}

/// The angle of a side's triangle around its edge, from any direction on: the same for all triangles of the edge.
class AnglesAround {
   public:
    AnglesAround(const Point& low, const Point& high) : low_(low) {
        const Point d = high - low;
        const Point axis = norm(d) > 0.0 ? unit(d) : Point{0, 0, 1};
        const double x = std::abs(axis.x), y = std::abs(axis.y), z = std::abs(axis.z);
        const Point other = x <= y && x <= z ? Point{1, 0, 0} : (y <= z ? Point{0, 1, 0} : Point{0, 0, 1});
        x_ = unit(cross(axis, other));
        y_ = cross(axis, x_);
    }

    double operator()(const Point& apex) const { return signed_angle_of(dot(apex - low_, x_), dot(apex - low_, y_)); }

   private:
    Point low_, x_, y_;
};

/// Which parts face inward: those with a rim whose backs are seen, and those hardly seen around which these wind, as
/// around the cavities of a solid that is inside out.
std::vector<char> find_turned(const TriangleMesh& mesh, const Orientation& parts, const std::vector<Visibility>& seen,
                              const std::vector<char>& has_rim) {
    std::vector<char> result(seen.size());
    for (std::size_t part = 0; part < seen.size(); ++part) {
        result[part] = has_rim[part] != 0 && seen[part].is_turned() ? 1 : 0;
    }
    if (std::ranges::count(result, 1) == 0) {
        return result;
    }
    TriangleMesh turned{mesh.vertices, {}};
    std::vector<Index> first(seen.size(), kNone);  // triangle of the other parts
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Index part = parts.component[t];
        if (result[part] != 0) {
            turned.triangles.push_back(mesh.triangles[t]);
        } else if (first[part] == kNone && (has_rim[part] == 0 || seen[part].is_hardly_seen())) {
            first[part] = static_cast<Index>(t);
        }
    }
    const Bvh bvh = build_bvh(turned);
    const FastWinding winding(bvh);
    for (std::size_t part = 0; part < seen.size(); ++part) {
        if (first[part] != kNone) {
            result[part] = winding(mesh.vertices[mesh.triangles[first[part]][0]]) < -0.5 ? 1 : 0;
        }
    }
    return result;
}

}  // namespace

Closing close_holes(TriangleMesh& mesh) {
    Closing closing;
    IndexLists edges = sides_of_edges(mesh.triangles, mesh.vertices.size());
    const Orientation parts = orient(mesh.triangles, opposite_sides(edges));
    const std::vector<Visibility> seen = visibilities(mesh, parts);
    std::vector<char> has_rim(seen.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        for (const Index side : edges[e]) {
            if (edges[e].size() != 2) {
                has_rim[parts.component[side / 3]] = 1;
            }
        }
    }
    const std::vector<char> is_turned = find_turned(mesh, parts, seen, has_rim);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (is_turned[parts.component[t]] != 0) {
            reverse(mesh.triangles[t]);
            ++closing.turned_triangles;
        }
    }
    if (closing.turned_triangles > 0) {  // their sides have other numbers now
        edges = sides_of_edges(mesh.triangles, mesh.vertices.size());
    }
    const std::vector<char> is_wall = find_walls(mesh.triangles, edges, parts, seen);
    closing.wall_triangles = std::ranges::count(is_wall, 1);
    drop(mesh.triangles, is_wall, is_wall.size(), closing.left_out);
    closing.open = mesh.triangles;
    Patched patched = add_patches(mesh, closing);
    drop_sheets(mesh, patched, closing);
    closing.holes = std::move(patched.holes);
    std::ranges::stable_sort(closing.holes, std::greater<>(), &Hole::width);
    return closing;
}

std::vector<Index> paired_sides(const TriangleMesh& mesh, const IndexLists& edges) {
    std::vector<Index> opposite = opposite_sides(edges);
    std::vector<std::pair<double, Index>> around;
    std::vector<Index> open;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (edges[e].size() == 2) {
            continue;
        }
        const auto [low, high] =
            std::minmax({start_of(mesh.triangles, edges[e][0]), end_of(mesh.triangles, edges[e][0])});
        const AnglesAround angle(mesh.vertices[low], mesh.vertices[high]);
        around.clear();
        for (const Index side : edges[e]) {
            around.emplace_back(angle(mesh.vertices[apex_of(mesh.triangles, side)]), side);
        }
        std::ranges::sort(around);
        // Counter-clockwise an arrow down enters the solid, an arrow up leaves it. Twice around, for what is entered
        // before the first angle.
        open.clear();
        for (int round = 0; round < 2; ++round) {
            for (const auto& [at, side] : around) {
                if (opposite[side] != kNone) {
                    continue;
                }
                if (arrow_of(mesh.triangles, side) < 0) {
                    if (round == 0) {
                        open.push_back(side);
                    }
                } else if (!open.empty()) {
                    opposite[side] = open.back();
                    opposite[open.back()] = side;
                    open.pop_back();
                }
            }
        }
    }
    return opposite;
}

}  // namespace scaleaxis::inline v1
