// SPDX-License-Identifier: Apache-2.0
// The kernels beneath the stages: Delaunay triangulations and nearest points.
#include <nanobind/nanobind.h>
#include <nanobind/stl/tuple.h>

#include <tuple>
#include <utility>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/delaunay.hpp"
#include "scaleaxis/nearest.hpp"

namespace scaleaxis::python {

void bind_kernels(nb::module_& m) {
    m.def("delaunay", [](const PointsIn& given, const DoublesIn& weights, int threads) {
        Delaunay found = run({threads, {}}, [&](const Execution& execution) {
            return delaunay(points(given), rows<double>(weights), execution);
        });
        return std::tuple(array_of(std::move(found.tetrahedra)), array_of(std::move(found.neighbors)));
    });
    m.def("nearest", [](const PointsIn& vertices, const RowsIn<3>& triangles, const PointsIn& given, int threads) {
        NearestOnMesh found = run({threads, {}}, [&](const Execution& execution) {
            return nearest(mesh_of(vertices, triangles), points(given), execution);
        });
        return std::tuple(array_of(std::move(found.points)), array_of(std::move(found.distances)),
                          array_of(std::move(found.triangles)));
    });
}

}  // namespace scaleaxis::python
