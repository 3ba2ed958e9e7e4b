// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "base/angles.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "base/vectors.hpp"
#include "sampling/questions.hpp"
#include "scaleaxis/delaunay.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/ranges.hpp"
#include "scaleaxis/thickness.hpp"
#include "scaleaxis/walls.hpp"
#include "spatial/point_tree.hpp"
#include "spatial/slab_tree.hpp"
#include "uses/divided_edges.hpp"
#include "uses/flat_faces.hpp"
#include "uses/walls/opposite_sides.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kSizesStage = "sizes";

// Between two places where the size is known it may exceed what is asked for by this part. Half of it takes twice the
// layers in walls, and four times the vertices where sizes change. Sizes at the ends of an edge that differ by less
// than twice of it are those of one wall: a taper of which edges are as long as `kEdgeOfSize` allows differs by less.
constexpr double kExcess = 0.1;

// The longest edge, in sizes, at which the surface is looked at, besides `WallOptions::edge`.
// Tetrahedra of the background are as long, and stay in a wall; twice as long they would leave bends of sheet metal.
constexpr double kEdgeOfSize = 8.0;

constexpr int kSizeRefinements = 12;                    // an edge of the diagonal is halved to 1/4000 of it
constexpr std::size_t kMostSizedTriangles = 4'000'000;  // about 4 GB; sizes between vertices are interpolated then
constexpr double kMostLayers = 32.0;                    // of a wall of 100 elements, at a gradation of 0.1
constexpr double kBackgroundMargin = 0.1;               // of the diagonal: how far its box is around that of the solid

// A point of the surface, and where the two sides that it lies between are equally far.
struct SizePlace {
    Point middle;
    double size = 0.0;
    bool is_across = true;  // the size is that of what lies between the two sides
};

}  // namespace

class SizeData {
   public:
    TriangleMesh surface;
    std::vector<double> surface_sizes;
    std::vector<Point> middles;  // #V
    Box box;
    double gradation = 0.0;
    double most = 0.0;
    bool is_capped = false;  // sizes are at most `most` everywhere; otherwise they are on the sources
    // Of radius (most - size) / gradation: what is least of their sizes plus gradation times the distance is `most`
    // plus gradation times the distance from the union of their balls.
    std::optional<SlabTree> sources;

    double at(const Point& p) const {
        if (!sources) {
            return most;
        }
        const double limit = is_capped ? 0.0 : kInfinity;
        return most + gradation * nearest_slab(*sources, p, limit).near.distance;
    }

    std::vector<double> at(std::span<const Point> points) const {
        return mapped<double>(
            points.size(), [&](std::size_t i) { return at(points[i]); }, std::size_t{256});
    }
};

namespace {

void check_options(const SizeOptions& options) {
    const auto is_length = [](const std::optional<double>& length) {
        return !length || (*length > 0.0 && std::isfinite(*length));
    };
    require(is_length(options.min_size) && is_length(options.max_size),
            "the least and the largest size must be positive lengths");
    require(!options.min_size || !options.max_size || *options.min_size <= *options.max_size,
            "the least size must not be more than the largest one");
    require(kElementsAcrossRange.contains(options.elements_across),
            "the number of elements across a wall must lie between 0.1 and 100");
    require(kGradationRange.contains(options.gradation), "the gradation of sizes must lie between 0.01 and 10");
    check_wall_angle(options.angle);
}

class SizeSearch {
   public:
    SizeSearch(const Solid& solid, TriangleMesh surface, const SizeOptions& options, const Execution& execution)
        : solid_(solid), outside_(solid), options_(options), execution_(execution) {
        const double diagonal = solid.bounds().diagonal();
        slope_ = cosine_of_degrees(0.5 * options.angle);
        most_ = std::min(options.max_size.value_or(diagonal), diagonal);
        // On a knife's edge no size is small enough.
        least_ = std::min(options.min_size.value_or(kNegligible * diagonal), most_);
        // No ball in the solid has half this radius and more; as large ones outside are next to a wall of the solid.
        const Point sides = solid.bounds().max - solid.bounds().min;
        most_radius_ = std::min({0.5 * options.elements_across * most_, sides.x, sides.y, sides.z});
        data_.surface =
            with_short_edges(with_delaunay_faces(std::move(surface)), WallOptions{}.edge * diagonal, execution);
    }

    std::shared_ptr<const SizeData> run() && {
        solid_.prepare_nearest();
        find_places(0.3);
        refine();
        if (places_.empty()) {
            throw UnusableInput("sizes need a surface, and this one has no vertices");
        }
        data_.is_capped = options_.max_size.has_value();
        if (!data_.is_capped) {
            most_ = std::ranges::max(places_, {}, &SizePlace::size).size;
        }
        const std::vector<Slab> slabs = sources();
        report(execution_, kSizesStage, 0.9);
        data_.box = solid_.bounds();
        data_.gradation = options_.gradation;
        data_.most = most_;
        if (!slabs.empty()) {
            data_.sources = build_slab_tree(slabs);
        }
        data_.surface_sizes = data_.at(data_.surface.vertices);
        data_.middles = each_of<Point>(places_, &SizePlace::middle);
        report(execution_, kSizesStage, 1.0);
        return std::make_shared<const SizeData>(std::move(data_));
    }

