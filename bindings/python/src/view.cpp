// SPDX-License-Identifier: Apache-2.0
// The page that shows results.
#include "scaleaxis/view.hpp"

#include <nanobind/nanobind.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <filesystem>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bindings.hpp"
#include "calls.hpp"
#include "data.hpp"
#include "scaleaxis/filtration.hpp"

namespace scaleaxis::python {

namespace {

/// `ViewedThickness`.
using ThicknessIn = std::tuple<DoublesIn, DoublesIn, IndicesIn, std::optional<double>>;

nb::bytes bytes_of(const std::string& data) { return nb::bytes(data.data(), data.size()); }

}  // namespace

void bind_view(nb::module_& m) {
    m.def("view_data", [](const std::string& name, const PointsIn& vertices, const RowsIn<3>& triangles,
                          const std::vector<Fields>& axes, const std::string& statistics,
                          const std::optional<ThicknessIn>& thickness) {
        ViewedModel model{name, mesh_of(vertices, triangles), {}, statistics};
        for (const Fields& axis : axes) {
            model.axes.push_back(
                {complex_of(nb::cast<Fields>(axis["complex"])), {}, nb::cast<std::string>(axis["statistics"])});
        }
        if (thickness) {
            const auto& [local, foot, regions, limit] = *thickness;
            model.thickness = {vector_of(local), vector_of(foot), vector_of(regions), limit};
        }
        return bytes_of(unlocked([&] { return view_data(model); }));
    });
    m.def("view_filtration", [](const std::string& name, const PointsIn& vertices, const RowsIn<3>& triangles,
                                const Fields& complex, const ScalesIn& scales) {
        ViewedModel model{name, mesh_of(vertices, triangles), {}, {}};
        Filtration nested = filtration_of(complex, scales);
        return bytes_of(unlocked([&] {
            std::vector<FiltrationLevel> levels = profile(nested, nested.largest_scale);
            model.axes.push_back(viewed(std::move(nested), std::move(levels)));
            return view_data(model);
        }));
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
