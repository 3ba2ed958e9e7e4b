// SPDX-License-Identifier: Apache-2.0
// The page that shows results.
#include "scaleaxis/view.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"

namespace scaleaxis::python {

void bind_view(nb::module_& m) {
    m.def("view_data", [](const std::string& name, const PointsIn& vertices, const RowsIn<3>& triangles,
                          const std::vector<Fields>& axes, const std::string& statistics) {
        ViewedModel model{name, mesh_of(vertices, triangles), {}, statistics};
        for (const Fields& axis : axes) {
            model.axes.push_back(
                {nb::cast<double>(axis["scale"]), complex_of(nb::cast<Fields>(axis["complex"])),
                 mesh_of(nb::cast<PointsIn>(axis["surface_vertices"]), nb::cast<RowsIn<3>>(axis["surface_triangles"])),
                 nb::cast<std::string>(axis["statistics"])});
        }
        const std::string data = unlocked([&] { return view_data(model); });
        return nb::bytes(data.data(), data.size());
    });
    m.def("write_view", [](const std::filesystem::path& file, const std::string& title, bool is_contact_sheet,
                           const std::vector<nb::bytes>& models) {
        std::vector<std::string> data;
        for (const nb::bytes& model : models) {
            data.emplace_back(model.c_str(), model.size());
        }
        const ViewLayout layout = is_contact_sheet ? ViewLayout::kContactSheet : ViewLayout::kSideBySide;
        unlocked([&] { write_view(file, title, layout, data); });
    });
    m.def("check_view_output", [](const std::filesystem::path& file) { check_view_output(file); });
}

}  // namespace scaleaxis::python
