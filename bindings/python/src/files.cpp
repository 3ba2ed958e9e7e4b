// SPDX-License-Identifier: Apache-2.0
// Reading and writing files.
#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/variant.h>
#include <nanobind/stl/vector.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "images.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/report.hpp"

namespace scaleaxis::python {
namespace {

/// A file, or its content in memory.
using FileIn = std::variant<nb::bytes, std::filesystem::path>;

/// What `read` makes of a file, without the lock of the interpreter.
template <class Read>
auto read_from(const FileIn& file, const std::string& name, const Read& read) {
    if (const auto* path = std::get_if<std::filesystem::path>(&file)) {
        return unlocked([&] { return read(*path); });
    }
    const nb::bytes& content = std::get<nb::bytes>(file);
    const FileBytes bytes{{reinterpret_cast<const std::byte*>(content.c_str()), content.size()}, name};
    return unlocked([&] { return read(bytes); });
}

void bind_readers(nb::module_& m) {
    m.def("input_extensions", &input_extensions);
    m.def("read_mesh", [](const FileIn& file, const std::string& name) {
        return fields_of(read_from(file, name, [](const auto& from) { return read_mesh(from); }));
    });
    m.def("read_objects", [](const FileIn& file, const std::string& name) {
        MeshObjects read = read_from(file, name, [](const auto& from) { return read_objects(from); });
        nb::list objects;
        for (MeshObject& object : read.objects) {
            objects.append(nb::make_tuple(object.name, fields_of(std::move(object.mesh))));
        }
        return nb::make_tuple(objects, to_json(std::span<const Diagnostic>(read.warnings)));
    });
    m.def("read_points", [](const FileIn& file, const std::string& name) {
        PointCloud cloud = read_from(file, name, [](const auto& from) { return read_points(from); });
        return std::pair(array_of(std::move(cloud.points)), array_of(std::move(cloud.normals)));
    });
    m.def("read_balls", [](const FileIn& file, const std::string& name) {
        return array_of(read_from(file, name, [](const auto& from) { return read_balls(from); }));
    });
    m.def("read_axis", [](const FileIn& file, const std::string& name, const std::optional<double>& scale) {
        return fields_of(read_from(file, name, [&](const auto& from) { return read_axis(from, scale); }));
    });
    m.def("read_image", [](const FileIn& file, const std::string& name) {
        return fields_of(read_from(file, name, [](const auto& from) { return read_image(from); }));
    });
}

void bind_writers(nb::module_& m) {
    using Path = std::filesystem::path;
    m.def("write_mesh", [](const Path& file, const PointsIn& vertices, const RowsIn<3>& triangles) {
        unlocked([&, mesh = mesh_of(vertices, triangles)] { write_mesh(file, mesh); });
    });
    m.def("write_balls", [](const Path& file, const BallsIn& given) {
        unlocked([&, all = balls(given)] { write_balls(file, all); });
    });
    m.def("write_axis", [](const Path& file, const Fields& complex, bool has_polygons,
                           const std::vector<std::pair<std::string, DoublesIn>>& values) {
        AxisFileOptions options{.has_polygons = has_polygons};
        for (const auto& [name, numbers] : values) {
            options.vertex_values.push_back({name, {numbers.data(), numbers.data() + numbers.size()}});
        }
        unlocked([&, given = complex_of(complex)] { write_axis(file, given, {}, options); });
    });
    m.def("write_shells", [](const Path& file, const Fields& shells, int order) {
        unlocked([&, given = shells_of(shells)] { write_shells(file, given, {order}); });
    });
    m.def("write_image", [](const Path& file, const FloatsIn& values, const PointsIn& place, const FrameIn& frame) {
        unlocked([&, image = image_of(values, place, frame)] { write_image(file, image); });
    });
    m.def("check_mesh_output", [](const Path& file) { check_mesh_output(file); });
    m.def("check_balls_output", [](const Path& file) { check_balls_output(file); });
    m.def("check_axis_output", [](const Path& file) { check_axis_output(file); });
    m.def("check_image_output", [](const Path& file) { check_image_output(file); });
}

}  // namespace

void bind_files(nb::module_& m) {
    bind_readers(m);
    bind_writers(m);
}

}  // namespace scaleaxis::python
