// SPDX-License-Identifier: Apache-2.0
// Exact decisions against CGAL and rational arithmetic.
#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/mst_orient_normals.h>
#include <CGAL/property_map.h>
#include <gtest/gtest.h>

#include <bit>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <tuple>

#include "point_sets.hpp"
#include "solid/cloud/normals.hpp"
#include "solid/mesh/segment_crossing.hpp"
#include "solid/mesh/triangle_intersection.hpp"
#include "spatial/exact/dyadic.hpp"
#include "spatial/exact/predicates.hpp"
#include "spatial/spheres.hpp"

namespace scaleaxis {
namespace {

using Rational = CGAL::Exact_rational;
using RationalKernel = CGAL::Simple_cartesian<Rational>;

RationalKernel::Point_3 rational(const Point& p) { return {p.x, p.y, p.z}; }
RationalKernel::Weighted_point_3 rational(const Ball& b) { return {rational(b.center), Rational(b.radius * b.radius)}; }

int sign_of(const Rational& r) { return static_cast<int>(CGAL::sign(r)); }

/// A scale, and where the origin goes.
struct Frame {
    double scale;
    Point offset;
};

Point moved(const Point& p, const Frame& frame) { return frame.scale * p + frame.offset; }

Point slightly_disturbed(Point p, std::mt19937_64& random) {
    p.x = std::nextafter(p.x, random() % 2 == 0 ? -INFINITY : INFINITY);
    return p;
}

/// Any finite double: all exponents, all mantissas.
double any_double(std::mt19937_64& random) {
    for (;;) {
        const double value = std::bit_cast<double>(random());
        if (std::isfinite(value)) {
            return value;
        }
    }
}

// Arithmetic.

TEST(Dyadic, AgreesWithRationalArithmetic) {
    std::mt19937_64 random = seeded(5);
    std::uniform_int_distribution<int> small(-3, 3);
    const auto number = [&](int kind) {
        switch (kind % 4) {
            case 0:
                return any_double(random);
            case 1:
                return 1.0 * small(random);
            case 2:
                return std::ldexp(1.0 * small(random), 40 * small(random));
            default:
                return std::bit_cast<double>(random() >> 12);  // denormal
        }
    };
    for (int i = 0; i < 20000; ++i) {
        const double a = number(i), b = number(i / 4), c = number(i / 16), d = number(i / 64);
        const Dyadic value = (Dyadic(a) * b - c) * (Dyadic(d) + a) - Dyadic(b) * Dyadic(c) * Dyadic(d);
        const Rational expected = (Rational(a) * Rational(b) - Rational(c)) * (Rational(d) + Rational(a)) -
                                  Rational(b) * Rational(c) * Rational(d);
        ASSERT_EQ(value.sign(), sign_of(expected)) << a << ' ' << b << ' ' << c << ' ' << d;
        ASSERT_EQ((value - value).sign(), 0);
        const Dyadic copy = value + 0.0;
        ASSERT_EQ((copy - value).sign(), 0);
    }
}

TEST(Dyadic, CarriesAndBorrows) {
    const Dyadic one = 1.0;
    Dyadic sum = 0.0, power = 1.0;
    for (int i = 0; i < 2000; ++i) {  // 1 + 2 + … + 2^1999 = 2^2000 - 1
        sum = sum + power;
        power = power + power;
        ASSERT_EQ((power - sum - one).sign(), 0) << i;
        ASSERT_EQ((sum - power).sign(), -1) << i;
    }
}

TEST(Dyadic, QuotientIsRoundedTowardsZero) {
    std::mt19937_64 random = seeded(6);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto check = [](double a, double b, double c) {
        const double q = quotient(Dyadic(a) * b, Dyadic(c));
        const Rational exact = Rational(a) * Rational(b) / Rational(c);
        ASSERT_LE(CGAL::abs(Rational(q)), CGAL::abs(exact));
        ASSERT_GT(CGAL::abs(Rational(std::nextafter(q, q < 0 || (q == 0 && exact < 0) ? -INFINITY : INFINITY))),
                  CGAL::abs(exact))
            << a << ' ' << b << ' ' << c;
    };
    for (int i = 0; i < 5000; ++i) {
        check(uniform(random), uniform(random), uniform(random));
        check(std::ldexp(uniform(random), -600), std::ldexp(uniform(random), 500), uniform(random));
        check(static_cast<double>(random() % 100), 1.0, static_cast<double>(1 + random() % 100));
    }
    EXPECT_EQ(quotient(Dyadic(0.0), 3.0), 0.0);
    EXPECT_EQ(quotient(Dyadic(-6.0), 3.0), -2.0);
    EXPECT_EQ(quotient(Dyadic(0x1p-1000), 0x1p1000), 0.0);
    EXPECT_EQ(quotient(Dyadic(0x1p1000), 0x1p-1000), std::numeric_limits<double>::max());
}

// Predicates.

/// Sign of the determinant of rows (x, y, z, lift), each a point minus `e`.
int rational_sign(const std::array<Point, 4>& rows, const std::array<double, 4>& weights, const Point& e, double we) {
    std::array<std::array<Rational, 4>, 4> m;
    for (std::size_t i = 0; i < 4; ++i) {
        m[i][0] = Rational(rows[i].x) - Rational(e.x);
        m[i][1] = Rational(rows[i].y) - Rational(e.y);
        m[i][2] = Rational(rows[i].z) - Rational(e.z);
        m[i][3] = m[i][0] * m[i][0] + m[i][1] * m[i][1] + m[i][2] * m[i][2] - (Rational(weights[i]) - Rational(we));
    }
    return -static_cast<int>(
        CGAL::sign(CGAL::determinant(m[0][0], m[0][1], m[0][2], m[0][3], m[1][0], m[1][1], m[1][2], m[1][3], m[2][0],
                                     m[2][1], m[2][2], m[2][3], m[3][0], m[3][1], m[3][2], m[3][3])));
}

TEST(Predicates, KnownSigns) {
    const Point a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0}, d{0, 0, 1};
    EXPECT_EQ(orientation(a, b, c, d), 1);
    EXPECT_EQ(orientation(b, a, c, d), -1);
    EXPECT_EQ(orientation(a, b, c, {5, 7, 0}), 0);
    EXPECT_EQ(in_sphere(a, b, c, d, {0.5, 0.5, 0.5}), 1);
    EXPECT_EQ(in_sphere(a, b, c, d, {1, 1, 1}), 0);
    EXPECT_EQ(in_sphere(a, b, c, d, {1, 1, 1 + 0x1p-52}), -1);
    EXPECT_EQ(in_power_sphere(a, 0, b, 0, c, 0, d, 0, {1, 1, 1}, 0), 0);
    EXPECT_EQ(in_power_sphere(a, 0, b, 0, c, 0, d, 0, {1, 1, 1}, 0x1p-60), 1);
    EXPECT_EQ(in_power_sphere(a, 0, b, 0, c, 0, d, 0, {1, 1, 1}, -0x1p-60), -1);
    EXPECT_EQ(in_power_sphere(a, 0x1p-60, b, 0, c, 0, d, 0, {1, 1, 1}, 0), 1);
    EXPECT_EQ(in_power_sphere(a, 0, b, 0x1p-60, c, 0, d, 0, {1, 1, 1}, 0), -1);
}

TEST(Predicates, AgreeWithRationalArithmetic) {
    std::mt19937_64 random = seeded(11);
    const std::vector<std::pair<double, Point>> frames{{1, {}},           {1, {1e6, -1e6, 1e6}}, {1e-9, {}}, {1e9, {}},
                                                       {1e-9, {1, 1, 1}}, {1e-40, {}},           {1e50, {}}};
    std::map<int, int> signs;
    int near_spheres = 0, told_near_spheres = 0;
    for (const auto& [scale, offset] : frames) {
        for (int i = 0; i < 300; ++i) {
            // Integers, points of one sphere up to rounding, and the integers slightly disturbed.
            Points p = i % 3 == 1 ? on_unit_sphere(5, random) : on_grid(5, 4, random);
            p = transformed(p, scale, offset);
            if (i % 3 == 2) {
                for (Point& q : p) {
                    q.x = std::nextafter(q.x, random() % 2 == 0 ? -INFINITY : INFINITY);
                }
            }
            std::array<double, 4> w;
            for (double& x : w) {
                x = scale * scale * static_cast<double>(random() % 4);
            }
            const double we = scale * scale * static_cast<double>(random() % 4);
            ASSERT_EQ(
                orientation(p[0], p[1], p[2], p[3]),
                static_cast<int>(CGAL::orientation(rational(p[0]), rational(p[1]), rational(p[2]), rational(p[3]))));
            const int expected = rational_sign({p[0], p[1], p[2], p[3]}, {0, 0, 0, 0}, p[4], 0);
            ASSERT_EQ(in_sphere(p[0], p[1], p[2], p[3], p[4]), expected) << "scale " << scale;
            ASSERT_EQ(in_power_sphere(p[0], w[0], p[1], w[1], p[2], w[2], p[3], w[3], p[4], we),
                      rational_sign({p[0], p[1], p[2], p[3]}, w, p[4], we))
                << "scale " << scale;
            // What it tells is true whatever the center, and it tells of points of one sphere up to rounding.
            const bool is_sphere = i % 3 == 1;
            const Point twice_center = is_sphere ? 2.0 * (offset - p[3]) : scale * in_cube(1, random)[0];
            const int near =
                predicate_details::sign_near_sphere(p[0], 0, p[1], 0, p[2], 0, p[3], 0, p[4], 0, twice_center);
            ASSERT_TRUE(near == 0 || near == expected) << "scale " << scale;
            near_spheres += is_sphere ? 1 : 0;
            told_near_spheres += is_sphere && near != 0 ? 1 : 0;
            const int near_weighted = predicate_details::sign_near_sphere(p[0], w[0], p[1], w[1], p[2], w[2], p[3],
                                                                          w[3], p[4], we, twice_center);
            ASSERT_TRUE(near_weighted == 0 || near_weighted == rational_sign({p[0], p[1], p[2], p[3]}, w, p[4], we))
                << "scale " << scale;
            ++signs[expected];
        }
    }
    EXPECT_GT(told_near_spheres, 0.5 * near_spheres);
    EXPECT_GT(signs[0], 100);
    EXPECT_GT(signs[1], 100);
    EXPECT_GT(signs[-1], 100);
}

TEST(Predicates, AreExactForAllExponents) {
    std::mt19937_64 random = seeded(12);
    std::map<int, int> signs;
    for (int i = 0; i < 1000; ++i) {
        std::array<Point, 5> p;
        for (Point& q : p) {
            q = {any_double(random), any_double(random), any_double(random)};
        }
        if (i % 2 == 0) {  // coplanar and cospherical
            p[3] = {p[0].x, p[1].y, p[2].z};
            p[1] = {p[0].x, p[1].y, p[0].z};
            p[2] = {p[0].x, p[0].y, p[2].z};
            p[4] = p[i / 2 % 4];
        }
        const int expected =
            static_cast<int>(CGAL::orientation(rational(p[0]), rational(p[1]), rational(p[2]), rational(p[3])));
        ASSERT_EQ(orientation(p[0], p[1], p[2], p[3]), expected);
        ASSERT_EQ(in_sphere(p[0], p[1], p[2], p[3], p[4]),
                  rational_sign({p[0], p[1], p[2], p[3]}, {0, 0, 0, 0}, p[4], 0));
        ++signs[expected];
    }
    EXPECT_GT(signs[0], 300);
    EXPECT_GT(signs[1], 100);
    EXPECT_GT(signs[-1], 100);
}

// Spheres.

TEST(Spheres, DecisionsAgreeWithRationalArithmetic) {
    std::mt19937_64 random = seeded(31);
    const RationalKernel kernel;
    const auto meets = kernel.compare_weighted_squared_radius_3_object();
    const auto side = kernel.power_side_of_bounded_power_sphere_3_object();
    int met = 0, in_conflict = 0, corners_in_conflict = 0, decided_by_zero = 0;
    for (const Frame& frame : {Frame{1, {}}, Frame{1, {1e6, -1e6, 1e6}}, Frame{1e-40, {}}, Frame{1e40, {}}}) {
        for (int i = 0; i < 2000; ++i) {
            // Integers with many ties, the same slightly disturbed, and balls of random radii.
            std::array<Ball, 5> b;
            const Points centers = i % 3 == 0 ? in_cube(5, random) : on_grid(5, 4, random);
            for (std::size_t k = 0; k < b.size(); ++k) {
                b[k] = {moved(centers[k], frame), frame.scale * (0.5 * static_cast<double>(random() % 5))};
                if (i % 3 == 2) {
                    b[k].center = slightly_disturbed(b[k].center, random);
                }
            }
            const auto at = [&](std::size_t k) { return rational(b[k]); };
            const auto point = [&](std::size_t k) { return rational(b[k].center); };
            if (CGAL::coplanar(point(0), point(1), point(2), point(3)) ||
                CGAL::collinear(point(0), point(1), point(2)) || point(0) == point(1)) {
                continue;
            }
            const auto is_met = [](CGAL::Comparison_result result) { return result != CGAL::LARGER; };
            ASSERT_EQ(meet(b[0], b[1]), is_met(meets(at(0), at(1), 0)));
            ASSERT_EQ(meet(b[0], b[1], b[2]), is_met(meets(at(0), at(1), at(2), 0)));
            ASSERT_EQ(meet(b[0], b[1], b[2], b[3]), is_met(meets(at(0), at(1), at(2), at(3), 0)));
            ASSERT_EQ(conflicts(b[0], b[4]), side(at(0), at(4)) == CGAL::ON_BOUNDED_SIDE);
            ASSERT_EQ(conflicts(b[0], b[1], b[4]), side(at(0), at(1), at(4)) == CGAL::ON_BOUNDED_SIDE);
            const CGAL::Bounded_side of_three = side(at(0), at(1), at(2), at(4));
            ASSERT_EQ(conflicts(b[0], b[1], b[2], b[4]), of_three == CGAL::ON_BOUNDED_SIDE);
            unsigned corners = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                const bool is_in =
                    side(at((k + 1) % 4), at((k + 2) % 4), at((k + 3) % 4), at(k)) == CGAL::ON_BOUNDED_SIDE;
                corners |= is_in ? 1U << k : 0U;
            }
            ASSERT_EQ(conflicts_of_corners(b[0], b[1], b[2], b[3]), corners);
            corners_in_conflict += corners != 0 ? 1 : 0;
            met += meet(b[0], b[1], b[2], b[3]) || meet(b[0], b[1], b[2]) ? 1 : 0;
            in_conflict += of_three == CGAL::ON_BOUNDED_SIDE ? 1 : 0;
            decided_by_zero += of_three == CGAL::ON_BOUNDARY || side(at(0), at(1), at(4)) == CGAL::ON_BOUNDARY ? 1 : 0;
        }
    }
    EXPECT_GT(met, 500);
    EXPECT_GT(in_conflict, 500);
    EXPECT_GT(corners_in_conflict, 500);
    EXPECT_GT(decided_by_zero, 50);
}

