// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/thickness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/triangulated.hpp"
#include "axis/stages/stages.hpp"
#include "base/angles.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/ranges.hpp"
#include "spatial/slab_tree.hpp"
#include "uses/ascent.hpp"
#include "uses/uphill.hpp"
#include "uses/walls/opposite_sides.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kThicknessStage = "thickness";

constexpr std::size_t kPointsAtOnce = 256;

constexpr Index kGridBlock = 16;  // points of a grid that are looked at together at first, along each axis …
constexpr Index kSmallBlock = 2;  // … and at last

constexpr int kCirclePoints = 12;  // for the contacts of a curve, which are a circle

// SeenDirections from a centre to contacts; unit vectors.
using SeenDirections = std::vector<Point>;

void add_contacts(const Slab& slab, SeenDirections& directions) {
    const auto shape = shape_of(slab);
    if (!shape) {
        return;
    }
    if (slab.size == 3) {
        for (const double side : {-1.0, 1.0}) {
            directions.push_back(side * shape->flank * shape->normal - shape->gradient);
        }
        return;
    }
    const Point along = unit(slab.corners[1].center - slab.corners[0].center);
    const Point x_axis = unit(cross(along, std::abs(along.x) < 0.6 ? Point{1.0, 0.0, 0.0} : Point{0.0, 1.0, 0.0}));
    const Point y_axis = cross(along, x_axis);
    for (int k = 0; k < kCirclePoints; ++k) {
        const auto [cosine, sine] = on_circle(static_cast<double>(k) / kCirclePoints);
        directions.push_back(shape->flank * (cosine * x_axis + sine * y_axis) - shape->gradient);
    }
}

// Do two of the directions differ by an angle with this cosine at least?
bool are_apart(const SeenDirections& directions, double cosine) {
    for (std::size_t i = 0; i < directions.size(); ++i) {
        for (std::size_t j = i + 1; j < directions.size(); ++j) {
            if (dot(directions[i], directions[j]) <= cosine) {
                return true;
            }
        }
    }
    return false;
}

Slab slab_between(const MedialComplex& complex, std::span<const Index> vertices) {
    std::array<Ball, 3> balls;
    std::ranges::transform(vertices, balls.begin(), [&](Index v) { return ball_at(complex, v); });
    return Slab(std::span(balls).first(vertices.size()));
}

// The simplices of a complex: triangles, all edges, all vertices.
struct Simplices {
    std::vector<std::array<Index, 3>> triangles;
    std::vector<std::array<Index, 2>> edges;
    std::vector<std::array<Index, 3>> triangle_edges;
    std::vector<std::uint8_t> is_curve;  // of each edge
};

Simplices simplices_of(const MedialComplex& complex) {
    MedialComplex cut;
    cut.vertices = complex.vertices;
    Simplices result;
    for (const FaceTriangle& triangle : face_triangles(complex)) {
        cut.faces.push_back(triangle.corners);
        result.triangles.push_back(triangle.corners);
    }
    build_edges(cut, curve_edges(complex));
    result.edges = cut.edges;
    result.is_curve.assign(cut.edges.size(), 1);
    for (std::size_t f = 0; f < cut.faces.size(); ++f) {
        const std::span<const Index> edges = cut.face_edges[f];
        result.triangle_edges.push_back({edges[0], edges[1], edges[2]});
        for (const Index e : edges) {
            result.is_curve[e] = 0;
        }
    }
    return result;
}

struct Slabs {
    std::vector<Slab> all;      // those that are not on the border of others
    std::vector<Slab> between;  // those that stand for what is between two sides, in the same way
};

