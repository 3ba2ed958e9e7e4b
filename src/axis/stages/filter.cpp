// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/filter.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <queue>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "axis/edit/collapse.hpp"
#include "axis/stages/crests.hpp"
#include "axis/stages/stages.hpp"
#include "base/angles.hpp"
#include "base/compiler.hpp"
#include "base/disjoint_sets.hpp"
#include "base/faults.hpp"
#include "base/numbers.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/ranges.hpp"

namespace scaleaxis::inline v1 {
namespace {

// The vertices whose balls are larger than all around them.
std::vector<std::uint8_t> maxima_of_radius(const MedialComplex& complex) {
    std::vector<std::uint8_t> is_maximum(complex.vertices.size(), 1);
    for (const auto& [p, q] : complex.edges) {
        if (complex.radii[p] <= complex.radii[q]) {
            is_maximum[p] = 0;
        }
        if (complex.radii[q] <= complex.radii[p]) {
            is_maximum[q] = 0;
        }
    }
    return is_maximum;
}

// Collapses parts, sheets or curves, from the remainder of a complex.
class PartCollapse {
   public:
    // \param stays vertices that do
    PartCollapse(const MedialComplex& complex, Remainder& remainder, std::vector<std::uint8_t> stays)
        : complex_(complex), remainder_(remainder), stays_(std::move(stays)), bare_for_(complex.edges.size(), kNone) {}

    // Collapses a part onto the rest of the complex: its faces, and the edges that no face is left at. If something of
    // the part would remain, it undoes everything, leaves in `blocking_vertices` the ends of edges that did not vanish,
    // and returns false. What may leave curves vanishes from its smallest balls on, and they are those of its largest.
    bool remove(Index part, std::span<const Index> faces, std::span<const Index> curve, bool may_leave_curves) {
        removed_.clear();
        bare_edges_.assign(curve.begin(), curve.end());
        blocking_vertices_.clear();
        for (const Index e : curve) {
            bare_for_[e] = part;
        }
        collapse(part, faces, may_leave_curves);
        const auto is_face = [](const ElementaryCollapse& collapse) { return collapse.has_face; };
        if (std::ranges::count_if(removed_, is_face) == std::ssize(faces)) {
            for (const Index e : bare_edges_) {
                if (remainder_.has_edge[e] != 0 && !may_leave_curves) {
                    append(blocking_vertices_, {complex_.edges[e][0], complex_.edges[e][1]});
                }
            }
            if (blocking_vertices_.empty()) {
                return true;
            }
        }
        for (const ElementaryCollapse& collapse : removed_) {
            undo(collapse, complex_, remainder_);
        }
        return false;
    }

    // What the last successful `remove` took away.
    const std::vector<ElementaryCollapse>& removed() const { return removed_; }
    const std::vector<Index>& blocking_vertices() const { return blocking_vertices_; }

   private:
    void collapse(Index part, std::span<const Index> faces, bool from_smallest) {
        const auto may_go = [&](const ElementaryCollapse& collapse) {
            return collapse.has_face ? complex_.face_sheets[collapse.element] == part
                                     : bare_for_[collapse.element] == part && stays_[collapse.free] == 0;
        };
        const auto note = [&](const ElementaryCollapse& collapse, const auto&) {
            removed_.push_back(collapse);
            if (collapse.has_face) {
                note_bare_edges(part, collapse.element);
            }
        };
        if (from_smallest) {
            const auto radius_if_it_may = [&](const ElementaryCollapse& collapse) {
                return may_go(collapse) ? std::optional(radius_of(collapse)) : std::nullopt;
            };
            run(Collapses(complex_, remainder_, radius_if_it_may, note), faces);
        } else {
            run(Collapses(complex_, remainder_, may_go, note), faces);
        }
    }

    template <class AnyCollapses>
    void run(AnyCollapses collapses, std::span<const Index> faces) {
        for (const Index f : faces) {
            for (const Index e : complex_.face_edges[f]) {
                collapses.add_edge(e);
            }
        }
        for (const Index e : bare_edges_) {
            for (const Index v : complex_.edges[e]) {
                collapses.add_vertex(v);
            }
        }
        collapses.run();
    }

    // The mean on what goes besides the face or the edge.
    double radius_of(const ElementaryCollapse& collapse) const {
        return collapse.has_face ? mean_ball(complex_, complex_.edges[collapse.free]).radius
                                 : complex_.radii[collapse.free];
    }

    void note_bare_edges(Index part, Index face) {
        for (const Index e : complex_.face_edges[face]) {
            if (remainder_.has_edge[e] != 0 && remainder_.faces_at_edge[e].count == 0) {
                bare_edges_.push_back(e);
                bare_for_[e] = part;
            }
        }
    }

