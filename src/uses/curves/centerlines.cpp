// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/centerlines.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "axis/cheapest_ways.hpp"
#include "base/faults.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "spatial/extent.hpp"
#include "uses/curves/ways_out.hpp"

namespace scaleaxis::inline v1 {
namespace {

using Edge = std::array<Index, 2>;

Edge ordered(Index a, Index b) { return {std::min(a, b), std::max(a, b)}; }

std::map<Edge, Index> branches_of_edges(const Skeleton& skeleton) {
    std::map<Edge, Index> result;
    for (Index b = 0; b < static_cast<Index>(skeleton.branches.size()); ++b) {
        const std::span<const Index> nodes = skeleton.branches[b];
        for (std::size_t k = 1; k < nodes.size(); ++k) {
            result.emplace(ordered(nodes[k - 1], nodes[k]), b);
        }
    }
    return result;
}

IndexLists neighbors_on_branches(const Skeleton& skeleton) {
    std::vector<Edge> edges;
    for (const auto& [edge, branch] : branches_of_edges(skeleton)) {
        edges.push_back(edge);
    }
    return grouped_both_ways(skeleton.nodes.size(), edges);
}

// The node of each component that its tree grows from: the one that is given, the thickest end, or if it has none the
// thickest node.
std::vector<Index> roots_of(const Skeleton& skeleton, const std::vector<Index>& degree) {
    std::vector<Index> roots;
    const auto key = [&](Index n) { return std::tuple(n == skeleton.root, degree[n] == 1, skeleton.radii[n]); };
    for (Index n = 0; n < static_cast<Index>(skeleton.nodes.size()); ++n) {
        const Index component = skeleton.node_components[n];
        if (component == static_cast<Index>(roots.size())) {
            roots.push_back(n);
        } else if (key(n) > key(roots[component])) {
            roots[component] = n;
        }
    }
    return roots;
}

/// Along edges, up to the goal if that is reached.
CheapestWays shortest_ways(const Skeleton& skeleton, const IndexLists& neighbors, Index from, Index goal = kNone) {
    return {neighbors, std::array{from}, [&](Index n) { return n == goal; },
            [&](Index n, Index next) { return distance(skeleton.nodes[n], skeleton.nodes[next]); }};
}

/// The branch of the edge between each node of a tree and its parent; of a root `kNone`.
std::vector<Index> branches_to_parents(const Skeleton& skeleton, const SkeletonTree& tree) {
    const std::map<Edge, Index> branches = branches_of_edges(skeleton);
    std::vector<Index> result(tree.nodes.size(), kNone);
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        if (const Index parent = tree.parents[i]; parent != kNone) {
            result[i] = branches.at(ordered(tree.nodes[i], tree.nodes[parent]));
        }
    }
    return result;
}

// A window of the fit has at least so many nodes on each side: two more than a third derivative needs even out noise.
constexpr std::size_t kLeastNodes = 4;
constexpr double kWindow = 2.0;  // radii on each side, see `BranchGeometry`

/// Value and derivatives at 0.
using Jet = std::array<double, 4>;

/// Derivatives at 0 of the cubic that fits values at `t` best with weights, by orthogonal polynomials (G. Forsythe,
/// "Generation and use of orthogonal polynomials for data-fitting with a digital computer", 1957); of a lower degree
/// where there are too few values.
std::array<Point, 4> fitted(const std::vector<double>& t, const std::vector<double>& weights,
                            const std::vector<Point>& values) {
    std::array<Point, 4> result{};
    std::vector<double> last(t.size(), 0.0);
    std::vector<double> now(t.size(), 1.0);
    Jet last_jet{};
    Jet jet{1.0, 0.0, 0.0, 0.0};
    double last_square = 0.0;
    for (std::size_t degree = 0; degree < std::min<std::size_t>(4, t.size()); ++degree) {
        double square = 0.0;
        double mean = 0.0;
        Point coefficient{};
        for (std::size_t i = 0; i < t.size(); ++i) {
            square += weights[i] * now[i] * now[i];
            mean += weights[i] * t[i] * now[i] * now[i];
            coefficient = coefficient + weights[i] * now[i] * values[i];
        }
        if (!(square > 0.0)) {
            break;
        }
        for (std::size_t d = 0; d < 4; ++d) {
            result[d] = result[d] + jet[d] / square * coefficient;
        }
        const double alpha = mean / square;
        const double beta = last_square > 0.0 ? square / last_square : 0.0;
        for (std::size_t i = 0; i < t.size(); ++i) {
            last[i] = std::exchange(now[i], (t[i] - alpha) * now[i] - beta * last[i]);
        }
        Jet next{};
        for (std::size_t d = 0; d < 4; ++d) {
            next[d] = -alpha * jet[d] - beta * last_jet[d] + (d > 0 ? static_cast<double>(d) * jet[d - 1] : 0.0);
        }
        last_jet = std::exchange(jet, next);
        last_square = square;
    }
    return result;
}

/// Derivatives of a curve by its length at node `k`. Of a loop the window goes around.
std::array<Point, 4> derivatives_at(const std::vector<Point>& places, const std::vector<double>& abscissas,
                                    bool is_loop, double radius, std::size_t k) {
    const auto count = static_cast<std::ptrdiff_t>(places.size());
    const double length = abscissas.back();
    const std::ptrdiff_t period = count - 1;
    const auto at = [&](std::ptrdiff_t i) { return is_loop ? ((i % period) + period) % period : i; };
    const auto way = [&](std::ptrdiff_t i) {
        const double turns = is_loop ? std::floor(static_cast<double>(i) / static_cast<double>(period)) : 0.0;
        return abscissas[at(i)] + turns * length - abscissas[k];
    };
    // Half a loop at most on each side, so that no node comes twice.
    const auto middle = static_cast<std::ptrdiff_t>(k);
    const std::ptrdiff_t first = is_loop ? middle - (period - 1) / 2 : 0;
    const std::ptrdiff_t last = is_loop ? middle + (period - 1) / 2 : count - 1;
    const auto least = static_cast<std::ptrdiff_t>(kLeastNodes);
    const double width = std::max({kWindow * radius, std::abs(way(std::max(first, middle - least))),
                                   std::abs(way(std::min(last, middle + least)))});
    std::vector<double> t;
    std::vector<double> weights;
    std::vector<Point> values;
    const auto add = [&](std::ptrdiff_t i) {
        const double along = way(i) / width;
        if (std::abs(along) > 1.0) {
            return false;
        }
        t.push_back(along);
        weights.push_back(1.0 - 0.75 * along * along);  // falls to a quarter, so that nodes come and go softly
        values.push_back(places[at(i)] - places[k]);
        return true;
    };
    for (std::ptrdiff_t i = middle; i >= first && add(i); --i) {
    }
    for (std::ptrdiff_t i = middle + 1; i <= last && add(i); ++i) {
    }
    std::array<Point, 4> result = fitted(t, weights, values);
    double unit_of = 1.0;
    for (Point& derivative : result) {
        derivative = unit_of * derivative;
        unit_of /= width;
    }
    return result;
}

// Turns a normal of one tangent into one of the next by the rotation that takes the tangents into each other.
Point transported(const Point& normal, const Point& from, const Point& to) {
    const double cosine = dot(from, to);
    const Point turned = cosine > -1.0 ? normal - dot(normal, to) / (1.0 + cosine) * (from + to) : normal;
    return unit(turned - dot(turned, to) * to);
}

}  // namespace

