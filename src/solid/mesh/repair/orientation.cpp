// SPDX-License-Identifier: Apache-2.0
#include "solid/mesh/repair/orientation.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "solid/mesh/winding.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {

Orientation orient(const std::vector<Triangle>& triangles, const std::vector<Index>& opposite) {
    Orientation result{std::vector<Index>(triangles.size(), kNone), std::vector<char>(triangles.size(), 0)};
    std::vector<Index> members;
    CancellationPoint cancellation;
    for (std::size_t seed = 0; seed < triangles.size(); ++seed) {
        if (result.component[seed] != kNone) {
            continue;
        }
        const Index component = result.components++;
        result.component[seed] = component;
        members.assign(1, static_cast<Index>(seed));
        std::size_t reversed = 0;
        for (std::size_t i = 0; i < members.size(); ++i) {
            cancellation();
            const Index t = members[i];
            reversed += result.is_reversed[t] ? 1 : 0;
            for (const Index side : {3 * t, 3 * t + 1, 3 * t + 2}) {
                const Index other_side = opposite[side];
                if (other_side == kNone) {
                    continue;
                }
                const Index other = other_side / 3;
                const bool agree = start_of(triangles, side) == end_of(triangles, other_side);
                const char is_reversed = agree ? result.is_reversed[t] : !result.is_reversed[t];
                if (result.component[other] == kNone) {
                    result.component[other] = component;
                    result.is_reversed[other] = is_reversed;
                    members.push_back(other);
                } else if (result.is_reversed[other] != is_reversed && result.one_sided == kNone) {
                    result.one_sided = other;
                }
            }
        }
        if (2 * reversed > members.size()) {
            for (const Index t : members) {
                result.is_reversed[t] = !result.is_reversed[t];
            }
        }
    }
    return result;
}

std::int64_t split_vertices(TriangleMesh& mesh, const std::vector<Index>& opposite) {
    const std::size_t vertex_count = mesh.vertices.size();
    enum class Fans : char { kZero, kOne, kSeveral };
    std::vector<Fans> fans(vertex_count, Fans::kZero);
    std::vector<char> is_visited(opposite.size(), 0);
    std::int64_t split = 0;
    CancellationPoint cancellation;
    for (std::size_t first = 0; first < opposite.size(); ++first) {
        cancellation();
        if (is_visited[first]) {
            continue;
        }
        const auto side = static_cast<Index>(first);
        const Index v = start_of(mesh.triangles, side);
        Index own = v;
        if (fans[v] == Fans::kZero) {
            fans[v] = Fans::kOne;
        } else {
            split += fans[v] == Fans::kOne ? 1 : 0;
            fans[v] = Fans::kSeveral;
            own = static_cast<Index>(mesh.vertices.size());
            mesh.vertices.push_back(mesh.vertices[v]);
        }
        for (Index s = side; !is_visited[s]; s = next_side(opposite[s])) {
            is_visited[s] = 1;
            mesh.triangles[s / 3][s % 3] = own;
        }
    }
    return split;
}

std::vector<int> sides_within_others(const Bvh& bvh, const TriangleMesh& mesh, const Orientation& orientation,
                                     std::span<const double> volumes) {
    struct Windings {     // of others around a place just inside a component
        int outward = 0;  // those oriented outward
        int inward = 0;   // those oriented inward
        int all = 0;
    };
    constexpr std::size_t kSamples = 8;
    constexpr double kInside = 1e-6;  // of the diagonal: faces that lie on those of others are not beside them
    const std::vector<Index>& component = orientation.component;
    std::vector<std::size_t> size(orientation.components, 0);
    for (const Index c : component) {
        ++size[c];
    }
    std::vector<std::size_t> samples;  // triangles of each component
    std::vector<std::size_t> passed(size.size(), 0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (passed[component[t]]++ % (size[component[t]] / kSamples + 1) == 0) {
            samples.push_back(t);
        }
    }
    const Box box = box_around(mesh.vertices);
    const auto windings = mapped<Windings>(
        samples.size(),
        [&](std::size_t i) {
            // A corner might be where components touch.
            const auto& [u, v, w] = mesh.triangles[samples[i]];
            const Point center = (1.0 / 3.0) * (mesh.vertices[u] + mesh.vertices[v] + mesh.vertices[w]);
            const Point normal = cross(mesh.vertices[v] - mesh.vertices[u], mesh.vertices[w] - mesh.vertices[u]);
            const Index own = component[samples[i]];
            const double step = (volumes[own] < 0.0 ? 1.0 : -1.0) * kInside * box.diagonal();
            const Point inside = squared_norm(normal) > 0.0 ? center + step * unit(normal) : center;
            const auto of_sign = [&](double sign) {
                return winding_number(bvh, box, inside, [&](Index t) {
                    const Index other = component[bvh.order[t]];
                    return other != own && sign * volumes[other] > 0.0;
                });
            };
            const int outward = of_sign(1.0);
            const int inward = of_sign(-1.0);
            return Windings{outward, inward, outward + inward};
        },
        std::size_t{16});
    std::vector<Windings> lowest(size.size(), {1, 1, 1});
    std::vector<Windings> highest(size.size(), {-1, -1, -1});
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::size_t c = component[samples[i]];
        for (int Windings::*kind : {&Windings::all, &Windings::outward, &Windings::inward}) {
            lowest[c].*kind = std::min(lowest[c].*kind, windings[i].*kind);
            highest[c].*kind = std::max(highest[c].*kind, windings[i].*kind);
        }
    }
    std::vector<int> result(size.size());
    for (std::size_t c = 0; c < result.size(); ++c) {
        const bool is_inclusion = lowest[c].all > 0;
        const bool is_cavity = volumes[c] < 0.0 && lowest[c].outward > 0 && highest[c].all > 0;
        const bool is_inclusion_inward = highest[c].all < 0;
        const bool is_cavity_inward = volumes[c] > 0.0 && highest[c].inward < 0 && lowest[c].all < 0;
        result[c] = is_inclusion || is_cavity ? 1 : is_inclusion_inward || is_cavity_inward ? -1 : 0;
    }
    return result;
}

std::vector<double> component_volumes(const TriangleMesh& mesh, const Orientation& orientation) {
    std::vector<double> volumes(orientation.components, 0.0);
    std::vector<Index> origin(volumes.size(), kNone);  // a near one, or small components drown in rounding errors
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const std::size_t component = orientation.component[t];
        if (origin[component] == kNone) {
            origin[component] = a;
        }
        const Point& o = mesh.vertices[origin[component]];
        volumes[component] += dot(mesh.vertices[a] - o, cross(mesh.vertices[b] - o, mesh.vertices[c] - o)) / 6.0;
    }
    return volumes;
}

std::int64_t turn_outward(TriangleMesh& mesh, const Orientation& orientation, const Bvh& bvh) {
    const std::vector<double> volumes = component_volumes(mesh, orientation);
    if (std::ranges::none_of(volumes, [](double volume) { return volume < 0.0; })) {
        return 0;
    }
    std::vector<char> is_inward(volumes.size());
    const std::vector<int> within = sides_within_others(bvh, mesh, orientation, volumes);
    for (std::size_t c = 0; c < volumes.size(); ++c) {
        is_inward[c] = within[c] < 0 || (within[c] == 0 && volumes[c] < 0.0);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        if (is_inward[orientation.component[t]]) {
            reverse(mesh.triangles[t]);
        }
    }
    return std::ranges::count(is_inward, 1);
}

}  // namespace scaleaxis::inline v1
