// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/strips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "axis/cheapest_ways.hpp"
#include "axis/complex.hpp"
#include "axis/edit/collapse.hpp"
#include "axis/edit/remainder.hpp"
#include "axis/sharp_edges/creases.hpp"
#include "base/angles.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "spatial/nearest_triangle.hpp"
#include "spatial/point_tree.hpp"
#include "spatial/triangle_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

// All lengths are in tolerances.
// Of a way off the bisector of the line, to other sheets, beside one away from the line.
constexpr double kOffCost = 8.0;
// How far from its line a way may lead: narrow sheets end up to ten before corners. Two thirds of it leave edges of
// frustums out; without a limit sheets come back that the filter has taken.
constexpr double kWayReach = 12.0;
constexpr double kFootReach = 2.0;  // of the way to the nearest vertex: how far the foot of a corner may be
constexpr int kPartsOfLoop = 3;     // the shortest way below a third of a loop does not lead around the other side

// Three vertices; places on the line are -1 - place.
using Triangle = std::array<Index, 3>;

bool is_place(Index corner) { return corner < 0; }
std::size_t number_of(Index corner) { return static_cast<std::size_t>(-1 - corner); }
std::size_t first_place_of(const Triangle& triangle) { return number_of(triangle[2]); }
std::size_t last_place_of(const Triangle& triangle) {
    return number_of(is_place(triangle[1]) ? triangle[1] : triangle[2]);
}
Index place_of(std::size_t number) { return -1 - static_cast<Index>(number); }

// The length of a line above a run of triangles.
double length_above(std::span<const Triangle> run, const EdgeLine& line) {
    return line.positions[last_place_of(run.back())] - line.positions[first_place_of(run.front())];
}

// Calls `visit(first, last)` for the runs of equal values, of which `last` is no part.
template <class Visit>
void for_each_run(const std::vector<std::uint8_t>& values, const Visit& visit) {
    for (std::size_t first = 0; first < values.size();) {
        const auto end = std::find_if(values.begin() + static_cast<std::ptrdiff_t>(first), values.end(),
                                      [&](std::uint8_t value) { return value != values[first]; });
        const auto last = static_cast<std::size_t>(end - values.begin());
        visit(first, last);
        first = last;
    }
}

// A complex with strips, the first of whose faces and vertices are those given. Parts of sheets beyond the ways lie
// beside strips, which stand for them: these parts collapse from their border.
MedialComplex without_doubles(const MedialComplex& complex, std::size_t given_faces, Index given_vertices,
                              double tolerance) {
    TriangleMesh strips{complex.vertices, {}};
    for (std::size_t f = given_faces; f < complex.faces.size(); ++f) {
        const std::span<const Index> corners = complex.faces[f];
        strips.triangles.push_back({corners[0], corners[1], corners[2]});
    }
    const Bvh tree = build_bvh(std::move(strips));
    const TriangleBounds bounds = triangle_bounds(tree);
    const auto is_double = [&](const ElementaryCollapse& collapse) {
        if (!collapse.has_face || static_cast<std::size_t>(collapse.element) >= given_faces) {
            return false;
        }
        const Point center = center_of_face(complex, collapse.element);
        const NearTriangle near = nearest_triangle(tree, bounds, center, 0.5 * tolerance);
        if (near.triangle == kNone) {
            return false;
        }
        std::vector<Point> feet;
        for (const Index v : complex.faces[given_faces + tree.order[near.triangle]]) {
            if (v < given_vertices) {
                feet.push_back(complex.vertices[v]);
            }
        }
        // What lies below a way is as near to it as to the strip.
        const Point on_way = nearest_point(feet.front(), feet.back(), feet.back(), center);
        return near.squared_distance < kNearby * kNearby * squared_distance(on_way, center);
    };
    return complex_of(after_collapses(complex, is_double), complex);
}

class Strips {
   public:
    Strips(MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options, SharpEdgeStatistics& statistics)
        : complex_(complex),
          solid_(solid),
          tolerance_(options.tolerance),
          statistics_(statistics),
          curves_(curve_edges(complex)),
          neighbors_(grouped_both_ways(complex.vertices.size(), complex.edges)),
          tree_(build_point_tree(complex.vertices)) {}

