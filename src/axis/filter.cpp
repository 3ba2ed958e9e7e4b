// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaleaxis/filter.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <queue>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "kernel/disjoint_sets.hpp"
#include "kernel/grouped.hpp"
#include "kernel/parallel.hpp"
#include "medial_axis/complex.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

// How many elements (of one dimension higher) an element belongs to, and the exclusive or of their indices: which one
// it is, if there is only one.
struct Cofaces {
    Index count = 0;
    Index combined = 0;

    void add(Index element) {
        ++count;
        combined ^= element;
    }
    void remove(Index element) {
        --count;
        combined ^= element;
    }
};

// A complex from which parts are collapsed one by one.
class Collapse {
   public:
    explicit Collapse(const MedialComplex& complex)
        : complex_(complex),
          has_vertex_(complex.vertices.size(), 1),
          has_edge_(complex.edges.size(), 1),
          has_face_(complex.faces.size(), 1),
          faces_at_edge_(complex.edges.size()),
          edges_at_vertex_(complex.vertices.size()),
          bare_for_(complex.edges.size(), kNone) {
        for (Index f = 0; f < static_cast<Index>(complex.faces.size()); ++f) {
            for (const Index e : complex.face_edges[f]) {
                faces_at_edge_[e].add(f);
            }
        }
        for (Index e = 0; e < static_cast<Index>(complex.edges.size()); ++e) {
            for (const Index v : complex.edges[e]) {
                edges_at_vertex_[v].add(e);
            }
        }
    }

    // Collapses a part, a sheet or a curve, onto the rest of the complex: its faces from their free edges, and then the
    // edges that no face is left at from their free ends. If something of the part would remain, it undoes everything,
    // leaves in `blocking_vertices` the ends of edges that did not vanish, and returns false.
    bool remove(Index part, std::span<const Index> faces, std::span<const Index> curve) {
        removed_faces_.clear();
        removed_edges_.clear();
        removed_vertices_.clear();
        maybe_free_edges_.clear();
        bare_edges_.assign(curve.begin(), curve.end());
        blocking_vertices_.clear();
        for (const Index e : curve) {
            bare_for_[e] = part;
        }
        for (const Index f : faces) {
            for (const Index e : complex_.face_edges[f]) {
                if (faces_at_edge_[e].count == 1) {
                    maybe_free_edges_.push_back(e);
                }
            }
        }
        while (!maybe_free_edges_.empty()) {
            const Index edge = maybe_free_edges_.back();
            maybe_free_edges_.pop_back();
            const Index face = faces_at_edge_[edge].combined;
            if (faces_at_edge_[edge].count == 1 && complex_.face_sheets[face] == part) {
                remove_face(part, face);
                remove_edge(edge);
            }
        }
        if (removed_faces_.size() == faces.size()) {
            collapse_bare_edges(part);
            if (blocking_vertices_.empty()) {
                return true;
            }
        }
        undo();
        return false;
    }

    // What the last successful `remove` took away.
    const std::vector<Index>& removed_faces() const { return removed_faces_; }
    const std::vector<Index>& removed_edges() const { return removed_edges_; }
    const std::vector<Index>& blocking_vertices() const { return blocking_vertices_; }

    // Asks memory for what `remove` will read of a face; `prefetch_edges` some time before.
    void prefetch_edges(Index face) const { __builtin_prefetch(complex_.face_edges[face].data()); }
    void prefetch_cofaces(Index face) const {
        for (const Index e : complex_.face_edges[face]) {
            __builtin_prefetch(&faces_at_edge_[e]);
            __builtin_prefetch(&complex_.edges[e]);
        }
    }

    // The only face at an edge, or `kNone` if there are none or more.
    Index only_face(Index edge) const {
        return faces_at_edge_[edge].count == 1 ? faces_at_edge_[edge].combined : kNone;
    }

    MedialComplex rest() const { return subcomplex(complex_, has_vertex_, has_edge_, has_face_); }

   private:
    void remove_face(Index part, Index face) {
        has_face_[face] = 0;
        removed_faces_.push_back(face);
        for (const Index e : complex_.face_edges[face]) {
            faces_at_edge_[e].remove(face);
            if (faces_at_edge_[e].count == 1) {
                maybe_free_edges_.push_back(e);
            } else if (faces_at_edge_[e].count == 0) {
                bare_edges_.push_back(e);
                bare_for_[e] = part;
            }
        }
    }

    void remove_edge(Index edge) {
        has_edge_[edge] = 0;
        removed_edges_.push_back(edge);
        for (const Index v : complex_.edges[edge]) {
            edges_at_vertex_[v].remove(edge);
        }
    }

