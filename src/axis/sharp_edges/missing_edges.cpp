// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/missing_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/sharp_edges/creases.hpp"
#include "axis/sharp_edges/edge_lines.hpp"
#include "axis/sharp_edges/ways.hpp"
#include "base/disjoint_sets.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/sharp_edges.hpp"
#include "spatial/point_tree.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Degrees. Sheets of less than the second are mostly filtered, and lines may be those of rough surfaces.
constexpr double kLeastAngle = 40.0;
constexpr double kClearAngle = 60.0;
constexpr double kMostAngle = 165.0;      // blades
constexpr double kOnEdge = 0.02;          // tolerances: nearer places lie on the edge
constexpr double kBesideEdge = 0.1;       // tolerances: or these, if no other edge is nearer; rows see planes of facets
constexpr double kLeastGap = 0.1;         // tolerances
constexpr double kLeastLine = 1.0;        // tolerances: shorter lines are those of rough surfaces
constexpr double kLeastFaintLine = 8.0;   // the same for lines that are not clear
constexpr double kPlaceStep = 1.0;        // tolerances, between places
constexpr double kLineSag = 0.01;         // tolerances, of the line between places
constexpr double kMaxGapStretch = 2.0;    // of the edge and the ways to it: the way through the complex
constexpr double kMostOutside = 0.5;      // tolerances: how far balls of a strip may stick out of the solid
constexpr double kMostLeft = 0.1;         // of a line: where more is not reached, it stays as it was
constexpr double kLeastSeen = 0.5;        // of the places of a strip
constexpr double kLeastWayRadius = 0.65;  // tolerances: where no ball of a way is larger, the wall is thin
constexpr double kLeastRadiusUnseen = 1.0;  // the same beside lines of which the border has shown little
constexpr double kFootReach = 2.0;          // of the way to the nearest vertex: how far the foot of a corner may be
constexpr double kSimilarFeet = 1.1;        // so many times the least distance in radii: then the nearest one counts
constexpr double kMostOfLoop = 0.34;        // of a closed line, for one strip
constexpr double kShortGap = 3.0;           // tolerances: between places that are reached, the mesh is enough

// Across from an edge, how far the surface may be from the plane there, in tolerances, and in how many of its places.
constexpr double kAcross = 0.75;
constexpr double kMostRise = 0.03;
constexpr double kLeastFlat = 0.8;

// Of the length of lines that hang together: where the border has shown less, walls must be thicker.
constexpr double kLeastReached = 0.25;

// A part of a line between two ends that are reached or corners.
struct LineGap {
    Index line;
    std::array<double, 2> positions;
    std::array<Index, 2> targets;  // vertices of radius 0; kNone: the end is not reached
    std::array<Index, 2> ends;     // their numbers, where the part ends with the line

    double length() const { return positions[1] - positions[0]; }
};

// Triangles, whose corners are vertices of a way through the complex, or places on the edge: -1 - place.
using Strip = std::vector<std::array<Index, 3>>;

class MissingEdges {
   public:
    MissingEdges(MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options,
                 SharpEdgeStatistics& statistics)
        : complex_(complex), solid_(solid), options_(options), statistics_(statistics) {}

    void run() {
        find_lines();
        for (const EdgeLine& line : lines_) {
            statistics_.known += line.length();
        }
        find_neighbors();
        if (on_edges_.empty() || inside_.empty()) {
            return;  // the border shows no edge, or there is nothing to go on from
        }
        curves_ = curve_edges(complex_);
        std::vector<std::vector<LineGap>> gaps_of_lines = find_gaps();
        const auto effort = [](const std::vector<LineGap>& gaps) {
            std::pair<std::ptrdiff_t, double> result;  // new corners, length
            for (const LineGap& gap : gaps) {
                result.first += std::ranges::count(gap.targets, kNone);
                result.second += gap.length();
            }
            return result;
        };
        std::ranges::stable_sort(gaps_of_lines, {}, effort);
        const std::size_t faces = complex_.faces.size();
        // Each line that is reached may reach corners for others.
        while (std::erase_if(gaps_of_lines, [&](const std::vector<LineGap>& gaps) { return close_line(gaps); }) > 0) {
            // once more
        }
        if (complex_.faces.size() > faces) {
            build_edges(complex_, curves_);
            label_sheets(complex_);
        }
    }

