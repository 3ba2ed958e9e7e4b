// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/report.hpp"

#include <array>
#include <utility>

namespace scaleaxis::inline v1 {

void AxisReport::set_result(const MedialComplex& complex) {
    vertices = static_cast<Index>(complex.vertices.size());
    edges = static_cast<Index>(complex.edges.size());
    faces = static_cast<Index>(complex.faces.size());
    sheets = complex.sheets;
}

AxisReport report_of(const AxisAtScale& axis, const std::optional<Topology>& solid, std::filesystem::path file) {
    AxisReport report;
    report.scale = axis.complex.scale;
    report.file = std::move(file);
    report.medial = axis.medial_statistics;
    report.filter = axis.filter_statistics;
    report.sharp = axis.sharp_statistics;
    report.clean = axis.clean_statistics;
    report.center = axis.center_statistics;
    report.narrow = axis.narrow_statistics;
    report.simplify = axis.simplify_statistics;
    report.accuracy = axis.accuracy;
    report.solid = solid;
    report.closed_gaps = axis.closed_gaps;
    report.costs = axis.costs;
    report.set_result(axis.complex);
    return report;
}

Agreement agreement(const AxisReport& axis) {
    Agreement result;
    if (axis.solid) {
        result.solid_and_dual = agree(*axis.solid, axis.medial.dual_complex);
    }
    result.dual_and_medial = agree(axis.medial.dual_complex, axis.medial.medial_complex);
    if (axis.filter) {
        result.medial_and_filtered = agree(axis.medial.medial_complex, axis.filter->topology);
    }
    if (axis.filter && axis.simplify) {
        const Topology& before = axis.clean ? axis.clean->topology : axis.filter->topology;
        result.compact_and_before = agree(before, axis.simplify->topology);
    }
    if (axis.filter && axis.sharp) {
        result.filtered_and_sharp = agree(axis.filter->topology, axis.sharp->topology);
    }
    if (axis.filter && axis.clean) {
        result.filtered_and_cleaned = agree(axis.filter->topology, axis.clean->topology);
    }
    return result;
}

std::string_view name_of(const InputReport& input) {
    constexpr std::array<std::string_view, std::variant_size_v<InputReport>> kNames{"mesh", "image", "points", "union",
                                                                                    "function"};
    return kNames[input.index()];
}

}  // namespace scaleaxis::inline v1