    const MedialComplex& complex_;
    Remainder& remainder_;
    std::vector<std::uint8_t> stays_;
    std::vector<Index> bare_for_;  // the part that an edge without faces belongs to
    // Of the last call of `remove`, kept to save allocations: there are about as many parts as faces.
    std::vector<Index> bare_edges_;
    std::vector<ElementaryCollapse> removed_;
    std::vector<Index> blocking_vertices_;
};

// Faces of so much of a sheet's area may be wider than it counts as. With a tenth a countersink keeps a sheet by two
// large faces at the end of a rim; with a half a sheet would go that has become one with a wide one.
constexpr double kWidePart = 0.2;

// What is kept or removed as a whole: the sheets, and behind them the curves.
struct Parts {
    IndexLists faces;                            // of every sheet
    IndexLists curve_edges;                      // of every curve
    std::vector<double> importance;              // of every part: its object angle
    std::vector<std::uint8_t> may_leave_curves;  // of every sheet; empty: none

    Index size() const { return static_cast<Index>(importance.size()); }
    std::span<const Index> faces_of(Index part) const {
        return part < static_cast<Index>(faces.size()) ? faces[part] : std::span<const Index>();
    }
    std::span<const Index> edges_of(Index part) const {
        const Index curve = part - static_cast<Index>(faces.size());
        return curve >= 0 ? curve_edges[curve] : std::span<const Index>();
    }
};

Parts find_sheets(const MedialComplex& complex) {
    Parts parts;
    parts.faces = faces_of_sheets(complex);
    parts.importance.assign(complex.sheets, 0.0);
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        double& largest = parts.importance[complex.face_sheets[f]];
        largest = std::max(largest, complex.face_angles[f]);
    }
    return parts;
}

// The sheets with the angles that a part of their area exceeds; 0 where they have no width. Those that are narrower
// than `crumb` stay: where balls are no more exact than this, creases around them may be noise, and their angles, too.
Parts find_sheets_by_area(const MedialComplex& complex, double crumb) {
    Parts parts;
    parts.faces = faces_of_sheets(complex);
    parts.importance.resize(complex.sheets);
    for_each_index(parts.importance.size(), [&](std::size_t sheet) {
        std::vector<std::pair<double, double>> angles_and_areas;
        double area = 0.0;
        double radius = 0.0;
        Box box;
        for (const Index f : parts.faces[sheet]) {
            angles_and_areas.emplace_back(complex.face_angles[f], face_area(complex, f));
            area += angles_and_areas.back().second;
            for (const Index v : complex.faces[f]) {
                radius = std::max(radius, complex.radii[v]);
                box.extend(complex.vertices[v]);
            }
        }
        if (area < crumb * box.diagonal()) {
            parts.importance[sheet] = kInfinity;
            return;
        }
        if (area <= kNegligible * radius * box.diagonal()) {
            return;  // without width it says nothing: in what other sheets have left of a curve
        }
        std::sort(angles_and_areas.rbegin(), angles_and_areas.rend());
        double wider = 0.0;
        for (const auto& [angle, part] : angles_and_areas) {
            parts.importance[sheet] = angle;
            wider += part;
            if (wider > kWidePart * area) {
                break;
            }
        }
    });
    return parts;
}

// Labels as sheets what creases divide, too: sheets are smooth, and where two triangles meet at an angle, a seam was
// whose third sheet has gone. What is left of a narrow sheet there makes one of the two wide ones that it lies between.
void label_parts_between_creases(MedialComplex& complex) {
    const IndexLists faces_at_edge = faces_at_edges(complex);
    DisjointSets parts(static_cast<Index>(complex.faces.size()));
    for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
        const std::span<const Index> faces = faces_at_edge[e];
        if (faces.size() == 2) {
            const Point a = inward(complex, faces[0], e);
            const Point b = inward(complex, faces[1], e);
            if (dot(a, b) < -kSamePlaneDirection * norm(a) * norm(b)) {
                parts.join(faces[0], faces[1]);
            }
        }
    }
    std::tie(complex.face_sheets, complex.sheets) = parts.numbered();
}

// The vertices that have faces of narrow sheets alone.
std::vector<std::uint8_t> on_narrow_sheets(const MedialComplex& complex, const Parts& parts, double angle) {
    std::vector<std::uint8_t> result(complex.vertices.size());
    const auto set_corners = [&](bool is_narrow) {
        for (std::size_t f = 0; f < complex.faces.size(); ++f) {
            if ((parts.importance[complex.face_sheets[f]] < angle) == is_narrow) {
                for (const Index v : complex.faces[f]) {
                    result[v] = is_narrow ? 1 : 0;
                }
            }
        }
    };
    set_corners(true);
    set_corners(false);
    return result;
}