SkeletonTree tree_of(const Skeleton& skeleton) {
    const std::vector<Index> degree = degrees(skeleton);
    const std::vector<Index> branch_degree = branch_degrees(skeleton);
    const IndexLists neighbors = neighbors_on_branches(skeleton);
    SkeletonTree tree;
    std::vector<Index> places(skeleton.nodes.size(), kNone);
    std::vector<Index> roots = roots_of(skeleton, degree);
    if (!skeleton.faces.empty()) {
        for (Index node = 0; node < static_cast<Index>(skeleton.nodes.size()); ++node) {
            roots.push_back(node);
        }
    }
    for (const Index root : roots) {
        const bool is_in_sheet = branch_degree[root] == 0 && degree[root] > 0;
        if (places[root] != kNone || is_in_sheet) {
            continue;
        }
        const CheapestWays ways = shortest_ways(skeleton, neighbors, root);
        std::vector<Edge> waiting{{root, kNone}};  // node, and the place of its parent
        while (!waiting.empty()) {
            const auto [node, parent] = waiting.back();
            waiting.pop_back();
            places[node] = static_cast<Index>(tree.nodes.size());
            tree.nodes.push_back(node);
            tree.parents.push_back(parent);
            for (std::size_t k = neighbors[node].size(); k-- > 0;) {
                if (const Index next = neighbors[node][k]; ways.arrivals.at(next).previous == node) {
                    waiting.push_back({next, places[node]});
                } else if (ways.arrivals.at(node).previous != next && node < next) {
                    tree.cuts.push_back({node, next});
                }
            }
        }
    }
    return tree;
}

