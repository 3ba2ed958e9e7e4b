// SPDX-License-Identifier: Apache-2.0
/// \file
/// Arrays of Python ↔ arrays of the library. What comes in is looked at where it lies; what goes out is moved, not copied,
/// and lives as long as the array of Python that shows it. The Python side makes any layout and type the ones named here.
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

/// An array of NumPy that owns `values`, and shows each as an array of the shape given.
template <class Scalar, class T>
nb::object array_of(std::vector<T> values, std::initializer_list<std::size_t> shape_of_one) {
    auto* kept = new std::vector<T>(std::move(values));
    const nb::capsule owner(kept, [](void* all) noexcept { delete static_cast<std::vector<T>*>(all); });
    std::array<std::size_t, 3> shape{kept->size()};
    std::size_t dimensions = 1;
    for (const std::size_t size : shape_of_one) {
        shape[dimensions++] = size;
    }
    return nb::cast(nb::ndarray<nb::numpy, Scalar>(kept->data(), dimensions, shape.data(), owner));
}
inline nb::object array_of(std::vector<Point> values) { return array_of<double>(std::move(values), {3}); }
inline nb::object array_of(std::vector<Ball> values) { return array_of<double>(std::move(values), {4}); }
inline nb::object array_of(std::vector<Contacts> values) { return array_of<double>(std::move(values), {2, 3}); }
inline nb::object array_of(std::vector<double> values) { return array_of<double>(std::move(values), {}); }
inline nb::object array_of(std::vector<float> values) { return array_of<float>(std::move(values), {}); }
inline nb::object array_of(std::vector<Index> values) { return array_of<Index>(std::move(values), {}); }
inline nb::object array_of(std::vector<std::uint8_t> values) { return array_of<bool>(std::move(values), {}); }
template <std::size_t K>
nb::object array_of(std::vector<std::array<Index, K>> values) {
    return array_of<Index>(std::move(values), {K});
}

}  // namespace scaleaxis::python