   private:
    void find_lines() {
        std::vector<SharpEdge> edges = solid_.sharp_edges(std::max(options_.angle, kLeastAngle));
        std::erase_if(edges, [&](const SharpEdge& edge) {
            const auto& [a, b] = edge.normals;
            // In a wedge the radius is the distance from the edge times the cosine of half the angle.
            const double growth = std::sqrt(std::max(0.0, 0.5 * (1.0 + dot(a, b))));
            return angle_between(a, b) > kMostAngle || options_.scale * growth >= 1.0;
        });
        lines_ = edge_lines(edges);
        const auto is_clear = [](const std::array<Point, 2>& normals) {
            return angle_between(normals[0], normals[1]) >= kClearAngle;
        };
        std::erase_if(lines_, [&](const EdgeLine& line) {
            const double least = std::ranges::all_of(line.normals, is_clear) ? kLeastLine : kLeastFaintLine;
            return line.length() < least * options_.tolerance;
        });
    }

    // Do plane faces, or those of cylinders and cones, meet in a line, and not a rough surface?
    bool is_flat(const EdgeLine& line) const {
        const double step = kPlaceStep * options_.tolerance;
        const EdgeLine part = section_of(line, 0.0, line.length(), step, kLineSag * options_.tolerance);
        std::vector<Point> points;  // two beside each place
        for (std::size_t k = 1; k < part.points.size(); ++k) {
            const Point place = midpoint(part.points[k - 1], part.points[k]);
            const Point direction = unit(part.points[k] - part.points[k - 1]);
            const auto& [a, b] = part.normals[k - 1];
            for (const auto& [normal, other] : {std::pair(a, b), std::pair(b, a)}) {
                const Point across = cross(normal, direction);
                const double sign = dot(across, other) < 0.0 ? 1.0 : -1.0;
                points.push_back(place + (sign * kAcross * options_.tolerance) * across);
            }
        }
        const std::vector<double> bounds(points.size(), kMostRise * options_.tolerance);
        const std::vector<std::optional<Point>> nearest = nearest_of(solid_, points, bounds);
        std::size_t flat = 0;
        for (std::size_t k = 0; k < nearest.size(); k += 2) {
            flat += nearest[k] && nearest[k + 1] ? 1 : 0;
        }
        return 2.0 * static_cast<double>(flat) >= kLeastFlat * static_cast<double>(nearest.size());
    }

    bool is_on_edge(Index v) const { return is_on_sharp_edge(complex_, v); }

    void find_neighbors() {
        std::vector<std::array<Index, 2>> inside;
        for (const auto& [a, b] : complex_.edges) {
            if (!is_on_edge(a) && !is_on_edge(b)) {
                inside.push_back({a, b});
            } else if (is_on_edge(a) && is_on_edge(b)) {
                edges_.insert({a, b});
            } else {
                feet_[is_on_edge(a) ? a : b].insert(is_on_edge(a) ? b : a);
            }
        }
        neighbors_ = grouped_both_ways(complex_.vertices.size(), inside);
        for (Index v = 0; v < static_cast<Index>(complex_.vertices.size()); ++v) {
            std::vector<Index>& list = is_on_edge(v) ? on_edges_ : inside_;
            list.push_back(v);
        }
    }

    PointTree tree_of(const std::vector<Index>& vertices) const {
        std::vector<Point> points;
        for (const Index v : vertices) {
            points.push_back(complex_.vertices[v]);
        }
        return build_point_tree(points);
    }

