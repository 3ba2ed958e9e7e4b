// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "axis/complex.hpp"
#include "base/parallel.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "spatial/extent.hpp"

namespace scaleaxis::inline v1 {
namespace {

[[noreturn]] void fail(const std::string& code, const std::string& message) {
    throw UnusableInput(Diagnostic{"complex." + code, "the complex is not valid: " + message});
}

[[noreturn]] void fail(const std::string& code, const std::string& element, std::int64_t index,
                       const std::string& fault) {
    throw UnusableInput(Diagnostic{"complex." + code,
                                   "the complex is not valid: " + element + ' ' + std::to_string(index) + ' ' + fault,
                                   element, index});
}

void check_size(const char* name, std::size_t size, std::size_t expected, const char* elements) {
    if (size != expected) {
        fail("size", std::string("`") + name + "` has " + std::to_string(size) + " entries for " +
                         std::to_string(expected) + ' ' + elements);
    }
}

// What is wrong with an element; no code: nothing.
struct Fault {
    const char* code = nullptr;
    const char* description = "";
};

// Throws for the first element, for any number of threads, with a fault.
template <class FaultOf>
void check_each(const char* element, std::size_t count, const FaultOf& fault_of) {
    std::atomic<std::size_t> first = count;
    for_each_index(count, [&](std::size_t i) {
        if (fault_of(i).code != nullptr) {
            std::size_t known = first.load();
            while (i < known && !first.compare_exchange_weak(known, i)) {
            }
        }
    });
    if (first < count) {
        const auto [code, description] = fault_of(first.load());
        fail(code, element, static_cast<std::int64_t>(first.load()), description);
    }
}

bool is_below(Index i, std::size_t size) { return i >= 0 && static_cast<std::size_t>(i) < size; }

void check_lists(const char* name, const IndexLists& lists) {
    const std::vector<Index>& offsets = lists.offsets;
    if (offsets.empty() || offsets.front() != 0 || offsets.back() != static_cast<Index>(lists.items.size()) ||
        !std::ranges::is_sorted(offsets)) {
        fail("size", std::string("the offsets of `") + name + "` do not cut its items into lists");
    }
}

bool has_repetition(std::span<const Index> items) {
    constexpr std::size_t kMostPairwise = 32;
    if (items.size() > kMostPairwise) {
        std::vector<Index> sorted(items.begin(), items.end());
        std::ranges::sort(sorted);
        return std::ranges::adjacent_find(sorted) != sorted.end();
    }
    for (std::size_t i = 1; i < items.size(); ++i) {
        if (std::find(items.begin(), items.begin() + i, items[i]) != items.begin() + i) {
            return true;
        }
    }
    return false;
}

void check_sizes(const MedialComplex& complex) {
    check_lists("faces", complex.faces);
    check_lists("face_edges", complex.face_edges);
    const std::size_t vertices = complex.vertices.size();
    const std::size_t faces = complex.faces.size();
    check_size("radii", complex.radii.size(), vertices, "vertices");
    check_size("vertex_origins", complex.vertex_origins.size(), vertices, "vertices");
    if (complex.face_edges.offsets != complex.faces.offsets) {
        fail("size", "`face_edges` and `faces` have lists of different lengths");
    }
    check_size("face_angles", complex.face_angles.size(), faces, "faces");
    check_size("face_sheets", complex.face_sheets.size(), faces, "faces");
    if (!complex.face_contacts.empty()) {
        check_size("face_contacts", complex.face_contacts.size(), faces, "faces");
    }
    check_size("boundary_vertex_balls", complex.boundary_vertex_balls.size(), complex.boundary_vertices.size(),
               "boundary vertices");
    if (!complex.vertex_labels.empty()) {
        check_size("vertex_labels", complex.vertex_labels.size(), vertices, "vertices");
    }
    if (complex.sheets < 0 || static_cast<std::size_t>(complex.sheets) > faces) {
        fail("sheet", "it has " + std::to_string(complex.sheets) + " sheets for " + std::to_string(faces) + " faces");
    }
}

Fault fault_of_vertex(const MedialComplex& complex, std::size_t v) {
    if (!is_usable(complex.vertices[v])) {
        return {"vertex", kUnusableCoordinate};
    }
    if (!(complex.radii[v] >= 0.0) || !(complex.radii[v] <= kLargestCoordinate)) {
        return {"radius", "has a radius that is not a finite number from 0 to 1e18"};
    }
    const auto& [kind, ball] = complex.vertex_origins[v];
    if (kind == VertexKind::kSharpEdge && complex.radii[v] > 0.0) {
        return {"origin", "is on a sharp edge with a radius other than 0"};
    }
    if ((kind == VertexKind::kBall) != (ball >= 0)) {
        return {"origin", "is the centre of a ball without its number, or has the number of one that it is not"};
    }
    return {};
}

Fault fault_of_edge(const MedialComplex& complex, std::size_t e) {
    const auto& [p, q] = complex.edges[e];
    if (!is_below(p, complex.vertices.size()) || !is_below(q, complex.vertices.size())) {
        return {"edge", "has an end that is no vertex"};
    }
    if (p >= q) {
        return {"edge", "does not have two different ends, the smaller one first"};
    }
    return {};
}

void check_distinct_edges(const std::vector<std::array<Index, 2>>& edges) {
    const auto is_ascending = [](const auto& a, const auto& b) { return a < b; };
    if (std::ranges::adjacent_find(edges, std::not_fn(is_ascending)) == edges.end()) {
        return;
    }
    std::vector<std::array<Index, 2>> sorted = edges;
    std::ranges::sort(sorted);
    if (const auto twice = std::ranges::adjacent_find(sorted); twice != sorted.end()) {
        fail("edge", "edge", std::ranges::find(edges, *twice) - edges.begin(), "occurs twice");
    }
}

bool are_edges_of(const MedialComplex& complex, std::size_t face) {
    const std::span<const Index> corners = complex.faces[face];
    const std::span<const Index> edges = complex.face_edges[face];
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const auto [low, high] = std::minmax(corners[k], corners[k + 1 < corners.size() ? k + 1 : 0]);
        if (!is_below(edges[k], complex.edges.size()) || complex.edges[edges[k]] != std::array{low, high}) {
            return false;
        }
    }
    return true;
}

Fault fault_of_face(const MedialComplex& complex, std::size_t f) {
    const std::span<const Index> corners = complex.faces[f];
    if (corners.size() < 3) {
        return {"face", "has fewer than three corners"};
    }
    if (!std::ranges::all_of(corners, [&](Index v) { return is_below(v, complex.vertices.size()); })) {
        return {"face", "has a corner that is no vertex"};
    }
    if (has_repetition(corners)) {
        return {"face", "has a corner twice"};
    }
    if (!are_edges_of(complex, f)) {
        return {"face", "has edges (`face_edges`) that do not join its corners"};
    }
    if (!is_below(complex.face_sheets[f], complex.sheets)) {
        return {"sheet", "belongs to a sheet that does not exist"};
    }
    if (!(complex.face_angles[f] >= 0.0 && complex.face_angles[f] <= 90.0)) {
        return {"angle", "has an object angle that is not a number from 0 to 90"};
    }
    if (complex.has_contacts()) {
        const auto& [a, b] = complex.face_contacts[f];
        if (!is_below(a, complex.boundary_vertices.size()) || !is_below(b, complex.boundary_vertices.size())) {
            return {"contact", "has a contact that is no boundary vertex"};
        }
    }
    return {};
}

}  // namespace

void check(const MedialComplex& complex) {
    if (!(complex.scale >= 1.0) || !std::isfinite(complex.scale)) {
        fail("scale", "its scale is not a finite number of at least 1");
    }
    check_sizes(complex);
    check_each("vertex", complex.vertices.size(), [&](std::size_t v) { return fault_of_vertex(complex, v); });
    check_each("edge", complex.edges.size(), [&](std::size_t e) { return fault_of_edge(complex, e); });
    check_distinct_edges(complex.edges);
    check_each("face", complex.faces.size(), [&](std::size_t f) { return fault_of_face(complex, f); });
}

void check_angles(const MedialComplex& complex) {
    check_each("face", complex.faces.size(), [&](std::size_t f) {
        return complex.face_angles[f] > 0.0
                   ? Fault()
                   : Fault{"angle",
                           "has no object angle, which filters go by: compute the complex, read it from a file that "
                           "has them (PLY), or find them by with_object_angles"};
    });
}

}  // namespace scaleaxis::inline v1
