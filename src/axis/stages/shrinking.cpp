// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/shrinking.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/split_triangle.hpp"
#include "axis/stages/stages.hpp"
#include "base/angles.hpp"
#include "base/faults.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/ranges.hpp"

namespace scaleaxis::inline v1 {
namespace {

// Edges halve every round; this many halvings are below the resolution of the coordinates.
constexpr int kMaxRounds = 50;

// Each halving makes the error of linear radii four times smaller. Where the balls are not those of a medial axis of a
// union, it need not end.
constexpr int kLinearRounds = 3;

// The limit of vertices, unless options set one: this factor, but no less than the second and no more than the third,
// above which the corners of all faces may be too many for an index.
constexpr std::int64_t kMostGrowth = 10;
constexpr std::int64_t kLeastLimit = 1'000'000;
constexpr auto kMostVertices = static_cast<std::int64_t>(kMostVerticesRange.max);

constexpr std::string_view kDensifyingStage = "densifying";

// A ball of the complex.
struct Node {
    Ball ball;
    VertexOrigin origin;
    Index vertex = kNone;  // if it is one of the complex that is sampled
};

// Do the balls at both ends of an edge, which are grown ones here, meet too flatly once they are shrunk, or not at all?
struct MeetingCriterion {
    double scale;
    double cosine;  // of the largest angle at which their radii to a point where the spheres meet may meet

    MeetingCriterion(const DensifyOptions& options, double shrunk_by)
        : scale(shrunk_by), cosine(cosine_of_degrees(180.0 - options.meeting_angle)) {}

    // Balls on sharp edges, of radius 0, never meet others: what ends there stays as it is.
    bool is_too_long(const Node& p, const Node& q) const {
        const auto is_sharp = [](const Node& node) { return node.origin.kind == VertexKind::kSharpEdge; };
        if (is_sharp(p) || is_sharp(q)) {
            return false;
        }
        const double rp = p.ball.radius / scale;
        const double rq = q.ball.radius / scale;
        return rp * rp + rq * rq - squared_distance(p.ball.center, q.ball.center) < 2.0 * rp * rq * cosine;
    }
};

// The ball in the middle of an edge. Where an end was moved, the radius is interpolated.
Node middle_of(const Node& p, const Node& q) {
    const Point center = midpoint(p.ball.center, q.ball.center);
    const VertexOrigin origin = origin_between(p.origin, q.origin);
    if (is_linear(origin)) {
        return {{center, 0.5 * (p.ball.radius + q.ball.radius)}, origin};
    }
    const double squared_length = squared_distance(p.ball.center, q.ball.center);
    return {{center, radius_between(p.ball.radius, q.ball.radius, squared_length, 0.5)}, origin};
}

// Is the radius in the middle of an edge, of grown balls, far from the mean of those at its ends? Unless the edge is
// one between vertices of which it is known that the mean will do.
struct LinearCriterion {
    double tolerance;
    const LinearPairs& known;

    bool is_too_long(const Node& p, const Node& q) const {
        return 0.5 * (p.ball.radius + q.ball.radius) - middle_of(p, q).ball.radius > tolerance &&
               !known(p.vertex, q.vertex);
    }
};

Node node_at(const MedialComplex& complex, Index v) {
    return {{complex.vertices[v], complex.radii[v]}, complex.vertex_origins[v], v};
}

// Is a side of a polygon too long, or a diagonal from its first corner?
template <class Criterion>
bool is_too_coarse(const MedialComplex& complex, std::span<const Index> polygon, const Criterion& criterion) {
    const auto is_too_long = [&](std::size_t i, std::size_t k) {
        return criterion.is_too_long(node_at(complex, polygon[i]), node_at(complex, polygon[k]));
    };
    for (std::size_t k = 1; k < polygon.size(); ++k) {
        if (is_too_long(k - 1, k) || is_too_long(0, k)) {
            return true;
        }
    }
    return false;
}

// For every face, whether it has to be split.
template <class Criterion>
std::vector<std::uint8_t> find_coarse_faces(const MedialComplex& complex, const Criterion& criterion) {
    return mapped<std::uint8_t>(complex.faces.size(), [&](std::size_t f) {
        return is_too_coarse(complex, complex.faces[f], criterion) ? 1 : 0;
    });
}

struct Triangle {
    std::array<Index, 3> corners;
    Index face;  // of the complex that is sampled
};

// Is told how many vertices there are, and throws if these are too many.
using SizeCheck = std::function<void(std::size_t)>;

// The vertices of the finer complex, and which of its edges are fine enough.
template <class Criterion>
class Refinement {
   public:
    Refinement(MedialComplex& complex, const Criterion& criterion, const SizeCheck& check_size)
        : complex_(complex), criterion_(criterion), check_size_(check_size) {}