// A simplex stands for it if two contacts are far enough apart, its own or those of the simplices around it.
Slabs sorted_slabs(const MedialComplex& complex, double angle) {
    const Simplices simplices = simplices_of(complex);
    const double cosine = cosine_of_degrees(angle);
    const double steep = cosine_of_degrees(0.5 * angle);
    const std::vector<std::uint8_t> is_steep = steep_vertices(complex, simplices.edges, steep);
    const auto is_between_sides = [&](const SeenDirections& directions, std::span<const Index> simplex) {
        // What lies on a sharp edge or in a corner is no place between two sides, whatever meets there.
        const bool is_edge = std::ranges::any_of(simplex, [&](Index v) { return is_on_sharp_edge(complex, v); });
        return !is_edge && are_apart(directions, cosine) &&
               std::ranges::none_of(simplex, [&](Index v) { return is_steep[v] != 0; });
    };
    Slabs slabs;
    std::vector<SeenDirections> edge_contacts(simplices.edges.size());
    std::vector<SeenDirections> vertex_contacts(complex.vertices.size());
    std::vector<std::uint8_t> is_edge_done(simplices.edges.size(), 0);
    std::vector<std::uint8_t> is_vertex_done(complex.vertices.size(), 0);
    std::vector<std::uint8_t> is_alone(complex.vertices.size(), 1);
    SeenDirections directions;
    for (std::size_t t = 0; t < simplices.triangles.size(); ++t) {
        const Slab slab = slab_between(complex, simplices.triangles[t]);
        slabs.all.push_back(slab);
        directions.clear();
        add_contacts(slab, directions);
        const bool is_between = is_between_sides(directions, simplices.triangles[t]);
        if (is_between) {
            slabs.between.push_back(slab);
        }
        for (int k = 0; k < 3; ++k) {
            const Index e = simplices.triangle_edges[t][k];
            const Index v = simplices.triangles[t][k];
            is_edge_done[e] |= is_between ? 1 : 0;
            is_vertex_done[v] |= is_between ? 1 : 0;
            append(edge_contacts[e], directions);
            append(vertex_contacts[v], directions);
        }
    }
    for (std::size_t e = 0; e < simplices.edges.size(); ++e) {
        const auto [a, b] = simplices.edges[e];
        const Slab slab = slab_between(complex, simplices.edges[e]);
        is_alone[a] = is_alone[b] = 0;
        if (simplices.is_curve[e] != 0) {
            slabs.all.push_back(slab);
            add_contacts(slab, edge_contacts[e]);
            append(vertex_contacts[a], edge_contacts[e]);
            append(vertex_contacts[b], edge_contacts[e]);
        }
        if (is_edge_done[e] == 0 && is_between_sides(edge_contacts[e], simplices.edges[e])) {
            slabs.between.push_back(slab);
            is_edge_done[e] = 1;
        }
        if (is_edge_done[e] != 0) {
            is_vertex_done[a] = is_vertex_done[b] = 1;
        }
    }
    for (Index v = 0; v < static_cast<Index>(complex.vertices.size()); ++v) {
        const Slab slab = slab_between(complex, std::span(&v, 1));
        if (is_alone[v] != 0) {
            slabs.all.push_back(slab);
        }
        if (is_alone[v] != 0 || (is_vertex_done[v] == 0 && is_between_sides(vertex_contacts[v], std::span(&v, 1)))) {
            slabs.between.push_back(slab);
        }
    }
    return slabs;
}

void check_options(const ThicknessOptions& options) {
    require(options.angle >= 0.0 && options.angle < 180.0,
            "the angle between contacts must lie between 0 and 180 degrees, and be less than 180");
}

// Of the balls that touch the surface at a point, within rounding, the largest: in re-entrant edges many touch. Where
// the radius changes by m along the axis, what is found is off by up to m sqrt(2 kFileRounding). \param limit of
// growth, more than the least one
Ball touching_ball(const SlabTree& tree, const Point& p, double limit) {
    const GrownBall least = least_grown_slab(tree, p, limit);
    const auto largest = largest_slab_ball(tree, p, (1.0 + kFileRounding) * least.growth);
    return largest.value_or(least.ball);
}

// More than the growth by which a ball reaches a point, also where rounding takes its place.
double growth_limit(const Ball& ball, const Point& p) {
    const double way = distance(ball.center, p);
    return ball.radius > 0.0
               ? (way + kRelativeRounding * (way + norm(p))) / ball.radius + std::numeric_limits<double>::min()
               : kInfinity;
}

