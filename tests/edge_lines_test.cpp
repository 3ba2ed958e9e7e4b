// SPDX-License-Identifier: Apache-2.0
#include "axis/sharp_edges/edge_lines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "axis/sharp_edges/traced_edges.hpp"
#include "complexes.hpp"
#include "meshes.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "solids.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;

using Polygon = std::vector<std::array<double, 2>>;

const Polygon kEll{{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};

/// An isosceles triangle of height 1 with this angle, in degrees, at the origin.
Polygon wedge(double angle) {
    const double half = std::tan(0.5 * angle * std::numbers::pi / 180.0);
    return {{0, 0}, {1, -half}, {1, half}};
}

std::vector<EdgeLine> lines_of(const TriangleMesh& mesh, double angle = 30.0) {
    return edge_lines(mesh_solid(mesh)->sharp_edges(angle).value());
}

/// Arrays of the right sizes, positions that are lengths, and ends that have a number if they are in the same place.
void expect_well_formed(const std::vector<EdgeLine>& lines) {
    std::map<Index, Point> places;
    for (const EdgeLine& line : lines) {
        ASSERT_GE(line.points.size(), 2U);
        ASSERT_EQ(line.positions.size(), line.points.size());
        ASSERT_EQ(line.normals.size() + 1, line.points.size());
        ASSERT_EQ(line.positions[0], 0.0);
        for (std::size_t k = 1; k < line.points.size(); ++k) {
            ASSERT_DOUBLE_EQ(line.positions[k] - line.positions[k - 1] + 1.0,
                             distance(line.points[k - 1], line.points[k]) + 1.0);
        }
        if (line.is_closed()) {
            ASSERT_EQ(line.points.front(), line.points.back());
            continue;
        }
        for (const auto& [end, place] :
             {std::pair(line.ends[0], line.points.front()), std::pair(line.ends[1], line.points.back())}) {
            ASSERT_EQ(places.try_emplace(end, place).first->second, place);
        }
    }
    for (const auto& end : places) {
        ASSERT_EQ(std::ranges::count_if(places, [&](const auto& other) { return other.second == end.second; }), 1);
    }
}

/// Lines between corners, each of one of the segments, all of them; in each corner as many lines end as segments do.
void expect_segments(const std::vector<EdgeLine>& lines, const std::vector<Segment>& segments, double accuracy) {
    ASSERT_NO_FATAL_FAILURE(expect_well_formed(lines));
    ASSERT_EQ(lines.size(), segments.size());
    std::set<std::array<Index, 2>> pairs;
    std::map<Index, std::size_t> lines_at;
    for (const EdgeLine& line : lines) {
        ASSERT_FALSE(line.is_closed());
        const Segment ends{line.points.front(), line.points.back()};
        ASSERT_TRUE(std::ranges::any_of(segments,
                                        [&](const Segment& segment) {
                                            const auto& [a, b] = segment;
                                            return std::min(std::max(distance(ends[0], a), distance(ends[1], b)),
                                                            std::max(distance(ends[0], b), distance(ends[1], a))) <=
                                                   accuracy;
                                        }))
            << "a line of length " << line.length() << " in " << line.points.size() << " points";
        EXPECT_NEAR(line.length(), distance(ends[0], ends[1]), accuracy);
        pairs.insert({std::min(line.ends[0], line.ends[1]), std::max(line.ends[0], line.ends[1])});
        std::ranges::for_each(line.ends, [&](Index end) { ++lines_at[end]; });
    }
    EXPECT_EQ(pairs.size(), segments.size()) << "a segment has two lines";
    std::vector<std::size_t> expected;
    std::vector<Point> corners;
    for (const Segment& segment : segments) {
        for (const Point& end : segment) {
            const auto is_there = [&](const Point& corner) { return distance(corner, end) <= accuracy; };
            const auto known = std::ranges::find_if(corners, is_there);
            if (known == corners.end()) {
                corners.push_back(end);
                expected.push_back(1);
            } else {
                ++expected[known - corners.begin()];
            }
        }
    }
    std::vector<std::size_t> found;
    for (const auto& [end, count] : lines_at) {
        found.push_back(count);
    }
    std::ranges::sort(expected);
    std::ranges::sort(found);
    EXPECT_EQ(found, expected);
}

std::vector<Segment> moved(std::vector<Segment> segments, const Similarity& similarity) {
    for (Segment& segment : segments) {
        std::ranges::transform(segment, segment.begin(), similarity);
    }
    return segments;
}

/// Closed lines of these radii around the z axis.
void expect_rims(const std::vector<EdgeLine>& lines, std::vector<double> radii, int segments) {
    ASSERT_NO_FATAL_FAILURE(expect_well_formed(lines));
    std::vector<double> found;
    for (const EdgeLine& line : lines) {
        EXPECT_TRUE(line.is_closed());
        EXPECT_EQ(line.normals.size(), segments);
        found.push_back(std::hypot(line.points[0].x, line.points[0].y));
        EXPECT_NEAR(line.length(), 2.0 * segments * std::sin(std::numbers::pi / segments) * found.back(), 1e-12);
    }
    std::ranges::sort(found);
    std::ranges::sort(radii);
    ASSERT_EQ(found.size(), radii.size());
    for (std::size_t k = 0; k < radii.size(); ++k) {
        EXPECT_NEAR(found[k], radii[k], 1e-12);
    }
}

TEST(EdgeLines, OfPrismsEndInTheirCorners) {
    const Polygon rectangle{{0, 0}, {3, 0}, {3, 2}, {0, 2}};
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const Similarity turned = random_turn(random);
        for (const Polygon& polygon : {rectangle, kEll, wedge(60.0), wedge(5.0)}) {
            expect_segments(lines_of(moved(prism(polygon, 2.0), turned)), moved(convex_edges(polygon, 2.0), turned),
                            1e-12);
        }
        // Of several parts.
        const std::vector<EdgeLine> lines = lines_of(moved(box_mesh({0, 0, 0}, {3, 2, 2}, 4), turned));
        expect_segments(lines, moved(convex_edges(rectangle, 2.0), turned), 1e-12);
        for (const EdgeLine& line : lines) {
            EXPECT_EQ(line.normals.size(), 4);
        }
    }
}

