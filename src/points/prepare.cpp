// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
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

// A neighbourhood looks like a piece of a surface if it is thinner than this part of its radius.
constexpr double kFlatness = 0.1;

// So many points are looked at to choose one of them.
constexpr std::size_t kTrials = 2000;

// The kernel reaches over so many spacings where the fit takes the fewest neighbours: over about 28 points.
constexpr double kKernel = 3.0;

// Neighbours of a point within a surface leave no gap as large as this.
constexpr double kBorderGap = 0.8 * std::numbers::pi;

// Fewer points than this part on a border are chance.
constexpr double kFewBorderPoints = 0.01;

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// The side of the square that each point has for itself, averaged over its neighbours.
std::vector<double> spacings(const kernel::PointTree& tree, const std::vector<Point>& points) {
    const std::size_t neighbors = std::min(kSpacingNeighbors, points.size() - 1);
    std::vector<double> raw(points.size());
    const auto for_each_neighborhood = [&](const auto& visit) {
        kernel::for_each_index(points.size(), [&](std::size_t i) {
            static thread_local std::vector<kernel::NearPoint> near;
            kernel::nearest_points(tree, points[i], neighbors + 1, near);
            visit(i, near);
        });
    };
    for_each_neighborhood([&](std::size_t i, const std::vector<kernel::NearPoint>& near) {
        raw[i] = std::sqrt(near.back().squared_distance * std::numbers::pi / static_cast<double>(neighbors));
    });
    std::vector<double> result(points.size());
    for_each_neighborhood([&](std::size_t i, const std::vector<kernel::NearPoint>& near) {
        double sum = 0.0;
        for (const kernel::NearPoint& other : near) {
            sum += raw[tree.order[other.position]];
        }
        result[i] = sum / static_cast<double>(near.size());
    });
    return result;
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

bool is_usable(const Point& normal) { return is_finite(normal) && squared_norm(normal) > 0.0; }

/// Six times the volume that the points' squares enclose, as seen from their centre; those of `part` alone, if any.
double volume(const PreparedCloud& cloud, const std::vector<Index>& parts, Index part) {
    const std::vector<Point>& points = cloud.cloud.points;
    Point center;
    double count = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (part == kNone || parts[i] == part) {
            center = center + points[i];
            count += 1.0;
        }
    }
    center = (1.0 / count) * center;
    double sum = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (part == kNone || parts[i] == part) {
            sum += cloud.spacings[i] * cloud.spacings[i] * dot(cloud.cloud.normals[i], points[i] - center);
        }
    }
    return sum;
}

/// The winding number of the squares of other parts around `p` (G. Barill and others, "Fast winding numbers for soups
/// and clouds", 2018).
double winding_number(const PreparedCloud& cloud, const std::vector<Index>& parts, Index part, const Point& p) {
    double sum = 0.0;
    for (std::size_t i = 0; i < cloud.cloud.points.size(); ++i) {
        if (parts[i] != part) {
            const Point d = cloud.cloud.points[i] - p;
            const double length = norm(d);
            sum += cloud.spacings[i] * cloud.spacings[i] * dot(cloud.cloud.normals[i], d) / (length * length * length);
        }
    }
    return sum / (4.0 * std::numbers::pi);
}

void flip(std::vector<Point>& normals, const std::vector<Index>& parts, Index part) {
    for (std::size_t i = 0; i < normals.size(); ++i) {
        if (part == kNone || parts[i] == part) {
            normals[i] = -1.0 * normals[i];
        }
    }
}

/// All parts outward; then those within others inward, as cavities, and so on.
void orient_outward(PreparedCloud& cloud, const OrientedParts& parts) {
    for (Index part = 0; part < parts.count; ++part) {
        if (volume(cloud, parts.part, part) < 0.0) {
            flip(cloud.cloud.normals, parts.part, part);
        }
    }
    if (parts.count == 1) {
        return;
    }
    std::vector<bool> is_cavity(parts.count);
    for (Index part = 0; part < parts.count; ++part) {
        const auto first = std::ranges::find(parts.part, part) - parts.part.begin();
        const double around = winding_number(cloud, parts.part, part, cloud.cloud.points[first]);
        is_cavity[part] = std::lround(around) % 2 != 0;
    }
    for (Index part = 0; part < parts.count; ++part) {
        if (is_cavity[part]) {
            flip(cloud.cloud.normals, parts.part, part);
        }
    }
}

void use_given_normals(PreparedCloud& cloud, std::vector<Point> normals) {
    for (Point& normal : normals) {
        normal = (1.0 / norm(normal)) * normal;
    }
    cloud.cloud.normals = std::move(normals);
    if (volume(cloud, {}, kNone) < 0.0) {
        flip(cloud.cloud.normals, {}, kNone);
        cloud.report.are_normals_flipped = true;
    }
}

std::string number(double value) {
    std::ostringstream text;
    text.precision(2);
    text << value;
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
    const std::vector<Point>& points = result.cloud.points = std::move(cloud.points);
    report.duplicates = report.points - static_cast<Index>(points.size());
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
            report.border_points += fits[i].gap > kBorderGap ? 1 : 0;
        }
        report.noise = median(std::move(noise));
        if (report.has_normals && report.unknown_normals == 0) {
            use_given_normals(result, std::move(normals));
        } else {
            std::vector<Point>& estimated = result.cloud.normals;
            std::ranges::transform(fits, std::back_inserter(estimated), &LocalFit::normal);
            const OrientedParts parts = orient_consistently(points, estimated, neighbors);
            report.parts = parts.count;
            orient_outward(result, parts);
        }
        return std::move(result);
    });
}

std::vector<std::string> CloudReport::warnings() const {
    std::vector<std::string> result;
    if (duplicates > 0) {
        result.push_back(std::to_string(duplicates) + " of " + std::to_string(points) +
                         " points lie where others do: merged");
    }
    if (unknown_normals > 0) {
        result.push_back(std::to_string(unknown_normals) +
                         " normals have no direction (0 or not finite): all of them are estimated");
    }
    if (are_normals_flipped) {
        result.push_back("the normals point inward: all of them are flipped");
    }
    if (border_points > kFewBorderPoints * points) {
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
    return "estimated, and oriented in " + std::to_string(parts) + (parts == 1 ? " part" : " parts");
}

CloudChoice choose_method(const CloudReport& report) {
    constexpr double kCleanPoints = 0.1;
    if (report.parts == 0) {
        return {CloudMethod::kMovingLeastSquares, "the points have normals"};
    }
    const std::string noise = "noise of " + number(100.0 * report.noise) + " % of the points' spacing";
    if (report.noise > kCleanPoints) {
        return {CloudMethod::kMovingLeastSquares, noise};
    }
    return {CloudMethod::kCrust, "no normals, and " + noise + " only"};
}

}  // namespace scaleaxis
