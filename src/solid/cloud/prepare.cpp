// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/grouped.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/errors.hpp"
#include "solid/cloud/normals.hpp"
#include "solid/cloud/outliers.hpp"
#include "solid/dipole_tree.hpp"
#include "spatial/extent.hpp"
#include "spatial/point_tree.hpp"
#include "spatial/poisson_disk.hpp"
#include "spatial/weld.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kNormalsStage = "normals";

constexpr std::size_t kSpacingNeighbors = 8;

// Numbers of neighbours that a local fit is tried with: the first one for clean points, more for noisy ones.
constexpr std::array<std::size_t, 5> kFitNeighbors{12, 24, 48, 96, 192};

// A neighbourhood looks like a piece of a surface if it is thinner than this part of its radius.
constexpr double kFlatness = 0.1;

// Points that are looked at to choose one of them.
constexpr std::size_t kTrials = 2000;

// Reach of the kernel, in spacings, where the fit takes the fewest neighbours: over about 28 points.
constexpr double kKernel = 3.0;

// Neighbours of a point within a surface leave no gap as large as this, if they are twice as many as a fit takes.
constexpr double kBorderGap = 0.8 * std::numbers::pi;

// Given normals are against each other where parts are thinner than the points are apart, but not at more than this
// part of the points.
constexpr double kFewOpposedNormals = 0.1;

// From this part on they are worth a warning.
constexpr double kHardlyAnyOpposedNormals = 0.02;

// Fewer points than this part on a border are chance, unless as many as this surround one hole. Along its rim points
// are no farther apart than this, in spacings.
constexpr double kFewBorderPoints = 0.01;
constexpr Index kFewestRimPoints = 8;
constexpr double kRimGap = 5.0;

/// Calls `visit(i, nearest points)` for each point, itself among the nearest ones.
template <class Visit>
void for_each_neighborhood(const PointTree& tree, const std::vector<Point>& points, const Visit& visit) {
    for_each_index(
        points.size(),
        [&](std::size_t i) {
            static thread_local std::vector<NearPoint> near;
            nearest_points(tree, points[i], std::min(kSpacingNeighbors, points.size() - 1) + 1, near);
            visit(i, near);
        },
        std::size_t{256});
}

/// The side of the square that each point has for itself.
std::vector<double> raw_spacings(const PointTree& tree, const std::vector<Point>& points) {
    std::vector<double> result(points.size());
    for_each_neighborhood(tree, points, [&](std::size_t i, const std::vector<NearPoint>& near) {
        result[i] = std::sqrt(near.back().squared_distance * std::numbers::pi / static_cast<double>(near.size() - 1));
    });
    return result;
}

/// The same, averaged over neighbours.
std::vector<double> spacings(const PointTree& tree, const std::vector<Point>& points) {
    const std::vector<double> raw = raw_spacings(tree, points);
    std::vector<double> result(points.size());
    for_each_neighborhood(tree, points, [&](std::size_t i, const std::vector<NearPoint>& near) {
        double sum = 0.0;
        for (const NearPoint& other : near) {
            sum += raw[tree.order[other.position]];
        }
        result[i] = sum / static_cast<double>(near.size());
    });
    return result;
}

std::vector<LocalFit> local_fits(const PointTree& tree, const std::vector<Point>& points, std::size_t step,
                                 std::size_t neighbors) {
    return mapped<LocalFit>((points.size() + step - 1) / step,
                            [&](std::size_t i) {
                                static thread_local std::vector<NearPoint> memory;
                                return fit_locally(tree, points[i * step], neighbors, memory);
                            },
                            std::size_t{64});
}