TEST(EdgeLines, OfRimsAreClosed) {
    expect_rims(lines_of(revolved_mesh({{1, 0}, {2, 0}, {2, 0.4}, {1, 0.4}}, 24, 1.0)), {1, 1, 2, 2}, 24);
    expect_rims(lines_of(cylinder_mesh(1.0, 0.5, 24)), {1, 1}, 24);
}

TEST(EdgeLines, OfACountersinkAreThoseOfTheAngle) {
    const TriangleMesh washer = revolved_mesh({{0.1, 0.0}, {1, 0}, {1, 0.3}, {0.3, 0.3}, {0.1, 0.2}}, 32, 1.0);
    expect_rims(lines_of(washer, 20.0), {0.1, 0.1, 0.3, 1, 1}, 32);
    expect_rims(lines_of(washer, 30.0), {0.1, 0.1, 1, 1}, 32);
}

/// Edges through some points, one after the other.
std::vector<SharpEdge> edges_through(const std::vector<Point>& points) {
    std::vector<SharpEdge> edges;
    for (std::size_t k = 1; k < points.size(); ++k) {
        edges.push_back({{points[k - 1], points[k]}, {Point{1, 0, 0}, Point{0, 1, 0}}});
    }
    return edges;
}

TEST(EdgeLines, EndWhereTheyTurnBy40DegreesOrBranch) {
    for (const double angle : {30.0, 39.0, 41.0, 90.0}) {
        SCOPED_TRACE(angle);
        const double radians = angle * std::numbers::pi / 180.0;
        const std::vector<EdgeLine> lines =
            edge_lines(edges_through({{0, 0, 0}, {1, 0, 0}, {1 + std::cos(radians), std::sin(radians), 0}}));
        ASSERT_NO_FATAL_FAILURE(expect_well_formed(lines));
        EXPECT_EQ(lines.size(), angle < 40.0 ? 1 : 2);
    }
    // A loop of 18 parts, with a tail: it begins and ends in the same point.
    std::vector<Point> loop;
    for (int k = 0; k <= 18; ++k) {
        const double angle = 2.0 * std::numbers::pi * (k % 18) / 18;
        loop.push_back({std::cos(angle), std::sin(angle), 0.0});
    }
    const std::vector<EdgeLine> closed = edge_lines(edges_through(loop));
    ASSERT_NO_FATAL_FAILURE(expect_well_formed(closed));
    ASSERT_EQ(closed.size(), 1);
    EXPECT_TRUE(closed[0].is_closed());
    loop.push_back({2, 0, 0});
    std::vector<EdgeLine> lines = edge_lines(edges_through(loop));
    ASSERT_NO_FATAL_FAILURE(expect_well_formed(lines));
    ASSERT_EQ(lines.size(), 2);
    std::ranges::sort(lines, {}, &EdgeLine::length);
    EXPECT_FALSE(lines[1].is_closed());
    EXPECT_EQ(lines[1].ends[0], lines[1].ends[1]);
    EXPECT_EQ(std::ranges::count(lines[0].ends, lines[1].ends[0]), 1);
}

