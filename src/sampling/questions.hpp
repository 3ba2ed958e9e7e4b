// SPDX-License-Identifier: Apache-2.0
/// \file
/// Questions to a solid, in batches that threads share.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/solid.hpp"
#include "spatial/spatial_order.hpp"

namespace scaleaxis::inline v1 {

/// Calls `body(begin, end, out)` for consecutive batches of `count` questions, in parallel, and returns all that was
/// appended to `out` in the order of the questions.
template <class Out, class Body>
Out collect_batches(const Solid& solid, std::size_t count, const Body& body) {
    const std::size_t size = std::max<std::size_t>(1, solid.batch_size());
    return collect<Out>(
        (count + size - 1) / size,
        [&](std::size_t batch, Out& out) { body(batch * size, std::min(count, (batch + 1) * size), out); },
        std::size_t{1});
}

/// The same in blocks of at least 16 batches, about `blocks` of them: `tell(part)` is called from this thread alone
/// after each with the part of the questions that is done. Returns what each block gave.
template <class Out, class Body, class Tell>
std::vector<Out> collect_blocks(const Solid& solid, std::size_t count, std::size_t blocks, const Body& body,
                                const Tell& tell) {
    const std::size_t batch = std::max<std::size_t>(1, solid.batch_size());
    const std::size_t block = std::max(batch * 16, count / blocks / batch * batch);
    std::vector<Out> result;
    for (std::size_t begin = 0; begin < count; begin += block) {
        const std::size_t size = std::min(block, count - begin);
        result.push_back(collect_batches<Out>(solid, size, [&](std::size_t first, std::size_t last, Out& out) {
            body(begin + first, begin + last, out);
        }));
        tell(static_cast<double>(begin + size) / static_cast<double>(count));
    }
    return result;
}

/// Which points lie in the solid: 1, else 0. In the order given, in which they mostly are near each other: to put them
/// into another would take as long as to answer for an image.
inline std::vector<std::uint8_t> sides_of(const Solid& solid, std::span<const Point> points) {
    return collect_batches<std::vector<std::uint8_t>>(
        solid, points.size(), [&](std::size_t begin, std::size_t end, std::vector<std::uint8_t>& sides) {
            sides.resize(end - begin);
            solid.inside(points.subspan(begin, end - begin), sides);
        });
}

/// The points of the boundary that are nearest to some points, in the order of these: see `Solid::nearest`. They are
/// asked for along a Hilbert curve, batch by batch and in parallel: questions about places near to each other are
/// answered faster one after the other.
inline std::vector<std::optional<Point>> nearest_of(const Solid& solid, std::span<const Point> points,
                                                    std::span<const double> bounds) {
    std::vector<std::optional<Point>> answers(points.size());
    if (points.empty()) {
        return answers;
    }
    solid.prepare_nearest();
    const std::vector<Index> order = hilbert_order(points);
    collect_batches<std::vector<Index>>(
        solid, points.size(), [&](std::size_t begin, std::size_t end, std::vector<Index>&) {
            const std::span<const Index> asked = std::span(order).subspan(begin, end - begin);
            const auto places = each_of<Point>(asked, [&](Index i) { return points[i]; });
            const auto within = each_of<double>(asked, [&](Index i) { return bounds[i]; });
            std::vector<std::optional<Point>> found(asked.size());
            solid.nearest(places, within, found);
            for (std::size_t k = 0; k < asked.size(); ++k) {
                answers[asked[k]] = found[k];
            }
        });
    return answers;
}

/// Asks for the crossing of `chord_of(i)` for `0 ≤ i < count`, calls `take(i, chord, crossing, out)` with each answer,
/// in parallel, and returns all that was appended to `out` in the order of `i`.
template <class Out, class ChordOf, class Take>
Out collect_crossings(const Solid& solid, std::size_t count, const ChordOf& chord_of, const Take& take) {
    return collect_batches<Out>(solid, count, [&](std::size_t begin, std::size_t end, Out& out) {
        std::vector<Chord> chords;
        chords.reserve(end - begin);
        for (std::size_t i = begin; i < end; ++i) {
            chords.push_back(chord_of(i));
        }
        std::vector<std::optional<Point>> points(chords.size());
        solid.crossings(chords, points);
        for (std::size_t i = begin; i < end; ++i) {
            take(i, chords[i - begin], points[i - begin], out);
        }
    });
}

/// The crossings of chords.
inline std::vector<std::optional<Point>> crossings_of(const Solid& solid, std::span<const Chord> chords) {
    using Crossings = std::vector<std::optional<Point>>;
    return collect_batches<Crossings>(solid, chords.size(), [&](std::size_t begin, std::size_t end, Crossings& points) {
        points.resize(end - begin);
        solid.crossings(chords.subspan(begin, end - begin), points);
    });
}

}  // namespace scaleaxis::inline v1
