// SPDX-License-Identifier: Apache-2.0
// A model as compressed bytes. docs/dev/viewer.md describes them; viewer/src/data.ts reads them.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "base/bytes.hpp"
#include "base/formats/json.hpp"
#include "base/parallel.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/cleaning.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/view.hpp"
#include "view/sheet_colors.hpp"

namespace scaleaxis::inline v1 {
namespace {

constexpr std::string_view kMagic = "SAXV";
constexpr std::uint32_t kVersion = 4;
constexpr double kCoarse = 0xFFFF;  // steps of numbers that are quantised: of meshes, angles and thicknesses
constexpr double kFine = 0xFFFFF;   // of balls

/// The arrays of a model, one behind the other. Each lies there byte plane by byte plane (first the lowest byte of all
/// numbers, last the highest): neighbours in a plane are alike, which halves what the compressor leaves.
class Arrays {
   public:
    /// Adds numbers. \returns what the header says of them
    template <class Number>
    Json add(const std::vector<Number>& numbers, std::string_view type) {
        const std::size_t start = bytes_.size();
        bytes_.resize(start + sizeof(Number) * numbers.size());
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const auto number = to_bytes(numbers[i], std::endian::little);
            for (std::size_t plane = 0; plane < sizeof(Number); ++plane) {
                bytes_[start + plane * numbers.size() + i] = number[plane];
            }
        }
        return {{"type", type}, {"offset", start}, {"count", numbers.size()}};
    }

    /// Adds integers that are not negative as differences from the one before, in the smallest type that holds all of
    /// them, and modulo its size.
    Json add_integers(const std::vector<std::uint32_t>& numbers) {
        const std::uint32_t largest = numbers.empty() ? 0 : *std::ranges::max_element(numbers);
        if (largest <= std::numeric_limits<std::uint8_t>::max()) {
            return add(differences<std::uint8_t>(numbers), "u8");
        }
        if (largest <= std::numeric_limits<std::uint16_t>::max()) {
            return add(differences<std::uint16_t>(numbers), "u16");
        }
        return add(differences<std::uint32_t>(numbers), "u32");
    }

    const std::string& bytes() const { return bytes_; }

   private:
    /// Differences d as 2d, or -2d - 1 where they are negative: small ones have few digits, whatever their sign.
    template <class Number>
    static std::vector<Number> differences(const std::vector<std::uint32_t>& numbers) {
        using Signed = std::make_signed_t<Number>;
        std::vector<Number> result(numbers.size());
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            const auto difference = static_cast<Number>(numbers[i] - (i == 0 ? 0 : numbers[i - 1]));
            const bool is_negative = static_cast<Signed>(difference) < 0;
            result[i] = static_cast<Number>(is_negative ? ~(2U * difference) : 2U * difference);
        }
        return result;
    }

    std::string bytes_;
};

Box bounds_of(const ViewedModel& model) {
    Box box;
    for (const Point& p : model.shape.vertices) {
        box.extend(p);
    }
    for (const ViewedAxis& axis : model.axes) {
        box.extend(box_of_balls(axis.complex));
        for (const Point& p : axis.surface.vertices) {
            box.extend(p);
        }
    }
    return box;
}

/// `value` in steps of `whole`.
std::uint32_t quantized(double value, double whole, double steps) {
    return whole > 0.0 ? static_cast<std::uint32_t>(std::lround(std::clamp(value / whole, 0.0, 1.0) * steps)) : 0;
}

/// The coordinates of points in the box, in steps of its sides.
Json add_points(Arrays& arrays, const std::vector<Point>& points, const Box& box, double steps) {
    const Point size = box.max - box.min;
    std::array<std::vector<std::uint32_t>, 3> coordinates;
    for (const Point& p : points) {
        coordinates[0].push_back(quantized(p.x - box.min.x, size.x, steps));
        coordinates[1].push_back(quantized(p.y - box.min.y, size.y, steps));
        coordinates[2].push_back(quantized(p.z - box.min.z, size.z, steps));
    }
    return Json::array({arrays.add_integers(coordinates[0]), arrays.add_integers(coordinates[1]),
                        arrays.add_integers(coordinates[2])});
}

Json add_mesh(Arrays& arrays, const TriangleMesh& mesh, const Box& box) {
    if (mesh.triangles.empty()) {
        return nullptr;
    }
    std::vector<std::uint32_t> corners;
    for (const auto& triangle : mesh.triangles) {
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    return {{"points", add_points(arrays, mesh.vertices, box, kCoarse)}, {"corners", arrays.add_integers(corners)}};
}

/// The curves that the page draws: edges without a face, and of a filtration those that outlive their faces.
struct Curves {
    std::vector<std::array<Index, 2>> edges;
    std::vector<double> scales;  ///< at which they vanish, of a filtration
};

Curves curves_of(const ViewedAxis& axis) {
    const MedialComplex& complex = axis.complex;
    if (!axis.scales) {
        return {curve_edges(complex), {}};
    }
    std::vector<double> face_scales(complex.edges.size(), 0.0);  // of each edge the last of its faces
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        for (const Index e : complex.face_edges[f]) {
            face_scales[e] = std::max(face_scales[e], axis.scales->faces[f]);
        }
    }
    Curves curves;
    for (std::size_t e = 0; e < complex.edges.size(); ++e) {
        if (axis.scales->edges[e] > face_scales[e]) {
            curves.edges.push_back(complex.edges[e]);
            curves.scales.push_back(axis.scales->edges[e]);
        }
    }
    return curves;
}

