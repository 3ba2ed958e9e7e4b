// SPDX-License-Identifier: Apache-2.0
// glTF 2.0 in its binary form (Khronos Group, "glTF 2.0 Specification"). Everything in it has four bytes.
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "axis/complex.hpp"
#include "base/faults.hpp"
#include "base/formats/json.hpp"
#include "base/vectors.hpp"
#include "io/colors.hpp"
#include "io/formats.hpp"

namespace scaleaxis::io {
namespace {

// Numbers that the specification gives to names.
constexpr std::uint32_t kMagic = 0x46546C67;  // "glTF"
constexpr std::uint32_t kVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr int kFloatComponent = 5126;
constexpr int kUnsignedIntComponent = 5125;
constexpr int kVertexData = 34962;
constexpr int kIndexData = 34963;
constexpr int kPoints = 0;
constexpr int kLines = 1;
constexpr int kTriangles = 4;

// Each primitive is a call to draw: of very many sheets, those so far apart share one.
constexpr std::size_t kMostColors = 256;
constexpr std::array kCurveColor{0.02, 0.02, 0.025};  // nearly black

/// The numbers of the binary chunk and what the JSON says of them: a view and an accessor for each array.
struct Arrays {
    std::vector<std::uint32_t> words;
    Json views = Json::array();
    Json accessors = Json::array();

    /// \returns the number of the new accessor
    template <class Number>
    std::size_t add(const std::vector<Number>& numbers, std::string_view type, std::size_t components) {
        constexpr bool is_float = std::is_same_v<Number, float>;
        views.push_back({{"buffer", 0},
                         {"byteOffset", 4 * words.size()},
                         {"byteLength", 4 * numbers.size()},
                         {"target", is_float ? kVertexData : kIndexData}});
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", is_float ? kFloatComponent : kUnsignedIntComponent},
                             {"count", numbers.size() / components},
                             {"type", type}});
        for (const Number number : numbers) {
            words.push_back(std::bit_cast<std::uint32_t>(number));
        }
        return accessors.size() - 1;
    }
};

/// The triangles of each colour: polygons become fans.
std::vector<std::vector<Index>> triangles_by_color(const MedialComplex& complex) {
    const IndexLists sheets = faces_of_sheets(complex);
    std::vector<std::vector<Index>> result(std::min(sheets.size(), kMostColors));
    for (std::size_t s = 0; s < sheets.size(); ++s) {
        std::vector<Index>& corners = result[s % kMostColors];
        for (const Index f : sheets[s]) {
            const std::span<const Index> face = complex.faces[f];
            for (std::size_t k = 1; k + 1 < face.size(); ++k) {
                corners.insert(corners.end(), {face[0], face[k], face[k + 1]});
            }
        }
    }
    return result;
}

Json material(const std::string& name, const std::array<double, 3>& color) {
    return {{"name", name},
            {"doubleSided", true},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {color[0], color[1], color[2], 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", 0.8}}}};
}

std::vector<Index> curve_ends(const MedialComplex& complex) {
    std::vector<Index> ends;
    for (const auto& [a, b] : curve_edges(complex)) {
        ends.insert(ends.end(), {a, b});
    }
    return ends;
}

struct Positions {
    std::size_t accessor = 0;
    Point middle;  ///< what they are relative to: single precision goes further near the origin
};

/// \param vertices at least one
Positions add_positions(std::span<const Point> vertices, Arrays& arrays) {
    Box box;
    for (const Point& p : vertices) {
        box.extend(p);
    }
    const Point middle = midpoint(box.min, box.max);
    std::vector<float> positions;
    std::array<float, 3> low;
    std::array<float, 3> high;
    low.fill(std::numeric_limits<float>::max());
    high.fill(std::numeric_limits<float>::lowest());
    for (const Point& vertex : vertices) {
        const Point p = vertex - middle;
        const std::array<float, 3> q{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
        if (!std::ranges::all_of(q, [](float x) { return std::isfinite(x); })) {
            throw unsupported("the coordinates are too large for GLB, which has single precision; write .ply");
        }
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], q[k]);
            high[k] = std::max(high[k], q[k]);
        }
        positions.insert(positions.end(), q.begin(), q.end());
    }
    const std::size_t position = arrays.add(positions, "VEC3", 3);
    Json& accessor = arrays.accessors.elements()[position];
    accessor["min"] = low;
    accessor["max"] = high;
    return {position, middle};
}