TEST(Spheres, CircumcentersOfFlatTetrahedraAgreeWithRationalArithmetic) {
    std::mt19937_64 random = seeded(37);
    int checked = 0;
    for (int i = 0; i < 1000; ++i) {
        Points p = on_grid(4, 5, random);
        for (Point& q : p) {
            q = slightly_disturbed(moved(q, {1, {10, 10, 10}}), random);
        }
        p[3] = slightly_disturbed(p[0] + (p[1] - p[0]) + (p[2] - p[0]), random);
        const Circumsphere sphere = circumsphere(p[0], p[1], p[2], p[3], 1e300);
        if (CGAL::coplanar(rational(p[0]), rational(p[1]), rational(p[2]), rational(p[3]))) {
            ASSERT_EQ(sphere.radius, INFINITY);
        } else if (std::isfinite(sphere.radius)) {
            const auto offset =
                CGAL::circumcenter(rational(p[0]), rational(p[1]), rational(p[2]), rational(p[3])) - rational(p[0]);
            const Point expected{CGAL::to_double(offset.x()), CGAL::to_double(offset.y()), CGAL::to_double(offset.z())};
            ASSERT_NEAR(sphere.radius, norm(expected), 1e-5 * norm(expected));
            ASSERT_LT(distance(sphere.center, p[0] + expected), 1e-5 * norm(expected));
            ++checked;
        }
    }
    EXPECT_GT(checked, 300);
}