/// The erosion thickness (see `clean`) at the vertices of each sheet in ascending order, one sheet after the other, and
/// then at those of curves and those without a face: where sheets and curves meet, each has its own.
std::vector<double> thicknesses(const ViewedAxis& axis, const Curves& curves) {
    const MedialComplex complex = grown(axis.complex);
    const ErosionThickness fire = erosion_thickness(complex);
    struct Value {
        Index sheet;
        Index vertex;
        double thickness;
    };
    std::vector<Value> values;
    std::vector<bool> is_on_curve(complex.vertices.size(), true);
    for (std::size_t f = 0, corner = 0; f < complex.faces.size(); ++f) {
        for (const Index v : complex.faces[f]) {
            is_on_curve[v] = false;
            values.push_back({complex.face_sheets[f], v, fire.corner_burn_times[corner++] - complex.radii[v]});
        }
    }
    for (const auto& [a, b] : curves.edges) {
        is_on_curve[a] = is_on_curve[b] = true;
    }
    for (Index v = 0; v < std::ssize(complex.vertices); ++v) {
        if (is_on_curve[v]) {
            values.push_back({complex.sheets, v, fire.thickness[v]});
        }
    }
    // Where a sheet comes by a vertex several times, the latest fire counts.
    std::ranges::sort(values, [](const Value& a, const Value& b) {
        return std::tuple(a.sheet, a.vertex, -a.thickness) < std::tuple(b.sheet, b.vertex, -b.thickness);
    });
    const auto repeated = std::unique(values.begin(), values.end(), [](const Value& a, const Value& b) {
        return a.sheet == b.sheet && a.vertex == b.vertex;
    });
    values.erase(repeated, values.end());
    return each_of<double>(values, &Value::thickness);
}

/// Lengths in steps of the largest finite one; the last step stands for infinity.
void add_thicknesses(Arrays& arrays, const std::vector<double>& thicknesses, Json& entry) {
    double largest = 0.0;
    for (const double thickness : thicknesses) {
        largest = std::isfinite(thickness) ? std::max(largest, thickness) : largest;
    }
    const auto steps = each_of<std::uint32_t>(thicknesses, [&](double thickness) {
        return std::isfinite(thickness) ? quantized(thickness, largest, kCoarse - 1.0)
                                        : static_cast<std::uint32_t>(kCoarse);
    });
    entry["largest_thickness"] = largest;
    entry["thicknesses"] = arrays.add_integers(steps);
}

Json add_axis(Arrays& arrays, const MedialComplex& complex, const Curves& curve_edges, const Box& box) {
    const auto radii =
        each_of<std::uint32_t>(complex.radii, [&](double radius) { return quantized(radius, box.diagonal(), kFine); });
    std::vector<std::uint32_t> sizes;
    std::vector<std::uint32_t> angles;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        sizes.push_back(static_cast<std::uint32_t>(complex.faces[f].size()));
        angles.push_back(quantized(complex.face_angles[f], 90.0, kCoarse));
    }
    std::vector<std::uint32_t> curves;
    for (const auto& edge : curve_edges.edges) {
        curves.insert(curves.end(), edge.begin(), edge.end());
    }
    return {{"points", add_points(arrays, complex.vertices, box, kFine)},
            {"radii", arrays.add_integers(radii)},
            {"sizes", arrays.add_integers(sizes)},
            {"corners", arrays.add_integers({complex.faces.items.begin(), complex.faces.items.end()})},
            {"sheets", arrays.add_integers({complex.face_sheets.begin(), complex.face_sheets.end()})},
            {"angles", arrays.add_integers(angles)},
            {"curves", arrays.add_integers(curves)}};
}

Json add_scales(Arrays& arrays, const std::optional<ViewedScales>& scales, const Curves& curves) {
    if (!scales) {
        return nullptr;
    }
    const Json levels = each_of<Json>(scales->levels, [&](const FiltrationLevel& level) {
        return Json::array({level.scale, level.sheets, level.balls, level.area, level.curve_length, level.volume});
    });
    const ScalePlateau& plateau = scales->plateau;
    return {{"vertices", arrays.add(scales->vertices, "f64")},
            {"faces", arrays.add(scales->faces, "f64")},
            {"curves", arrays.add(curves.scales, "f64")},
            {"levels", levels},
            {"plateau", {plateau.begin, plateau.middle, plateau.end}}};
}