double distance_to_line(const std::vector<Point>& line, const Point& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < line.size(); ++k) {
        least = std::min(least, distance_to_segment(p, line[k - 1], line[k]));
    }
    return least;
}

/// By brute force.
Point point_at(const EdgeLine& line, double position) {
    std::size_t k = 1;
    while (k + 1 < line.points.size() && line.positions[k] < position) {
        ++k;
    }
    const double t = (position - line.positions[k - 1]) / (line.positions[k] - line.positions[k - 1]);
    return line.points[k - 1] + t * (line.points[k] - line.points[k - 1]);
}

TEST(EdgeLines, HaveNearestPointsAndTheirPositions) {
    Random random(1);
    for (const EdgeLine& line : lines_of(revolved_mesh({{1, 0}, {2, 0}, {1.5, 1}}, 24, 1.0))) {
        for (int i = 0; i < 100; ++i) {
            const Point p = random_point(random, 2.0);
            const auto [place, position] = nearest_on(line, p);
            EXPECT_NEAR(distance(p, place), distance_to_line(line.points, p), 1e-12);
            EXPECT_NEAR(distance(place, point_at(line, position)), 0.0, 1e-12);
        }
    }
}

TEST(EdgeLines, HaveSectionsOfTheirLengthInSmallSteps) {
    std::vector<EdgeLine> lines = lines_of(revolved_mesh({{1, 0}, {2, 0}, {1.5, 1}}, 24, 1.0));
    for (EdgeLine& line : lines_of(box_mesh({0, 0, 0}, {3, 2, 2}, 4))) {
        lines.push_back(std::move(line));
    }
    const std::uint64_t seed = 1;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    for (const EdgeLine& line : lines) {
        for (int i = 0; i < 100; ++i) {
            const double from = uniform(random, 0.0, 0.9 * line.length());
            const double to = uniform(random, from, line.length());
            const double step = std::exp(uniform(random, -4.0, 1.0));
            const double sag = i % 2 == 0 ? 0.0 : uniform(random, 0.0, 0.1);
            EdgeLine section = section_of(line, from, to, step, sag);
            section.ends = {0, 1};
            ASSERT_NO_FATAL_FAILURE(expect_well_formed({section}));
            EXPECT_NEAR(distance(section.points.front(), point_at(line, from)), 0.0, 1e-12);
            EXPECT_NEAR(distance(section.points.back(), point_at(line, to)), 0.0, 1e-12);
            EXPECT_LE(section.length(), to - from + 1e-12);
            if (sag == 0.0) {
                EXPECT_NEAR(section.length(), to - from, 1e-12);
            }
            for (std::size_t k = 1; k < section.points.size(); ++k) {
                ASSERT_LE(section.positions[k] - section.positions[k - 1], step * (1.0 + 1e-12));
                ASSERT_LE(distance_to_line(line.points, section.points[k]), sag + 1e-12);
            }
            for (int k = 0; k <= 100; ++k) {
                ASSERT_LE(distance_to_line(section.points, point_at(line, from + 0.01 * k * (to - from))), sag + 1e-12);
            }
        }
    }
}

/// A function whose normals jump, and the convex edges of the solid where it is negative.
struct Shape {
    std::function<double(const Point&)> function;
    Box bounds;
    std::vector<Segment> edges;
};

/// A cone or a cylinder around the z axis, for z from 0 to 1, and its rims.
Shape tapered(double radius, double top) {
    Shape shape;
    const double slope = std::hypot(1.0, radius - top);
    shape.function = [=](const Point& p) {
        return std::max({-p.z, p.z - 1.0, (std::hypot(p.x, p.y) - radius + (radius - top) * p.z) / slope});
    };
    shape.bounds = {{-1.1 * radius, -1.1 * radius, -0.1}, {1.1 * radius, 1.1 * radius, 1.1}};
    constexpr int kSegments = 4096;  // 3e-7 radii from the circle
    const auto at = [](double r, double z, int k) {
        const double angle = 2.0 * std::numbers::pi * k / kSegments;
        return Point{r * std::cos(angle), r * std::sin(angle), z};
    };
    for (int k = 0; k < kSegments; ++k) {
        shape.edges.push_back({at(radius, 0.0, k), at(radius, 0.0, k + 1)});
        if (top > 0.0) {
            shape.edges.push_back({at(top, 1.0, k), at(top, 1.0, k + 1)});
        }
    }
    return shape;
}