// Triangles.

struct TrianglePair {
    Corners a, b;
};

/// Triangles of few integer coordinates: coplanar ones, common corners, corners on sides, sides that cross, …
TrianglePair triangles_of_grid(std::mt19937_64& random, bool is_flat) {
    const Points p = on_grid(6, is_flat ? 5 : 3, random);
    TrianglePair pair{{p[0], p[1], p[2]}, {p[3], p[4], p[5]}};
    if (is_flat) {  // in the plane x + 2 y = z
        for (Corners* const t : {&pair.a, &pair.b}) {
            for (Point& q : *t) {
                q.z = q.x + 2 * q.y;
            }
        }
    }
    return pair;
}

bool has_area(const Corners& t) { return first_sign_of_cross(t[0], t[1], t[0], t[2]) != 0; }

RationalKernel::Triangle_3 rational(const Corners& t) { return {rational(t[0]), rational(t[1]), rational(t[2])}; }

TEST(TriangleIntersection, AgreesWithCgal) {
    std::mt19937_64 random = seeded(41);
    const std::vector<Frame> frames{{1, {}}, {1e-160, {}}, {1e140, {}}, {1e-9, {1, 1, 1}}, {0.1, {1e3, 1e3, 1e3}}};
    std::map<bool, int> of_triangles, of_segments;
    for (const Frame& frame : frames) {
        for (int i = 0; i < 1200; ++i) {
            TrianglePair pair = triangles_of_grid(random, i % 2 == 0);
            for (Corners* const t : {&pair.a, &pair.b}) {
                for (Point& q : *t) {
                    q = moved(q, frame);
                    q = i % 3 == 0 ? slightly_disturbed(q, random) : q;
                }
            }
            if (!has_area(pair.a) || !has_area(pair.b)) {
                EXPECT_EQ(rational(pair.a).is_degenerate() || rational(pair.b).is_degenerate(), true);
                continue;
            }
            const bool expected = CGAL::do_intersect(rational(pair.a), rational(pair.b));
            ASSERT_EQ(intersect(pair.a, pair.b), expected) << "scale " << frame.scale << ", case " << i;
            ASSERT_EQ(intersect(pair.b, pair.a), expected) << "scale " << frame.scale << ", case " << i;
            const RationalKernel::Segment_3 side(rational(pair.b[0]), rational(pair.b[1]));
            const bool is_side_met = CGAL::do_intersect(rational(pair.a), side);
            ASSERT_EQ(intersect(pair.a, Ends{pair.b[0], pair.b[1]}), is_side_met)
                << "scale " << frame.scale << ", case " << i;
            ++of_triangles[expected];
            ++of_segments[is_side_met];
        }
    }
    EXPECT_GT(of_triangles[true], 500);
    EXPECT_GT(of_triangles[false], 500);
    EXPECT_GT(of_segments[true], 500);
    EXPECT_GT(of_segments[false], 500);
}

