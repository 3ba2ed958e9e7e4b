// SPDX-License-Identifier: Apache-2.0
// Solids, and how they are made of arrays and functions.
#include "scaleaxis/solid.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "images.hpp"
#include "scaleaxis/ball_union.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/function.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::python {
namespace {

constexpr std::size_t kQuestionsBetweenSignals = 1 << 16;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// Calls `ask(begin, end)` for parts of `0 … count`, and answers signals between them.
template <class Ask>
void in_parts(std::size_t count, const Ask& ask) {
    for (std::size_t begin = 0; begin < count; begin += kQuestionsBetweenSignals) {
        unlocked([&] { ask(begin, std::min(count - begin, kQuestionsBetweenSignals)); });
        if (PyErr_CheckSignals() != 0) {
            throw nb::python_error();
        }
    }
}

/// Points as rows; of nothing rows of NaN.
Out<double, 3> rows_of(const std::vector<std::optional<Point>>& points) {
    std::vector<Point> rows(points.size());
    std::ranges::transform(points, rows.begin(), [](const auto& p) { return p.value_or(Point{kNaN, kNaN, kNaN}); });
    return array_of(std::move(rows));
}

Out<bool> inside(const Solid& solid, const PointsIn& given) {
    const std::span<const Point> all = points(given);
    std::vector<std::uint8_t> sides(all.size());
    in_parts(all.size(), [&](std::size_t begin, std::size_t count) {
        solid.inside(all.subspan(begin, count), std::span(sides).subspan(begin, count));
    });
    return array_of(std::move(sides));
}

Out<double, 3> crossings(const Solid& solid, const PointsIn& inside_ends, const PointsIn& outside_ends,
                         const PointsIn& references) {
    std::vector<Chord> chords(inside_ends.shape(0));
    for (std::size_t i = 0; i < chords.size(); ++i) {
        chords[i] = {points(inside_ends)[i], points(outside_ends)[i], points(references)[i]};
    }
    std::vector<std::optional<Point>> found(chords.size());
    in_parts(chords.size(), [&](std::size_t begin, std::size_t count) {
        solid.crossings(std::span(chords).subspan(begin, count), std::span(found).subspan(begin, count));
    });
    return rows_of(found);
}

Out<double, 3> nearest(const Solid& solid, const PointsIn& given, const DoublesIn& bounds) {
    const std::span<const Point> all = points(given);
    const std::span<const double> limits = rows<double>(bounds);
    std::vector<std::optional<Point>> found(all.size());
    in_parts(all.size(), [&](std::size_t begin, std::size_t count) {
        solid.nearest(all.subspan(begin, count), limits.subspan(begin, count), std::span(found).subspan(begin, count));
    });
    return rows_of(found);
}

/// A function of Python that the library asks from threads of its own. The last copy goes with the lock held.
class PythonFunction {
   public:
    explicit PythonFunction(nb::object function)
        : function_(new nb::object(std::move(function)), [](nb::object* last) {
              const nb::gil_scoped_acquire acquired;
              delete last;
          }) {}

    void operator()(std::span<const Point> points, std::span<double> values) const {
        const nb::gil_scoped_acquire acquired;
        // A copy, since the function may keep its argument.
        const nb::object answer = (*function_)(array_of(copy(points)));
        const auto given = nb::cast<DoublesIn>(answer);
        if (given.shape(0) != points.size()) {
            throw nb::value_error("the function must return one value for each point");
        }
        std::copy_n(given.data(), points.size(), values.begin());
    }

   private:
    std::shared_ptr<nb::object> function_;
};

}  // namespace

void bind_solids(nb::module_& m) {
    nb::class_<Solid>(m, "CoreSolid")
        .def("bounds", [](const Solid& solid) { return array_of(unlocked([&] { return solid.bounds(); })); })
        .def("knows_nearest", &Solid::knows_nearest)
        .def("batch_size", &Solid::batch_size)
        .def("inside", inside)
        .def("crossings", crossings)
        .def("nearest", nearest)
        .def("seeds",
             [](const Solid& solid, double spacing, std::uint64_t seed, int threads, Tell progress) {
                 return array_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
                     return solid.seeds(spacing, seed, execution);
                 }));
             })
        .def("topology", [](const Solid& solid) { return tuple_of(unlocked([&] { return solid.topology(); })); })
        .def("warnings", [](const Solid& solid) { return to_json(unlocked([&] { return solid.warnings(); })); });

    m.def("mesh_solid", [](const PointsIn& vertices, const RowsIn<3>& triangles, int threads, Tell progress) {
        const MeshView mesh{points(vertices), index_rows<3>(triangles)};
        return run({threads, std::move(progress)},
                   [&](const Execution& execution) { return mesh_solid(mesh, execution); });
    });
    m.def("image_solid",
          [](const FloatsIn& values, const PointsIn& place, double iso, bool is_below, int threads, Tell progress) {
              const ImageView image = image_view(values, place);
              return run({threads, std::move(progress)}, [&](const Execution& execution) {
                  return image_solid(image, {iso, is_below}, execution);
              });
          });
    m.def("function_solid", [](nb::object function, const PointsIn& bounds, double smallest_feature, bool is_clipped,
                               int threads, Tell progress) {
        const FunctionOptions options{{points(bounds)[0], points(bounds)[1]}, smallest_feature, is_clipped};
        const std::function<void(std::span<const Point>, std::span<double>)> asked =
            PythonFunction(std::move(function));
        return run({threads, std::move(progress)},
                   [&](const Execution& execution) { return function_solid(asked, options, execution); });
    });
    m.def("cloud_solid",
          [](const PointsIn& given, const PointsIn& normals, std::optional<double> kernel, int threads, Tell progress) {
              const CloudView cloud{points(given), points(normals)};
              return run({threads, std::move(progress)}, [&](const Execution& execution) {
                  return cloud_solid(prepare(cloud, {}, execution), {kernel}, execution);
              });
          });
    m.def("union_solid", [](const BallsIn& given, int threads, Tell progress) {
        return run({threads, std::move(progress)},
                   [&](const Execution& execution) { return union_solid(copy(balls(given)), execution); });
    });
}

}  // namespace scaleaxis::python
