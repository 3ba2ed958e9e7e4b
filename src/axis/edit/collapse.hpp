// SPDX-License-Identifier: Apache-2.0
/// \file
/// Elementary collapses, which keep the homotopy type.
#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <queue>
#include <type_traits>
#include <utility>
#include <vector>

#include "axis/edit/remainder.hpp"
#include "base/parallel.hpp"

namespace scaleaxis::inline v1 {

/// A face and an edge that no other face has; or an edge without faces and an end that no other edge has.
struct ElementaryCollapse {
    bool has_face = false;
    Index element = kNone;  ///< the face, or the edge
    Index free = kNone;     ///< the edge, or the end; goes with it

    auto operator<=>(const ElementaryCollapse&) const = default;
};

/// Takes back the last collapse that has not been taken back.
inline void undo(const ElementaryCollapse& collapse, const MedialComplex& complex, Remainder& remainder) {
    const auto& [has_face, element, free] = collapse;
    const Index edge = has_face ? free : element;
    remainder.has_edge[edge] = 1;
    for (const Index v : complex.edges[edge]) {
        remainder.edges_at_vertex[v].add(edge);
    }
    if (has_face) {
        remainder.has_face[element] = 1;
        for (const Index e : complex.face_edges[element]) {
            remainder.faces_at_edge[e].add(element);
        }
    } else {
        remainder.has_vertex[free] = 1;
    }
}

/// Collapses what is left of a complex for as long as there is anything to collapse: from some edges and vertices on,
/// and from what that frees.
///
/// `key_of(collapse)` says which collapses may take place: a `bool` in any order, the last one found first; an
/// `std::optional` of a key in the order of keys, ties in that of elements. `collapsed(collapse, key)` is called after
/// each, and may remove more.
template <class KeyOf, class Collapsed>
class Collapses {
   public:
    Collapses(const MedialComplex& complex, Remainder& remainder, KeyOf key_of, Collapsed collapsed)
        : complex_(complex), remainder_(remainder), key_of_(std::move(key_of)), collapsed_(std::move(collapsed)) {}

    /// From a free edge on. Does nothing if it is not free.
    void add_edge(Index edge) {
        if (const Index face = remainder_.only_face(edge); face != kNone) {
            add({true, face, edge});
        }
    }

    /// From a free vertex on. Does nothing if it is not free.
    void add_vertex(Index vertex) {
        if (const Index edge = remainder_.only_bare_edge(vertex); edge != kNone) {
            add({false, edge, vertex});
        }
    }

    void add_all() {
        for (Index e = 0; e < static_cast<Index>(complex_.edges.size()); ++e) {
            add_edge(e);
        }
        for (Index v = 0; v < static_cast<Index>(complex_.vertices.size()); ++v) {
            add_vertex(v);
        }
    }

    void run() {
        while (!waiting_.empty()) {
            stop_if_cancelled_now_and_then_();
            const Entry entry = waiting_.top();
            waiting_.pop();
            if (is_possible(entry.second)) {
                take(entry.second, entry.first);
            }
        }
    }

   private:
    using Key = std::invoke_result_t<KeyOf&, const ElementaryCollapse&>;
    static constexpr bool kHasOrder = !std::same_as<Key, bool>;
    using Entry = std::pair<Key, ElementaryCollapse>;
    struct LastFirst : private std::vector<Entry> {
        using std::vector<Entry>::empty;
        const Entry& top() const { return this->back(); }
        void push(const Entry& entry) { this->push_back(entry); }
        void pop() { this->pop_back(); }
    };
    using Waiting =
        std::conditional_t<kHasOrder, std::priority_queue<Entry, std::vector<Entry>, std::greater<>>, LastFirst>;

    void add(const ElementaryCollapse& collapse) {
        if (const Key key = key_of_(collapse)) {
            waiting_.push({key, collapse});
        }
    }

    bool is_possible(const ElementaryCollapse& collapse) const {
        const auto& [has_face, element, free] = collapse;
        return has_face ? remainder_.only_face(free) == element
                        : remainder_.has_edge[element] != 0 && remainder_.edges_at_vertex[free].count == 1;
    }

    void take(const ElementaryCollapse& collapse, const Key& key) {
        const auto& [has_face, element, free] = collapse;
        if (has_face) {
            remainder_.remove_face(complex_, element);
            remainder_.remove_edge(complex_, free);
            collapsed_(collapse, key);
            for (const Index e : complex_.face_edges[element]) {
                add_edge(e);
            }
            for (const Index v : complex_.faces[element]) {
                add_vertex(v);
            }
        } else {
            remainder_.remove_edge(complex_, element);
            remainder_.has_vertex[free] = 0;
            collapsed_(collapse, key);
            add_vertex(other_end(complex_.edges[element], free));
        }
    }

    const MedialComplex& complex_;
    Remainder& remainder_;
    KeyOf key_of_;
    Collapsed collapsed_;
    Waiting waiting_;
    CancellationPoint stop_if_cancelled_now_and_then_;
};

/// What is left of a complex after all collapses that `key_of` allows, as of `Collapses`.
template <class KeyOf>
Remainder after_collapses(const MedialComplex& complex, KeyOf key_of) {
    using Key = std::invoke_result_t<KeyOf&, const ElementaryCollapse&>;
    Remainder remainder(complex);
    Collapses collapses(complex, remainder, std::move(key_of), [](const ElementaryCollapse&, const Key&) {});
    collapses.add_all();
    collapses.run();
    return remainder;
}

}  // namespace scaleaxis::inline v1