/// The fewest neighbours among which noise does not hide the surface.
std::size_t fit_neighbors(const PointTree& tree, const std::vector<Point>& points) {
    const std::size_t step = std::max<std::size_t>(1, points.size() / kTrials);
    std::size_t best = kFitNeighbors[0];
    double thinnest = std::numeric_limits<double>::infinity();
    for (const std::size_t neighbors : kFitNeighbors) {
        if (neighbors * 4 > points.size() && neighbors > kFitNeighbors[0]) {
            break;
        }
        const auto thickness = each_of<double>(local_fits(tree, points, step, std::min(neighbors, points.size() - 1)),
                                               [&](const LocalFit& fit) { return fit.residual / fit.radius; });
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

/// The points that have others on one side only.
std::vector<Index> find_border(const PointTree& tree, const std::vector<Point>& points,
                               const std::vector<LocalFit>& fits, std::size_t neighbors) {
    const auto is_on_border = mapped<std::uint8_t>(
        points.size(),
        [&](std::size_t i) {
            static thread_local std::vector<NearPoint> memory;
            return largest_gap(tree, points[i], fits[i].normal, neighbors, memory) > kBorderGap ? 1 : 0;
        },
        std::size_t{64});
    return indices_where(points.size(), [&](Index i) { return is_on_border[i] != 0; });
}

/// Groups of border points that are close together; few of them are chance. The widest first.
std::vector<CloudHole> find_holes(const PreparedCloud& cloud, std::span<const Index> border) {
    const auto rims = each_of<Point>(border, [&](Index i) { return cloud.cloud.points[i]; });
    if (rims.empty()) {
        return {};
    }
    const PointTree tree = build_point_tree(rims);
    DisjointSets sets(static_cast<Index>(rims.size()));
    CancellationPoint cancellation_point;
    for (std::size_t i = 0; i < rims.size(); ++i, cancellation_point()) {
        for_each_point_near(tree, rims[i], kRimGap * cloud.spacings[border[i]],
                            [&](Index position, double) { sets.join(static_cast<Index>(i), tree.order[position]); });
    }
    struct Rim {
        Box box;
        Index points = 0;
    };
    std::vector<Rim> of_set(rims.size());
    for (std::size_t i = 0; i < rims.size(); ++i) {
        Rim& rim = of_set[sets.find(static_cast<Index>(i))];
        rim.box.extend(rims[i]);
        ++rim.points;
    }
    std::vector<CloudHole> holes;
    for (std::size_t i = 0; i < rims.size(); ++i) {
        if (of_set[i].points >= kFewestRimPoints) {
            holes.push_back({rims[i], of_set[i].box.diagonal(), of_set[i].points});
        }
    }
    std::ranges::stable_sort(holes, std::ranges::greater(), &CloudHole::width);
    return holes;
}

/// How many points have a normal against that of the nearest other point? On the two sides of something thin they
/// should, but points are nearer to each other than to the other side there.
Index count_opposed(const PointTree& tree, const std::vector<Point>& points, const std::vector<Point>& normals) {
    std::vector<std::uint8_t> is_opposed(points.size());
    for_each_neighborhood(tree, points, [&](std::size_t i, const std::vector<NearPoint>& near) {
        is_opposed[i] = dot(normals[i], normals[tree.order[near[1].position]]) < 0.0 ? 1 : 0;
    });
    return static_cast<Index>(std::ranges::count(is_opposed, 1));
}

bool has_direction(const Point& normal) { return is_finite(normal) && normal != Point{}; }

/// A usable vector of length 1, however long it was: its square may be beyond the range of a double.
Point normalized(const Point& vector) {
    const int exponent = std::ilogb(std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)}));
    const Point scaled{std::scalbn(vector.x, -exponent), std::scalbn(vector.y, -exponent),
                       std::scalbn(vector.z, -exponent)};
    return (1.0 / norm(scaled)) * scaled;
}

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

