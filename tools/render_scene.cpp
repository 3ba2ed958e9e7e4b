// SPDX-License-Identifier: GPL-3.0-or-later
#include "render_scene.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <string>

#include "render_ply.hpp"
#include "render_tokens.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis::render {
namespace {

/// A vertex number as files write it.
Index checked_index(const std::string& file, double value, std::size_t vertices) {
    if (!(value >= 0.0 && value < static_cast<double>(vertices))) {
        throw FileError(file + ": a face or an edge names a vertex that is not there; there are " +
                        std::to_string(vertices) + " vertices");
    }
    return static_cast<Index>(value);
}

const std::vector<double>& required(const std::string& file, const PlyElement& element, const char* name) {
    const PlyProperty* property = element.find(name);
    if (!property || property->is_list) {
        throw FileError(file + ": the PLY element '" + element.name + "' has no number '" + name + "'");
    }
    return property->values;
}

Scene scene_of_ply(const std::filesystem::path& path) {
    const std::string file = path.string();
    const Ply ply = read_ply(path);
    const PlyElement* vertex = ply.find("vertex");
    const PlyElement* face = ply.find("face");
    const PlyElement* edge = ply.find("edge");
    if (!vertex) throw FileError(file + ": the PLY file has no element 'vertex'");

    Scene scene;
    const auto& x = required(file, *vertex, "x");
    const auto& y = required(file, *vertex, "y");
    const auto& z = required(file, *vertex, "z");
    for (std::size_t v = 0; v < vertex->count; ++v) scene.vertices.push_back({x[v], y[v], z[v]});
    if (vertex->find("radius")) scene.radii = required(file, *vertex, "radius");
    scene.kind = scene.radii.empty() ? Kind::Mesh : face || edge ? Kind::Axis : Kind::Balls;

    if (face && face->count > 0) {
        const PlyProperty* corners = face->find("vertex_indices");
        if (!corners) corners = face->find("vertex_index");
        if (!corners || !corners->is_list) throw FileError(file + ": the PLY faces have no list 'vertex_indices'");
        std::vector<Index> polygon;
        for (std::size_t f = 0; f < face->count; ++f) {
            polygon.clear();
            for (std::size_t k = corners->offsets[f]; k < corners->offsets[f + 1]; ++k) {
                polygon.push_back(checked_index(file, corners->values[k], vertex->count));
            }
            scene.faces.push_back(polygon);
        }
        if (face->find("angle")) scene.face_angles = required(file, *face, "angle");
        if (face->find("sheet")) {
            const auto& sheets = required(file, *face, "sheet");
            for (const double sheet : sheets) {
                if (!(std::abs(sheet) <= std::numeric_limits<Index>::max())) {
                    throw FileError(file + ": a face has a sheet that is no 32-bit number");
                }
                scene.face_sheets.push_back(static_cast<Index>(sheet));
            }
        }
    }
    if (edge && edge->count > 0) {
        const auto& from = required(file, *edge, "vertex1");
        const auto& to = required(file, *edge, "vertex2");
        for (std::size_t e = 0; e < edge->count; ++e) {
            scene.edges.push_back(
                {checked_index(file, from[e], vertex->count), checked_index(file, to[e], vertex->count)});
        }
    }
    return scene;
}

Scene scene_of_ma(const std::filesystem::path& path) {
    const std::string file = path.string();
    const std::string content = read_file(path);
    Tokens tokens(file, content);
    const double vertices = tokens.number();
    const double edges = tokens.number();
    const double faces = tokens.number();
    Scene scene;
    scene.kind = Kind::Axis;
    for (double i = 0.0; i < vertices; i += 1.0) {
        tokens.expect("v");
        Point p;
        for (double* coordinate : {&p.x, &p.y, &p.z}) *coordinate = tokens.number();
        scene.vertices.push_back(p);
        scene.radii.push_back(tokens.number());
    }
    const auto next_index = [&] { return checked_index(file, tokens.number(), scene.vertices.size()); };
    for (double i = 0.0; i < edges; i += 1.0) {
        tokens.expect("e");
        const Index from = next_index();
        scene.edges.push_back({from, next_index()});
    }
    for (double i = 0.0; i < faces; i += 1.0) {
        tokens.expect("f");
        std::array<Index, 3> triangle{};
        for (Index& corner : triangle) corner = next_index();
        scene.faces.push_back(triangle);
    }
    return scene;
}

Scene scene_of_balls(const std::vector<Ball>& balls) {
    Scene scene;
    scene.kind = Kind::Balls;
    for (const Ball& ball : balls) {
        scene.vertices.push_back(ball.center);
        scene.radii.push_back(ball.radius);
    }
    return scene;
}

Scene scene_of_mesh(TriangleMesh mesh) {
    Scene scene;
    scene.vertices = std::move(mesh.vertices);
    for (const auto& triangle : mesh.triangles) scene.faces.push_back(triangle);
    return scene;
}

std::string lower_extension(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

Scene read_unchecked(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".ply") return scene_of_ply(file);
    if (extension == ".ma") return scene_of_ma(file);
    for (const char* balls : {".balls", ".txt", ".xyzr", ".woff"}) {
        if (extension == balls) return scene_of_balls(read_balls(file));
    }
    return scene_of_mesh(read_mesh(file));
}

}  // namespace

Scene read_scene(const std::filesystem::path& file) {
    Scene scene = read_unchecked(file);
    const bool has_content = scene.kind == Kind::Mesh ? !scene.faces.empty() : !scene.vertices.empty();
    if (!has_content) throw FileError(file.string() + ": there is nothing to draw in it");
    // NaN fails this test too, and the square of what passes it is finite.
    const auto is_drawable = [](double value) { return std::abs(value) < 1e100; };
    for (std::size_t v = 0; v < scene.vertices.size(); ++v) {
        const auto& [x, y, z] = scene.vertices[v];
        if (!is_drawable(x) || !is_drawable(y) || !is_drawable(z) ||
            (!scene.radii.empty() && !is_drawable(scene.radii[v]))) {
            throw FileError(file.string() + ": vertex " + std::to_string(v) +
                            " has a coordinate or radius that is not finite, or above 1e100");
        }
    }
    return scene;
}

}  // namespace scaleaxis::render