    bool is_too_long(Index p, Index q) const { return criterion_.is_too_long(node(p), node(q)); }

    // The vertex in the middle of an edge, the same for everything that shares the edge.
    Index middle(Index p, Index q) {
        const auto [low, high] = std::minmax(p, q);
        const std::uint64_t key = static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high);
        const auto [entry, is_new] = middles_.try_emplace(key, static_cast<Index>(complex_.vertices.size()));
        if (is_new) {
            const Node middle = middle_of(node(low), node(high));
            add_vertex(complex_, middle.ball, middle.origin);
            check_size_(complex_.vertices.size());
        }
        return entry->second;
    }

    // Adds the parts of a triangle to `parts`. Returns false if it is fine enough.
    bool split(const Triangle& triangle, std::vector<Triangle>& parts) {
        const auto middle_of_side = [&](int k) {
            const Index p = triangle.corners[k];
            const Index q = triangle.corners[(k + 1) % 3];
            return is_too_long(p, q) ? std::optional(middle(p, q)) : std::nullopt;
        };
        const auto place_of = [&](Index v) { return complex_.vertices[v]; };
        return split_triangle(triangle.corners, middle_of_side, place_of, [&](Index a, Index b, Index c) {
            parts.push_back({{a, b, c}, triangle.face});
        });
    }

   private:
    Node node(Index v) const { return node_at(complex_, v); }

    MedialComplex& complex_;
    const Criterion& criterion_;
    const SizeCheck& check_size_;
    std::unordered_map<std::uint64_t, Index> middles_;
};

void validate(const DensifyOptions& options) {
    require(kMeetingAngleRange.contains(options.meeting_angle),
            "the meeting angle must lie between 90 and 175 degrees");
    require(!options.most_vertices || kMostVerticesRange.contains(*options.most_vertices),
            "the limit of vertices must lie between 1 and " + std::to_string(kMostVertices));
}

SizeCheck size_check(std::size_t given, double scale, const DensifyOptions& options) {
    const auto vertices = static_cast<std::int64_t>(given);
    const std::int64_t automatic = std::clamp(kMostGrowth * vertices, kLeastLimit, kMostVertices);
    return [=, limit = options.most_vertices.value_or(automatic)](std::size_t count) {
        if (static_cast<std::int64_t>(count) > limit) {
            Words message;
            message << "shrunk by s = " << scale << ", the balls of the axis overlap so little that it takes more than "
                    << limit << " vertices (the limit; now there are " << vertices << ") until they meet at "
                    << options.meeting_angle << " degrees: use more balls (a smaller delta) or a smaller scale";
            throw UnusableInput(Diagnostic{"shrinking.size", message.str()});
        }
    };
}

// Faces and curves of a complex, split until they are fine enough.
template <class Criterion>
MedialComplex refined(const MedialComplex& complex, const Criterion& criterion,
                      const std::vector<std::uint8_t>& is_coarse, int rounds, const SizeCheck& check_size,
                      const Execution& execution) {
    MedialComplex result = vertices_of(complex);
    Refinement refinement(result, criterion, check_size);
    CancellationPoint stop_if_cancelled_now_and_then;

    std::vector<std::array<Index, 2>> curves;
    std::vector<std::array<Index, 2>> coarse_curves = curve_edges(complex);
    std::vector<Triangle> coarse;
    for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
        stop_if_cancelled_now_and_then();
        const std::span<const Index> polygon = complex.faces[f];
        if (is_coarse[f] == 0) {
            add_face(result, polygon, values_of(complex, f));
            continue;
        }
        for (std::size_t k = 2; k < polygon.size(); ++k) {
            coarse.push_back({{polygon[0], polygon[k - 1], polygon[k]}, f});
        }
    }
    for (int round = 0; !(coarse.empty() && coarse_curves.empty()); ++round) {
        report(execution, kDensifyingStage, 0.5);
        std::vector<Triangle> finer;
        for (const Triangle& triangle : coarse) {
            stop_if_cancelled_now_and_then();
            if (round == rounds || !refinement.split(triangle, finer)) {
                add_face(result, triangle.corners, values_of(complex, triangle.face));
            }
        }
        coarse = std::move(finer);
        std::vector<std::array<Index, 2>> finer_curves;
        for (const auto& [p, q] : coarse_curves) {
            stop_if_cancelled_now_and_then();
            if (round == rounds || !refinement.is_too_long(p, q)) {
                curves.push_back({p, q});
            } else {
                const Index m = refinement.middle(p, q);
                finer_curves.push_back({p, m});
                finer_curves.push_back({m, q});
            }
        }
        coarse_curves = std::move(finer_curves);
    }
    report(execution, kDensifyingStage, 0.8);
    build_edges(result, curves);
    return result;
}

}  // namespace