    // The parts of lines that are not reached.
    std::vector<std::vector<LineGap>> find_gaps() {
        for (const EdgeLine& line : lines_) {
            next_end_ = std::max({next_end_, line.ends[0] + 1, line.ends[1] + 1});
        }
        const std::vector<std::vector<Reached>> reached_on = reached_on_lines();
        std::vector<std::vector<LineGap>> gaps;
        std::vector<double> missing;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            const EdgeLine& line = lines_[i];
            const std::vector<Reached>& reached = reached_on[i];
            note_corners(line, reached);
            gaps.push_back(gaps_on(static_cast<Index>(i), reached));
            missing.push_back(0.0);
            for (const LineGap& gap : gaps.back()) {
                missing.back() += gap.length();
            }
        }
        is_seen_ = are_seen(missing);
        for (std::vector<LineGap>& of_line : gaps) {
            std::erase_if(of_line, [&](const LineGap& gap) { return gap.length() <= kLeastGap * options_.tolerance; });
        }
        std::erase_if(gaps, [&](const std::vector<LineGap>& of_line) {
            return of_line.empty() || !is_flat(lines_[of_line.front().line]);
        });
        return gaps;
    }

    // A vertex on a line, and how far along it that is.
    using Reached = std::pair<double, Index>;

    // The vertices on each line in order, each where it is nearest to the line.
    std::vector<std::vector<Reached>> reached_on_lines() const {
        using Here = std::pair<double, double>;  // how far from the line, and along it
        const PointTree tree = tree_of(on_edges_);
        const double reach = kBesideEdge * options_.tolerance;
        std::vector<std::map<Index, Here>> found(lines_.size());
        std::map<Index, double> least;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            const EdgeLine& line = lines_[i];
            for (std::size_t k = 1; k < line.points.size(); ++k) {
                const std::array ends{line.points[k - 1], line.points[k]};
                const double radius = 0.5 * distance(ends[0], ends[1]) + reach;
                for_each_point_near(tree, midpoint(ends[0], ends[1]), radius, [&](Index at, double) {
                    const auto [place, along] = nearest_on(ends, tree.points[at]);
                    const Index v = on_edges_[tree.order[at]];
                    const Here here{distance(place, tree.points[at]), line.positions[k - 1] + along};
                    if (here.first <= reach) {
                        Here& known = found[i].try_emplace(v, here).first->second;
                        known = std::min(known, here);
                        double& least_of_all = least.try_emplace(v, here.first).first->second;
                        least_of_all = std::min(least_of_all, here.first);
                    }
                });
            }
        }
        std::vector<std::vector<Reached>> result(lines_.size());
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            for (const auto& [v, here] : found[i]) {
                if (here.first <= std::max(same_place_, least.at(v))) {
                    result[i].emplace_back(here.second, v);
                }
            }
            std::ranges::sort(result[i]);
        }
        return result;
    }

    // Between places that are reached, and between these and the ends of the line.
    std::vector<LineGap> gaps_on(Index number, std::vector<Reached> at) {
        const EdgeLine& line = lines_[number];
        if (line.is_closed()) {
            at = with_cuts(line, std::move(at));
        } else {
            if (at.empty() || at.front().first > same_place_) {
                at.insert(at.begin(), {0.0, kNone});
            }
            if (at.back().first < line.length() - same_place_) {
                at.emplace_back(line.length(), kNone);
            }
        }
        const std::vector<Index> ends = numbers_of_ends(line, at);
        const auto is_strip = [&](Index v, Index w) {
            return v != kNone && w != kNone && (v == w || edges_.contains(std::minmax(v, w)));
        };
        std::vector<LineGap> gaps;
        for (std::size_t k = 1; k < at.size(); ++k) {
            const auto& [from, v] = at[k - 1];
            const auto& [to, w] = at[k];
            if (!is_strip(v, w)) {
                gaps.push_back({number, {from, to}, {v, w}, {ends[k - 1], ends[k]}});
            }
        }
        return gaps;
    }

    // The places on a closed line, the first one again as the last, with others between those that are far apart: the
    // shortest way along a part of it is to lie below this part.
    static std::vector<Reached> with_cuts(const EdgeLine& line, std::vector<Reached> at) {
        if (at.empty()) {
            at.emplace_back(0.0, kNone);
        }
        at.emplace_back(at.front().first + line.length(), at.front().second);
        std::vector<Reached> result{at.front()};
        for (std::size_t k = 1; k < at.size(); ++k) {
            const auto& [from, v] = at[k - 1];
            const auto& [to, w] = at[k];
            const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / (kMostOfLoop * line.length()))));
            for (int i = 1; i < pieces; ++i) {
                result.emplace_back(from + (to - from) * i / pieces, kNone);
            }
            result.push_back(at[k]);
        }
        return result;
    }

    // Of the ends of gaps that are not reached: those of the line, or new ones where a closed line is cut.
    std::vector<Index> numbers_of_ends(const EdgeLine& line, const std::vector<Reached>& at) {
        std::vector<Index> numbers(at.size(), kNone);
        numbers.front() = line.ends[0];
        numbers.back() = line.ends[1];
        if (line.is_closed()) {
            for (std::size_t k = 0; k + 1 < at.size(); ++k) {
                numbers[k] = next_end_++;
            }
            numbers.back() = numbers.front();
        }
        return numbers;
    }

    // Which lines hang together with others of which the border has shown a part that is large enough.
    std::vector<std::uint8_t> are_seen(const std::vector<double>& missing) const {
        DisjointSets sets(next_end_ + static_cast<Index>(lines_.size()));
        const auto set_of = [&](std::size_t line) { return sets.find(next_end_ + static_cast<Index>(line)); };
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            for (const Index end : lines_[i].ends) {
                if (end != kNone) {
                    sets.join(end, next_end_ + static_cast<Index>(i));
                }
            }
        }
        std::map<Index, std::array<double, 2>> lengths;  // missing, and all
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            lengths[set_of(i)][0] += missing[i];
            lengths[set_of(i)][1] += lines_[i].length();
        }
        std::vector<std::uint8_t> result(lines_.size());
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            const auto& [part, all] = lengths[set_of(i)];
            result[i] = part <= (1.0 - kLeastReached) * all ? 1 : 0;
        }
        return result;
    }

    void note_corners(const EdgeLine& line, const std::vector<Reached>& reached) {
        if (line.is_closed()) {
            return;
        }
        for (const auto& [position, v] : reached) {
            if (position <= same_place_) {
                corners_.try_emplace(line.ends[0], v);
            } else if (position >= line.length() - same_place_) {
                corners_.try_emplace(line.ends[1], v);
            }
        }
    }

    Index corner_at(Index number) const {
        const auto known = corners_.find(number);
        return known == corners_.end() ? kNone : known->second;
    }

    // The vertices from which a strip may begin at a target: those that have an edge to it; of a new corner one
    // near it.
    std::vector<Index> feet_of(Index target, const Point& place, bool is_corner) {
        if (target != kNone) {
            const std::set<Index>& feet = feet_[target];
            return {feet.begin(), feet.end()};
        }
        if (inside_tree_.points.empty()) {
            inside_tree_ = tree_of(inside_);
        }
        const Index nearest = inside_[inside_tree_.order[nearest_point(inside_tree_, place).position]];
        if (!is_corner) {
            return {nearest};
        }
        // In the wedge at the place no ball is larger beside its distance than one that touches all faces there.
        const double least = distance(complex_.vertices[nearest], place);
        std::vector<std::pair<double, Index>> near;  // distances
        double best = kInfinity;                     // of the distances, in radii
        for_each_point_near(inside_tree_, place, kFootReach * least, [&](Index at, double) {
            const Index v = inside_[inside_tree_.order[at]];
            near.emplace_back(distance(complex_.vertices[v], place), v);
            best = std::min(best, near.back().first / complex_.radii[v]);
        });
        std::erase_if(near,
                      [&](const auto& foot) { return foot.first > kSimilarFeet * best * complex_.radii[foot.second]; });
        return {std::ranges::min(near).second};
    }

    // What undoes the strips of a line: an edge is reached, but for short parts, or stays as rows have left it.
    struct Before {
        std::size_t vertices;
        std::size_t faces;
        std::size_t boundary_vertices;
        SharpEdgeStatistics statistics;
    };

    Before remember() {
        feet_before_.clear();
        return {complex_.vertices.size(), complex_.faces.size(), complex_.boundary_vertices.size(), statistics_};
    }

    void undo(const Before& before) {
        complex_.vertices.resize(before.vertices);
        complex_.radii.resize(before.vertices);
        complex_.vertex_origins.resize(before.vertices);
        complex_.faces.offsets.resize(before.faces + 1);
        complex_.faces.items.resize(static_cast<std::size_t>(complex_.faces.offsets.back()));
        complex_.face_angles.resize(before.faces);
        complex_.face_sheets.resize(before.faces);
        if (has_contacts_) {
            complex_.face_contacts.resize(before.faces);
            complex_.boundary_vertices.resize(before.boundary_vertices);
            complex_.boundary_vertex_balls.resize(before.boundary_vertices);
        }
        statistics_ = before.statistics;
        for (auto& [v, feet] : feet_before_) {
            feet_[v] = std::move(feet);
        }
        std::erase_if(corners_,
                      [&](const auto& corner) { return std::cmp_greater_equal(corner.second, before.vertices); });
    }

    // Reaches a line but for short parts, or leaves it as it was.
    bool close_line(const std::vector<LineGap>& gaps) {
        stop_if_cancelled();
        const Before before = remember();
        double left = 0.0;
        for (const LineGap& gap : gaps) {
            left += close(gap) ? 0.0 : gap.length();
        }
        const bool is_reached = left <= kMostLeft * lines_[gaps.front().line].length();
        if (!is_reached) {
            undo(before);
        }
        return is_reached;
    }

    // Adds the strip of a gap, if there is one that may be there.
    bool close(LineGap gap) {
        const EdgeLine& line = lines_[gap.line];
        for (int k = 0; k < 2; ++k) {
            if (gap.targets[k] == kNone) {
                gap.targets[k] = corner_at(gap.ends[k]);  // another strip may have reached it
            }
        }
        if (gap.targets[0] != kNone && gap.targets[0] == gap.targets[1]) {
            return false;
        }
        const double step = std::min(kPlaceStep * options_.tolerance, 0.5 * gap.length());
        const EdgeLine part = section_of(line, gap.positions[0], gap.positions[1], step, kLineSag * options_.tolerance);
        if (part.points.size() < 3) {
            return false;
        }
        const std::vector<Index> way = way_below(part, gap.targets, !line.is_closed());
        if (way.empty()) {
            return false;
        }
        const Strip strip = strip_between(way, part);
        const bool is_seen = is_seen_[gap.line] != 0;
        const bool is_short = is_seen && gap.length() <= kShortGap * options_.tolerance;
        const bool is_known = is_short && std::ranges::count(gap.targets, kNone) == 0;
        const double least_radius = is_short ? 0.0 : is_seen ? kLeastWayRadius : kLeastRadiusUnseen;
        if ((!is_known && !sees_edge(strip, part)) ||
            !stays_inside(strip, way, part, least_radius * options_.tolerance)) {
            return false;
        }
        add(strip, part, gap);
        return true;
    }

    // Through the complex, along the edge, from a foot of the one target to one of the other.
    std::vector<Index> way_below(const EdgeLine& part, const std::array<Index, 2>& targets, bool has_corners) {
        const std::vector<Index> from = feet_of(targets[0], part.points.front(), has_corners);
        const std::vector<Index> to = feet_of(targets[1], part.points.back(), has_corners);
        const auto way_to_edge = [&](Index v) {
            return distance(complex_.vertices[v], nearest_on(part.points, complex_.vertices[v]).first);
        };
        const double reach = kCreaseReach * options_.tolerance;
        const auto is_near = [&](Index v) { return way_to_edge(v) <= reach; };
        if (!std::ranges::any_of(from, is_near) || !std::ranges::any_of(to, is_near)) {
            return {};
        }
        // Away from the edge ways are longer.
        const auto cost = [&](Index v, Index next) {
            const double away = way_to_edge(next);
            return away > reach
                       ? kInfinity
                       : distance(complex_.vertices[v], complex_.vertices[next]) * (1.0 + away / options_.tolerance);
        };
        const double most = kMaxGapStretch * (part.length() + 2.0 * reach) * (1.0 + kCreaseReach);
        return cheapest_way(
            neighbors_, from, most, [&](Index v) { return std::ranges::binary_search(to, v); }, cost);
    }

    // Triangles between a way and the places above it.
    Strip strip_between(const std::vector<Index>& way, const EdgeLine& part) const {
        Strip strip;
        const std::size_t last = part.points.size() - 1;
        const auto place = [](std::size_t k) { return -1 - static_cast<Index>(k); };
        std::size_t k = 0;
        for (std::size_t i = 0; i + 1 < way.size() || k < last;) {
            const bool goes_on = k == last || (i + 1 < way.size() &&
                                               squared_distance(complex_.vertices[way[i + 1]], part.points[k]) <
                                                   squared_distance(complex_.vertices[way[i]], part.points[k + 1]));
            if (goes_on) {
                strip.push_back({way[i], way[i + 1], place(k)});
                ++i;
            } else {
                strip.push_back({way[i], place(k + 1), place(k)});
                ++k;
            }
        }
        return strip;
    }

    static bool is_place(Index corner) { return corner < 0; }
    static std::size_t number_of(Index corner) { return static_cast<std::size_t>(-1 - corner); }
    const Point& at(Index corner, const EdgeLine& part) const {
        return is_place(corner) ? part.points[number_of(corner)] : complex_.vertices[corner];
    }

    // Is the edge what is seen from near it, at most of its places?
    bool sees_edge(const Strip& strip, const EdgeLine& part) const {
        std::vector<Point> points;
        std::vector<Point> places;
        for (const std::array<Index, 3>& corners : strip) {
            const auto [v, second, third] = corners;
            const std::size_t k = number_of(third);
            if (!is_place(second) || k == 0) {
                continue;
            }
            const Point& place = part.points[k];
            const Point way = complex_.vertices[v] - place;
            // Near the ends other planes are near.
            const double free = std::min(part.positions[k], part.length() - part.positions[k]);
            const double aside = std::min(kAsideOfEdge, kAsideOfEdge * free / norm(way));
            points.push_back(place + aside * way);
            places.push_back(place);
        }
        const std::vector<std::optional<Crease>> creases = creases_near(solid_, points, options_, false);
        std::size_t seen = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const bool is_seen = creases[i] && distance(creases[i]->place, places[i]) <= distance(points[i], places[i]);
            seen += is_seen ? 1 : 0;
        }
        return static_cast<double>(seen) >= kLeastSeen * static_cast<double>(points.size());
    }

    std::vector<double> distances_to_boundary(const std::vector<Point>& points) const {
        std::vector<double> result;
        for (const std::optional<Point>& nearest :
             nearest_of(solid_, points, std::vector<double>(points.size(), kInfinity))) {
            result.push_back(nearest ? distance(points[result.size()], *nearest) : 0.0);
        }
        return result;
    }

    // Are the balls in the middle of the triangles in the solid, if those at their corners touch it? And is one of
    // these large enough?
    bool stays_inside(const Strip& strip, const std::vector<Index>& way, const EdgeLine& part,
                      double least_radius) const {
        std::vector<Point> vertices;
        for (const Index v : way) {
            vertices.push_back(complex_.vertices[v]);
        }
        const std::vector<double> radii = distances_to_boundary(vertices);
        if (std::ranges::max(radii) < least_radius) {
            return false;
        }
        std::map<Index, double> radius_of;
        for (std::size_t i = 0; i < way.size(); ++i) {
            radius_of[way[i]] = radii[i];
        }
        std::vector<Point> middles;
        std::vector<double> wanted;
        for (const std::array<Index, 3>& corners : strip) {
            Point middle;
            double radius = 0.0;
            for (const Index corner : corners) {
                middle = middle + (1.0 / 3.0) * at(corner, part);
                radius += is_place(corner) ? 0.0 : radius_of.at(corner) / 3.0;
            }
            middles.push_back(middle);
            wanted.push_back(radius);
        }
        const std::vector<double> room = distances_to_boundary(middles);
        const std::vector<std::uint8_t> sides = sides_of(solid_, middles);
        for (std::size_t f = 0; f < strip.size(); ++f) {
            if (sides[f] == 0 || wanted[f] > room[f] + kMostOutside * options_.tolerance) {
                return false;
            }
        }
        return true;
    }

    Index add_vertex(const Point& place) {
        ++statistics_.points;
        return scaleaxis::add_vertex(complex_, {place, 0.0}, {VertexKind::kSharpEdge});
    }

    void add(const Strip& strip, const EdgeLine& part, const LineGap& gap) {
        const std::size_t last = part.points.size() - 1;
        std::vector<Index> targets;
        for (std::size_t k = 0; k <= last; ++k) {
            const bool is_end = k == 0 || k == last;
            const int end = k == 0 ? 0 : 1;
            if (is_end && gap.targets[end] != kNone) {
                targets.push_back(gap.targets[end]);
                continue;
            }
            targets.push_back(add_vertex(part.points[k]));
            if (is_end) {
                corners_.emplace(gap.ends[end], targets.back());
                statistics_.corners += lines_[gap.line].is_closed() ? 0 : 1;
            }
        }
        for (std::array<Index, 3> corners : strip) {
            const auto& [a, b] = part.normals[std::min(number_of(corners[2]), last - 1)];
            for (Index& corner : corners) {
                corner = is_place(corner) ? targets[number_of(corner)] : corner;
            }
            note_feet(corners);
            const auto contacts = has_contacts_ ? std::optional(added_contacts(corners, {a, b})) : std::nullopt;
            add_face(complex_, corners, {0.5 * angle_between(a, b), 0, contacts});
        }
        statistics_.length += part.length();
    }

    void note_feet(const std::array<Index, 3>& corners) {
        for (const Index target : corners) {
            for (const Index foot : corners) {
                if (is_on_edge(target) && !is_on_edge(foot)) {
                    std::set<Index>& feet = feet_[target];
                    feet_before_.try_emplace(target, feet);
                    feet.insert(foot);
                }
            }
        }
    }

    // Where the ball between the vertices of a triangle that lie inside touches the planes on both sides of the edge.
    std::array<Index, 2> added_contacts(const std::array<Index, 3>& corners, const std::array<Point, 2>& normals) {
        std::vector<Index> feet;
        std::ranges::copy_if(corners, std::back_inserter(feet), [&](Index corner) { return !is_on_edge(corner); });
        const auto [middle, radius] = mean_ball(complex_, feet);
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
    const SharpEdgeOptions& options_;
    SharpEdgeStatistics& statistics_;
    std::vector<std::uint8_t> is_seen_;  // of each line: see kLeastReached
    double same_place_ = kOnEdge * options_.tolerance;
    bool has_contacts_ = complex_.has_contacts();
    std::vector<EdgeLine> lines_;
    std::vector<std::array<Index, 2>> curves_;
    IndexLists neighbors_;                          // of vertices of positive radius, among themselves
    std::vector<Index> on_edges_;                   // vertices of radius 0, as given
    std::vector<Index> inside_;                     // the others
    PointTree inside_tree_;                         // of these, when needed
    std::map<Index, std::set<Index>> feet_;         // of vertices of radius 0: those of positive radius beside them
    std::map<Index, std::set<Index>> feet_before_;  // what the strips of a line have changed of them
    std::set<std::pair<Index, Index>> edges_;       // between vertices of radius 0, as given
    std::map<Index, Index> corners_;                // ends of lines that are reached
    Index next_end_ = 0;                            // numbers of ends are less
};

}  // namespace

void reach_missing_edges(MedialComplex& complex, const Solid& solid, const SharpEdgeOptions& options,
                         SharpEdgeStatistics& statistics) {
    MissingEdges(complex, solid, options, statistics).run();
}

}  // namespace scaleaxis::inline v1