/// The part of all directions in which `p` sees these squares from behind: 1 for a point that they enclose, 0 outside
/// (G. Barill and others, "Fast winding numbers for soups and clouds", 2018).
double enclosed_share(const PreparedCloud& cloud, std::span<const Index> part, const Point& p) {
    double sum = 0.0;
    for (const Index i : part) {
        const Point d = cloud.cloud.points[i] - p;
        sum += cloud.spacings[i] * cloud.spacings[i] * dipole_angle(cloud.cloud.normals[i], d);
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
        stop_if_cancelled();
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
            stop_if_cancelled();
            if (other != part && boxes[other].contains(p)) {
                around += enclosed_share(cloud, parts[other], p);
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

/// All points as one part: of an open surface only the whole tells which side is out.
IndexLists as_one_part(std::size_t points) {
    return grouped(1, [&](const auto& add) {
        for (Index i = 0; i < static_cast<Index>(points); ++i) {
            add(0, i);
        }
    });
}

/// Why the arrays are no cloud at all; empty if they are.
Diagnostic find_bad_data(const PointCloud& cloud) {
    if (cloud.points.size() > std::numeric_limits<Index>::max()) {
        return {"points.too_many", "too many points: " + std::to_string(cloud.points.size()) + "; reduce them to " +
                                       std::to_string(std::numeric_limits<Index>::max())};
    }
    if (!cloud.normals.empty() && cloud.normals.size() != cloud.points.size()) {
        return {"points.normals", std::to_string(cloud.normals.size()) + " normals for " +
                                      std::to_string(cloud.points.size()) +
                                      " points: give one for each point, (0, 0, 0) where it is unknown, or none"};
    }
    return {};
}

/// Why points bound no solid that can be computed with; empty if they may bound one.
Diagnostic find_extent_fault(std::span<const Point> points) {
    if (points.size() < 4) {
        return {"points.few", "there are " + std::to_string(points.size()) +
                                  " different points: a solid needs four at least, and many more to be of use"};
    }
    return extent_fault(box_around(points), "points");
}

/// Merges points at the same place; their normal is the first one's.
void merge_duplicates(PointCloud& cloud, CloudReport& report) {
    const std::vector<Index> places = weld(cloud.points);
    std::vector<Point> normals(cloud.normals.empty() ? 0 : cloud.points.size());
    for (std::size_t i = cloud.normals.size(); i-- > 0;) {
        normals[places[i]] = cloud.normals[i];
    }
    cloud.normals = std::move(normals);
    report.duplicates = report.points - report.not_finite - static_cast<Index>(cloud.points.size());
}

void remove_marked(PointCloud& cloud, const std::vector<std::uint8_t>& is_marked) {
    erase_marked(cloud.points, is_marked);
    if (!cloud.normals.empty()) {
        erase_marked(cloud.normals, is_marked);
    }
}

void remove_not_finite(PointCloud& cloud, CloudReport& report) {
    const auto is_bad = each_of<std::uint8_t>(cloud.points, [](const Point& p) { return is_usable(p) ? 0 : 1; });
    report.not_finite = static_cast<Index>(std::ranges::count(is_bad, 1));
    if (report.not_finite > 0) {
        remove_marked(cloud, is_bad);
    }
}

void remove_far_points(PointCloud& cloud, CloudReport& report) {
    const std::vector<std::uint8_t> is_far = find_far_points(cloud.points);
    report.outliers = static_cast<Index>(std::ranges::count(is_far, 1));
    if (report.outliers > 0) {
        remove_marked(cloud, is_far);
    }
}

/// The cloud without points that are closer than `least` to one that stays; as it is where half of them would stay.
PointCloud thinned(const PointCloud& cloud, double least) {
    const std::size_t count = cloud.points.size();
    PointCloud result;
    if (least > 0.0) {
        result.points = poisson_disk_subset(cloud.points, least, 0);
    }
    const std::size_t kept = result.points.size();
    if (kept < 4 || 2 * kept > count) {
        return cloud;
    }
    if (!cloud.normals.empty()) {
        // At whose place is a point? The first ones of the list are those that stay.
        std::vector<Point> all = result.points;
        append(all, cloud.points);
        const std::vector<Index> places = weld(all);
        result.normals.resize(kept);
        for (std::size_t i = 0; i < count; ++i) {
            if (const auto place = static_cast<std::size_t>(places[kept + i]); place < kept) {
                result.normals[place] = cloud.normals[i];
            }
        }
    }
    return result;
}

/// \param given the points before they were thinned
void remove_outliers(PointCloud& cloud, const std::vector<Point>& given, CloudReport& report) {
    if (cloud.points.size() <= kSpacingNeighbors) {
        return;
    }
    const std::size_t neighbors = fit_neighbors(build_point_tree(cloud.points), cloud.points);
    const std::vector<std::uint8_t> is_outlier = find_outliers(cloud.points, given, neighbors);
    if (const std::ptrdiff_t outliers = std::ranges::count(is_outlier, 1); outliers > 0) {
        report.outliers += static_cast<Index>(outliers);
        remove_marked(cloud, is_outlier);
    }
}

/// Distances, noise and normals of distinct points. \param given the normals given, or none
void analyse(PreparedCloud& result, std::vector<Point> given, const Execution& execution) {
    const std::vector<Point>& points = result.cloud.points;
    CloudReport& report = result.report;
    const PointTree tree = build_point_tree(points);
    result.spacings = spacings(tree, points);
    report.spacing = median(result.spacings);
    scaleaxis::report(execution, kNormalsStage, 0.2);
    const std::size_t neighbors = fit_neighbors(tree, points);
    report.kernel = kKernel * std::sqrt(static_cast<double>(neighbors) / static_cast<double>(kFitNeighbors[0]));
    const std::vector<LocalFit> fits = local_fits(tree, points, 1, neighbors);
    std::vector<double> noise(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        noise[i] = fits[i].residual / result.spacings[i];
    }
    report.noise = median(std::move(noise));
    scaleaxis::report(execution, kNormalsStage, 0.4);
    const std::vector<Index> border = find_border(tree, points, fits, 2 * neighbors);
    report.border_points = static_cast<Index>(border.size());
    report.holes = find_holes(result, border);
    scaleaxis::report(execution, kNormalsStage, 0.6);
    std::vector<Point>& chosen = result.cloud.normals;
    if (report.has_normals && report.unknown_normals == 0) {
        chosen = std::move(given);
        std::ranges::transform(chosen, chosen.begin(), normalized);
        report.opposed_normals = count_opposed(tree, points, chosen);
        if (!report.are_normals_inconsistent()) {
            const std::vector<Point> before = chosen;
            orient_outward(result,
                           report.is_open() ? as_one_part(points.size()) : connected_parts(tree, points, neighbors));
            for (std::size_t i = 0; i < points.size(); ++i) {
                report.flipped_normals += chosen[i] == before[i] ? 0 : 1;
            }
            return;
        }
    } else {
        std::ranges::transform(fits, std::back_inserter(chosen), &LocalFit::normal);
    }
    const IndexLists parts = connected_parts(tree, points, neighbors);
    // That of all points: where the two sides of a thin part are mixed up, the points of one are no noise of the other.
    const auto deviations = each_of<double>(result.spacings, [&](double spacing) { return report.noise * spacing; });
    for (std::size_t part = 0; part < parts.size(); ++part) {
        stop_if_cancelled();
        orient_consistently(points, parts[part], deviations, neighbors, chosen);
    }
    report.parts = static_cast<Index>(parts.size());
    orient_outward(result, parts);
}

}  // namespace

PreparedCloud prepare(PointCloud cloud, const PrepareOptions& options, const Execution& execution) {
    require(options.thinning >= 0.0 && std::isfinite(options.thinning),
            "the distance to which points are thinned must be a length of at least 0");
    return in_arena(execution, [&] {
        PreparedCloud result;
        CloudReport& report = result.report;
        scaleaxis::report(execution, kNormalsStage, 0.0);
        report.fault = find_bad_data(cloud);
        if (!report.fault.empty()) {
            return result;
        }
        report.points = static_cast<Index>(cloud.points.size());
        remove_not_finite(cloud, report);
        merge_duplicates(cloud, report);
        remove_far_points(cloud, report);
        report.fault = find_extent_fault(cloud.points);
        if (report.fault.empty()) {
            const std::vector<Point> given = std::exchange(cloud, thinned(cloud, options.thinning)).points;
            report.thinned = static_cast<Index>(given.size() - cloud.points.size());
            remove_outliers(cloud, given, report);
            report.fault = find_extent_fault(cloud.points);
        }
        report.bounds = box_around(cloud.points);
        report.has_normals = !cloud.normals.empty();
        report.unknown_normals =
            static_cast<Index>(std::ranges::count_if(cloud.normals, [](const Point& n) { return !has_direction(n); }));
        result.cloud.points = std::move(cloud.points);
        if (report.fault.empty() && are_coplanar(result.cloud.points)) {
            report.fault = {"points.coplanar", "all points lie in a plane: they bound no solid"};
        }
        if (report.fault.empty()) {
            analyse(result, std::move(cloud.normals), execution);
        }
        scaleaxis::report(execution, kNormalsStage, 1.0);
        return result;
    });
}

PreparedCloud prepare(const CloudView& cloud, const PrepareOptions& options, const Execution& execution) {
    return prepare(PointCloud{{cloud.points.begin(), cloud.points.end()}, {cloud.normals.begin(), cloud.normals.end()}},
                   options, execution);
}

Index CloudReport::kept() const { return points - not_finite - duplicates - thinned - outliers; }

bool CloudReport::are_normals_inconsistent() const { return opposed_normals > kFewOpposedNormals * kept(); }

std::vector<Diagnostic> CloudReport::warnings() const {
    std::vector<Diagnostic> result;
    if (not_finite > 0) {
        result.push_back(
            {"points.not_finite", std::to_string(not_finite) + " of " + std::to_string(points) +
                                      " points have a coordinate that is not a finite number up to 1e18: left out"});
    }
    if (duplicates > 0) {
        result.push_back({"points.duplicates", std::to_string(duplicates) + " of " + std::to_string(points) +
                                                   " points lie where others do: merged"});
    }
    if (outliers > 0) {
        result.push_back({"points.outliers", std::to_string(outliers) + " of " + std::to_string(points) +
                                                 " points lie off the surface of the others: left out"});
    }
    if (unknown_normals > 0) {
        result.push_back(
            {"points.unknown_normals", std::to_string(unknown_normals) +
                                           " normals have no direction (0 or not finite): all of them are estimated"});
    }
    if (opposed_normals > kHardlyAnyOpposedNormals * kept()) {
        result.push_back({"points.opposed_normals",
                          "the normals of " + std::to_string(opposed_normals) + " of " + std::to_string(kept()) +
                              " points are against those of the nearest point: " +
                              (are_normals_inconsistent()
                                   ? "all of them are turned anew"
                                   : "parts are thinner than the points are apart, or some normals point inward")});
    }
    if (flipped_normals > 0) {
        result.push_back(
            {"points.flipped_normals",
             "the normals of " +
                 (flipped_normals == kept() ? "all"
                                            : std::to_string(flipped_normals) + " of " + std::to_string(kept())) +
                 " points point into the solid: they are flipped"});
    }
    if (is_open() || !holes.empty()) {
        Words places;
        if (!holes.empty()) {
            places << ", at " << counted(std::ssize(holes), "place") << ", the widest of them " << holes.front().width
                   << " across, at " << to_text(holes.front().place);
        }
        result.push_back(
            {"points.open", std::to_string(border_points) +
                                " points lie on a border, so that the surface is open there" + places.str() +
                                (is_open() ? ": it is continued as it comes, and closed where the points end"
                                           : ": it is closed there")});
    }
    return result;
}

bool CloudReport::is_open() const { return border_points > kFewBorderPoints * kept(); }

std::string CloudReport::note() const {
    if (parts == 0) {
        return flipped_normals == 0        ? "as given"
               : flipped_normals == kept() ? "given, and flipped"
                                           : "given, some flipped";
    }
    return std::string(are_normals_inconsistent() ? "as given, but" : "estimated, and") + " oriented in " +
           std::to_string(parts) + (parts == 1 ? " part" : " parts");
}

}  // namespace scaleaxis::inline v1