// The points of a grid that are looked at together.
struct Block {
    std::array<Index, 3> begin{};
    std::array<Index, 3> end{};

    bool is_small() const {
        return end[0] - begin[0] <= kSmallBlock && end[1] - begin[1] <= kSmallBlock && end[2] - begin[2] <= kSmallBlock;
    }
};

// A ball around the points of a block.
Ball ball_around(const ImageView& image, const Block& block) {
    Ball ball{image.origin, 0.0};
    std::array<Point, 3> half;
    for (int axis = 0; axis < 3; ++axis) {
        ball.center = ball.center + (0.5 * (block.begin[axis] + block.end[axis] - 1)) * image.steps[axis];
        half[axis] = (0.5 * (block.end[axis] - 1 - block.begin[axis])) * image.steps[axis];
    }
    for (const double y : {-1.0, 1.0}) {
        for (const double z : {-1.0, 1.0}) {
            ball.radius = std::max(ball.radius, norm(half[0] + y * half[1] + z * half[2]));
        }
    }
    return ball;
}

Slab inflated(Slab slab, double by) {
    for (Ball& ball : slab.corners) {
        ball.radius += by;
    }
    return slab;
}

std::vector<Slab> inflated(std::vector<Slab> slabs, double by) {
    std::ranges::transform(slabs, slabs.begin(), [by](const Slab& slab) { return inflated(slab, by); });
    return slabs;
}

double largest_radius(const Slab& slab) {
    double radius = 0.0;
    for (Index k = 0; k < slab.size; ++k) {
        radius = std::max(radius, slab.corners[k].radius);
    }
    return radius;
}

// A slab, and how large those of its balls are that contain a point of a block, at most.
struct SlabBound {
    Slab slab;
    double most = 0.0;
};

// Radii at the points of a grid where a mask is not 0: of the largest ball that contains a point. Blocks are halved,
// and with them the slabs that may have that ball become fewer.
class BallPainter {
   public:
    BallPainter(const ImageView& mask, std::vector<float>& radii) : mask_(mask), radii_(radii) {}

    // Radii that are larger already stay.
    void paint(const SlabTree& tree, double inflation, const Block& block) {
        if (!least_radius(block)) {
            return;
        }
        const Ball around = ball_around(mask_, block);
        std::vector<SlabBound> candidates;
        for_each_near_slab(tree, around.center, around.radius, [&](Index i) {
            const Slab slab = inflated(tree.slabs[i], -inflation);
            candidates.push_back({slab, largest_radius(slab)});
        });
        // Large ones first: most of the others then need no look.
        std::ranges::stable_sort(candidates, std::greater(), &SlabBound::most);
        paint(candidates, block, 0.0);
    }

    template <class Visit>
    void for_each_point(const Block& block, const Visit& visit) const {
        for (Index k = block.begin[2]; k < block.end[2]; ++k) {
            for (Index j = block.begin[1]; j < block.end[1]; ++j) {
                const std::size_t row = (static_cast<std::size_t>(k) * mask_.sizes[1] + j) * mask_.sizes[0];
                for (Index i = block.begin[0]; i < block.end[0]; ++i) {
                    if (mask_.values[row + i] != 0.0F) {
                        visit(row + i, mask_.origin + static_cast<double>(i) * mask_.steps[0] +
                                           static_cast<double>(j) * mask_.steps[1] +
                                           static_cast<double>(k) * mask_.steps[2]);
                    }
                }
            }
        }
    }

   private:
    // The least radius known so far; nothing if no point of the block is in the mask.
    std::optional<double> least_radius(const Block& block) const {
        std::optional<double> least;
        for_each_point(block, [&](std::size_t n, const Point&) {
            least = std::min(least.value_or(kInfinity), static_cast<double>(radii_[n]));
        });
        return least;
    }

