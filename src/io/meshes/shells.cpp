// SPDX-License-Identifier: Apache-2.0
// Shell meshes as programs for the finite-element method read them. Numbers of nodes, elements and sheets begin at 1.
#include "io/meshes/shells.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "io/formats.hpp"

namespace scaleaxis::io {

namespace {

// CalculiX reads 20 characters of a number, and not what follows.
constexpr std::size_t kInpWidth = 20;

bool is_even(const MidsurfaceSheet& sheet) { return sheet.min == sheet.max; }

/// Calls `use(t)` for the triangles of a sheet.
template <class Use>
void for_each_of_sheet(const ShellMesh& shells, std::size_t sheet, const Use& use) {
    for (std::size_t t = 0; t < shells.mesh.triangles.size(); ++t) {
        if (shells.triangle_sheets[t] == static_cast<Index>(sheet)) {
            use(t);
        }
    }
}

/// A number with a decimal point, as Nastran wants it, in a field of some width.
std::string real_field(double value, std::size_t width) {
    for (int precision = 16; precision > 0; --precision) {
        std::array<char, 40> digits;
        const auto [end, error] =
            std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::general, precision);
        std::string text(digits.data(), end);
        if (text.find('.') == std::string::npos) {
            text.insert(std::min(text.find('e'), text.size()), ".");
        }
        if (text.size() <= width) {
            return text + std::string(width - text.size(), ' ');
        }
    }
    return std::string(width, ' ');
}

std::string field(std::string_view text, std::size_t width = 8) {
    return std::string(text) + std::string(width - std::min(width, text.size()), ' ');
}
std::string field(std::size_t number, std::size_t width = 8) { return field(std::to_string(number), width); }

}  // namespace

double mean_thickness(const ShellMesh& shells, std::size_t triangle) {
    const auto& [a, b, c] = shells.thickness[triangle];
    return (a + b + c) / 3.0;
}

ShellNodes shell_nodes(const ShellMesh& shells, bool has_middles) {
    ShellNodes nodes;
    nodes.places = shells.mesh.vertices;
    const auto corners = static_cast<Index>(nodes.places.size());
    if (has_middles) {
        nodes.places.insert(nodes.places.end(), shells.middles.begin(), shells.middles.end());
    }
    nodes.thickness.resize(nodes.places.size());
    std::vector<double> counts(nodes.places.size());
    const auto add = [&](Index node, double thickness) {
        nodes.thickness[node] += thickness;
        ++counts[node];
    };
    for (std::size_t t = 0; t < shells.mesh.triangles.size(); ++t) {
        std::vector<Index> of_triangle(shells.mesh.triangles[t].begin(), shells.mesh.triangles[t].end());
        const std::array<double, 3>& values = shells.thickness[t];
        for (std::size_t k = 0; k < 3; ++k) {
            add(of_triangle[k], values[k]);
        }
        for (std::size_t k = 0; k < 3 && has_middles; ++k) {
            of_triangle.push_back(corners + shells.triangle_middles[t][k]);
            add(of_triangle.back(), 0.5 * (values[k] + values[(k + 1) % 3]));
        }
        nodes.triangles.push_back(of_triangle);
    }
    for (std::size_t v = 0; v < counts.size(); ++v) {
        nodes.thickness[v] /= counts[v];
    }
    return nodes;
}

/// The same for Abaqus. The material is that of the deck that includes the file.
void write_inp_shells(OutputFile& out, const ShellMesh& shells, bool has_middles) {
    const ShellNodes nodes = shell_nodes(shells, has_middles);
    out.text("** made by scaleaxis: include it after a material of the name WALL\n*NODE, NSET=SHELLS\n");
    for (std::size_t v = 0; v < nodes.places.size(); ++v) {
        const Point& p = nodes.places[v];
        out.text(v + 1, ", ", real_field(p.x, kInpWidth), ", ", real_field(p.y, kInpWidth), ", ",
                 real_field(p.z, kInpWidth), '\n');
    }
    std::vector<std::uint8_t> is_uneven(nodes.places.size());
    for (std::size_t sheet = 0; sheet < shells.sheets.size(); ++sheet) {
        out.text("*ELEMENT, TYPE=", has_middles ? "S6" : "S3", ", ELSET=SHEET", sheet + 1, '\n');
        for_each_of_sheet(shells, sheet, [&](std::size_t t) {
            out.text(t + 1);
            for (const Index v : nodes.triangles[t]) {
                out.text(", ", v + 1);
                is_uneven[v] |= static_cast<std::uint8_t>(is_even(shells.sheets[sheet]) ? 0 : 1);
            }
            out.text('\n');
        });
    }
    out.text("*ELSET, ELSET=SHELLS\n");
    for (std::size_t sheet = 0; sheet < shells.sheets.size(); ++sheet) {
        out.text("SHEET", sheet + 1, ",\n");
    }
    if (std::ranges::find(is_uneven, 1) != is_uneven.end()) {
        out.text("*NODAL THICKNESS\n");
        for (std::size_t v = 0; v < is_uneven.size(); ++v) {
            if (is_uneven[v] != 0) {
                out.text(v + 1, ", ", real_field(nodes.thickness[v], kInpWidth), '\n');
            }
        }
    }
    for (std::size_t sheet = 0; sheet < shells.sheets.size(); ++sheet) {
        // Where nodes have a thickness this one does not count, but without it CalculiX skips the next card.
        out.text("*SHELL SECTION, MATERIAL=WALL, ELSET=SHEET", sheet + 1,
                 is_even(shells.sheets[sheet]) ? "\n" : ", NODAL THICKNESS\n",
                 real_field(shells.sheets[sheet].mean, kInpWidth), '\n');
    }
}