std::vector<Diagnostic> tree_warnings(const Skeleton& skeleton) {
    const SkeletonTree tree = tree_of(skeleton);
    std::vector<Diagnostic> result;
    const auto trees = std::ranges::count(tree.parents, kNone);
    if (!tree.cuts.empty()) {
        const Point place = midpoint(skeleton.nodes[tree.cuts[0][0]], skeleton.nodes[tree.cuts[0][1]]);
        Words text;
        text << "trees have no loops: " << tree.cuts.size() << (tree.cuts.size() == 1 ? " is" : " are")
             << " cut, the first near (" << place.x << ", " << place.y << ", " << place.z
             << "); GraphML, JSON and VTP keep them";
        result.push_back({.code = "skeleton.loops", .message = text.str(), .place = place});
    }
    if (trees > 1) {
        result.push_back({.code = "skeleton.trees",
                          .message = "the skeleton has " + std::to_string(trees) +
                                     " parts, and the file a tree for each; NEURON and others expect one: remove "
                                     "small parts of the input, or write labels one by one"});
    }
    return result;
}

BranchPlaces branch_places(const Skeleton& skeleton) {
    const SkeletonTree tree = tree_of(skeleton);
    const std::vector<Index> branches = branches_to_parents(skeleton, tree);
    const std::size_t count = tree.nodes.size();
    // A tree is walked depth first, so its ends come in the order of centerlines.
    std::vector<Index> centerlines(count, kNone);
    std::vector<Index> order(skeleton.nodes.size());
    std::vector<char> has_child(count);
    for (std::size_t i = 0; i < count; ++i) {
        order[tree.nodes[i]] = static_cast<Index>(i);
        if (tree.parents[i] != kNone) {
            has_child[tree.parents[i]] = 1;
        }
    }
    Index ends = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (has_child[i] == 0 && tree.parents[i] != kNone) {
            const Index end = ends++;
            for (auto j = static_cast<Index>(i); j != kNone && centerlines[j] == kNone; j = tree.parents[j]) {
                centerlines[j] = end;
            }
        }
    }
    BranchPlaces result;
    result.centerlines.assign(skeleton.branches.size(), kNone);
    result.tracts.assign(skeleton.branches.size(), 0);
    std::vector<Index> tracts(count, kNone);
    for (std::size_t i = 0; i < count; ++i) {
        const Index parent = tree.parents[i];
        if (parent == kNone) {
            continue;
        }
        tracts[i] = tracts[parent] + (branches[i] == branches[parent] ? 0 : 1);
        if (Index& centerline = result.centerlines[branches[i]]; centerline == kNone) {
            centerline = centerlines[i];
            result.tracts[branches[i]] = tracts[i];
        }
    }
    for (std::size_t b = 0; b < skeleton.branches.size(); ++b) {
        const std::span<const Index> nodes = skeleton.branches[b];
        result.is_backwards.push_back(order[nodes.front()] > order[nodes.back()] ? 1 : 0);
    }
    return result;
}

BranchGeometry branch_geometry(const Skeleton& skeleton, Index branch) {
    const std::span<const Index> nodes = skeleton.branches[branch];
    const std::size_t count = nodes.size();
    std::vector<Point> places;
    BranchGeometry result;
    for (const Index n : nodes) {
        result.length += places.empty() ? 0.0 : distance(places.back(), skeleton.nodes[n]);
        result.abscissas.push_back(result.length);
        places.push_back(skeleton.nodes[n]);
    }
    const bool is_loop = count > 3 && nodes.front() == nodes.back();
    const double chord = distance(places.front(), places.back());
    result.tortuosity = chord > 0.0 ? result.length / chord - 1.0 : 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const double radius = skeleton.radii[nodes[k]];
        const auto [place, first, second, third] = derivatives_at(places, result.abscissas, is_loop, radius, k);
        const Point tangent = unit(first);
        const Point bend = cross(first, second);
        const double speed = norm(first);
        const double curvature = speed > 0.0 ? norm(bend) / (speed * speed * speed) : 0.0;
        // Where a window hardly turns the direction of the bend is rounding.
        const bool is_straight = !(curvature * kWindow * radius > kNegligible);
        const Point before = k > 0 ? result.transported.back() : normals_to(tangent)[0];
        result.transported.push_back(k > 0 ? transported(before, result.tangents.back(), tangent) : before);
        result.tangents.push_back(tangent);
        result.curvature.push_back(curvature);
        result.torsion.push_back(is_straight ? 0.0 : dot(bend, third) / squared_norm(bend));
        result.binormals.push_back(is_straight ? cross(tangent, result.transported.back()) : unit(bend));
        result.normals.push_back(is_straight ? result.transported.back() : cross(result.binormals.back(), tangent));
    }
    return result;
}

