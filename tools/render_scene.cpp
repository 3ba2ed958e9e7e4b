// SPDX-License-Identifier: Apache-2.0
#include "render_scene.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "scaleaxis/cloud.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis::render {
namespace {

Scene scene_of_axis(MedialComplex complex) {
    Scene scene;
    scene.kind = Kind::Axis;
    scene.vertices = std::move(complex.vertices);
    scene.radii = std::move(complex.radii);
    scene.edges = std::move(complex.edges);
    scene.faces = std::move(complex.faces);
    scene.face_sheets = std::move(complex.face_sheets);
    scene.labels = std::move(complex.vertex_labels);
    // Angles are above 0; a file without them reads as zeros.
    if (std::ranges::any_of(complex.face_angles, [](double angle) { return angle > 0.0; })) {
        scene.face_angles = std::move(complex.face_angles);
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

/// As small balls.
Scene scene_of_points(const PointCloud& cloud) {
    constexpr double kRadius = 0.003;  // of the diagonal
    Box box;
    for (const Point& p : cloud.points) box.extend(p);
    std::vector<Ball> balls;
    for (const Point& p : cloud.points) balls.push_back({p, kRadius * box.diagonal()});
    return scene_of_balls(balls);
}

Scene read_unchecked(const std::filesystem::path& file) {
    switch (file_kind(file)) {
        case FileKind::kAxis:
            return scene_of_axis(read_axis(file));
        case FileKind::kBalls:
            return scene_of_balls(read_balls(file));
        case FileKind::kPoints:
            return scene_of_points(read_points(file));
        case FileKind::kImage:
            throw FileError(file.string() + ": a 3D image cannot be drawn; make an axis or balls of it");
        case FileKind::kMesh:
            break;
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