    void run(std::span<const EdgeLine> lines) {
        std::vector<EdgeLine> parts = parts_of(lines);
        std::ranges::stable_sort(parts, std::greater<>(), &EdgeLine::length);
        const std::size_t faces = complex_.faces.size();
        const auto vertices = static_cast<Index>(complex_.vertices.size());
        // A corner that is reached may be where another line can begin.
        while (std::erase_if(parts, [&](const EdgeLine& part) { return reach(part); }) > 0) {
            // once more
        }
        if (complex_.faces.size() > faces) {
            build_edges(complex_, curves_);
            complex_ = without_doubles(complex_, faces, vertices, tolerance_);
            label_sheets(complex_);
        }
    }

   private:
    // Lines between corners, or between cuts through a closed line, in steps.
    std::vector<EdgeLine> parts_of(std::span<const EdgeLine> lines) {
        for (const EdgeLine& line : lines) {
            first_cut_ = std::max({first_cut_, line.ends[0] + 1, line.ends[1] + 1});
        }
        std::vector<EdgeLine> parts;
        Index next_end = first_cut_;
        for (const EdgeLine& line : lines) {
            const int count = line.ends[0] == line.ends[1] ? kPartsOfLoop : 1;
            const double length = line.length() / count;
            // Places as close as vertices of the border at most; one between the ends at least: else the strip would
            // end in an edge between two corners.
            const double step = std::min(tolerance_, 0.5 * length);
            for (int i = 0; i < count; ++i) {
                const auto end_of = [&](int k) {
                    return line.is_closed() || k % count != 0 ? next_end + k % count : line.ends[k == 0 ? 0 : 1];
                };
                parts.push_back(section_of(line, i * length, (i + 1) * length, step, kEdgeAccuracy * tolerance_));
                parts.back().ends = {end_of(i), end_of(i + 1)};
            }
            next_end += count;
        }
        return parts;
    }

    // Else it is where a loop is cut.
    bool is_corner(Index end) const { return end < first_cut_; }

    bool reach(const EdgeLine& line) {
        stop_if_cancelled();
        const std::vector<Index> way = way_below(line);
        if (way.empty()) {
            return false;
        }
        const std::vector<Triangle> strip = strip_between(way, line);
        const std::vector<std::uint8_t> is_valid = are_valid(strip, line);
        bool is_reached = false;
        for_each_run(is_valid, [&](std::size_t first, std::size_t last) {
            is_reached |= is_valid[first] != 0 && add_run(std::span(strip).subspan(first, last - first), line,
                                                          first == 0, last == strip.size());
        });
        return is_reached;
    }

    struct Corner {
        Index vertex = kNone;
        std::set<Index> feet{};  // vertices that have an edge to it
    };

    // From where strips may begin.
    std::vector<Index> feet_of(Index end, const Point& place) const {
        const auto known = corners_.find(end);
        if (known != corners_.end()) {
            return {known->second.feet.begin(), known->second.feet.end()};
        }
        const Index nearest = tree_.order[nearest_point(tree_, place).position];
        if (!is_corner(end)) {
            return {nearest};
        }
        // In the wedge at the place no ball is larger beside its distance than one that touches all faces there.
        const double least = distance(complex_.vertices[nearest], place);
        std::vector<std::pair<double, Index>> near;  // distances
        double best = kInfinity;                     // of the distances, in radii
        for_each_point_near(tree_, place, kFootReach * least, [&](Index at, double) {
            const Index v = tree_.order[at];
            near.emplace_back(distance(complex_.vertices[v], place), v);
            best = std::min(best, near.back().first / complex_.radii[v]);
        });
        // Of balls that are as large, but for the errors of their radii, the nearest one.
        std::erase_if(near, [&](const auto& foot) {
            return foot.first > (1.0 + kRadiusError) * best * complex_.radii[foot.second];
        });
        return {std::ranges::min(near).second};
    }

