// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/filtration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <queue>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/collapse.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/powers.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kFiltrationStage = "filtration";
constexpr int kClosedRings = 2;  // of faces around a vertex
constexpr double kPlateauLoss = 0.02;
constexpr double kLargestPlateauScale = 2.0;

// What balls allow: when vertices, and faces, may vanish.
struct Earliest {
    std::vector<double> vertices;
    std::vector<double> faces;
};

// Faces may vanish when all their balls off the seams have: a ball on a seam may stay for the sake of one sheet, and
// says nothing of the others. A face without such a ball may when those beside it in its sheet may.
std::vector<double> scales_of_faces(const MedialComplex& complex, std::span<const double> scales,
                                    const std::vector<std::uint8_t>& is_on_seam) {
    const IndexLists faces_at = faces_at_edges(complex);
    const std::vector<double> of_balls = mapped<double>(complex.faces.size(), [&](std::size_t f) {
        double scale = 0.0;
        for (const Index v : complex.faces[f]) {
            scale = is_on_seam[v] == 0 ? std::max(scale, scales[v]) : scale;
        }
        return scale;
    });
    return mapped<double>(complex.faces.size(), [&](std::size_t f) {
        double scale = of_balls[f];
        if (scale < 1.0) {  // of no ball
            for (const Index e : complex.face_edges[f]) {
                for (const Index other : faces_at[e].size() == 2 ? faces_at[e] : std::span<const Index>()) {
                    scale = std::max(scale, of_balls[other]);
                }
            }
        }
        if (scale < 1.0) {
            for (const Index v : complex.faces[f]) {
                scale = std::max(scale, scales[v]);
            }
        }
        return scale;
    });
}

// Collapses a complex, always what its balls allow first.
void collapse_by_scale(Filtration& filtration, const Earliest& earliest) {
    const MedialComplex& complex = filtration.complex;
    filtration.vertex_scales.assign(complex.vertices.size(), kNeverVanishes);
    filtration.edge_scales.assign(complex.edges.size(), kNeverVanishes);
    filtration.face_scales.assign(complex.faces.size(), kNeverVanishes);
    // When the balls of the face, or that of the free end, allow it, and when those of the edge have vanished.
    using Key = std::pair<double, double>;
    const auto key_of = [&](const ElementaryCollapse& collapse) {
        const auto& [has_face, element, free] = collapse;
        const auto& [p, q] = complex.edges[has_face ? free : element];
        const Key key{has_face ? earliest.faces[element] : earliest.vertices[free],
                      std::max(earliest.vertices[p], earliest.vertices[q])};
        return key.first < kNeverVanishes ? std::optional(key) : std::nullopt;
    };
    double scale = 1.0;
    const auto collapsed = [&](const ElementaryCollapse& collapse, const std::optional<Key>& key) {
        const auto& [has_face, element, free] = collapse;
        scale = std::max(scale, key->first);
        filtration.edge_scales[has_face ? free : element] = scale;
        (has_face ? filtration.face_scales[element] : filtration.vertex_scales[free]) = scale;
    };
    Remainder remainder(complex);
    Collapses collapses(complex, remainder, key_of, collapsed);
    collapses.add_all();
    collapses.run();
}

// Of each vertex off the seams the largest or the least of the values of such in its faces.
std::vector<double> spread(const MedialComplex& complex, const std::vector<double>& values,
                           const std::vector<std::uint8_t>& is_on_seam, bool is_largest) {
    std::vector<double> result = values;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        double most = is_largest ? 1.0 : kInfinity;
        for (const Index v : complex.faces[f]) {
            if (is_on_seam[v] == 0) {
                most = is_largest ? std::max(most, values[v]) : std::min(most, values[v]);
            }
        }
        for (const Index v : complex.faces[f]) {
            if (is_on_seam[v] == 0) {
                result[v] = is_largest ? std::max(result[v], most) : std::min(result[v], most);
            }
        }
    }
    return result;
}

// The scales with narrow gaps filled, as a morphological closing does: s* depends on where exactly the vertices are, so
// that the borders of levels would be ragged. No scale becomes smaller.
std::vector<double> closed(const MedialComplex& complex, std::vector<double> scales,
                           const std::vector<std::uint8_t>& is_on_seam) {
    for (const bool is_largest : {true, false}) {
        for (int ring = 0; ring < kClosedRings; ++ring) {
            scales = spread(complex, scales, is_on_seam, is_largest);
        }
    }
    return scales;
}

MedialComplex level_at(const Filtration& filtration, double scale) {
    const auto later = [&](const std::vector<double>& scales) {
        return each_of<std::uint8_t>(scales, [&](double s) { return s > scale ? 1 : 0; });
    };
    MedialComplex result = subcomplex(filtration.complex, later(filtration.vertex_scales),
                                      later(filtration.edge_scales), later(filtration.face_scales));
    label_sheets(result);
    return result;
}

