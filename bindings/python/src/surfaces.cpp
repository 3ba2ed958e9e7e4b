// SPDX-License-Identifier: Apache-2.0
// Unions of balls as meshes and images; distances between surfaces.
#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/variant.h>

#include <tuple>
#include <utility>
#include <variant>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "images.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/envelope.hpp"
#include "scaleaxis/field.hpp"
#include "scaleaxis/report.hpp"
#include "scaleaxis/union_mesh.hpp"

namespace scaleaxis::python {
namespace {

using python::fields_of;

using MeshIn = std::tuple<PointsIn, RowsIn<3>>;
using SurfaceIn = std::variant<const Envelope*, BallsIn, MeshIn>;

Surface surface_of(const SurfaceIn& given) {
    if (const auto* mesh = std::get_if<MeshIn>(&given)) {
        return mesh_of(std::get<0>(*mesh), std::get<1>(*mesh));
    }
    if (const auto* envelope = std::get_if<const Envelope*>(&given)) {
        return **envelope;
    }
    return BallUnion(copy(balls(std::get<BallsIn>(given))));
}

Fields fields_of(const OneSidedDistance& distance) {
    Fields fields;
    fields["max"] = distance.max;
    fields["error"] = distance.error;
    fields["mean"] = distance.mean;
    fields["rms"] = distance.rms;
    fields["farthest"] = nb::make_tuple(distance.farthest.x, distance.farthest.y, distance.farthest.z);
    fields["samples"] = distance.samples;
    return fields;
}

}  // namespace

void bind_surfaces(nb::module_& m) {
    nb::class_<Envelope>(m, "CoreEnvelope")
        .def("__init__", [](Envelope* self, const Fields& complex) { new (self) Envelope(complex_of(complex)); })
        .def("bounds", [](const Envelope& envelope) { return array_of(envelope.bounds()); })
        .def("topology", [](const Envelope& envelope) { return tuple_of(envelope.topology()); })
        .def("signed_distances",
             [](const Envelope& envelope, const PointsIn& given, int threads, Tell progress) {
                 return array_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
                     return envelope.signed_distances(points(given), execution);
                 }));
             })
        .def("inside", [](const Envelope& envelope, const PointsIn& given, int threads, Tell progress) {
            return array_of(run({threads, std::move(progress)},
                                [&](const Execution& execution) { return envelope.inside(points(given), execution); }));
        });
    m.def("union_mesh", [](const std::variant<const Envelope*, BallsIn>& given, double delta, bool is_absolute,
                           std::uint64_t seed, int threads, Tell progress) {
        const UnionMeshOptions options{is_absolute ? Length::absolute(delta) : Length::relative(delta), seed};
        UnionMesh mesh = run({threads, std::move(progress)}, [&](const Execution& execution) {
            if (const auto* envelope = std::get_if<const Envelope*>(&given)) {
                return envelope_mesh(**envelope, options, execution);
            }
            return union_mesh(copy(balls(std::get<BallsIn>(given))), options, execution);
        });
        Fields fields;
        fields["statistics"] = to_json(mesh, {});
        fields["warnings"] = to_json(std::span<const Diagnostic>(mesh.warnings));
        fields.update(fields_of(std::move(mesh.boundary.mesh)));
        return fields;
    });
    m.def("surface_distance", [](const SurfaceIn& a, const SurfaceIn& b, double spacing, double accuracy,
                                 std::uint64_t seed, int threads, Tell progress) {
        const SurfaceDistance distance = run({threads, std::move(progress)}, [&](const Execution& execution) {
            return surface_distance(surface_of(a), surface_of(b), {spacing, accuracy, seed}, execution);
        });
        return std::pair(fields_of(distance.a_to_b), fields_of(distance.b_to_a));
    });
    m.def("surface_bounds", [](const SurfaceIn& given) { return array_of(surface_bounds(surface_of(given))); });
    m.def("signed_distance_image", [](const std::variant<const Envelope*, const BallUnion*>& given, Index resolution,
                                      int threads, Tell progress) {
        return fields_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
            return std::visit([&](const auto* solid) { return signed_distance_image(*solid, resolution, execution); },
                              given);
        }));
    });
    m.def("topology_of_image",
          [](const FloatsIn& values, const PointsIn& place, double iso, bool is_below, int threads, Tell progress) {
              const ImageView image = image_view(values, place);
              return tuple_of(run({threads, std::move(progress)}, [&](const Execution& execution) {
                  return topology(image, {iso, is_below}, execution);
              }));
          });
    m.def("smoothed_mask", [](const FloatsIn& values, const PointsIn& place, double width, int threads, Tell progress) {
        const ImageView image = image_view(values, place);
        return fields_of(run({threads, std::move(progress)},
                             [&](const Execution& execution) { return smoothed_mask(image, {width}, execution); }));
    });
}

}  // namespace scaleaxis::python