    // \param least all points of the block lie in a ball as large, which need not be in the slabs given
    void paint(const std::vector<SlabBound>& given, const Block& block, double least) {
        const auto known = least_radius(block);
        if (!known) {
            return;
        }
        const Ball around = ball_around(mask_, block);
        least = std::max(least, *known);
        std::vector<SlabBound> candidates;
        for (const SlabBound& candidate : given) {
            if (candidate.most <= least) {
                break;
            }
            const double nearest = least_distance_bound(candidate.slab, around.center);
            if (nearest > (1.0 + kRelativeRounding) * around.radius) {
                continue;
            }
            const auto most = largest_ball(inflated(candidate.slab, around.radius), around.center);
            if (!most || most->radius - around.radius <= least) {
                continue;
            }
            candidates.push_back({candidate.slab, most->radius - around.radius});
            if (nearest <= -around.radius) {
                if (const auto holding = largest_ball(inflated(candidate.slab, -around.radius), around.center)) {
                    least = std::max(least, holding->radius + around.radius);
                }
            }
        }
        std::erase_if(candidates, [&](const SlabBound& c) { return c.most <= least; });
        std::ranges::stable_sort(candidates, std::greater(), &SlabBound::most);
        if (block.is_small() || candidates.empty()) {
            paint_points(candidates, block, least);
            return;
        }
        for (const Block& half : halves(block)) {
            paint(candidates, half, least);
        }
    }

    void paint_points(const std::vector<SlabBound>& candidates, const Block& block, double least) {
        for_each_point(block, [&](std::size_t n, const Point& p) {
            double largest = std::max(least, static_cast<double>(radii_[n]));
            for (const SlabBound& candidate : candidates) {
                if (candidate.most <= largest) {
                    break;
                }
                if (least_distance_bound(candidate.slab, p) > kRelativeRounding * candidate.most) {
                    continue;
                }
                if (const auto ball = largest_ball(candidate.slab, p)) {
                    largest = std::max(largest, ball->radius);
                }
            }
            radii_[n] = static_cast<float>(largest);
        });
    }

    static std::vector<Block> halves(const Block& block) {
        std::vector<Block> blocks{block};
        for (int axis = 0; axis < 3; ++axis) {
            const Index middle = (block.begin[axis] + block.end[axis]) / 2;
            if (middle > block.begin[axis]) {
                const std::size_t count = blocks.size();
                for (std::size_t i = 0; i < count; ++i) {
                    blocks.push_back(blocks[i]);
                    blocks[i].end[axis] = middle;
                    blocks.back().begin[axis] = middle;
                }
            }
        }
        return blocks;
    }

    const ImageView& mask_;
    std::vector<float>& radii_;
};

}  // namespace

class ThicknessData {
   public:
    ThicknessData(MedialComplex complex, double angle) : slope_(cosine_of_degrees(0.5 * angle)) {
        // On the tip of a knife the balls are points, which no factor makes larger.
        inflation_ = kSmallLength * box_of_balls(complex).diagonal();
        const auto largest = std::ranges::max_element(complex.radii);
        largest_ = ball_at(complex, static_cast<Index>(largest - complex.radii.begin()));
        const Slabs slabs = sorted_slabs(complex, angle);
        all_ = build_slab_tree(inflated(slabs.all, inflation_));
        if (angle > 0.0 && !slabs.between.empty()) {
            between_ = build_slab_tree(inflated(slabs.between, inflation_));
        }
    }

    // Balls found for one point, which bound what is looked for at the next one, and change nothing of what is found.
    struct Hint {
        std::optional<Ball> foot;
        std::optional<Ball> between;
        std::optional<Ball> start;  // of the way uphill to `top`: all points of a sphere have the same
        Ball top;
    };

    // Where the largest ball of the axis leads to: in thick parts all ways do.
    Ball top_of(const Solid* solid) const {
        return solid != nullptr && slope_ < 1.0 ? uphill(*solid, largest_, slope_) : Ball();
    }