    void collapse_bare_edges(Index part) {
        for (Index edge : bare_edges_) {
            // From a free end on, edge after edge, up to where something else begins.
            while (has_edge_[edge] != 0 && faces_at_edge_[edge].count == 0 && bare_for_[edge] == part) {
                auto [free_end, other_end] = complex_.edges[edge];
                if (edges_at_vertex_[free_end].count != 1) {
                    std::swap(free_end, other_end);
                }
                if (edges_at_vertex_[free_end].count != 1) {
                    break;
                }
                remove_edge(edge);
                has_vertex_[free_end] = 0;
                removed_vertices_.push_back(free_end);
                if (edges_at_vertex_[other_end].count != 1) {
                    break;
                }
                edge = edges_at_vertex_[other_end].combined;
            }
        }
        for (const Index edge : bare_edges_) {
            if (has_edge_[edge] != 0) {
                blocking_vertices_.insert(blocking_vertices_.end(), complex_.edges[edge].begin(),
                                          complex_.edges[edge].end());
            }
        }
    }

    void undo() {
        for (const Index v : removed_vertices_) {
            has_vertex_[v] = 1;
        }
        for (const Index e : removed_edges_) {
            has_edge_[e] = 1;
            for (const Index v : complex_.edges[e]) {
                edges_at_vertex_[v].add(e);
            }
        }
        for (const Index f : removed_faces_) {
            has_face_[f] = 1;
            for (const Index e : complex_.face_edges[f]) {
                faces_at_edge_[e].add(f);
            }
        }
    }

    const MedialComplex& complex_;
    std::vector<std::uint8_t> has_vertex_;
    std::vector<std::uint8_t> has_edge_;
    std::vector<std::uint8_t> has_face_;
    std::vector<Cofaces> faces_at_edge_;
    std::vector<Cofaces> edges_at_vertex_;
    std::vector<Index> bare_for_;  // the part that the edge belongs to alone, of those tried so far
    // Of the last call of `remove`, kept to save allocations: there are about as many parts as faces.
    std::vector<Index> maybe_free_edges_;
    std::vector<Index> bare_edges_;
    std::vector<Index> removed_faces_;
    std::vector<Index> removed_edges_;
    std::vector<Index> removed_vertices_;
    std::vector<Index> blocking_vertices_;
};

// The elements of every part, from the part of every element (`kNone`: of no part).
IndexLists elements_of_parts(const std::vector<Index>& part_of_element, Index parts) {
    return kernel::grouped(static_cast<std::size_t>(parts), [&](const auto& add) {
        for (Index element = 0; element < static_cast<Index>(part_of_element.size()); ++element) {
            if (part_of_element[element] != kNone) {
                add(part_of_element[element], element);
            }
        }
    });
}

// What is kept or removed as a whole: the sheets, and the curves, which are maximal chains of edges without faces.
struct Parts {
    Index count = 0;
    IndexLists faces;                // of the sheets; empty for a curve
    IndexLists curve_edges;          // of the curves; empty for a sheet
    std::vector<double> importance;  // largest object angle
};

Parts find_parts(const MedialComplex& complex) {
    const auto edges = static_cast<Index>(complex.edges.size());
    std::vector<bool> has_face(edges);
    for (const Index e : complex.face_edges.items) {
        has_face[e] = true;
    }
    std::vector<Cofaces> edges_at_vertex(complex.vertices.size());
    for (Index e = 0; e < edges; ++e) {
        for (const Index v : complex.edges[e]) {
            edges_at_vertex[v].add(e);
        }
    }
    DisjointSets chains(edges);
    for (Index e = 0; e < edges; ++e) {
        for (const Index v : complex.edges[e]) {
            const Index other = edges_at_vertex[v].combined ^ e;
            if (!has_face[e] && edges_at_vertex[v].count == 2 && !has_face[other]) {
                chains.join(e, other);
            }
        }
    }

    Parts parts;
    parts.count = complex.sheets;
    std::vector<Index> part_of_edge(edges, kNone);
    for (Index e = 0; e < edges; ++e) {
        if (!has_face[e]) {
            const Index first = chains.find(e);
            part_of_edge[e] = first == e ? parts.count++ : part_of_edge[first];
        }
    }
    parts.faces = elements_of_parts(complex.face_sheets, parts.count);
    parts.curve_edges = elements_of_parts(part_of_edge, parts.count);
    parts.importance.assign(parts.count, 0.0);
    for (std::size_t f = 0; f < complex.face_sheets.size(); ++f) {
        double& largest = parts.importance[complex.face_sheets[f]];
        largest = std::max(largest, complex.face_angles[f]);
    }
    for (Index e = 0; e < edges; ++e) {
        if (part_of_edge[e] != kNone) {
            double& largest = parts.importance[part_of_edge[e]];
            largest = std::max(largest, curve_size(complex, complex.edges[e]).object_angle);
        }
    }
    return parts;
}

