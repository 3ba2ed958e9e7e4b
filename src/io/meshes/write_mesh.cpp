// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "io/colors.hpp"
#include "io/formats.hpp"
#include "scaleaxis/skeleton.hpp"

namespace scaleaxis::io {

namespace {

constexpr std::string_view kMadeBy = "comment made by scaleaxis\n";
constexpr std::string_view kColor = "property uchar red\nproperty uchar green\nproperty uchar blue\n";

/// A mesh whose vertices have further properties, of which `add_values(v)` writes the values.
template <class AddValues>
void write_ply_triangles(OutputFile& out, const TriangleMesh& mesh, std::string_view comment,
                         std::string_view properties, const AddValues& add_values) {
    out.text("ply\nformat binary_little_endian 1.0\n", comment, "element vertex ", mesh.vertices.size(),
             "\nproperty double x\nproperty double y\nproperty double z\n", properties, "element face ",
             mesh.triangles.size(), "\nproperty list uchar int vertex_indices\nend_header\n");
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Point& p = mesh.vertices[v];
        out.binary(p.x, p.y, p.z);
        add_values(v);
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        out.binary(std::uint8_t{3}, a, b, c);
    }
}

void add_color(OutputFile& out, const std::array<double, 3>& color) {
    out.binary(srgb_byte(color[0]), srgb_byte(color[1]), srgb_byte(color[2]));
}

}  // namespace

void write_ply_mesh(OutputFile& out, const TriangleMesh& mesh) {
    write_ply_triangles(out, mesh, kMadeBy, "", [](std::size_t) {});
}

void write_ply_surface(OutputFile& out, const TriangleMesh& mesh, std::span<const VertexValues> values) {
    std::string properties(kColor);
    for (const VertexValues& attribute : values) {
        properties += "property double " + attribute.name + '\n';
    }
    const auto colors = value_colors(values.front().values);
    write_ply_triangles(out, mesh, kMadeBy, properties, [&](std::size_t v) {
        add_color(out, colors[v]);
        for (const VertexValues& attribute : values) {
            out.binary(finite_or_minus_one(attribute.values[v]));
        }
    });
}

void write_ply_parts(OutputFile& out, const TriangleMesh& surface, const Skeleton& skeleton,
                     std::span<const Index> nodes) {
    const std::string properties = std::string(kColor) + "property int node\nproperty int branch\n";
    write_ply_triangles(out, surface, "", properties, [&](std::size_t v) {
        const Index branch = skeleton.node_branches[nodes[v]];
        add_color(out, sheet_color(branch + 1));
        out.binary(nodes[v], branch);
    });
}

void write_off_mesh(OutputFile& out, const TriangleMesh& mesh) {
    out.text("OFF\n", mesh.vertices.size(), ' ', mesh.triangles.size(), " 0\n");
    for (const Point& p : mesh.vertices) {
        out.text(p.x, ' ', p.y, ' ', p.z, '\n');
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        out.text("3 ", a, ' ', b, ' ', c, '\n');
    }
}

void write_obj_mesh(OutputFile& out, const TriangleMesh& mesh) {
    out.text("# made by scaleaxis\n");
    for (const Point& p : mesh.vertices) {
        out.text("v ", p.x, ' ', p.y, ' ', p.z, '\n');
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        out.text("f ", a + 1, ' ', b + 1, ' ', c + 1, '\n');
    }
}

/// As text: the binary form has single precision only, in which near vertices would become one.
void write_stl_mesh(OutputFile& out, const TriangleMesh& mesh) {
    out.text("solid scaleaxis\n");
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        const Point& a = mesh.vertices[triangle[0]];
        const Point normal = cross(mesh.vertices[triangle[1]] - a, mesh.vertices[triangle[2]] - a);
        const double length = norm(normal);
        const Point unit = length > 0.0 ? (1.0 / length) * normal : Point{};
        out.text("facet normal ", unit.x, ' ', unit.y, ' ', unit.z, "\nouter loop\n");
        for (const Index v : triangle) {
            const Point& p = mesh.vertices[v];
            out.text("vertex ", p.x, ' ', p.y, ' ', p.z, '\n');
        }
        out.text("endloop\nendfacet\n");
    }
    out.text("endsolid scaleaxis\n");
}

}  // namespace scaleaxis::io
