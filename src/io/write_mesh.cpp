// SPDX-License-Identifier: GPL-3.0-or-later
// Triangle meshes to files.
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/output_file.hpp"
#include "io/text_reader.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis {
namespace {

using io::OutputFile;

void write_ply(OutputFile& out, const TriangleMesh& mesh) {
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

void write_off(OutputFile& out, const TriangleMesh& mesh) {
    out.text("OFF\n", mesh.vertices.size(), ' ', mesh.triangles.size(), " 0\n");
    for (const Point& p : mesh.vertices) {
        out.text(p.x, ' ', p.y, ' ', p.z, '\n');
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        out.text("3 ", a, ' ', b, ' ', c, '\n');
    }
}

void write_obj(OutputFile& out, const TriangleMesh& mesh) {
    out.text("# made by scaleaxis\n");
    for (const Point& p : mesh.vertices) {
        out.text("v ", p.x, ' ', p.y, ' ', p.z, '\n');
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        out.text("f ", a + 1, ' ', b + 1, ' ', c + 1, '\n');
    }
}

/// As text: the binary form has single precision only, in which near vertices would become one.
void write_stl(OutputFile& out, const TriangleMesh& mesh) {
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

struct Format {
    std::string_view extension;  ///< in lower case
    void (*write)(OutputFile& out, const TriangleMesh& mesh);
};
constexpr std::array kFormats{Format{".ply", write_ply}, Format{".obj", write_obj}, Format{".off", write_off},
                              Format{".stl", write_stl}};

const Format& format_of(const std::filesystem::path& file) {
    const std::string extension = io::to_lower(file.extension().string());
    for (const Format& format : kFormats) {
        if (format.extension == extension) {
            return format;
        }
    }
    throw FileError("cannot write " + file.string() +
                    ": the name of a mesh has to end in one of .ply, .obj, .off, .stl");
}

}  // namespace

void write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh) {
    const Format& format = format_of(file);
    OutputFile out(file);
    format.write(out, mesh);
    out.commit();
}

void check_mesh_output(const std::filesystem::path& file) {
    format_of(file);
    const OutputFile probe(file);
}

}  // namespace scaleaxis
