// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdint>
#include <span>

#include "io/formats.hpp"
#include "io/value_color.hpp"

namespace scaleaxis::io {

void write_ply_mesh(OutputFile& out, const TriangleMesh& mesh) {
    out.text("ply\nformat binary_little_endian 1.0\ncomment made by scaleaxis\n");
    out.text("element vertex ", mesh.vertices.size(), "\nproperty double x\nproperty double y\nproperty double z\n");
    out.text("element face ", mesh.triangles.size(), "\nproperty list uchar int vertex_indices\nend_header\n");
    for (const Point& p : mesh.vertices) {
        out.binary(p.x, p.y, p.z);
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        out.binary(std::uint8_t{3}, a, b, c);
    }
}

void write_ply_surface(OutputFile& out, const TriangleMesh& mesh, std::span<const VertexValues> values) {
    out.text("ply\nformat binary_little_endian 1.0\ncomment made by scaleaxis\n");
    out.text("element vertex ", mesh.vertices.size(), "\nproperty double x\nproperty double y\nproperty double z\n");
    out.text("property uchar red\nproperty uchar green\nproperty uchar blue\n");
    for (const VertexValues& attribute : values) {
        out.text("property double ", attribute.name, '\n');
    }
    out.text("element face ", mesh.triangles.size(), "\nproperty list uchar int vertex_indices\nend_header\n");
    const auto colors = value_colors(values.front().values);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const auto& [x, y, z] = mesh.vertices[v];
        out.binary(x, y, z, srgb_byte(colors[v][0]), srgb_byte(colors[v][1]), srgb_byte(colors[v][2]));
        for (const VertexValues& attribute : values) {
            out.binary(finite_or_minus_one(attribute.values[v]));
        }
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        out.binary(std::uint8_t{3}, a, b, c);
    }
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