Shape convex_prism(const Polygon& polygon, double height) {
    Shape shape;
    shape.function = [=](const Point& p) {
        double most = std::max(-p.z, p.z - height);
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const auto& [ax, ay] = polygon[i];
            const auto& [bx, by] = polygon[(i + 1) % polygon.size()];
            most = std::max(most, ((by - ay) * (p.x - ax) - (bx - ax) * (p.y - ay)) / std::hypot(bx - ax, by - ay));
        }
        return most;
    };
    shape.edges = convex_edges(polygon, height);
    for (const Segment& edge : shape.edges) {
        shape.bounds.extend(edge[0]);
    }
    return shape;
}

Shape octahedron() {
    Shape shape;
    shape.function = [](const Point& p) {
        return (std::abs(p.x) + std::abs(p.y) + std::abs(p.z) - 1.0) / std::numbers::sqrt3;
    };
    shape.bounds = {{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
    for (const double a : {-1.0, 1.0}) {
        for (const double b : {-1.0, 1.0}) {
            shape.edges.push_back({Point{a, 0.0, 0.0}, Point{0.0, b, 0.0}});
            shape.edges.push_back({Point{0.0, a, 0.0}, Point{0.0, 0.0, b}});
            shape.edges.push_back({Point{0.0, 0.0, a}, Point{b, 0.0, 0.0}});
        }
    }
    return shape;
}

Shape ell_prism() {
    Shape shape;
    shape.function = [](const Point& p) {
        return std::max({-p.z, p.z - 2.0, -p.x, -p.y, p.x - 4.0, p.y - 4.0, std::min(p.x - 1.0, p.y - 1.0)});
    };
    shape.bounds = {{0.0, 0.0, 0.0}, {4.0, 4.0, 2.0}};
    shape.edges = convex_edges(kEll, 2.0);
    return shape;
}

std::vector<EdgeLine> traced_lines(const Shape& shape, const Similarity& turned) {
    const Point middle = turned(midpoint(shape.bounds.min, shape.bounds.max));
    const double reach = 0.55 * shape.bounds.diagonal();
    const Point half{reach, reach, reach};
    const std::unique_ptr<Solid> solid =
        function_solid([&](const Point& p) { return shape.function(turned.inverse(p)); },
                       {.bounds = {middle - half, middle + half}, .is_distance = true});
    const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.02),
                                               .scales = {1.0},
                                               .reaches_sharp_edges = false,
                                               .cleaning = Length::relative(0.0)});
    return edge_lines(traced_edges(axis.axes[0].complex, *solid, {.tolerance = axis.tolerance}));
}

void expect_rims_traced(const Shape& shape, std::size_t count) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const Similarity turned = random_turn(random);
        const std::vector<EdgeLine> lines = traced_lines(shape, turned);
        const double accuracy = 1e-6 * shape.bounds.diagonal();
        ASSERT_NO_FATAL_FAILURE(expect_well_formed(lines));
        EXPECT_EQ(lines.size(), count);
        double length = 0.0;
        for (const EdgeLine& line : lines) {
            EXPECT_TRUE(line.is_closed());
            length += line.length();
            for (const Point& p : line.points) {
                double least = std::numeric_limits<double>::infinity();
                for (const auto& [a, b] : shape.edges) {
                    least = std::min(least, distance_to_segment(turned.inverse(p), a, b));
                }
                ASSERT_LE(least, accuracy);
            }
        }
        double whole = 0.0;
        for (const auto& [a, b] : shape.edges) {
            whole += distance(a, b);
        }
        EXPECT_GE(length, 0.99 * whole);
        EXPECT_LE(length, whole);
    }
}

void expect_segments_traced(const Shape& shape) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const Similarity turned = random_turn(random);
        const std::vector<EdgeLine> lines = traced_lines(shape, turned);
        expect_segments(lines, moved(shape.edges, turned), 1e-6 * shape.bounds.diagonal());
    }
}

TEST(TracedEdges, OfACube) { expect_segments_traced(convex_prism({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1.0)); }

TEST(TracedEdges, OfAWedgeOf20Degrees) { expect_segments_traced(convex_prism(wedge(20.0), 1.0)); }

TEST(TracedEdges, OfAPrismWithAReentrantEdge) { expect_segments_traced(ell_prism()); }

TEST(TracedEdges, OfAnOctahedron) { expect_segments_traced(octahedron()); }

TEST(TracedEdges, OfACylinderAreTwoClosedRims) { expect_rims_traced(tapered(1.0, 1.0), 2); }

TEST(TracedEdges, OfAConeAreItsRim) { expect_rims_traced(tapered(1.0, 0.0), 1); }

}  // namespace
}  // namespace scaleaxis
