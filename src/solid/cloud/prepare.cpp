// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <sstream>
#include <utility>

#include "kernel/parallel.hpp"
#include "kernel/point_tree.hpp"
#include "points/normals.hpp"
#include "scaleaxis/points.hpp"
#include "shapes/weld.hpp"

namespace scaleaxis {
namespace {

constexpr std::size_t kSpacingNeighbors = 8;

// Numbers of neighbours that a local fit is tried with: the first one for clean points, more for noisy ones.
constexpr std::array<std::size_t, 5> kFitNeighbors{12, 24, 48, 96, 192};

// A point is left out if its neighbours are so many times farther away than these have theirs.
constexpr double kOutlier = 5.0;

// A neighbourhood looks like a piece of a surface if it is thinner than this part of its radius.
constexpr double kFlatness = 0.1;

// So many points are looked at to choose one of them.
constexpr std::size_t kTrials = 2000;

// The kernel reaches over so many spacings where the fit takes the fewest neighbours: over about 28 points.
constexpr double kKernel = 3.0;

// Neighbours of a point within a surface leave no gap as large as this, if they are twice as many as a fit takes.
constexpr double kBorderGap = 0.8 * std::numbers::pi;

// Given normals are against each other where parts are thinner than the points are apart, but not at more than this
// part of the points.
constexpr double kFewOpposedNormals = 0.1;

// From this part on they are worth a warning.
constexpr double kHardlyAnyOpposedNormals = 0.02;

// Fewer points than this part on a border are chance.
constexpr double kFewBorderPoints = 0.01;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Calls `visit(i, nearest points)` for each point, itself among the nearest ones.
template <class Visit>
void for_each_neighborhood(const kernel::PointTree& tree, const std::vector<Point>& points, const Visit& visit) {
    kernel::for_each_index(
        points.size(),
        [&](std::size_t i) {
            static thread_local std::vector<kernel::NearPoint> near;
            kernel::nearest_points(tree, points[i], std::min(kSpacingNeighbors, points.size() - 1) + 1, near);
            visit(i, near);
        },
        std::size_t{256});
}

/// The side of the square that each point has for itself.
std::vector<double> raw_spacings(const kernel::PointTree& tree, const std::vector<Point>& points) {
    std::vector<double> result(points.size());
    for_each_neighborhood(tree, points, [&](std::size_t i, const std::vector<kernel::NearPoint>& near) {
        result[i] = std::sqrt(near.back().squared_distance * std::numbers::pi / static_cast<double>(near.size() - 1));
    });
    return result;
}

/// The same, averaged over neighbours.
std::vector<double> spacings(const kernel::PointTree& tree, const std::vector<Point>& points) {
    const std::vector<double> raw = raw_spacings(tree, points);
    std::vector<double> result(points.size());
    for_each_neighborhood(tree, points, [&](std::size_t i, const std::vector<kernel::NearPoint>& near) {
        double sum = 0.0;
        for (const kernel::NearPoint& other : near) {
            sum += raw[tree.order[other.position]];
        }
        result[i] = sum / static_cast<double>(near.size());
    });
    return result;
}

/// Which points are much farther from their neighbours than these are from each other?
std::vector<std::uint8_t> find_outliers(const std::vector<Point>& points) {
    const kernel::PointTree tree = kernel::build_point_tree(points);
    const std::vector<double> raw = raw_spacings(tree, points);
    std::vector<std::uint8_t> is_outlier(points.size());
    for_each_neighborhood(tree, points, [&](std::size_t i, const std::vector<kernel::NearPoint>& near) {
        std::vector<double> around;
        for (const kernel::NearPoint& other : near) {
            around.push_back(raw[tree.order[other.position]]);
        }
        is_outlier[i] = raw[i] > kOutlier * median(around) ? 1 : 0;
    });
    return is_outlier;
}

template <class T>
void remove_marked(std::vector<T>& items, const std::vector<std::uint8_t>& is_marked) {
    std::size_t i = 0;
    std::erase_if(items, [&](const T&) { return is_marked[i++] != 0; });
}

std::vector<LocalFit> local_fits(const kernel::PointTree& tree, const std::vector<Point>& points, std::size_t step,
                                 std::size_t neighbors) {
    std::vector<LocalFit> fits((points.size() + step - 1) / step);
    kernel::for_each_index(
        fits.size(),
        [&](std::size_t i) {
            static thread_local std::vector<kernel::NearPoint> memory;
            fits[i] = fit_locally(tree, points[i * step], neighbors, memory);
        },
        std::size_t{64});
    return fits;
}

/// The fewest neighbours among which noise does not hide the surface.
std::size_t fit_neighbors(const kernel::PointTree& tree, const std::vector<Point>& points) {
    const std::size_t step = std::max<std::size_t>(1, points.size() / kTrials);
    std::size_t best = kFitNeighbors[0];
    double thinnest = std::numeric_limits<double>::infinity();
    for (const std::size_t neighbors : kFitNeighbors) {
        if (neighbors * 4 > points.size() && neighbors > kFitNeighbors[0]) {
            break;
        }
        std::vector<double> thickness;
        for (const LocalFit& fit : local_fits(tree, points, step, std::min(neighbors, points.size() - 1))) {
            thickness.push_back(fit.residual / fit.radius);
        }
        const double typical = median(thickness);
        if (typical < thinnest) {
            thinnest = typical;
            best = neighbors;
        }
        if (typical < kFlatness) {
            break;
        }
    }
    return std::min(best, points.size() - 1);
}

Index count_border_points(const kernel::PointTree& tree, const std::vector<Point>& points,
                          const std::vector<LocalFit>& fits, std::size_t neighbors) {
    std::vector<std::uint8_t> is_on_border(points.size());
    kernel::for_each_index(
        points.size(),
        [&](std::size_t i) {
            static thread_local std::vector<kernel::NearPoint> memory;
            is_on_border[i] = largest_gap(tree, points[i], fits[i].normal, neighbors, memory) > kBorderGap ? 1 : 0;
        },
        std::size_t{64});
    return static_cast<Index>(std::ranges::count(is_on_border, 1));
}

/// How many points have a normal against that of the nearest other point? On the two sides of something thin they
/// should, but points are nearer to each other than to the other side there.
Index count_opposed(const kernel::PointTree& tree, const std::vector<Point>& points,
                    const std::vector<Point>& normals) {
    std::vector<std::uint8_t> is_opposed(points.size());
    for_each_neighborhood(tree, points, [&](std::size_t i, const std::vector<kernel::NearPoint>& near) {
        is_opposed[i] = dot(normals[i], normals[tree.order[near[1].position]]) < 0.0 ? 1 : 0;
    });
    return static_cast<Index>(std::ranges::count(is_opposed, 1));
}

bool is_usable(const Point& normal) { return is_finite(normal) && squared_norm(normal) > 0.0; }

/// What the squares that points have for themselves enclose, as seen from their centre, up to a factor > 0.
double volume(const PreparedCloud& cloud, std::span<const Index> part) {
    const std::vector<Point>& points = cloud.cloud.points;
    Point center;
    for (const Index i : part) {
        center = center + (1.0 / static_cast<double>(part.size())) * points[i];
    }
    double sum = 0.0;
    for (const Index i : part) {
        sum += cloud.spacings[i] * cloud.spacings[i] * dot(cloud.cloud.normals[i], points[i] - center);
    }
    return sum;
}

/// The winding number of these squares around `p` (G. Barill and others, "Fast winding numbers for soups and clouds",
/// 2018).
double winding_number(const PreparedCloud& cloud, std::span<const Index> part, const Point& p) {
    double sum = 0.0;
    for (const Index i : part) {
        const Point d = cloud.cloud.points[i] - p;
        const double length = norm(d);
        sum += cloud.spacings[i] * cloud.spacings[i] * dot(cloud.cloud.normals[i], d) / (length * length * length);
    }
    return sum / (4.0 * std::numbers::pi);
}

void flip(std::vector<Point>& normals, std::span<const Index> part) {
    for (const Index i : part) {
        normals[i] = -1.0 * normals[i];
    }
}

/// All parts outward; then those within others inward, as cavities, and so on.
void orient_outward(PreparedCloud& cloud, const IndexLists& parts) {
    const std::vector<Point>& points = cloud.cloud.points;
    std::vector<Box> boxes(parts.size());
    for (std::size_t part = 0; part < parts.size(); ++part) {
        for (const Index i : parts[part]) {
            boxes[part].extend(points[i]);
        }
        if (volume(cloud, parts[part]) < 0.0) {
            flip(cloud.cloud.normals, parts[part]);
        }
    }
    std::vector<std::size_t> cavities;
    for (std::size_t part = 0; part < parts.size(); ++part) {
        const Point& p = points[parts[part][0]];
        double around = 0.0;
        for (std::size_t other = 0; other < parts.size(); ++other) {
            if (other != part && boxes[other].contains(p)) {
                around += winding_number(cloud, parts[other], p);
            }
        }
        if (std::lround(around) % 2 != 0) {
            cavities.push_back(part);
        }
    }
    for (const std::size_t part : cavities) {
        flip(cloud.cloud.normals, parts[part]);
    }
}

/// As a whole only.
void turn_outward(PreparedCloud& cloud) {
    std::vector<Index> all(cloud.cloud.normals.size());
    std::iota(all.begin(), all.end(), 0);
    if (volume(cloud, all) < 0.0) {
        flip(cloud.cloud.normals, all);
        cloud.report.are_normals_flipped = true;
    }
}

bool is_open(const CloudReport& report) { return report.border_points > kFewBorderPoints * report.points; }

std::string number(double value) {
    std::ostringstream text;
    text.precision(value < 10.0 ? 2 : 9);
    text << (value < 10.0 ? value : std::round(value));
    return text.str();
}

}  // namespace

PreparedCloud prepare(PointCloud cloud, const Execution& execution) {
    PreparedCloud result;
    CloudReport& report = result.report;
    report.points = static_cast<Index>(cloud.points.size());
    const std::vector<Index> places = weld(cloud.points);
    std::vector<Point> normals(cloud.normals.empty() ? 0 : cloud.points.size());
    for (std::size_t i = cloud.normals.size(); i-- > 0;) {
        normals[places[i]] = cloud.normals[i];
    }
    report.duplicates = report.points - static_cast<Index>(cloud.points.size());
    if (cloud.points.size() > kSpacingNeighbors) {
        const std::vector<std::uint8_t> is_outlier =
            kernel::in_arena(execution, [&] { return find_outliers(cloud.points); });
        report.outliers = static_cast<Index>(std::ranges::count(is_outlier, 1));
        if (report.outliers > 0) {
            remove_marked(cloud.points, is_outlier);
            if (!normals.empty()) {
                remove_marked(normals, is_outlier);
            }
        }
    }
    const std::vector<Point>& points = result.cloud.points = std::move(cloud.points);
    for (const Point& p : points) {
        report.bounds.extend(p);
    }
    report.has_normals = !normals.empty();
    report.unknown_normals =
        static_cast<Index>(std::ranges::count_if(normals, [](const Point& n) { return !is_usable(n); }));
    if (points.size() < 4) {
        report.fault = "there are " + std::to_string(points.size()) +
                       " different points: a solid needs four at least, and many more to be of use";
        return result;
    }
    if (are_coplanar(points)) {
        report.fault = "all points lie in a plane: they bound no solid";
        return result;
    }
    return kernel::in_arena(execution, [&] {
        const kernel::PointTree tree = kernel::build_point_tree(points);
        result.spacings = spacings(tree, points);
        report.spacing = median(result.spacings);
        const std::size_t neighbors = fit_neighbors(tree, points);
        report.kernel = kKernel * std::sqrt(static_cast<double>(neighbors) / static_cast<double>(kFitNeighbors[0]));
        const std::vector<LocalFit> fits = local_fits(tree, points, 1, neighbors);
        std::vector<double> noise(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            noise[i] = fits[i].residual / result.spacings[i];
        }
        report.noise = median(std::move(noise));
        report.border_points = count_border_points(tree, points, fits, 2 * neighbors);
        std::vector<Point>& chosen = result.cloud.normals;
        if (report.has_normals && report.unknown_normals == 0) {
            chosen = std::move(normals);
            for (Point& normal : chosen) {
                normal = (1.0 / norm(normal)) * normal;
            }
            report.opposed_normals = count_opposed(tree, points, chosen);
            if (!report.are_normals_inconsistent()) {
                turn_outward(result);
                return std::move(result);
            }
        } else {
            std::ranges::transform(fits, std::back_inserter(chosen), &LocalFit::normal);
        }
        const IndexLists parts = connected_parts(tree, points, neighbors);
        for (std::size_t part = 0; part < parts.size(); ++part) {
            orient_consistently(points, parts[part], neighbors, chosen);
        }
        report.parts = static_cast<Index>(parts.size());
        orient_outward(result, parts);
        return std::move(result);
    });
}

bool CloudReport::are_normals_inconsistent() const { return opposed_normals > kFewOpposedNormals * points; }

std::vector<std::string> CloudReport::warnings() const {
    std::vector<std::string> result;
    if (duplicates > 0) {
        result.push_back(std::to_string(duplicates) + " of " + std::to_string(points) +
                         " points lie where others do: merged");
    }
    if (outliers > 0) {
        result.push_back(std::to_string(outliers) + " of " + std::to_string(points) +
                         " points lie far from all others: left out");
    }
    if (unknown_normals > 0) {
        result.push_back(std::to_string(unknown_normals) +
                         " normals have no direction (0 or not finite): all of them are estimated");
    }
    if (opposed_normals > kHardlyAnyOpposedNormals * points) {
        result.push_back("the normals of " + std::to_string(opposed_normals) + " of " + std::to_string(points) +
                         " points are against those of the nearest point: " +
                         (are_normals_inconsistent()
                              ? "all of them are turned anew"
                              : "parts are thinner than the points are apart, or some normals point inward"));
    }
    if (are_normals_flipped) {
        result.push_back("the normals point inward: all of them are flipped");
    }
    if (is_open(*this)) {
        result.push_back(std::to_string(border_points) +
                         " points lie on a border, so that the surface is open there: it is continued as it comes, and "
                         "closed where the points end");
    }
    return result;
}

std::string CloudReport::note() const {
    if (parts == 0) {
        return are_normals_flipped ? "given, and flipped" : "as given";
    }
    return std::string(are_normals_inconsistent() ? "as given, but" : "estimated, and") + " oriented in " +
           std::to_string(parts) + (parts == 1 ? " part" : " parts");
}

CloudChoice choose_method(const PreparedCloud& cloud, const Execution& execution) {
    constexpr double kCleanPoints = 0.25;
    constexpr double kFewIrregularPoints = 0.02;
    const auto moving_least_squares = [](const std::string& reason) {
        return CloudChoice{CloudMethod::kMovingLeastSquares, reason, std::nullopt};
    };
    const CloudReport& report = cloud.report;
    const std::string noise = "noise of " + number(100.0 * report.noise) + " % of the points' spacing";
    if (report.parts == 0 && report.fault.empty()) {
        return moving_least_squares("the points have normals");
    }
    if (is_open(report)) {
        return moving_least_squares("the surface is open");
    }
    if (report.noise > kCleanPoints) {
        return moving_least_squares(noise);
    }
    Samples samples = crust(cloud, execution);
    const std::string irregular = std::to_string(samples.statistics.irregular_samples) + " of " +
                                  std::to_string(samples.points.size()) + " points are irregular";
    if (samples.statistics.irregular_samples > kFewIrregularPoints * static_cast<double>(samples.points.size())) {
        return moving_least_squares("the points as they are form no surface: " + irregular);
    }
    return {CloudMethod::kCrust, "no normals, and the points as they are form a surface: " + irregular + ", " + noise,
            std::move(samples)};
}

}  // namespace scaleaxis
