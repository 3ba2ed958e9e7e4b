// SPDX-License-Identifier: Apache-2.0
/// \file
/// Arrays of Python ↔ arrays of the library. What comes in is looked at where it lies; what goes out is moved, not
/// copied, and lives as long as the array of Python that shows it. The Python side makes any layout and type the ones
/// named here.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "scaleaxis/fit.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::python {

namespace nb = nanobind;

template <class T, class... Shape>
using In = nb::ndarray<const T, Shape..., nb::c_contig, nb::device::cpu>;

using PointsIn = In<double, nb::shape<-1, 3>>;
using BallsIn = In<double, nb::shape<-1, 4>>;
using DoublesIn = In<double, nb::ndim<1>>;
using IndicesIn = In<Index, nb::ndim<1>>;
using BytesIn = In<std::uint8_t, nb::ndim<1>>;
using FloatsIn = In<float, nb::ndim<3>>;
template <int K>
using RowsIn = In<Index, nb::shape<-1, K>>;

static_assert(sizeof(Point) == 3 * sizeof(double) && sizeof(Ball) == 4 * sizeof(double));
static_assert(sizeof(Contacts) == 6 * sizeof(double));

/// The rows of an array as values of a type that has the same layout.
template <class T, class Array>
std::span<const T> rows(const Array& array) {
    return {reinterpret_cast<const T*>(array.data()), array.shape(0)};
}
inline std::span<const Point> points(const PointsIn& array) { return rows<Point>(array); }
inline std::span<const Ball> balls(const BallsIn& array) { return rows<Ball>(array); }
template <int K>
std::span<const std::array<Index, K>> index_rows(const RowsIn<K>& array) {
    return rows<std::array<Index, K>>(array);
}
template <class T>
std::vector<T> copy(std::span<const T> values) {
    return {values.begin(), values.end()};
}

template <class T>
std::vector<T> vector_of(const In<T, nb::ndim<1>>& array) {
    return copy(rows<T>(array));
}

template <class T, int... Shape>
using Out = nb::ndarray<nb::numpy, T, nb::shape<-1, Shape...>>;

/// An array of NumPy that owns `values`, and shows each as an array of the shape given.
template <class Scalar, int... Shape, class T>
Out<Scalar, Shape...> owning(std::vector<T> values) {
    auto* kept = new std::vector<T>(std::move(values));
    const nb::capsule owner(kept, [](void* all) noexcept { delete static_cast<std::vector<T>*>(all); });
    return {kept->data(), {kept->size(), Shape...}, owner};
}
inline auto array_of(std::vector<Point> values) { return owning<double, 3>(std::move(values)); }
inline auto array_of(std::vector<Ball> values) { return owning<double, 4>(std::move(values)); }
inline auto array_of(std::vector<Contacts> values) { return owning<double, 2, 3>(std::move(values)); }
inline auto array_of(std::vector<std::array<double, 3>> values) { return owning<double, 3>(std::move(values)); }
inline auto array_of(std::vector<double> values) { return owning<double>(std::move(values)); }
inline auto array_of(std::vector<float> values) { return owning<float>(std::move(values)); }
inline auto array_of(std::vector<Index> values) { return owning<Index>(std::move(values)); }
inline auto array_of(std::vector<std::uint8_t> values) { return owning<bool>(std::move(values)); }
template <std::size_t K>
auto array_of(std::vector<std::array<Index, K>> values) {
    return owning<Index, static_cast<int>(K)>(std::move(values));
}

}  // namespace scaleaxis::python