bool has_corner_in(const std::vector<std::uint8_t>& vertices, const MedialComplex& complex,
                   std::span<const Index> faces) {
    return std::ranges::any_of(faces, [&](Index f) {
        return std::ranges::any_of(complex.faces[f], [&](Index v) { return vertices[v] != 0; });
    });
}

void add_curves(Parts& parts, const MedialComplex& complex, const Remainder& remainder) {
    parts.curve_edges = find_curves(complex, remainder);
    for (std::size_t curve = 0; curve < parts.curve_edges.size(); ++curve) {
        double largest = 0.0;
        for (const Index e : parts.curve_edges[curve]) {
            largest = std::max(largest, curve_size(complex, complex.edges[e]).object_angle);
        }
        parts.importance.push_back(largest);
    }
}

using PartToRemove = std::pair<double, Index>;  // importance and part

std::vector<PartToRemove> find_candidates(const Parts& parts, double angle) {
    std::vector<PartToRemove> candidates;
    for (Index part = 0; part < parts.size(); ++part) {
        if (parts.importance[part] < angle) {
            candidates.emplace_back(parts.importance[part], part);
        }
    }
    tasks::parallel_sort(candidates.begin(), candidates.end());
    stop_if_cancelled();
    return candidates;
}

// Removes parts, and tries those again that could not be removed as soon as something beside them has gone: an edge of
// theirs has become free, or something at a vertex by which they held the rest together.
class PartRemoval {
   public:
    PartRemoval(const MedialComplex& complex, const Parts& parts, Remainder& remainder, std::vector<std::uint8_t> stays)
        : complex_(complex),
          parts_(parts),
          remainder_(remainder),
          collapse_(complex, remainder, std::move(stays)),
          has_failed_(parts.size()) {}

    // Removes a part if it can be removed, and then always the least important one that this makes removable.
    void operator()(Index part) {
        try_to_remove(part);
        while (!retries_.empty()) {
            const Index next = retries_.top().second;
            retries_.pop();
            try_to_remove(next);
        }
    }

   private:
    void try_to_remove(Index part) {
        stop_if_cancelled_now_and_then_();
        const bool may_leave_curves = !parts_.may_leave_curves.empty() && parts_.may_leave_curves[part] != 0;
        if (!collapse_.remove(part, parts_.faces_of(part), parts_.edges_of(part), may_leave_curves)) {
            has_failed_[part] = 1;
            for (const Index v : collapse_.blocking_vertices()) {
                blocked_at_vertex_.emplace(v, part);
            }
            return;
        }
        for (const auto& [has_face, element, free] : collapse_.removed()) {
            if (has_face) {
                for (const Index e : complex_.face_edges[element]) {
                    if (const Index face = remainder_.only_face(e); face != kNone) {
                        retry(complex_.face_sheets[face]);
                    }
                }
            }
            if (!blocked_at_vertex_.empty()) {
                const auto& [p, q] = complex_.edges[has_face ? free : element];
                retry_at_vertex(p);
                retry_at_vertex(q);
            }
        }
    }

    void retry(Index part) {
        if (has_failed_[part] != 0) {
            has_failed_[part] = 0;
            retries_.emplace(parts_.importance[part], part);
        }
    }

    void retry_at_vertex(Index v) {
        const auto [begin, end] = blocked_at_vertex_.equal_range(v);
        for (auto it = begin; it != end; ++it) {
            retry(it->second);
        }
        blocked_at_vertex_.erase(begin, end);
    }

    const MedialComplex& complex_;
    const Parts& parts_;
    const Remainder& remainder_;
    PartCollapse collapse_;
    std::vector<std::uint8_t> has_failed_;
    std::unordered_multimap<Index, Index> blocked_at_vertex_;
    std::priority_queue<PartToRemove, std::vector<PartToRemove>, std::greater<>> retries_;
    CancellationPoint stop_if_cancelled_now_and_then_;
};

// The candidates lie scattered in memory. This asks for what the next ones lead to in time, step by step.
void prefetch_next(const MedialComplex& complex, const Parts& parts, const Remainder& remainder,
                   std::span<const PartToRemove> next) {
    constexpr std::size_t kList = 24;
    constexpr std::size_t kOffsets = 16;
    constexpr std::size_t kFaces = 12;
    constexpr std::size_t kEdges = 8;
    if (next.size() <= kList || parts.faces.empty()) {
        return;
    }
    const auto first_face = [&](std::size_t i) {
        const std::span<const Index> faces = parts.faces_of(next[i].second);
        return faces.empty() ? 0 : faces.front();
    };
    prefetch(parts.faces_of(next[kList].second).data());
    prefetch(&complex.face_edges.offsets[first_face(kOffsets)]);
    prefetch(complex.face_edges[first_face(kFaces)].data());
    for (const Index e : complex.face_edges[first_face(kEdges)]) {
        prefetch(&remainder.faces_at_edge[e]);
        prefetch(&complex.edges[e]);
    }
}