    // \param top see `top_of`
    PointThickness at(const Point& p, const Solid* solid, const Ball& top, Hint& hint) const {
        PointThickness result;
        const double nearest = hint.foot ? distance(hint.foot->center, p) - hint.foot->radius : kInfinity;
        const Ball foot = nearest_slab(all_, p, nearest + kRelativeRounding * (std::abs(nearest) + norm(p))).near.ball;
        result.foot = 2.0 * deflated(foot);
        result.ball = touching_ball(all_, p, growth_limit(foot, p));
        hint.foot = foot;
        if (solid != nullptr && slope_ < 1.0) {
            if (hint.start != result.ball) {
                hint.start = result.ball;
                hint.top = uphill(*solid, result.ball, slope_, kInfinity, top);
            }
            // What the axis has lost, as a void smaller than delta, may lie in the ball that it starts with.
            const bool is_lost = hint.top.radius < (1.0 - kSmallPart) * result.ball.radius;
            result.ball = is_lost ? ball_seen_from(p, *solid, result.ball) : hint.top;
            result.thickness = 2.0 * result.ball.radius;
            return result;
        }
        if (between_) {
            hint.between = touching_ball(*between_, p, hint.between ? growth_limit(*hint.between, p) : kInfinity);
            result.ball = hint.between->radius > result.ball.radius ? *hint.between : result.ball;
        }
        result.ball.radius = deflated(result.ball);
        result.thickness = 2.0 * result.ball.radius;
        return result;
    }

    /// \param radii of the grid, which get the radii of balls where the mask is not 0
    void paint(const ImageView& mask, const Block& block, std::vector<float>& radii) const {
        BallPainter painter(mask, radii);
        const SlabTree& tree = between_ ? *between_ : all_;
        painter.paint(tree, inflation_, block);
        painter.for_each_point(block, [&](std::size_t n, const Point& p) {
            radii[n] = radii[n] > 0.0F ? radii[n] : static_cast<float>(first_to_reach(tree, p));
        });
        if (between_) {
            painter.paint(all_, inflation_, block);
        }
    }

   private:
    Ball ball_seen_from(const Point& p, const Solid& solid, const Ball& ball) const {
        return ball_between_sides(solid, p, unit(ball.center - p), slope_, ball.radius);
    }

    double first_to_reach(const SlabTree& tree, const Point& p) const {
        return deflated(least_grown_slab(tree, p).ball);
    }
    // Rounding must not make it negative.
    double deflated(const Ball& ball) const { return std::max(0.0, ball.radius - inflation_); }

    double slope_ = 0.0;      // of the radius, from which on a ball lies in an edge
    double inflation_ = 0.0;  // of all balls in the trees
    Ball largest_;
    SlabTree all_;
    std::optional<SlabTree> between_;  // nothing: all balls are meant
};

Thickness::Thickness(const MedialComplex& complex, const ThicknessOptions& options) {
    check_options(options);
    check(complex);
    if (complex.vertices.empty()) {
        throw UnusableInput(Diagnostic{"complex.empty", "the axis has no vertices: it has no thickness"});
    }
    data_ = std::make_shared<const ThicknessData>(complex, options.angle);
}

namespace {

std::vector<PointThickness> thickness_at(const ThicknessData& data, std::span<const Point> points, const Solid* solid,
                                         const Execution& execution) {
    return in_arena(execution, [&] {
        report(execution, kThicknessStage, 0.0);
        if (solid != nullptr) {
            solid->prepare_nearest();
        }
        const Ball top = data.top_of(solid);
        std::vector<PointThickness> result(points.size());
        for_each_index((points.size() + kPointsAtOnce - 1) / kPointsAtOnce,
                       [&](std::size_t part) {
                           ThicknessData::Hint hint;
                           const std::size_t end = std::min(points.size(), (part + 1) * kPointsAtOnce);
                           for (std::size_t i = part * kPointsAtOnce; i < end; ++i) {
                               result[i] = data.at(points[i], solid, top, hint);
                           }
                       },
                       std::size_t{1});
        report(execution, kThicknessStage, 1.0);
        return result;
    });
}

}  // namespace

std::vector<PointThickness> Thickness::at_surface(std::span<const Point> points, const Execution& execution) const {
    return thickness_at(*data_, points, nullptr, execution);
}

std::vector<PointThickness> Thickness::at_surface(std::span<const Point> points, const Solid& solid,
                                                  const Execution& execution) const {
    return thickness_at(*data_, points, solid.knows_nearest() ? &solid : nullptr, execution);
}