    // A line as a point sees it: which place is nearest, how far it is, and how far the planes on both sides of it are.
    struct View {
        Point place;
        double position;
        double away;
        double nearer;
        double farther;
    };

    static View seen_from(const Point& p, const EdgeLine& line) {
        const auto [place, position] = nearest_on(line, p);
        const auto& [n, m] = line.normals[line.part_at(position)];
        const auto [nearer, farther] = std::minmax({dot(n, place - p), dot(m, place - p)});
        return {place, position, distance(p, place), nearer, farther};
    }

    // Through the complex, along the line, from a foot of the one end to one of the other.
    std::vector<Index> way_below(const EdgeLine& line) const {
        const std::vector<Index> goals = feet_of(line.ends[1], line.points.back());
        const double reach = kWayReach * tolerance_;
        std::unordered_map<Index, View> views;  // a step leads to a vertex from all sides
        const auto view_of = [&](Index v) -> const View& {
            const auto [view, is_new] = views.try_emplace(v);
            if (is_new) {
                view->second = seen_from(complex_.vertices[v], line);
            }
            return view->second;
        };
        const auto cost = [&](Index v, Index next) {
            const View& view = view_of(next);
            // A step across the middle of a loop would cut it short.
            const double step = std::max(distance(complex_.vertices[v], complex_.vertices[next]),
                                         std::abs(view.position - view_of(v).position));
            return std::max(view.away, view_of(v).away) > reach
                       ? kInfinity
                       : step * (1.0 + (view.away + kOffCost * (view.farther - view.nearer)) / tolerance_);
        };
        const auto is_foot = [&](Index v) { return std::ranges::binary_search(goals, v); };
        const CheapestWays ways(neighbors_, feet_of(line.ends[0], line.points.front()), is_foot, cost);
        return ways.way_to(ways.goal);
    }

    // Triangles between a way and the places above it.
    std::vector<Triangle> strip_between(const std::vector<Index>& way, const EdgeLine& line) const {
        std::vector<Triangle> strip;
        const auto positions =  // along the line
            each_of<double>(way, [&](Index v) { return nearest_on(line, complex_.vertices[v]).second; });
        const std::size_t last = line.points.size() - 1;
        std::size_t k = 0;
        for (std::size_t i = 0; i + 1 < way.size() || k < last;) {
            const bool goes_on =
                k == last || (i + 1 < way.size() && std::abs(positions[i + 1] - line.positions[k]) <
                                                        std::abs(positions[i] - line.positions[k + 1]));
            if (goes_on) {
                strip.push_back({way[i], way[i + 1], place_of(k)});
                ++i;
            } else {
                strip.push_back({way[i], place_of(k + 1), place_of(k)});
                ++k;
            }
        }
        return strip;
    }

    const Point& at(Index corner, const EdgeLine& line) const {
        return is_place(corner) ? line.points[number_of(corner)] : complex_.vertices[corner];
    }

    // Which triangles belong to the sheet of the edge: both sides of it are equally far from their vertices, or nearly
    // so, and a ball in the middle that touches them is in the solid.
    std::vector<std::uint8_t> are_valid(const std::vector<Triangle>& strip, const EdgeLine& line) const {
        std::vector<std::uint8_t> result;
        std::vector<Point> middles;
        std::vector<double> radii;
        for (const Triangle& triangle : strip) {
            const auto& [a, b, c] = triangle;
            middles.push_back((1.0 / 3.0) * (at(a, line) + at(b, line) + at(c, line)));
            radii.push_back(0.0);
            result.push_back(1);
            for (const Index corner : triangle) {
                const View view = seen_from(at(corner, line), line);
                radii.back() += view.nearer / 3.0;
                if (view.farther - view.nearer > 2.0 * tolerance_) {
                    result.back() = 0;
                }
            }
        }
        // Short stretches that are off go on.
        for_each_run(std::vector(result), [&](std::size_t first, std::size_t last) {
            if (length_above(std::span(strip).subspan(first, last - first), line) < tolerance_) {
                std::ranges::fill(std::span(result).subspan(first, last - first), std::uint8_t{1});
            }
        });
        const auto nearest = nearest_of(solid_, middles, std::vector<double>(middles.size(), kInfinity));
        const std::vector<std::uint8_t> sides = sides_of(solid_, middles);
        for (std::size_t f = 0; f < strip.size(); ++f) {
            const double away = nearest[f] ? distance(middles[f], *nearest[f]) : 0.0;
            if (radii[f] > (sides[f] != 0 ? away : -away) + tolerance_) {
                result[f] = 0;
            }
        }
        return result;
    }