void check_scales(const ViewedAxis& axis) {
    if (!axis.scales) {
        return;
    }
    const ViewedScales& scales = *axis.scales;
    if (scales.vertices.size() != axis.complex.vertices.size() || scales.edges.size() != axis.complex.edges.size() ||
        scales.faces.size() != axis.complex.faces.size() || scales.levels.empty()) {
        throw UnusableInput(Diagnostic{"view.scales",
                                       "the page of a filtration needs a scale of each vertex, edge and "
                                       "face, and at least one level"});
    }
}

/// Values of the vertices of the shape, in steps of the largest.
Json add_thickness(Arrays& arrays, const ViewedModel& model) {
    if (!model.thickness) {
        return nullptr;
    }
    const ViewedThickness& thickness = *model.thickness;
    const std::size_t count = model.shape.vertices.size();
    if (thickness.local.size() != count || thickness.foot.size() != count ||
        (!thickness.regions.empty() && thickness.regions.size() != count)) {
        throw UnusableInput(Diagnostic{"view.thickness", "the page needs the thickness of each vertex of the shape"});
    }
    double largest = 0.0;
    for (const std::vector<double>* values : {&thickness.local, &thickness.foot}) {
        for (const double value : *values) {
            largest = std::max(largest, value);
        }
    }
    const auto steps = [&](const std::vector<double>& values) {
        const auto result = each_of<std::uint32_t>(values, [&](double x) { return quantized(x, largest, kCoarse); });
        return arrays.add_integers(result);
    };
    const auto regions = each_of<std::uint32_t>(
        thickness.regions, [](Index region) { return static_cast<std::uint32_t>(region == kNone ? 0 : region + 1); });
    return {{"largest", largest},
            {"local", steps(thickness.local)},
            {"foot", steps(thickness.foot)},
            {"regions", regions.empty() ? Json(nullptr) : arrays.add_integers(regions)},
            {"limit", thickness.limit ? Json(*thickness.limit) : Json(nullptr)}};
}

Json statistics_of(const std::string& text) { return text.empty() ? Json(nullptr) : Json::parse(text); }

std::string compressed(const std::string& bytes) {
    const auto count = static_cast<uLong>(bytes.size());  // of 32 bits on Windows
    uLongf size = compressBound(count);
    std::string result(size, '\0');
    if (count != bytes.size() ||
        compress2(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()), count,
                  Z_DEFAULT_COMPRESSION) != Z_OK) {
        throw std::bad_alloc();
    }
    result.resize(size);
    return result;
}

std::string data_of(const ViewedModel& model) {
    Box box = bounds_of(model);
    if (box.is_empty()) {
        box = {{0, 0, 0}, {0, 0, 0}};
    }
    if (!(box.diagonal() < std::numeric_limits<float>::max())) {
        throw FileError(model.name + ": the coordinates are too large for a page, which has single precision");
    }
    std::vector<const ViewedAxis*> axes;
    for (const ViewedAxis& axis : model.axes) {
        check(axis.complex);
        check_scales(axis);
        axes.push_back(&axis);
    }
    std::ranges::stable_sort(axes, {}, [](const ViewedAxis* axis) { return axis->complex.scale; });
    const auto complexes = each_of<const MedialComplex*>(axes, [](const ViewedAxis* axis) { return &axis->complex; });
    const std::vector<std::vector<Index>> colors = view::sheet_colors(complexes);
    Arrays arrays;
    Json header{{"name", model.name},
                {"min", {box.min.x, box.min.y, box.min.z}},
                {"max", {box.max.x, box.max.y, box.max.z}},
                {"statistics", statistics_of(model.statistics)},
                {"shape", add_mesh(arrays, model.shape, box)},
                {"thickness", add_thickness(arrays, model)},
                {"axes", Json::array()}};
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const ViewedAxis& axis = *axes[i];
        const Curves curves = curves_of(axis);
        Json entry = add_axis(arrays, axis.complex, curves, box);
        entry["colors"] = arrays.add_integers({colors[i].begin(), colors[i].end()});
        add_thicknesses(arrays, thicknesses(axis, curves), entry);
        entry["scales"] = add_scales(arrays, axis.scales, curves);
        entry["scale"] = axis.complex.scale;
        entry["surface"] = add_mesh(arrays, axis.surface, box);
        entry["statistics"] = statistics_of(axis.statistics);
        header["axes"].push_back(std::move(entry));
    }
    const std::string text = header.dump();
    std::string bytes(kMagic);
    for (const std::uint32_t number : {kVersion, static_cast<std::uint32_t>(text.size())}) {
        const auto word = to_bytes(number, std::endian::little);
        bytes.append(word.begin(), word.end());
    }
    return compressed(bytes + text + arrays.bytes());
}

}  // namespace

ViewedAxis viewed(Filtration filtration, std::vector<FiltrationLevel> levels) {
    const ScalePlateau plateau = longest_plateau(levels);
    return {std::move(filtration.complex),
            {},
            {},
            ViewedScales{std::move(filtration.vertex_scales), std::move(filtration.edge_scales),
                         std::move(filtration.face_scales), std::move(levels), plateau}};
}

std::string view_data(const ViewedModel& model, const Execution& execution) {
    return in_arena(execution, [&] { return data_of(model); });
}

}  // namespace scaleaxis::inline v1