using Candidate = std::pair<double, Index>;  // importance and part

// Always removes the least important part that can be removed. So what a smaller threshold removes comes first for a
// larger one too, and the results are nested.
void remove_parts(Collapse& collapse, const MedialComplex& complex, double angle, const Execution& execution) {
    const Parts parts = find_parts(complex);
    std::vector<Candidate> candidates;
    for (Index part = 0; part < parts.count; ++part) {
        if (parts.importance[part] < angle) {
            candidates.emplace_back(parts.importance[part], part);
        }
    }
    std::sort(candidates.begin(), candidates.end());

    // A part that could not be removed is tried again when something beside it has gone: an edge of it has become free,
    // or something at a vertex by which it held the rest together.
    std::vector<std::uint8_t> has_failed(parts.count);
    std::unordered_multimap<Index, Index> blocked_at_vertex;
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> retries;
    const auto retry = [&](Index part) {
        if (has_failed[part] != 0) {
            has_failed[part] = 0;
            retries.emplace(parts.importance[part], part);
        }
    };
    const auto retry_at_vertex = [&](Index v) {
        const auto [begin, end] = blocked_at_vertex.equal_range(v);
        for (auto it = begin; it != end; ++it) {
            retry(it->second);
        }
        blocked_at_vertex.erase(begin, end);
    };
    const auto try_to_remove = [&](Index part) {
        if (!collapse.remove(part, parts.faces[part], parts.curve_edges[part])) {
            has_failed[part] = 1;
            for (const Index v : collapse.blocking_vertices()) {
                blocked_at_vertex.emplace(v, part);
            }
            return;
        }
        for (const Index f : collapse.removed_faces()) {
            for (const Index e : complex.face_edges[f]) {
                if (const Index face = collapse.only_face(e); face != kNone) {
                    retry(complex.face_sheets[face]);
                }
            }
        }
        for (const Index e : collapse.removed_edges()) {
            retry_at_vertex(complex.edges[e][0]);
            retry_at_vertex(complex.edges[e][1]);
        }
    };
    // The candidates lie scattered in memory. So what the next ones lead to is asked for in time, step by step.
    constexpr std::size_t kAhead = 24;
    const auto first_face = [&](std::size_t i) {
        const std::span<const Index> faces = parts.faces[candidates[i].second];
        return faces.empty() ? 0 : faces.front();
    };
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (i + kAhead < candidates.size() && !complex.faces.empty()) {
            __builtin_prefetch(parts.faces[candidates[i + kAhead].second].data());
            __builtin_prefetch(&complex.face_edges.offsets[first_face(i + 16)]);
            collapse.prefetch_edges(first_face(i + 12));
            collapse.prefetch_cofaces(first_face(i + 8));
        }
        if (i % 65536 == 0) {
            kernel::report(execution, "filter", static_cast<double>(i) / static_cast<double>(candidates.size()));
        }
        try_to_remove(candidates[i].second);
        while (!retries.empty()) {
            const Index part = retries.top().second;
            retries.pop();
            try_to_remove(part);
        }
    }
}

}  // namespace

FilteredComplex filter(const MedialComplex& complex, const FilterOptions& options, const Execution& execution) {
    if (!(options.angle >= 0.0 && options.angle <= 90.0)) {
        throw InvalidOption("the filter angle must lie between 0 and 90 degrees");
    }
    return kernel::in_arena(execution, [&] {
        kernel::report(execution, "filter", 0.0);
        Collapse collapse(complex);
        remove_parts(collapse, complex, options.angle, execution);
        FilteredComplex result;
        result.complex = collapse.rest();
        label_sheets(result.complex);  // seams have gone, so that what they separated is one sheet now
        result.statistics.sheets_before = complex.sheets;
        result.statistics.sheets_after = result.complex.sheets;
        result.statistics.faces_removed = static_cast<Index>(complex.faces.size() - result.complex.faces.size());
        result.statistics.topology = topology(result.complex);
        kernel::report(execution, "filter", 1.0);
        return result;
    });
}

}  // namespace scaleaxis
