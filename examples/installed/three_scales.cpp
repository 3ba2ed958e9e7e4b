// SPDX-License-Identifier: Apache-2.0
// The scale axis of a mesh in arrays at three scales, distances to the simplified solid, and cancellation.
#include <chrono>
#include <cmath>
#include <iostream>
#include <numbers>
#include <scaleaxis/scaleaxis.hpp>
#include <stop_token>
#include <thread>
#include <vector>

using namespace scaleaxis;

/// A torus of radii 1 and 0.4 as a closed triangle mesh.
TriangleMesh torus(int segments) {
    TriangleMesh mesh;
    for (int i = 0; i < segments; ++i) {
        for (int j = 0; j < segments; ++j) {
            const double u = 2.0 * std::numbers::pi * i / segments;
            const double v = 2.0 * std::numbers::pi * j / segments;
            const double r = 1.0 + 0.4 * std::cos(v);
            mesh.vertices.push_back({r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v)});
            const auto at = [&](int k, int l) { return (k % segments) * segments + l % segments; };
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

int main() try {
    const auto solid = mesh_solid(torus(64));
    const ScaleAxis result = scale_axis(*solid, {.delta = Length::relative(0.02), .scales = {1.0, 1.1, 1.5}});
    for (const AxisAtScale& axis : result.axes) {
        std::cout << "s = " << axis.complex.scale << ": " << axis.complex.vertices.size() << " balls\n";
    }

    const std::vector<Point> points{{1, 0, 0}, {0, 0, 0}, {2, 0, 0}};
    for (const double distance : BallUnion(balls_of(result.axes[1].complex)).signed_distances(points)) {
        std::cout << "signed distance " << distance << '\n';  // about -0.4, 0.6, 0.6
    }

    std::stop_source stop;
    const std::jthread watch([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        stop.request_stop();
    });
    try {
        scale_axis(*solid, {.delta = Length::relative(0.001)}, {.cancel = stop.get_token()});
        return 1;  // would have taken much longer
    } catch (const Cancelled&) {
        std::cout << "cancelled\n";
    }
} catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
}
