// SPDX-License-Identifier: Apache-2.0
// Skeletons as SWC (R. Cannon, D. Turner, G. Pyapali, H. Wheal, "An on-line archive of reconstructed hippocampal
// neurons", 1998), as cylinders, as GraphML (U. Brandes et al., "GraphML progress report", 2001) and as JSON.
#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "base/formats/json.hpp"
#include "io/formats.hpp"
#include "scaleaxis/centerlines.hpp"
#include "scaleaxis/skeleton.hpp"

namespace scaleaxis::io {
namespace {

// The type of all SWC nodes: undefined. NEURON cuts a section wherever the type changes, so forks and ends have no
// other.
constexpr int kUndefined = 0;

std::string_view kind_of(Index degree) {
    return degree == 0 ? "single" : degree == 1 ? "end" : degree == 2 ? "inner" : "junction";
}

}  // namespace

/// One tree for each component. Loops are cut, each at one edge, which a comment names. Sheets around voids, which are
/// no trees, are left out with a comment, and a component may have several trees then.
void write_swc_skeleton(OutputFile& out, const Skeleton& skeleton) {
    const SkeletonTree tree = tree_of(skeleton);
    std::vector<std::size_t> numbers(skeleton.nodes.size());
    out.text("# curve skeleton, one tree for each component\n# id type x y z radius parent\n");
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const Index node = tree.nodes[i];
        const Point& p = skeleton.nodes[node];
        const Index parent = tree.parents[i];
        numbers[node] = i + 1;
        out.text(numbers[node], ' ', kUndefined, ' ', p.x, ' ', p.y, ' ', p.z, ' ', skeleton.radii[node], ' ',
                 parent == kNone ? kNone : parent + 1, '\n');
    }
    for (const auto& [a, b] : tree.cuts) {
        out.text("# loop cut: an edge between ", numbers[a], " and ", numbers[b], " is left out\n");
    }
    if (!skeleton.faces.empty()) {
        out.text("# sheets around voids: ", skeleton.faces.size(), " faces are left out\n");
    }
}

/// Cylinders with the names and the numbering of TreeQSM (P. Raumonen et al., "Fast automatic precision tree models
/// from terrestrial laser scanner data", 2013): ids, branches and positions from 1 on, parent 0 for none.
void write_csv_skeleton(OutputFile& out, const Skeleton& skeleton) {
    out.text("id,parent,start_x,start_y,start_z,axis_x,axis_y,axis_z,length,radius,branch,branch_order,");
    out.text("position_in_branch\n");
    std::size_t id = 0;
    for (const Cylinder& c : cylinders(skeleton)) {
        out.text(++id, ',', c.parent + 1, ',', c.start.x, ',', c.start.y, ',', c.start.z, ',', c.axis.x, ',', c.axis.y,
                 ',', c.axis.z, ',', c.length, ',', c.radius, ',', c.branch + 1, ',', c.order, ',', c.position + 1,
                 '\n');
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
        Json node{{"place", {p.x, p.y, p.z}},
                  {"radius", skeleton.radii[n]},
                  {"kind", kind_of(degree[n])},
                  {"branch", skeleton.node_branches[n]},
                  {"component", skeleton.node_components[n]}};
        if (!skeleton.sections.empty()) {
            const Section& section = skeleton.sections[n];
            node["section"] = {{"area", section.area},
                               {"least_width", section.least_width},
                               {"largest_width", section.largest_width},
                               {"is_closed", section.is_closed}};
        }
        nodes.push_back(node);
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
                        {"faces", faces},
                        {"root", skeleton.root == kNone ? Json(nullptr) : Json(skeleton.root)}};
    out.text(document.dump(), '\n');
}

void write_ply_skeleton(OutputFile& out, const Skeleton& skeleton) { write_ply_axis(out, complex_of(skeleton), {}); }

}  // namespace scaleaxis::io