TEST(TriangleIntersection, OfTouchingTriangles) {
    const Corners t{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
    const auto meets = [&](const Point& a, const Point& b, const Point& c) { return intersect(t, {a, b, c}); };
    EXPECT_TRUE(meets({1, 1, 0}, {2, 1, 0}, {1, 2, 0})) << "inside, coplanar";
    EXPECT_TRUE(meets({1, 1, 0}, {1, 1, 1}, {2, 2, 1})) << "a corner on the face";
    EXPECT_TRUE(meets({4, 0, 0}, {5, 0, 1}, {5, 1, -1})) << "a common corner";
    EXPECT_TRUE(meets({2, 2, -1}, {2, 2, 1}, {5, 5, 0})) << "side on side, crossing";
    EXPECT_TRUE(meets({2, 0, 0}, {2, -1, 0}, {3, -1, 0})) << "a corner on a side, coplanar";
    EXPECT_FALSE(meets({2, -0x1p-1070, 0}, {2, -1, 0}, {3, -1, 0})) << "hardly apart, coplanar";
    EXPECT_FALSE(meets({1, 1, 0x1p-1070}, {1, 1, 1}, {2, 2, 1})) << "hardly above";
    EXPECT_FALSE(meets({3, 3, -1}, {3, 3, 1}, {5, 5, 0})) << "through the plane, beside";
    EXPECT_FALSE(meets({10, -1, 0}, {11, -1, 0}, {10, 0, 0})) << "coplanar, in line with a side";
}

// Orientation of normals.

std::vector<Point> oriented_by_cgal(const Points& points, const std::vector<Point>& normals, std::size_t neighbors) {
    using Kernel = CGAL::Simple_cartesian<double>;
    using Item = std::tuple<Kernel::Point_3, Kernel::Vector_3, std::size_t>;
    std::vector<Item> items;
    for (std::size_t i = 0; i < points.size(); ++i) {
        items.emplace_back(Kernel::Point_3(points[i].x, points[i].y, points[i].z),
                           Kernel::Vector_3(normals[i].x, normals[i].y, normals[i].z), i);
    }
    CGAL::mst_orient_normals(items, static_cast<unsigned>(neighbors),
                             CGAL::parameters::point_map(CGAL::Nth_of_tuple_property_map<0, Item>())
                                 .normal_map(CGAL::Nth_of_tuple_property_map<1, Item>()));
    std::vector<Point> result(points.size());
    for (const auto& [point, normal, i] : items) {
        result[i] = {normal.x(), normal.y(), normal.z()};
    }
    return result;
}

struct Cloud {
    Points points;
    std::vector<Point> normals;  // outward
};

Cloud torus(std::size_t count, std::mt19937_64& random) {
    std::uniform_real_distribution<double> angle(0, 2 * std::numbers::pi);
    Cloud cloud;
    for (std::size_t i = 0; i < count; ++i) {
        const double u = angle(random), v = angle(random);
        const Point radial{std::cos(u), std::sin(u), 0};
        const Point normal = std::cos(v) * radial + Point{0, 0, std::sin(v)};
        cloud.points.push_back(2 * radial + 0.7 * normal);
        cloud.normals.push_back(normal);
    }
    return cloud;
}

/// With normals as rounded at edges as estimates would be.
Cloud box(std::size_t count, std::mt19937_64& random) {
    Cloud cloud;
    for (const Point& p : in_cube(count, random)) {
        const double most = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        const Point q = (1 / most) * p;
        const auto bent = [](double x) { return std::pow(x, 15); };
        const Point normal{bent(q.x), bent(q.y), bent(q.z)};
        cloud.points.push_back(q);
        cloud.normals.push_back((1 / norm(normal)) * normal);
    }
    return cloud;
}

std::vector<double> no_noise(const Cloud& cloud) { return std::vector<double>(cloud.points.size(), 0.0); }

TEST(OrientConsistently, AgreesWithCgal) {
    std::mt19937_64 random = seeded(43);
    for (const Cloud& cloud : {torus(3000, random), box(4000, random)}) {
        std::vector<Point> normals = cloud.normals;
        for (Point& normal : normals) {
            normal = random() % 2 == 0 ? -1.0 * normal : normal;
        }
        EXPECT_NE(normals, cloud.normals);
        constexpr std::size_t kNeighbors = 18;
        const std::vector<Point> expected = oriented_by_cgal(cloud.points, normals, kNeighbors);
        std::vector<Index> all(cloud.points.size());
        std::iota(all.begin(), all.end(), 0);
        orient_consistently(cloud.points, all, no_noise(cloud), kNeighbors, normals);
        EXPECT_EQ(normals, expected);
        EXPECT_EQ(normals, cloud.normals);
    }
}

TEST(OrientConsistently, TurnsAroundFromOneSideOfAThinPartToTheOther) {
    std::mt19937_64 random = seeded(53);
    Cloud lens;  // twice as thick as its points are apart: most of these have neighbours on the other side
    constexpr double kThickness = 0.04;
    for (const Point& p : in_cube(8000, random)) {
        const Point q = (1 / norm(p)) * p;
        const Point normal{q.x, q.y, q.z / kThickness};
        lens.points.push_back({q.x, q.y, kThickness * q.z});
        lens.normals.push_back((1 / norm(normal)) * normal);
    }
    std::vector<Point> normals = lens.normals;
    for (Point& normal : normals) {
        normal = random() % 2 == 0 ? -1.0 * normal : normal;
    }
    std::vector<Index> all(lens.points.size());
    std::iota(all.begin(), all.end(), 0);
    orient_consistently(lens.points, all, no_noise(lens), 18, normals);
    EXPECT_EQ(normals, lens.normals);
}

TEST(OrientConsistently, TurnsThePartAlone) {
    std::mt19937_64 random = seeded(47);
    Cloud cloud = torus(1000, random);
    std::vector<Point> normals = cloud.normals;
    std::vector<Index> part;
    for (Index i = 0; i < 1000; ++i) {
        normals[i] = -1.0 * normals[i];
        if (i >= 200) {
            part.push_back(i);
        }
    }
    orient_consistently(cloud.points, part, no_noise(cloud), 18, normals);
    for (Index i = 0; i < 1000; ++i) {
        ASSERT_EQ(normals[i], i < 200 ? -1.0 * cloud.normals[i] : cloud.normals[i]) << i;
    }
}

}  // namespace
}  // namespace scaleaxis