std::vector<PointThickness> Thickness::at_surface(const TriangleMesh& surface, const Execution& execution) const {
    RepairedMesh repaired = repair(surface, part_of(execution, 0.0, 0.3));
    const bool is_solid = repaired.report.fault.empty();
    const auto solid = is_solid ? mesh_solid(std::move(repaired), part_of(execution, 0.3, 0.4)) : nullptr;
    return thickness_at(*data_, surface.vertices, solid.get(), part_of(execution, 0.4, 1.0));
}

Image Thickness::image(const ImageView& mask, const Execution& execution) const {
    check(mask, execution);
    return in_arena(execution, [&] {
        report(execution, kThicknessStage, 0.0);
        Image image{mask.sizes, mask.origin, mask.steps, std::vector<float>(mask.values.size(), 0.0F)};
        std::array<std::size_t, 3> blocks{};
        std::ranges::transform(mask.sizes, blocks.begin(),
                               [](Index size) { return (size + kGridBlock - 1) / kGridBlock; });
        for_each_index(
            blocks[0] * blocks[1] * blocks[2],
            [&](std::size_t b) {
                const std::array begin{static_cast<Index>(b % blocks[0]) * kGridBlock,
                                       static_cast<Index>(b / blocks[0] % blocks[1]) * kGridBlock,
                                       static_cast<Index>(b / (blocks[0] * blocks[1])) * kGridBlock};
                Block block{begin, {}};
                for (int axis = 0; axis < 3; ++axis) {
                    block.end[axis] = std::min(mask.sizes[axis], begin[axis] + kGridBlock);
                }
                data_->paint(mask, block, image.values);
            },
            std::size_t{8});
        for_each_index(image.values.size(), [&](std::size_t n) { image.values[n] *= 2.0F; });
        report(execution, kThicknessStage, 1.0);
        return image;
    });
}

Image cubic_grid(const Box& box, Index resolution) {
    require(kResolutionRange.contains(resolution), "the resolution of an image must lie between 8 and 4096");
    const Point extent = box.max - box.min;
    const double longest = std::max({extent.x, extent.y, extent.z});
    if (box.is_empty() || !(longest > 0.0) || !std::isfinite(longest)) {
        throw UnusableInput("the solid has no extent: there is no grid around it");
    }
    const double spacing = longest / (resolution - 4);
    Image grid;
    grid.origin = box.min - 1.5 * spacing * Point{1.0, 1.0, 1.0};
    grid.steps = {Point{spacing, 0, 0}, Point{0, spacing, 0}, Point{0, 0, spacing}};
    std::ranges::transform(std::array{extent.x, extent.y, extent.z}, grid.sizes.begin(), [&](double length) {
        return static_cast<Index>(std::ceil(length / spacing - kRelativeRounding)) + 4;
    });
    return grid;
}

Image grid_mask(Image grid, const InsideTest& inside, const Execution& execution) {
    return in_arena(execution, [&] {
        report(execution, "mask", 0.0);
        const auto width = static_cast<std::size_t>(grid.sizes[0]);
        const std::size_t rows = static_cast<std::size_t>(grid.sizes[1]) * static_cast<std::size_t>(grid.sizes[2]);
        grid.values.assign(width * rows, 0.0F);
        for_each_index(
            rows,
            [&](std::size_t row) {
                const auto j = static_cast<double>(row % static_cast<std::size_t>(grid.sizes[1]));
                const auto k = static_cast<double>(row / static_cast<std::size_t>(grid.sizes[1]));
                std::vector<Point> points(width);
                std::vector<std::uint8_t> sides(width);
                for (std::size_t i = 0; i < width; ++i) {
                    points[i] =
                        grid.origin + static_cast<double>(i) * grid.steps[0] + j * grid.steps[1] + k * grid.steps[2];
                }
                inside(points, sides);
                std::ranges::copy(sides, grid.values.begin() + static_cast<std::ptrdiff_t>(row * width));
            },
            std::size_t{16});
        report(execution, "mask", 1.0);
        return std::move(grid);
    });
}

}  // namespace scaleaxis::inline v1