Index nearest_node(const Skeleton& skeleton, const Point& place) {
    if (skeleton.nodes.empty()) {
        throw UnusableInput("a skeleton without nodes has none that is nearest to a place");
    }
    require(is_usable(place), "a place on a skeleton must have finite coordinates");
    const auto away = [&](const Point& node) { return squared_distance(node, place); };
    return static_cast<Index>(std::ranges::min_element(skeleton.nodes, {}, away) - skeleton.nodes.begin());
}

Skeleton path_between(const Skeleton& skeleton, const Point& from, const Point& to) {
    const Index source = nearest_node(skeleton, from);
    const Index target = nearest_node(skeleton, to);
    const IndexLists neighbors = grouped_both_ways(skeleton.nodes.size(), skeleton.edges);
    const CheapestWays ways = shortest_ways(skeleton, neighbors, source, target);
    if (ways.goal == kNone) {
        throw UnusableInput("no curve leads from one end of the path to the other: they are in different parts");
    }
    Skeleton result;
    std::vector<Index> branch;
    for (const Index n : ways.way_to(target)) {
        const auto place = static_cast<Index>(result.nodes.size());
        result.nodes.push_back(skeleton.nodes[n]);
        result.radii.push_back(skeleton.radii[n]);
        if (!skeleton.sections.empty()) {
            result.sections.push_back(skeleton.sections[n]);
        }
        if (place > 0) {
            result.edges.push_back({place - 1, place});
        }
        branch.push_back(place);
    }
    const bool has_branch = branch.size() > 1;
    result.node_branches.assign(branch.size(), has_branch ? 0 : kNone);
    result.node_components.assign(branch.size(), 0);
    if (has_branch) {
        result.branches.push_back(branch);
    }
    result.root = 0;
    return result;
}

Skeleton resampled(const Skeleton& skeleton, double step) {
    require(step > 0.0 && std::isfinite(step), "the step of nodes along branches must be a number above 0");
    std::vector<char> stays(skeleton.nodes.size(), 1);
    for (std::size_t b = 0; b < skeleton.branches.size(); ++b) {
        const std::span<const Index> nodes = skeleton.branches[b];
        for (std::size_t k = 1; k + 1 < nodes.size(); ++k) {
            stays[nodes[k]] = 0;
        }
    }
    for (const Index n : skeleton.faces.items) {
        stays[n] = 1;
    }
    Skeleton result;
    std::vector<Index> moved(skeleton.nodes.size(), kNone);  // where each node of before has gone
    const auto add = [&](const Point& place, double radius, Index like) {
        result.nodes.push_back(place);
        result.radii.push_back(radius);
        result.node_branches.push_back(skeleton.node_branches[like]);
        result.node_components.push_back(skeleton.node_components[like]);
        return static_cast<Index>(result.nodes.size()) - 1;
    };
    for (Index n = 0; n < static_cast<Index>(skeleton.nodes.size()); ++n) {
        if (stays[n] != 0) {
            moved[n] = add(skeleton.nodes[n], skeleton.radii[n], n);
        }
    }
    std::set<Edge> edges;
    const std::map<Edge, Index> on_branches = branches_of_edges(skeleton);
    for (const Edge& edge : skeleton.edges) {
        if (on_branches.count(edge) == 0) {
            edges.insert(ordered(moved[edge[0]], moved[edge[1]]));
        }
    }
    for (std::size_t b = 0; b < skeleton.branches.size(); ++b) {
        const std::span<const Index> nodes = skeleton.branches[b];
        std::vector<double> ways{0.0};
        for (std::size_t k = 1; k < nodes.size(); ++k) {
            ways.push_back(ways.back() + distance(skeleton.nodes[nodes[k - 1]], skeleton.nodes[nodes[k]]));
        }
        // A loop is a triangle at least, and two branches between the same junctions are not one edge.
        const Edge ends = ordered(moved[nodes.front()], moved[nodes.back()]);
        const double least = ends[0] == ends[1] ? 3.0 : edges.contains(ends) ? 2.0 : 1.0;
        const double parts = std::max(least, std::ceil(ways.back() / step * (1.0 - 1e-12)));  // but for rounding
        std::vector<Index> branch{moved[nodes.front()]};
        std::size_t k = 1;
        for (double i = 1.0; i < parts; i += 1.0) {
            const double way = i / parts * ways.back();
            while (k + 1 < nodes.size() && ways[k] < way) {
                ++k;
            }
            const double share = ways[k] > ways[k - 1] ? (way - ways[k - 1]) / (ways[k] - ways[k - 1]) : 0.0;
            const Index a = nodes[k - 1];
            const Index c = nodes[k];
            branch.push_back(add(skeleton.nodes[a] + share * (skeleton.nodes[c] - skeleton.nodes[a]),
                                 skeleton.radii[a] + share * (skeleton.radii[c] - skeleton.radii[a]), a));
            result.node_branches[branch.back()] = static_cast<Index>(b);
        }
        branch.push_back(moved[nodes.back()]);
        for (std::size_t i = 1; i < branch.size(); ++i) {
            edges.insert(ordered(branch[i - 1], branch[i]));
        }
        result.branches.push_back(branch);
        for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
            if (stays[nodes[i]] == 0) {
                const double part = ways.back() > 0.0 ? ways[i] / ways.back() * parts : 0.0;
                moved[nodes[i]] = branch[static_cast<std::size_t>(part + 0.5)];
            }
        }
    }
    result.edges.assign(edges.begin(), edges.end());
    for (std::size_t f = 0; f < skeleton.faces.size(); ++f) {
        std::vector<Index> face(skeleton.faces[f].begin(), skeleton.faces[f].end());
        std::ranges::transform(face, face.begin(), [&](Index n) { return moved[n]; });
        result.faces.push_back(face);
    }
    result.vertex_nodes = each_of<Index>(skeleton.vertex_nodes, [&](Index n) { return moved[n]; });
    result.root = skeleton.root == kNone ? kNone : moved[skeleton.root];
    return result;
}

