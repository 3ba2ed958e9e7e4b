// SPDX-License-Identifier: GPL-3.0-or-later
#include "scaleaxis/filter.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

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

// A complex from which sheets are collapsed one by one.
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

    // Collapses a sheet onto the rest of the complex: its faces from their free edges, and then the edges that no face
    // is left at from their free ends. If something of the sheet would remain, it undoes everything, leaves in
    // `blocking_vertices` the ends of edges that did not vanish, and returns false.
    bool remove(Index sheet, std::span<const Index> faces) {
        removed_faces_.clear();
        removed_edges_.clear();
        removed_vertices_.clear();
        maybe_free_edges_.clear();
        bare_edges_.clear();
        blocking_vertices_.clear();
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
            if (faces_at_edge_[edge].count == 1 && complex_.face_sheets[face] == sheet) {
                remove_face(sheet, face);
                remove_edge(edge);
            }
        }
        if (removed_faces_.size() == faces.size()) {
            collapse_bare_edges(sheet);
            if (blocking_vertices_.empty()) {
                return true;
            }
        }
        undo();
        return false;
    }

    // What the last successful `remove` took away.
    const std::vector<Index>& removed_faces() const { return removed_faces_; }
    const std::vector<Index>& blocking_vertices() const { return blocking_vertices_; }

    // The only face at an edge, or `kNone` if there are none or more.
    Index only_face(Index edge) const {
        return faces_at_edge_[edge].count == 1 ? faces_at_edge_[edge].combined : kNone;
    }

    MedialComplex rest() const { return subcomplex(complex_, has_vertex_, has_edge_, has_face_); }

   private:
    void remove_face(Index sheet, Index face) {
        has_face_[face] = 0;
        removed_faces_.push_back(face);
        for (const Index e : complex_.face_edges[face]) {
            faces_at_edge_[e].remove(face);
            if (faces_at_edge_[e].count == 1) {
                maybe_free_edges_.push_back(e);
            } else if (faces_at_edge_[e].count == 0) {
                bare_edges_.push_back(e);
                bare_for_[e] = sheet;
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

    void collapse_bare_edges(Index sheet) {
        for (Index edge : bare_edges_) {
            // From a free end on, edge after edge, up to where something else begins.
            while (has_edge_[edge] != 0 && faces_at_edge_[edge].count == 0 && bare_for_[edge] == sheet) {
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
    std::vector<Index> bare_for_;  // the sheet whose removal left the edge without a face
    // Of the last call of `remove`, kept to save allocations: there are about as many sheets as faces.
    std::vector<Index> maybe_free_edges_;
    std::vector<Index> bare_edges_;
    std::vector<Index> removed_faces_;
    std::vector<Index> removed_edges_;
    std::vector<Index> removed_vertices_;
    std::vector<Index> blocking_vertices_;
};

// The faces of every sheet.
IndexLists faces_of_sheets(const MedialComplex& complex) {
    IndexLists lists;
    lists.offsets.assign(static_cast<std::size_t>(complex.sheets) + 1, 0);
    for (const Index sheet : complex.face_sheets) {
        ++lists.offsets[sheet + 1];
    }
    std::partial_sum(lists.offsets.begin(), lists.offsets.end(), lists.offsets.begin());
    lists.items.resize(complex.face_sheets.size());
    std::vector<Index> next(lists.offsets.begin(), lists.offsets.end() - 1);
    for (Index f = 0; f < static_cast<Index>(complex.face_sheets.size()); ++f) {
        lists.items[next[complex.face_sheets[f]]++] = f;
    }
    return lists;
}

using Candidate = std::pair<double, Index>;  // importance and sheet

// Always removes the least important sheet that can be removed. So what a smaller threshold removes comes first for a
// larger one too, and the results are nested.
void remove_sheets(Collapse& collapse, const MedialComplex& complex, double angle, const Execution& execution) {
    const IndexLists faces = faces_of_sheets(complex);
    std::vector<double> importance(complex.sheets, 0.0);
    for (std::size_t f = 0; f < complex.face_sheets.size(); ++f) {
        double& largest = importance[complex.face_sheets[f]];
        largest = std::max(largest, complex.face_angles[f]);
    }
    std::vector<Candidate> candidates;
    for (Index sheet = 0; sheet < complex.sheets; ++sheet) {
        if (importance[sheet] < angle) {
            candidates.emplace_back(importance[sheet], sheet);
        }
    }
    std::sort(candidates.begin(), candidates.end());

    // A sheet that could not be removed is tried again when something beside it has gone: an edge of it has become
    // free, or the vertex at which it held something else.
    std::vector<std::uint8_t> has_failed(complex.sheets);
    std::unordered_multimap<Index, Index> blocked_at_vertex;
    std::priority_queue<Candidate, std::vector<Candidate>, std::greater<>> retries;
    const auto retry = [&](Index sheet) {
        if (has_failed[sheet] != 0) {
            has_failed[sheet] = 0;
            retries.emplace(importance[sheet], sheet);
        }
    };
    const auto try_to_remove = [&](Index sheet) {
        if (!collapse.remove(sheet, faces[sheet])) {
            has_failed[sheet] = 1;
            for (const Index v : collapse.blocking_vertices()) {
                blocked_at_vertex.emplace(v, sheet);
            }
            return;
        }
        for (const Index f : collapse.removed_faces()) {
            for (const Index e : complex.face_edges[f]) {
                if (const Index face = collapse.only_face(e); face != kNone) {
                    retry(complex.face_sheets[face]);
                }
            }
            for (const Index v : complex.faces[f]) {
                const auto [begin, end] = blocked_at_vertex.equal_range(v);
                for (auto it = begin; it != end; ++it) {
                    retry(it->second);
                }
                blocked_at_vertex.erase(begin, end);
            }
        }
    };
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (i % 65536 == 0) {
            kernel::report(execution, "filter", static_cast<double>(i) / static_cast<double>(candidates.size()));
        }
        try_to_remove(candidates[i].second);
        while (!retries.empty()) {
            const Index sheet = retries.top().second;
            retries.pop();
            try_to_remove(sheet);
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
        remove_sheets(collapse, complex, options.angle, execution);
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
