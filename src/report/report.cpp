// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.hpp"

#include "outputs.hpp"

namespace scaleaxis::app {

void AxisReport::set_result(const MedialComplex& complex) {
    vertices = static_cast<Index>(complex.vertices.size());
    edges = static_cast<Index>(complex.edges.size());
    faces = static_cast<Index>(complex.faces.size());
    sheets = complex.sheets;
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
    return result;
}

Json new_document(const std::string& schema) { return {{"schema", schema}, {"version", SCALEAXIS_VERSION}}; }

std::string to_text(const Json& document) {
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_statistics(const std::string& file, const Json& document) {
    if (file == "-") {
        print_text(to_text(document));
    } else if (!file.empty()) {
        write_text(file, to_text(document));
    }
}

}  // namespace scaleaxis::app