std::vector<Cylinder> cylinders(const Skeleton& skeleton) {
    const SkeletonTree tree = tree_of(skeleton);
    const std::vector<Index> branches = branches_to_parents(skeleton, tree);
    const std::size_t count = tree.nodes.size();
    // How thick the branch is that leads to a node: the mean over its nodes, as one of them may be thick by chance.
    std::vector<double> thickness(skeleton.branches.size());
    for (std::size_t b = 0; b < skeleton.branches.size(); ++b) {
        for (const Index n : skeleton.branches[b]) {
            thickness[b] += skeleton.radii[n] / static_cast<double>(skeleton.branches[b].size());
        }
    }
    std::vector<Index> successors(count, kNone);  // the child that goes on with the branch of each node
    for (std::size_t i = 0; i < count; ++i) {
        if (const Index parent = tree.parents[i]; parent != kNone) {
            Index& best = successors[parent];
            if (best == kNone || thickness[branches[i]] > thickness[branches[best]]) {
                best = static_cast<Index>(i);
            }
        }
    }
    std::vector<Cylinder> result;
    std::vector<Index> of_nodes(count, kNone);  // the cylinder that ends at each node
    Index branch_count = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const Index parent = tree.parents[i];
        if (parent == kNone) {
            continue;
        }
        const Index a = tree.nodes[parent];
        const Index b = tree.nodes[i];
        const Index before = of_nodes[parent];
        Cylinder cylinder{.parent = before,
                          .start = skeleton.nodes[a],
                          .axis = unit(skeleton.nodes[b] - skeleton.nodes[a]),
                          .length = distance(skeleton.nodes[a], skeleton.nodes[b]),
                          .radius = 0.5 * (skeleton.radii[a] + skeleton.radii[b])};
        const bool goes_on = successors[parent] == static_cast<Index>(i);
        if (goes_on && before != kNone) {
            cylinder.branch = result[before].branch;
            cylinder.order = result[before].order;
            cylinder.position = result[before].position + 1;
        } else {
            cylinder.branch = branch_count++;
            // At a root that is no end the thickest is the trunk.
            cylinder.order = before != kNone ? result[before].order + 1 : goes_on ? 0 : 1;
        }
        of_nodes[i] = static_cast<Index>(result.size());
        result.push_back(cylinder);
    }
    return result;
}

}  // namespace scaleaxis::inline v1