   private:
    double size_of(double measure) const { return std::clamp(measure / options_.elements_across, least_, most_); }

    // \param sign of normals that lead to it
    std::vector<Ball> balls_of(const Solid& side, double sign, std::size_t first) const {
        const std::vector<Point>& vertices = data_.surface.vertices;
        return mapped<Ball>(
            vertices.size() - first,
            [&](std::size_t i) {
                const std::size_t v = first + i;
                return ball_between_sides(side, vertices[v], sign * normals_[v], slope_, most_radius_);
            },
            std::size_t{64});
    }

    // Finds those of vertices that have none yet; of feature sizes all, for any ball may be near any vertex.
    void find_places(double progress) {
        add_normals(data_.surface, normals_);
        append(inner_, balls_of(solid_, -1.0, inner_.size()));
        const bool is_thickness = options_.measure == SizeMeasure::kThickness;
        if (!is_thickness) {
            append(outer_, balls_of(outside_, 1.0, outer_.size()));
        }
        places_.resize(inner_.size());
        for (std::size_t v = 0; v < places_.size() && is_thickness; ++v) {
            places_[v] = {inner_[v].center, size_of(2.0 * inner_[v].radius), true};
        }
        if (!is_thickness) {
            measure_distances();
        }
        report(execution_, kSizesStage, progress);
    }

    // The axis of one side, between the balls of vertices; nothing where none lie between two sides.
    std::optional<SlabTree> axis_of(const std::vector<Ball>& balls) const {
        std::vector<Slab> slabs;
        const auto counts = [&](Index v) { return balls[v].radius < most_radius_; };
        for (const std::array<Index, 3>& triangle : data_.surface.triangles) {
            std::array<Ball, 3> corners;
            std::ranges::transform(triangle, corners.begin(), [&](Index v) { return Ball{balls[v].center, 0.0}; });
            const double longest = std::max({distance(corners[0].center, corners[1].center),
                                             distance(corners[1].center, corners[2].center),
                                             distance(corners[2].center, corners[0].center)});
            // Farther from each other than from the surface they may lie on different sheets.
            const double near =
                std::min({balls[triangle[0]].radius, balls[triangle[1]].radius, balls[triangle[2]].radius});
            if (std::ranges::all_of(triangle, counts) && longest <= near) {
                slabs.emplace_back(corners);
                continue;
            }
            for (int k = 0; k < 3; ++k) {
                if (counts(triangle[k])) {
                    slabs.emplace_back(std::span(corners).subspan(k, 1));
                }
            }
        }
        return slabs.empty() ? std::nullopt : std::optional(build_slab_tree(slabs));
    }

    void measure_distances() {
        const std::optional<SlabTree> inside = axis_of(inner_);
        const std::optional<SlabTree> outside = axis_of(outer_);
        const double limit = 0.5 * options_.elements_across * most_;
        const auto distance_to = [&](const std::optional<SlabTree>& axis, const Point& p) {
            return axis ? nearest_slab(*axis, p, limit).near.distance : limit;
        };
        for_each_index(
            places_.size(),
            [&](std::size_t v) {
                const Point& p = data_.surface.vertices[v];
                const double in = distance_to(inside, p);
                const double out = distance_to(outside, p);
                places_[v] = {inner_[v].center, size_of(2.0 * std::min(in, out)), in <= out};
            },
            std::size_t{256});
    }

    bool is_even(Index a, Index b) const {
        const auto [low, high] = std::minmax(places_[a].size, places_[b].size);
        return high - low <= 2.0 * kExcess * low;
    }

    bool is_long(Index a, Index b) const {
        const double low = std::min(places_[a].size, places_[b].size);
        const double length = distance(data_.surface.vertices[a], data_.surface.vertices[b]);
        const double even = kEdgeOfSize * low;
        return low < most_ &&
               length > (is_even(a, b) ? even : std::min(even, 2.0 * kExcess * low / options_.gradation));
    }

    void refine() {
        TriangleMesh& mesh = data_.surface;
        for (int round = 0; round < kSizeRefinements; ++round) {
            const std::vector<MeshEdge> edges = edges_of(mesh, [&](Index a, Index b) { return is_long(a, b); });
            if (edges.empty() || mesh.triangles.size() > kMostSizedTriangles) {
                return;
            }
            halve(mesh, edges);
            find_places(0.3 + 0.5 * (round + 1) / kSizeRefinements);
        }
    }

    Ball source(Index v, double part) const {
        const Point& p = data_.surface.vertices[v];
        return {p + part * (places_[v].middle - p), (most_ - places_[v].size) / options_.gradation};
    }