FiltrationLevel level_of(const MedialComplex& complex, double scale) {
    FiltrationLevel level{scale, complex.sheets, static_cast<Index>(complex.vertices.size()), 0.0, 0.0, 0.0};
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        level.area += face_area(complex, static_cast<Index>(f));
    }
    for (const auto& [a, b] : curve_edges(complex)) {
        level.curve_length += distance(complex.vertices[a], complex.vertices[b]);
    }
    return level;
}

// When each cell of a grid vanishes, the last ball with its centre in it.
struct CellScales {
    std::vector<double> scales;  // ascending; of cells in some ball alone
    double cell_volume = 0.0;

    double volume_after(double scale) const {
        const auto first = std::ranges::upper_bound(scales, scale);
        return cell_volume * static_cast<double>(scales.end() - first);
    }
};

// Marks the unmarked cells of a row whose centres lie within a length of a place, both in cells.
class RowOfCells {
   public:
    explicit RowOfCells(Index count) : count_(count), next_(static_cast<std::size_t>(count) + 1) {
        std::iota(next_.begin(), next_.end(), 0);
    }

    Index mark(double center, double half_length) {
        const double first = std::ceil(std::max(0.0, center - half_length - 0.5));
        const double last = std::floor(std::min(count_ - 1.0, center + half_length - 0.5));
        Index marked = 0;
        for (Index i = first <= last ? unmarked_from(static_cast<Index>(first)) : count_; i <= last;
             i = unmarked_from(i)) {
            next_[i] = i + 1;
            ++marked;
        }
        return marked;
    }

   private:
    Index unmarked_from(Index i) {
        while (next_[i] != i) {
            next_[i] = next_[next_[i]];
            i = next_[i];
        }
        return i;
    }

    Index count_;
    std::vector<Index> next_;  // of each cell, one that is no later than the next unmarked one; itself if it is that
};

CellScales cell_scales(const Filtration& filtration) {
    constexpr double kCells = 2e6;
    std::vector<std::pair<double, Ball>> balls;  // those that vanish last first
    Box box;
    const std::vector<Ball> all = balls_at_vertices(filtration.complex);
    for (std::size_t v = 0; v < all.size(); ++v) {
        if (const auto& [center, r] = all[v]; r > 0.0) {
            balls.emplace_back(filtration.vertex_scales[v], all[v]);
            box.extend(center - Point{r, r, r});
            box.extend(center + Point{r, r, r});
        }
    }
    if (balls.empty()) {
        return {};
    }
    std::ranges::stable_sort(balls, std::greater<>(), &std::pair<double, Ball>::first);
    const Point size = box.max - box.min;
    const double cell = cube_root(size.x * size.y * size.z / kCells);
    const auto count = [&](double length) {
        return std::max<Index>(1, static_cast<Index>(std::lround(length / cell)));
    };
    const std::array<Index, 3> counts{count(size.x), count(size.y), count(size.z)};
    const Point step{size.x / counts[0], size.y / counts[1], size.z / counts[2]};
    CellScales result;
    result.cell_volume = step.x * step.y * step.z;
    result.scales = collect<std::vector<double>>(
        static_cast<std::size_t>(counts[2]),
        [&](std::size_t k, std::vector<double>& scales) {
            const double z = box.min.z + (static_cast<double>(k) + 0.5) * step.z;
            std::vector<RowOfCells> rows(static_cast<std::size_t>(counts[1]), RowOfCells(counts[0]));
            for (const auto& [scale, ball] : balls) {
                const double square = ball.radius * ball.radius - (z - ball.center.z) * (z - ball.center.z);
                if (square <= 0.0) {
                    continue;
                }
                const double middle = (ball.center.y - box.min.y) / step.y - 0.5;
                const double reach = std::sqrt(square) / step.y;
                const auto last = static_cast<Index>(std::floor(std::min(counts[1] - 1.0, middle + reach)));
                for (auto j = static_cast<Index>(std::ceil(std::max(0.0, middle - reach))); j <= last; ++j) {
                    const double across = (j - middle) * step.y;
                    const double half = std::sqrt(std::max(0.0, square - across * across)) / step.x;
                    const Index marked = rows[j].mark((ball.center.x - box.min.x) / step.x, half);
                    scales.insert(scales.end(), static_cast<std::size_t>(marked), scale);
                }
            }
        },
        std::size_t{1});
    std::ranges::sort(result.scales);
    return result;
}

void require_order(bool condition, const std::string& message) {
    if (!condition) {
        throw UnusableInput(Diagnostic{"filtration.order", message});
    }
}

}  // namespace