/// The material has the number 1.
void write_bdf_shells(OutputFile& out, const ShellMesh& shells, bool has_middles) {
    const ShellNodes nodes = shell_nodes(shells, has_middles);
    out.text("$ made by scaleaxis: PSHELL n is sheet n, of material 1\nBEGIN BULK\n");
    for (std::size_t v = 0; v < nodes.places.size(); ++v) {
        const Point& p = nodes.places[v];
        out.text(field("GRID*"), field(v + 1, 16), field("", 16), real_field(p.x, 16), real_field(p.y, 16), "\n",
                 field("*"), real_field(p.z, 16), '\n');
    }
    for (std::size_t t = 0; t < shells.mesh.triangles.size(); ++t) {
        const auto sheet = static_cast<std::size_t>(shells.triangle_sheets[t]);
        out.text(field(has_middles ? "CTRIA6" : "CTRIA3"), field(t + 1), field(sheet + 1));
        for (const Index v : nodes.triangles[t]) {
            out.text(field(static_cast<std::size_t>(v) + 1));
        }
        if (!is_even(shells.sheets[sheet])) {
            out.text('\n', field(""), field(""), field(""), has_middles ? "" : field(""));
            for (const double thickness : shells.thickness[t]) {
                out.text(real_field(thickness, 8));
            }
        }
        out.text('\n');
    }
    for (std::size_t sheet = 0; sheet < shells.sheets.size(); ++sheet) {
        out.text(field("PSHELL"), field(sheet + 1), field("1"), real_field(shells.sheets[sheet].mean, 8), field("1"),
                 field(""), field("1"), '\n');
    }
    out.text("ENDDATA\n");
}

/// In the text form, a physical group for each sheet.
void write_msh_shells(OutputFile& out, const ShellMesh& shells, bool has_middles) {
    const ShellNodes nodes = shell_nodes(shells, has_middles);
    const std::size_t sheets = shells.sheets.size();
    Box box;
    std::ranges::for_each(nodes.places, [&](const Point& p) { box.extend(p); });
    out.text("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n", sheets, '\n');
    for (std::size_t sheet = 1; sheet <= sheets; ++sheet) {
        out.text("2 ", sheet, " \"sheet", sheet, "\"\n");
    }
    out.text("$EndPhysicalNames\n$Entities\n0 0 ", sheets, " 0\n");
    for (std::size_t sheet = 1; sheet <= sheets; ++sheet) {
        out.text(sheet, ' ', box.min.x, ' ', box.min.y, ' ', box.min.z, ' ', box.max.x, ' ', box.max.y, ' ', box.max.z,
                 " 1 ", sheet, " 0\n");
    }
    const std::size_t count = nodes.places.size();
    out.text("$EndEntities\n$Nodes\n1 ", count, " 1 ", count, "\n2 1 0 ", count, '\n');
    for (std::size_t v = 1; v <= count; ++v) {
        out.text(v, '\n');
    }
    for (const Point& p : nodes.places) {
        out.text(p.x, ' ', p.y, ' ', p.z, '\n');
    }
    const std::size_t triangles = shells.mesh.triangles.size();
    std::vector<std::size_t> counts(sheets);
    std::ranges::for_each(shells.triangle_sheets, [&](Index sheet) { ++counts[static_cast<std::size_t>(sheet)]; });
    constexpr int kTriangle = 2;
    constexpr int kQuadraticTriangle = 9;
    out.text("$EndNodes\n$Elements\n", sheets, ' ', triangles, " 1 ", triangles, '\n');
    for (std::size_t sheet = 0; sheet < sheets; ++sheet) {
        out.text("2 ", sheet + 1, ' ', has_middles ? kQuadraticTriangle : kTriangle, ' ', counts[sheet], '\n');
        for_each_of_sheet(shells, sheet, [&](std::size_t t) {
            out.text(t + 1);
            for (const Index v : nodes.triangles[t]) {
                out.text(' ', v + 1);
            }
            out.text('\n');
        });
    }
    out.text("$EndElements\n");
    const auto values = [&](std::string_view kind, std::size_t number, const auto& value) {
        out.text('$', kind, "\n1\n\"thickness\"\n1\n0\n3\n0\n1\n", number, '\n');
        for (std::size_t i = 0; i < number; ++i) {
            out.text(i + 1, ' ', value(i), '\n');
        }
        out.text("$End", kind, '\n');
    };
    values("NodeData", count, [&](std::size_t v) { return nodes.thickness[v]; });
    values("ElementData", triangles, [&](std::size_t t) { return mean_thickness(shells, t); });
}

}  // namespace scaleaxis::io
