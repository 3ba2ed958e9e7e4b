// SPDX-License-Identifier: Apache-2.0
// Skeletons as SWC (R. Cannon, D. Turner, G. Pyapali, H. Wheal, "An on-line archive of reconstructed hippocampal
// neurons", 1998), as GraphML (U. Brandes et al., "GraphML progress report", 2001) and as JSON.
#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "base/formats/json.hpp"
#include "base/grouped.hpp"
#include "io/formats.hpp"
#include "scaleaxis/skeleton.hpp"

namespace scaleaxis::io {
namespace {

// Types of SWC nodes.
constexpr int kUndefined = 0;
constexpr int kFork = 5;
constexpr int kEnd = 6;

int swc_type(Index degree, Index branches) { return branches > 2 ? kFork : degree == 1 ? kEnd : kUndefined; }

// The node of each component that its tree grows from: the thickest end, or if it has none the thickest node.
std::vector<Index> roots_of(const Skeleton& skeleton, const std::vector<Index>& degree) {
    std::vector<Index> roots;
    const auto is_better = [&](Index a, Index b) {
        const auto key = [&](Index n) { return std::pair(degree[n] == 1, skeleton.radii[n]); };
        return key(a) > key(b);
    };
    for (Index n = 0; n < static_cast<Index>(skeleton.nodes.size()); ++n) {
        const Index component = skeleton.node_components[n];
        if (component == static_cast<Index>(roots.size())) {
            roots.push_back(n);
        } else if (is_better(n, roots[component])) {
            roots[component] = n;
        }
    }
    return roots;
}

std::vector<std::array<Index, 2>> edges_of_branches(const Skeleton& skeleton) {
    std::vector<std::array<Index, 2>> edges;
    for (std::size_t b = 0; b < skeleton.branches.size(); ++b) {
        const std::span<const Index> branch = skeleton.branches[b];
        for (std::size_t k = 1; k < branch.size(); ++k) {
            edges.push_back({std::min(branch[k - 1], branch[k]), std::max(branch[k - 1], branch[k])});
        }
    }
    std::ranges::sort(edges);
    std::vector<std::array<Index, 2>> result = skeleton.edges;
    std::erase_if(result, [&](const auto& edge) { return !std::ranges::binary_search(edges, edge); });
    return result;
}

std::string_view kind_of(Index degree) {
    return degree == 0 ? "single" : degree == 1 ? "end" : degree == 2 ? "inner" : "junction";
}

}  // namespace

/// One tree for each component. Loops are cut, each at one edge, which a comment names. Sheets around voids, which are
/// no trees, are left out with a comment, and a component may have several trees then.
void write_swc_skeleton(OutputFile& out, const Skeleton& skeleton) {
    const std::vector<Index> degree = degrees(skeleton);
    const std::vector<Index> branch_degree = branch_degrees(skeleton);
    const IndexLists neighbors = grouped_both_ways(skeleton.nodes.size(), edges_of_branches(skeleton));
    out.text("# curve skeleton, one tree for each component\n# id type x y z radius parent\n",
             "# types: 0 inner node, 5 junction, 6 end\n");
    std::vector<Index> numbers(skeleton.nodes.size());  // from 1 on; 0: not yet
    std::vector<std::array<Index, 2>> cuts;
    Index count = 0;
    std::vector<Index> roots = roots_of(skeleton, degree);
    if (!skeleton.faces.empty()) {
        for (Index node = 0; node < static_cast<Index>(skeleton.nodes.size()); ++node) {
            roots.push_back(node);
        }
    }
    for (const Index root : roots) {
        const bool is_in_sheet = branch_degree[root] == 0 && degree[root] > 0;
        if (numbers[root] != 0 || is_in_sheet) {
            continue;
        }
        std::vector<std::array<Index, 2>> waiting{{root, kNone}};  // node and parent
        while (!waiting.empty()) {
            const auto [node, parent] = waiting.back();
            waiting.pop_back();
            if (numbers[node] != 0) {
                cuts.push_back({numbers[node], numbers[parent]});
                continue;
            }
            numbers[node] = ++count;
            const Point& p = skeleton.nodes[node];
            out.text(count, ' ', swc_type(degree[node], branch_degree[node]), ' ', p.x, ' ', p.y, ' ', p.z, ' ',
                     skeleton.radii[node], ' ', parent == kNone ? kNone : numbers[parent], '\n');
            for (std::size_t k = neighbors[node].size(); k-- > 0;) {
                if (const Index next = neighbors[node][k]; numbers[next] == 0) {
                    waiting.push_back({next, node});
                }
            }
        }
    }
    for (const auto& [a, b] : cuts) {
        out.text("# loop cut: an edge between ", a, " and ", b, " is left out\n");
    }
    if (!skeleton.faces.empty()) {
        out.text("# sheets around voids: ", skeleton.faces.size(), " faces are left out\n");
    }
}

void write_graphml_skeleton(OutputFile& out, const Skeleton& skeleton) {
    out.text("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n");
    const auto key = [&](std::string_view name, std::string_view type, std::string_view owner = "node") {
        out.text("<key id=\"", name, "\" for=\"", owner, "\" attr.name=\"", name, "\" attr.type=\"", type, "\"/>\n");
    };
    for (const std::string_view name : {"x", "y", "z", "radius"}) {
        key(name, "double");
    }
    key("kind", "string");
    key("branch", "int");
    key("component", "int");
    key("length", "double", "edge");
    out.text("<graph edgedefault=\"undirected\">\n");
    const std::vector<Index> degree = degrees(skeleton);
    const auto data = [&](std::string_view name, const auto& value) {
        out.text("<data key=\"", name, "\">", value, "</data>");
    };
    for (std::size_t n = 0; n < skeleton.nodes.size(); ++n) {
        const Point& p = skeleton.nodes[n];
        out.text("<node id=\"n", n, "\">");
        data("x", p.x);
        data("y", p.y);
        data("z", p.z);
        data("radius", skeleton.radii[n]);
        data("kind", kind_of(degree[n]));
        data("branch", skeleton.node_branches[n]);
        data("component", skeleton.node_components[n]);
        out.text("</node>\n");
    }
    for (const auto& [a, b] : skeleton.edges) {
        out.text("<edge source=\"n", a, "\" target=\"n", b, "\">");
        data("length", distance(skeleton.nodes[a], skeleton.nodes[b]));
        out.text("</edge>\n");
    }
    out.text("</graph>\n</graphml>\n");
}

void write_json_skeleton(OutputFile& out, const Skeleton& skeleton) {
    const std::vector<Index> degree = degrees(skeleton);
    Json nodes = Json::array();
    for (std::size_t n = 0; n < skeleton.nodes.size(); ++n) {
        const Point& p = skeleton.nodes[n];
        nodes.push_back({{"place", {p.x, p.y, p.z}},
                         {"radius", skeleton.radii[n]},
                         {"kind", kind_of(degree[n])},
                         {"branch", skeleton.node_branches[n]},
                         {"component", skeleton.node_components[n]}});
    }
    Json branches = Json::array();
    for (Index b = 0; b < static_cast<Index>(skeleton.branches.size()); ++b) {
        const std::span<const Index> branch = skeleton.branches[b];
        const auto [least, largest] = std::ranges::minmax(branch, {}, [&](Index n) { return skeleton.radii[n]; });
        branches.push_back({{"nodes", branch},
                            {"length", branch_length(skeleton, b)},
                            {"least_radius", skeleton.radii[least]},
                            {"largest_radius", skeleton.radii[largest]}});
    }
    Json faces = Json::array();
    for (std::size_t f = 0; f < skeleton.faces.size(); ++f) {
        faces.push_back(skeleton.faces[f]);
    }
    const Json document{{"schema", "scaleaxis.skeleton-graph/1"},
                        {"nodes", nodes},
                        {"edges", skeleton.edges},
                        {"branches", branches},
                        {"faces", faces}};
    out.text(document.dump(), '\n');
}

void write_ply_skeleton(OutputFile& out, const Skeleton& skeleton) { write_ply_axis(out, complex_of(skeleton), {}); }

}  // namespace scaleaxis::io