Filtration filtration(MedialComplex complex, const FiltrationOptions& options, const Execution& execution) {
    return in_arena(execution, [&] {
        check(complex);
        report(execution, kFiltrationStage, 0.0);
        Filtration result;
        result.complex = std::move(complex);
        result.largest_scale = options.largest_scale;
        result.ball_scales = vanishing_scales(balls_at_vertices(result.complex), options);
        report(execution, kFiltrationStage, 0.9);
        const std::vector<std::uint8_t> is_on_seam = vertices_at_seams(result.complex);
        Earliest earliest{closed(result.complex, result.ball_scales, is_on_seam), {}};
        earliest.faces = scales_of_faces(result.complex, earliest.vertices, is_on_seam);
        collapse_by_scale(result, earliest);
        report(execution, kFiltrationStage, 1.0);
        return result;
    });
}

void check(const Filtration& filtration) {
    const MedialComplex& complex = filtration.complex;
    check(complex);
    require_order(filtration.vertex_scales.size() == complex.vertices.size() &&
                      filtration.edge_scales.size() == complex.edges.size() &&
                      filtration.face_scales.size() == complex.faces.size(),
                  "the scales of a filtration must be as many as its vertices, edges and faces");
    const auto is_scale = [](double scale) { return scale >= 1.0; };
    require_order(std::ranges::all_of(filtration.vertex_scales, is_scale) &&
                      std::ranges::all_of(filtration.edge_scales, is_scale) &&
                      std::ranges::all_of(filtration.face_scales, is_scale),
                  "the scales of a filtration must be at least 1");
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        for (const Index v : complex.edges[e]) {
            require_order(
                filtration.edge_scales[e] <= filtration.vertex_scales[v],
                "edge " + std::to_string(e) + " of the filtration vanishes after its vertex " + std::to_string(v));
        }
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index e : complex.face_edges[f]) {
            require_order(
                filtration.face_scales[f] <= filtration.edge_scales[e],
                "face " + std::to_string(f) + " of the filtration vanishes after its edge " + std::to_string(e));
        }
    }
}

MedialComplex cut(const Filtration& filtration, double scale) {
    check_scale(scale);
    check(filtration);
    return level_at(filtration, scale);
}

std::optional<Diagnostic> grown_axis(const MedialComplex& complex) {
    if (complex.scale == 1.0) {
        return std::nullopt;
    }
    Words message;
    message << "the axis is of s = " << complex.scale
            << ": what had vanished up to there is missing at all scales of its filtration; take an axis of s = 1";
    return Diagnostic{.code = "filtration.grown_axis", .message = message.str()};
}

std::optional<Diagnostic> unknown_level(const Filtration& filtration, double scale) {
    if (!(scale > filtration.largest_scale)) {
        return std::nullopt;
    }
    Words message;
    message << "the filtration knows its levels up to s = " << filtration.largest_scale
            << ", and the one at s = " << scale << " is the same as there: compute it up to a larger scale";
    return Diagnostic{.code = "filtration.unknown_level", .message = message.str(), .hints = {{"largest-scale"}}};
}

std::vector<FiltrationLevel> profile(const Filtration& filtration, double largest_scale, Index count,
                                     const Execution& execution) {
    check_scale(largest_scale);
    require(count >= 2, "a profile needs at least two levels");
    return in_arena(execution, [&] {
        report(execution, "profile", 0.0);
        check(filtration);
        const CellScales cells = cell_scales(filtration);
        std::vector<FiltrationLevel> levels(count);
        for_each_index(
            count,
            [&](Index i) {
                const double scale = power(largest_scale, static_cast<double>(i) / static_cast<double>(count - 1));
                levels[i] = level_of(level_at(filtration, scale), scale);
                levels[i].volume = cells.volume_after(scale);
            },
            Index{1});
        report(execution, "profile", 1.0);
        return levels;
    });
}

ScalePlateau longest_plateau(std::span<const FiltrationLevel> levels) {
    ScalePlateau longest{levels.front().scale, levels.front().scale, levels.front().scale};
    for (std::size_t i = 0; i < levels.size(); ++i) {
        std::size_t end = i;
        while (end + 1 < levels.size() && levels[end + 1].scale <= kLargestPlateauScale &&
               levels[end + 1].area >= (1.0 - kPlateauLoss) * levels[i].area) {
            ++end;
        }
        // Equal steps of log s come with rounding.
        if (levels[end].scale / levels[i].scale > (1.0 + kRelativeRounding) * longest.end / longest.begin) {
            longest = {levels[i].scale, levels[end].scale, std::sqrt(levels[i].scale * levels[end].scale)};
        }
    }
    return longest;
}

}  // namespace scaleaxis::inline v1