    // Adds a part of a strip. A part that begins or ends in a corner that is there has the edge to it.
    bool add_run(std::span<const Triangle> run, const EdgeLine& line, bool is_first, bool is_last) {
        while (!is_first && !run.empty() && first_place_of(run.front()) == 0) {
            run = run.subspan(1);
        }
        while (!is_last && !run.empty() && last_place_of(run.back()) + 1 == line.points.size()) {
            run = run.first(run.size() - 1);
        }
        if (run.empty() || (!(is_first && is_last) && length_above(run, line) < tolerance_)) {
            return false;
        }
        std::map<Index, Corner> places;  // those between the ends
        for (const Triangle& triangle : run) {
            std::vector<Index> feet;
            std::ranges::remove_copy_if(triangle, std::back_inserter(feet), is_place);
            Triangle corners = triangle;
            for (Index& corner : corners) {
                if (is_place(corner)) {
                    const Index end = end_at(number_of(corner), line);
                    Corner& target = end == kNone ? places[corner] : corners_[end];
                    if (target.vertex == kNone) {
                        target.vertex = add_vertex(complex_, {at(corner, line), 0.0}, {VertexKind::kSharpEdge});
                        ++statistics_.points;
                        statistics_.corners += end != kNone && is_corner(end) ? 1 : 0;
                    }
                    target.feet.insert(feet.begin(), feet.end());
                    corner = target.vertex;
                }
            }
            const auto& [n, m] = line.normals[std::min(first_place_of(triangle), line.normals.size() - 1)];
            const auto contacts = complex_.has_contacts() ? std::optional(added_contacts(feet, {n, m})) : std::nullopt;
            const double angle = angle_of_cosine(std::clamp(dot(n, m), -1.0, 1.0)) / kDegree;
            add_face(complex_, corners, {0.5 * angle, 0, contacts});
        }
        statistics_.length += length_above(run, line);
        return true;
    }

    // The number of an end at that place, if it is one.
    static Index end_at(std::size_t place, const EdgeLine& line) {
        return place == 0 ? line.ends[0] : place + 1 == line.points.size() ? line.ends[1] : kNone;
    }

    // Where the ball between vertices touches the planes on both sides of the edge.
    std::array<Index, 2> added_contacts(std::span<const Index> vertices, const std::array<Point, 2>& normals) {
        const auto [middle, radius] = mean_ball(complex_, vertices);
        std::array<Index, 2> contacts{};
        for (int side = 0; side < 2; ++side) {
            contacts[side] = static_cast<Index>(complex_.boundary_vertices.size());
            complex_.boundary_vertices.push_back(middle + radius * normals[side]);
            complex_.boundary_vertex_balls.push_back({kNone, kNone, kNone});
        }
        return contacts;
    }

    MedialComplex& complex_;
    const Solid& solid_;
    double tolerance_;
    SharpEdgeStatistics& statistics_;
    std::vector<std::array<Index, 2>> curves_;
    IndexLists neighbors_;
    PointTree tree_;                   // of the vertices as given
    std::map<Index, Corner> corners_;  // by the numbers of ends
    Index first_cut_ = 0;              // the least number of an end that is no corner
};

}  // namespace

void add_strips(MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options,
                std::span<const EdgeLine> lines, SharpEdgeStatistics& statistics) {
    if (!complex.vertices.empty()) {
        Strips(complex, solid, options, statistics).run(lines);
    }
}

}  // namespace scaleaxis::inline v1