/// The JSON of a file with one node of this name. \param primitives and \param materials of its mesh; of none there is
/// no mesh, which would not be valid
Json document(const std::string& name, const Point& middle, const Json& primitives, const Json& materials,
              const Arrays& arrays) {
    Json node{{"name", name}};
    Json result{{"asset", {{"version", "2.0"}, {"generator", "scaleaxis"}}}, {"scene", 0}};
    result["scenes"] = Json::array({{{"nodes", Json::array({0})}}});
    if (primitives.size() == 0) {
        result["nodes"] = Json::array({node});
        return result;
    }
    node["mesh"] = 0;
    node["translation"] = {middle.x, middle.y, middle.z};
    result["nodes"] = Json::array({node});
    result["meshes"] = Json::array({{{"name", name}, {"primitives", primitives}}});
    result["materials"] = materials;
    result["accessors"] = arrays.accessors;
    result["bufferViews"] = arrays.views;
    result["buffers"] = Json::array({{{"byteLength", 4 * arrays.words.size()}}});
    return result;
}

/// The two chunks of a file.
void write_chunks(OutputFile& out, const Json& document, const Arrays& arrays) {
    std::string json = document.dump();
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::size_t numbers = 4 * arrays.words.size();
    const std::size_t length = 12 + 8 + json.size() + (numbers > 0 ? 8 + numbers : 0);
    if (length > std::numeric_limits<std::uint32_t>::max()) {
        throw unsupported("it is too large for GLB, which ends at 4 GiB; write .ply");
    }
    const auto word = [](std::size_t number) { return static_cast<std::uint32_t>(number); };
    out.binary(kMagic, kVersion, word(length), word(json.size()), kJsonChunk);
    out.text(json);
    if (numbers > 0) {
        out.binary(word(numbers), kBinaryChunk);
        for (const std::uint32_t number : arrays.words) {
            out.binary(number);
        }
    }
}

}  // namespace

/// Faces become triangles, curves lines, isolated balls points; all share the vertices, which have the radius as the
/// attribute `_RADIUS`. Each sheet is a primitive with a material of its own.
void write_glb_axis(OutputFile& out, const MedialComplex& complex, const AxisFileOptions&) {
    Arrays arrays;
    Json primitives = Json::array();
    Json materials = Json::array();
    Positions positions;
    if (!complex.vertices.empty()) {
        positions = add_positions(complex.vertices, arrays);
        const std::size_t radius =
            arrays.add(std::vector<float>(complex.radii.begin(), complex.radii.end()), "SCALAR", 1);
        const auto add_primitive = [&](const std::vector<Index>& indices, int mode, const std::string& name,
                                       const std::array<double, 3>& color) {
            if (!indices.empty()) {
                primitives.push_back({{"attributes", {{"POSITION", positions.accessor}, {"_RADIUS", radius}}},
                                      {"indices", arrays.add(indices, "SCALAR", 1)},
                                      {"material", materials.size()},
                                      {"mode", mode}});
                materials.push_back(material(name, color));
            }
        };
        const std::vector<std::vector<Index>> triangles = triangles_by_color(complex);
        for (std::size_t c = 0; c < triangles.size(); ++c) {
            add_primitive(triangles[c], kTriangles, "sheet " + std::to_string(c), sheet_color(static_cast<Index>(c)));
        }
        add_primitive(curve_ends(complex), kLines, "curves", kCurveColor);
        add_primitive(isolated_vertices(complex), kPoints, "isolated balls", kCurveColor);
    }
    write_chunks(out, document("medial axis", positions.middle, primitives, materials, arrays), arrays);
}

/// One primitive whose vertices have their values as attributes, `_NAME`, and colours.
void write_glb_surface(OutputFile& out, const TriangleMesh& mesh, std::span<const VertexValues> values) {
    Arrays arrays;
    const auto [position, middle] = add_positions(mesh.vertices, arrays);
    Json attributes{{"POSITION", position}};
    std::vector<float> colors;
    for (const std::array<double, 3>& color : value_colors(values.front().values)) {
        for (const double c : color) {
            colors.push_back(static_cast<float>(std::clamp(c, 0.0, 1.0)));
        }
    }
    attributes["COLOR_0"] = arrays.add(colors, "VEC3", 3);
    for (const VertexValues& attribute : values) {
        std::string name = "_";
        std::ranges::transform(attribute.name, std::back_inserter(name),
                               [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        const auto numbers = each_of<float>(
            attribute.values, [&](double value) { return static_cast<float>(finite_or_minus_one(value)); });
        attributes[name] = arrays.add(numbers, "SCALAR", 1);
    }
    std::vector<Index> corners;
    for (const std::array<Index, 3>& triangle : mesh.triangles) {
        corners.insert(corners.end(), triangle.begin(), triangle.end());
    }
    const std::size_t indices = arrays.add(corners, "SCALAR", 1);
    const Json primitive{{"attributes", attributes}, {"indices", indices}, {"material", 0}, {"mode", kTriangles}};
    const Json materials = Json::array({material("surface", {1.0, 1.0, 1.0})});
    write_chunks(out, document("surface", middle, Json::array({primitive}), materials, arrays), arrays);
}

}  // namespace scaleaxis::io