// Always removes the least important part that can be removed. So what a smaller threshold removes comes first for a
// larger one too, and the results are nested.
void remove_parts(const MedialComplex& complex, const Parts& parts, double angle, std::vector<std::uint8_t> stays,
                  Remainder& remainder, const Execution& execution) {
    const std::vector<PartToRemove> candidates = find_candidates(parts, angle);
    PartRemoval remove_part(complex, parts, remainder, std::move(stays));
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (i % 65536 == 0) {
            report(execution, "filter", static_cast<double>(i) / static_cast<double>(candidates.size()));
        }
        prefetch_next(complex, parts, remainder, std::span(candidates).subspan(i));
        remove_part(candidates[i].second);
    }
}

}  // namespace

FilteredComplex with_statistics(MedialComplex part, const MedialComplex& complex) {
    FilteredComplex result{std::move(part), {}};
    MedialComplex& rest = result.complex;
    FilterStatistics& statistics = result.statistics;
    run_together([&] { statistics.topology = topology_of(rest); }, [&] { label_sheets(rest); });
    statistics.sheets_before = complex.sheets;
    statistics.sheets_after = rest.sheets;
    statistics.faces_removed = static_cast<Index>(complex.faces.size() - rest.faces.size());
    return result;
}

FilteredComplex filtered_by_area(const MedialComplex& complex, double angle, double tolerance,
                                 const Execution& execution) {
    const double wide = angle + kClearlyWider;
    const double cosine = cosine_of_degrees(std::min(wide, 90.0));
    MedialComplex rest = complex;
    // Asks again where what went has made one sheet of two. What is narrow beyond a crease comes last, so that a
    // sheet's few wide triangles go with it.
    for (bool is_by_crease = false;;) {
        const std::size_t before = rest.faces.size();
        if (is_by_crease) {
            label_parts_between_creases(rest);
        } else {
            label_sheets(rest);
        }
        Remainder remainder(rest);
        Parts parts = find_sheets_by_area(rest, is_by_crease ? tolerance : 0.0);
        const std::vector<std::uint8_t> is_narrow = on_narrow_sheets(rest, parts, wide);
        std::vector<std::uint8_t> may_go = is_narrow;
        for (const auto& [p, q] : curve_edges(rest)) {
            may_go[p] = may_go[q] = 0;
        }
        std::vector<std::uint8_t> crests = crests_of_narrow_sheets(rest, may_go, cosine);
        parts.may_leave_curves = mapped<std::uint8_t>(parts.importance.size(), [&](std::size_t sheet) {
            return parts.importance[sheet] == 0.0 || has_corner_in(crests, rest, parts.faces[sheet]) ? 1 : 0;
        });
        remove_parts(rest, parts, wide, std::move(crests), remainder, execution);
        remove_hairs(rest, is_narrow, cosine, remainder);
        rest = complex_of(remainder, rest);
        const bool is_same = rest.faces.size() == before;
        if (is_same && is_by_crease) {
            break;
        }
        is_by_crease = is_same;
    }
    return with_statistics(std::move(rest), complex);
}

FilteredComplex filtered(const MedialComplex& complex, const FilterOptions& options, const Execution& execution) {
    require(kAngleRange.contains(options.angle), "the filter angle must lie between 0 and 90 degrees");
    return in_arena(execution, [&] {
        report(execution, "filter", 0.0);
        if (options.angle > 0.0) {
            check_angles(complex);
        }
        if (options.measure == SheetAngle::kByArea && options.angle > 0.0) {
            const double tolerance = kDefaultTolerance * box_of_balls(complex).diagonal();
            FilteredComplex result = filtered_by_area(complex, options.angle, tolerance, execution);
            report(execution, "filter", 1.0);
            return result;
        }
        std::optional<Remainder> remainder;
        Parts parts;
        run_together([&] { remainder.emplace(complex); }, [&] { parts = find_sheets(complex); });
        add_curves(parts, complex, *remainder);
        remove_parts(complex, parts, options.angle, maxima_of_radius(complex), *remainder, execution);
        FilteredComplex result = with_statistics(complex_of(*remainder, complex), complex);
        report(execution, "filter", 1.0);
        return result;
    });
}

FilteredComplex filter(const MedialComplex& complex, const FilterOptions& options, const Execution& execution) {
    return in_arena(execution, [&] {
        check(complex);
        return filtered(complex, options, execution);
    });
}

}  // namespace scaleaxis::inline v1