MedialComplex shrunk(MedialComplex complex, double scale) {
    check_scale(scale);
    for (double& radius : complex.radii) {
        radius /= scale;
    }
    complex.scale *= scale;
    return complex;
}

MedialComplex densified(MedialComplex complex, const DensifyOptions& options, const Execution& execution) {
    validate(options);
    return in_arena(execution, [&] {
        report(execution, kDensifyingStage, 0.0);
        const double scale = complex.scale;
        const MeetingCriterion criterion(options, scale);
        complex = grown(std::move(complex));
        const std::vector<std::uint8_t> is_coarse = find_coarse_faces(complex, criterion);
        const SizeCheck check_size = size_check(complex.vertices.size(), scale, options);
        check_size(complex.vertices.size());
        MedialComplex result = shrunk(refined(complex, criterion, is_coarse, kMaxRounds, check_size, execution), scale);
        report(execution, kDensifyingStage, 1.0);
        return result;
    });
}

std::vector<std::array<Index, 2>> pairs_off_linear(const MedialComplex& complex, double tolerance) {
    const MedialComplex grown_complex = grown(vertices_of(complex));
    const LinearPairs none_known = no_pairs;
    const LinearCriterion criterion{complex.scale * tolerance, none_known};
    std::vector<std::array<Index, 2>> pairs;
    const auto note = [&](Index a, Index b) {
        if (criterion.is_too_long(node_at(grown_complex, a), node_at(grown_complex, b))) {
            pairs.push_back({std::min(a, b), std::max(a, b)});
        }
    };
    for (const auto& [a, b] : complex.edges) {
        note(a, b);
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        const std::span<const Index> polygon = complex.faces[f];
        for (std::size_t k = 2; k + 1 < polygon.size(); ++k) {
            note(polygon[0], polygon[k]);
        }
    }
    return pairs;
}

MedialComplex linearized(MedialComplex complex, double tolerance, const LinearPairs& known) {
    const double scale = complex.scale;
    const LinearCriterion criterion{scale * tolerance, known};
    complex = grown(std::move(complex));
    const std::vector<std::uint8_t> is_coarse = find_coarse_faces(complex, criterion);
    const SizeCheck none = [](std::size_t) {};
    return shrunk(refined(complex, criterion, is_coarse, kLinearRounds, none, {}), scale);
}

MedialComplex with_linear_radii(MedialComplex complex) {
    std::ranges::transform(complex.radii, complex.vertex_origins.begin(), linear_vertex);
    return complex;
}

MedialComplex shrink(MedialComplex complex, double scale) {
    check(complex);
    return shrunk(std::move(complex), scale);
}

MedialComplex densify(const MedialComplex& complex, const DensifyOptions& options, const Execution& execution) {
    return in_arena(execution, [&] {
        check(complex);
        return densified(complex, options, execution);
    });
}

}  // namespace scaleaxis::inline v1