    // Layers of a triangle from the surface to the middle that are needed for sizes to exceed by no more than allowed.
    int layers_of(const std::array<Index, 3>& triangle) const {
        double layers = 0.0;
        for (const Index v : triangle) {
            const double way = distance(places_[v].middle, data_.surface.vertices[v]);
            layers = std::max(layers, options_.gradation * way / (2.0 * kExcess * places_[v].size));
        }
        return static_cast<int>(std::ceil(std::clamp(layers, 1.0, kMostLayers)));
    }

    std::vector<Slab> sources() const {
        std::vector<Slab> slabs;
        std::vector<char> is_alone(places_.size(), 0);
        for (const std::array<Index, 3>& triangle : data_.surface.triangles) {
            if (data_.is_capped && std::ranges::all_of(triangle, [&](Index v) { return places_[v].size >= most_; })) {
                continue;
            }
            const auto add = [&](double part) {
                slabs.emplace_back(
                    std::array{source(triangle[0], part), source(triangle[1], part), source(triangle[2], part)});
            };
            add(0.0);
            const bool is_across = std::ranges::all_of(triangle, [&](Index v) { return places_[v].is_across; });
            const bool is_uniform = is_even(triangle[0], triangle[1]) && is_even(triangle[1], triangle[2]) &&
                                    is_even(triangle[2], triangle[0]);
            if (is_across && is_uniform) {
                const int layers = layers_of(triangle);
                for (int k = 1; k <= layers; ++k) {
                    add(static_cast<double>(k) / layers);
                }
            } else {
                std::ranges::for_each(triangle, [&](Index v) { is_alone[v] = places_[v].is_across ? 1 : 0; });
            }
        }
        for (Index v = 0; v < static_cast<Index>(places_.size()); ++v) {
            if (is_alone[v] != 0) {
                slabs.emplace_back(std::array{source(v, 0.0), source(v, 1.0)});
            }
        }
        return slabs;
    }

    const Solid& solid_;
    OutsideOf outside_;
    const SizeOptions& options_;
    const Execution& execution_;
    double slope_ = 0.0;
    double least_ = 0.0;
    double most_ = 0.0;
    double most_radius_ = 0.0;
    std::vector<Point> normals_;     // #V
    std::vector<Ball> inner_;        // #V
    std::vector<Ball> outer_;        // #V, for feature sizes
    std::vector<SizePlace> places_;  // #V
    SizeData data_;
};

// Of those points that are nearer to one of a smaller size than half of that none; by ascending size.
std::vector<Index> spread_points(const std::vector<Point>& points, const std::vector<double>& sizes) {
    const auto order = sorted_indices(points.size(), [&](Index i) { return sizes[i]; });
    const PointTree tree = build_point_tree(points);
    std::vector<char> is_covered(points.size(), 0);
    std::vector<Index> spread;
    CancellationPoint stop_if_asked;
    for (const Index i : order) {
        stop_if_asked();
        if (is_covered[i] == 0) {
            spread.push_back(i);
            for_each_point_near(tree, points[i], kNearby * sizes[i],
                                [&](Index position, double) { is_covered[tree.order[position]] = 1; });
        }
    }
    return spread;
}

}  // namespace

SizeField::SizeField(const Solid& solid, TriangleMesh surface, const SizeOptions& options, const Execution& execution) {
    check_options(options);
    data_ = in_arena(execution, [&] {
        report(execution, kSizesStage, 0.0);
        return SizeSearch(solid, std::move(surface), options, execution).run();
    });
}

double SizeField::operator()(const Point& p) const { return data_->at(p); }

std::vector<double> SizeField::operator()(std::span<const Point> points, const Execution& execution) const {
    return in_arena(execution, [&] { return data_->at(points); });
}

const TriangleMesh& SizeField::surface() const { return data_->surface; }

const std::vector<double>& SizeField::surface_sizes() const { return data_->surface_sizes; }

SizeMesh SizeField::background(const Execution& execution) const {
    return in_arena(execution, [&] {
        std::vector<Point> points = data_->surface.vertices;
        append(points, data_->middles);
        const std::vector<double> sizes = data_->at(points);
        SizeMesh mesh;
        for (const Index i : spread_points(points, sizes)) {
            mesh.vertices.push_back(points[i]);
            mesh.sizes.push_back(sizes[i]);
        }
        const double margin = kBackgroundMargin * data_->box.diagonal();
        const Box& box = data_->box;
        for (int corner = 0; corner < 8; ++corner) {
            const Point p{(corner & 1) != 0 ? box.max.x + margin : box.min.x - margin,
                          (corner & 2) != 0 ? box.max.y + margin : box.min.y - margin,
                          (corner & 4) != 0 ? box.max.z + margin : box.min.z - margin};
            mesh.vertices.push_back(p);
            mesh.sizes.push_back(std::min(data_->at(p), data_->most));
        }
        mesh.tetrahedra = delaunay(mesh.vertices, {}, execution).tetrahedra;
        return mesh;
    });
}

}  // namespace scaleaxis::inline v1
