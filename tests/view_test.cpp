// SPDX-License-Identifier: Apache-2.0
// The interactive page as the library writes it. viewer/test reads the same bytes with the page's own code, and looks
// at pages in a browser.
#include "scaleaxis/view.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "axis/complex.hpp"
#include "complexes.hpp"
#include "folder.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis {
namespace {

using test::complex_by_hand;
using Json = nlohmann::json;

std::uint32_t word(const std::string& bytes, std::size_t at, std::size_t width = 4) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < width; ++k) {
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + k])) << (8 * k);
    }
    return value;
}

/// A model decompressed and taken apart, by the description in docs/dev/viewer.md.
struct Decoded {
    std::string bytes;
    Json header;
    std::string arrays;

    explicit Decoded(const std::string& compressed) {
        std::string buffer(64 << 20, '\0');
        auto size = static_cast<uLongf>(buffer.size());
        EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(buffer.data()), &size,
                             reinterpret_cast<const Bytef*>(compressed.data()), static_cast<uLong>(compressed.size())),
                  Z_OK);
        bytes = buffer.substr(0, size);
        EXPECT_EQ(bytes.substr(0, 4), "SAXV");
        EXPECT_EQ(word(bytes, 4), 4U);
        const std::uint32_t length = word(bytes, 8);
        header = Json::parse(bytes.substr(12, length));
        arrays = bytes.substr(12 + length);
    }

    std::vector<std::uint32_t> integers(const Json& entry) const {
        const std::string type = entry["type"];
        const std::size_t width = type == "u8" ? 1 : type == "u16" ? 2 : 4;
        const std::size_t count = entry["count"];
        const std::size_t offset = entry["offset"];
        const std::uint32_t mask = width == 4 ? 0xFFFFFFFFU : (1U << (8 * width)) - 1;
        std::vector<std::uint32_t> result(count);
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < count; ++i) {
            std::string number;
            for (std::size_t plane = 0; plane < width; ++plane) {
                number += arrays.at(offset + plane * count + i);
            }
            const std::uint32_t step = word(number, 0, width);
            value = (value + ((step & 1) != 0 ? ~(step >> 1) : step >> 1)) & mask;
            result[i] = value;
        }
        return result;
    }

    std::vector<double> doubles(const Json& entry) const {
        EXPECT_EQ(entry["type"], "f64");
        const std::size_t count = entry["count"];
        std::vector<double> result(count);
        for (std::size_t i = 0; i < count; ++i) {
            std::uint64_t bits = 0;
            for (std::size_t plane = 8; plane-- > 0;) {
                bits = bits << 8 |
                       static_cast<unsigned char>(arrays.at(entry["offset"].get<std::size_t>() + plane * count + i));
            }
            result[i] = std::bit_cast<double>(bits);
        }
        return result;
    }

    std::vector<double> coordinates(const Json& entry, int k, double steps) const {
        const double low = header["min"][k];
        const double high = header["max"][k];
        std::vector<double> result;
        for (const std::uint32_t step : integers(entry[k])) {
            result.push_back(low + step / steps * (high - low));
        }
        return result;
    }
};

constexpr double kCoarse = 0xFFFF;
constexpr double kFine = 0xFFFFF;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A pentagon, a triangle on one of its sides, and a curve.
MedialComplex small_complex() {
    MedialComplex complex;
    complex.vertices = {{1000, 2, 3},  {1001, 2, 3},   {1001.5, 3, 3}, {1000.5, 4, 3},
                        {999.5, 3, 3}, {1000.5, 1, 4}, {1002, 5, 6}};
    complex.radii = {0.5, 0.25, 0.125, 1, 0.75, 0, 0.3};
    complex.vertex_origins.resize(7);
    complex.faces.push_back(std::vector<Index>{0, 1, 2, 3, 4});
    complex.faces.push_back(std::vector<Index>{1, 0, 5});
    complex.face_angles = {89.5, 12.25};
    complex.face_sheets = {0, 1};
    complex.sheets = 2;
    build_edges(complex, std::vector<std::array<Index, 2>>{{3, 6}});
    return complex;
}

TriangleMesh tetrahedron() {
    return {{{990, 0, 0}, {1010, 0, 0}, {1000, 10, 0}, {1000, 5, 10}}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

ViewedModel small_model() {
    ViewedModel model;
    model.name = "small \"model\" \xC3\xA4";
    model.shape = tetrahedron();
    model.axes.push_back({test::with_scale(small_complex(), 1.25), {}, R"({"scale": 1.25})"});
    model.axes.push_back({test::with_scale({}, 2.0), tetrahedron(), ""});
    model.statistics = R"({"samples": 7})";
    return model;
}

TEST(ViewData, HoldsTheModel) {
    const ViewedModel model = small_model();
    const Decoded decoded(view_data(model));
    EXPECT_EQ(decoded.header["name"], model.name);
    EXPECT_EQ(decoded.header["statistics"]["samples"], 7);
    EXPECT_EQ(decoded.header["min"], Json({990.0, 0.0, 0.0}));
    EXPECT_EQ(decoded.header["max"], Json({1010.0, 10.0, 10.0}));
    ASSERT_EQ(decoded.header["axes"].size(), 2U);

    const Json& axis = decoded.header["axes"][0];
    const MedialComplex& complex = model.axes[0].complex;
    EXPECT_EQ(axis["scale"], 1.25);
    EXPECT_EQ(axis["statistics"]["scale"], 1.25);
    EXPECT_TRUE(axis["surface"].is_null());
    const std::vector<std::uint32_t> radii = decoded.integers(axis["radii"]);
    ASSERT_EQ(radii.size(), complex.radii.size());
    const double diagonal = std::sqrt(20 * 20 + 10 * 10 + 10 * 10);
    for (int k = 0; k < 3; ++k) {
        const std::vector<double> x = decoded.coordinates(axis["points"], k, kFine);
        ASSERT_EQ(x.size(), complex.vertices.size());
        for (std::size_t v = 0; v < x.size(); ++v) {
            const Point& p = complex.vertices[v];
            EXPECT_NEAR(x[v], k == 0 ? p.x : k == 1 ? p.y : p.z, 0.51 * 20 / kFine);
            EXPECT_NEAR(radii[v] / kFine * diagonal, complex.radii[v], 0.51 * diagonal / kFine);
        }
    }
    using Numbers = std::vector<std::uint32_t>;
    EXPECT_EQ(decoded.integers(axis["sizes"]), (Numbers{5, 3}));
    EXPECT_EQ(decoded.integers(axis["corners"]), (Numbers{0, 1, 2, 3, 4, 1, 0, 5}));
    EXPECT_EQ(decoded.integers(axis["sheets"]), (Numbers{0, 1}));
    EXPECT_EQ(decoded.integers(axis["curves"]), (Numbers{3, 6}));
    const Numbers angles = decoded.integers(axis["angles"]);
    EXPECT_NEAR(angles[0] * 90 / kCoarse, 89.5, 0.001);
    EXPECT_NEAR(angles[1] * 90 / kCoarse, 12.25, 0.001);

    EXPECT_TRUE(decoded.header["axes"][1]["statistics"].is_null());
    for (const Json* mesh : {&decoded.header["shape"], &decoded.header["axes"][1]["surface"]}) {
        EXPECT_EQ(decoded.integers((*mesh)["corners"]), (Numbers{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2}));
        const std::vector<double> x = decoded.coordinates((*mesh)["points"], 0, kCoarse);
        for (std::size_t v = 0; v < 4; ++v) {
            EXPECT_NEAR(x[v], tetrahedron().vertices[v].x, 0.51 * 20 / kCoarse);
        }
    }
}

/// The erosion thicknesses of an axis, and the largest that is finite.
struct Thicknesses {
    std::vector<double> values;
    double largest;
};

Thicknesses thicknesses_of(const Json& axis, const Decoded& decoded) {
    Thicknesses result{{}, axis["largest_thickness"]};
    for (const std::uint32_t step : decoded.integers(axis["thicknesses"])) {
        result.values.push_back(step == 0xFFFF ? kInfinity : step / (kCoarse - 1) * result.largest);
    }
    return result;
}

TEST(ViewData, HoldsTheScalesOfAFiltration) {
    // Two triangles on a common side, one of whose sides outlives it, and a curve.
    ViewedModel model;
    model.axes.push_back(
        {complex_by_hand({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 2, 0}}, {{0, 1, 2}, {1, 3, 2}}, {}, {{3, 4}}),
         {},
         ""});
    const MedialComplex& complex = model.axes[0].complex;
    ASSERT_EQ(complex.edges, (std::vector<std::array<Index, 2>>{{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}, {3, 4}}));
    ViewedScales scales{{1.5, 3, kInfinity, 2.75, 1.25},
                        {1.5, 1.5, kInfinity, 2.5, 2.75, 1.25},
                        {1.5, 1.0 / 0.4},
                        {{1.0, 1, 5, 1.0, 1.5, 4.0}, {2.0, 1, 3, 0.5, 0.0, 3.5}},
                        {1.0, 1.4, 1.1875}};
    model.axes[0].scales = scales;
    const Decoded decoded(view_data(model));
    const Json& axis = decoded.header["axes"][0];
    EXPECT_EQ(decoded.doubles(axis["scales"]["vertices"]), scales.vertices);
    EXPECT_EQ(decoded.doubles(axis["scales"]["faces"]), scales.faces);
    EXPECT_EQ(decoded.integers(axis["curves"]), (std::vector<std::uint32_t>{1, 2, 2, 3, 3, 4}));
    EXPECT_EQ(decoded.doubles(axis["scales"]["curves"]), (std::vector<double>{kInfinity, 2.75, 1.25}));
    EXPECT_EQ(axis["scales"]["levels"], Json({{1.0, 1, 5, 1.0, 1.5, 4.0}, {2.0, 1, 3, 0.5, 0.0, 3.5}}));
    EXPECT_EQ(axis["scales"]["plateau"], Json({1.0, 1.1875, 1.4}));
    EXPECT_EQ(thicknesses_of(axis, decoded).values.size(), 4U + 4U);  // of the sheet, and of curves
    for (std::vector<double> ViewedScales::*wrong :
         {&ViewedScales::vertices, &ViewedScales::edges, &ViewedScales::faces}) {
        model.axes[0].scales = scales;
        ((*model.axes[0].scales).*wrong).pop_back();
        EXPECT_THROW(view_data(model), UnusableInput);
    }
    model.axes[0].scales = scales;
    model.axes[0].scales->levels.clear();
    EXPECT_THROW(view_data(model), UnusableInput);
}

TEST(ViewData, HoldsTheThicknessOfTheShape) {
    ViewedModel model = small_model();
    EXPECT_TRUE(Decoded(view_data(model)).header["thickness"].is_null());
    model.thickness = ViewedThickness{{1, 2, 3, 4}, {0, 5, 2.5, 1}, {kNone, 0, 2, kNone}, 2.25};
    const Decoded decoded(view_data(model));
    const Json& thickness = decoded.header["thickness"];
    EXPECT_EQ(thickness["largest"], 5.0);
    EXPECT_EQ(thickness["limit"], 2.25);
    EXPECT_EQ(decoded.integers(thickness["local"]), (std::vector<std::uint32_t>{13107, 26214, 39321, 52428}));
    EXPECT_EQ(decoded.integers(thickness["foot"]), (std::vector<std::uint32_t>{0, 65535, 32768, 13107}));
    EXPECT_EQ(decoded.integers(thickness["regions"]), (std::vector<std::uint32_t>{0, 1, 3, 0}));
    model.thickness->regions = {0};
    EXPECT_THROW(view_data(model), UnusableInput);
    model.thickness->regions.clear();
    EXPECT_TRUE(Decoded(view_data(model)).header["thickness"]["regions"].is_null());
    model.thickness->foot.pop_back();
    EXPECT_THROW(view_data(model), UnusableInput);
}

TEST(ViewData, TakesWhatIsEmptyOrFlat) {
    EXPECT_TRUE(Decoded(view_data({})).header["axes"].empty());
    ViewedModel flat;
    flat.axes.resize(1);
    flat.axes[0].complex.vertices = {{3, 4, 5}};
    flat.axes[0].complex.radii = {0};
    flat.axes[0].complex.vertex_origins.resize(1);
    const Decoded decoded(view_data(flat));
    EXPECT_EQ(decoded.header["min"], Json({3.0, 4.0, 5.0}));
    EXPECT_EQ(decoded.integers(decoded.header["axes"][0]["points"][0]), std::vector<std::uint32_t>{0});
}

TEST(ViewData, RefusesWhatSinglePrecisionCannotHold) {
    ViewedModel model = small_model();
    model.shape.vertices[0].x = 1e39;
    EXPECT_THROW(view_data(model), FileError);
}

TEST(ViewData, RefusesAComplexThatIsNone) {
    ViewedModel model = small_model();
    model.axes[0].complex.radii.pop_back();
    EXPECT_THROW(view_data(model), UnusableInput);
}

TEST(ViewData, TellsTheErosionThicknessOfTheGrownBalls) {
    // A square plate, where the fire starts at a quarter of the scale and comes to the middle a side's half later.
    MedialComplex plate = complex_by_hand({{-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}, {0, 0, 0}},
                                          {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
    plate.radii = {0.25, 0.25, 0.25, 0.25, 0.5};
    ViewedModel model;
    model.axes.push_back({test::with_scale(plate, 2.0), {}, ""});
    model.axes.push_back({test::with_scale(plate, 1.0), {}, ""});
    const Decoded decoded(view_data(model));
    for (const auto& [k, middle] : {std::pair{0, 1.75}, std::pair{1, 1.5}}) {
        const Json& axis = decoded.header["axes"][k];
        EXPECT_EQ(axis["scale"], k + 1);
        const Thicknesses thicknesses = thicknesses_of(axis, decoded);
        EXPECT_NEAR(thicknesses.largest, middle, 1e-9);
        ASSERT_EQ(thicknesses.values.size(), 5U);
        for (int v = 0; v < 5; ++v) {
            EXPECT_NEAR(thicknesses.values[v], v == 4 ? middle : 0.0, 1e-4) << v;
        }
    }
}

TEST(ViewData, TellsTheErosionThicknessOfEachSheet) {
    // A fin on the surface of a tetrahedron, around which no fire comes; a loop with a twig; and a triangle with a
    // curve at its corner, which burns from both ends.
    ViewedModel model;
    model.axes.push_back({complex_by_hand({{0, 0, 0},
                                           {1, 0, 0},
                                           {0, 1, 0},
                                           {0, 0, 1},
                                           {0.5, -1, 0},
                                           {5, 0, 0},
                                           {6, 0, 0},
                                           {5, 1, 0},
                                           {4, 0, 0},
                                           {20, 0, 0},
                                           {21, 1, 0},
                                           {21, -1, 0},
                                           {15, 0, 0}},
                                          {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 4}, {9, 10, 11}}, {},
                                          {{5, 6}, {6, 7}, {5, 7}, {5, 8}, {9, 12}}),
                          {},
                          ""});
    model.axes[0].complex.radii[12] = 0.5;
    const Decoded decoded(view_data(model));
    const Json& axis = decoded.header["axes"][0];
    ASSERT_EQ(decoded.integers(axis["sheets"]), (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 2}));
    // Vertices 0 … 3 of the tetrahedron; 0, 1, 4 of the fin; 9, 10, 11 of the triangle; and of curves 5 … 9 and 12.
    const double inf = kInfinity;
    EXPECT_EQ(thicknesses_of(axis, decoded).values,
              (std::vector<double>{inf, inf, inf, inf, 0, 0, 0, 0, 0, 0, inf, inf, inf, 0, 0, 0}));
}

/// A rectangle from x = `from` to `to` in the plane of height z, `columns` × 1 squares, as a sheet of its own.
void add_strip(MedialComplex& complex, double from, double to, double z, int columns = 8) {
    const auto first = static_cast<Index>(complex.vertices.size());
    for (int i = 0; i <= columns; ++i) {
        const double x = from + (to - from) * i / columns;
        for (const double y : {0.0, 1.0}) {
            complex.vertices.push_back({x, y, z});
            complex.radii.push_back(1.0);
            complex.vertex_origins.push_back({});
        }
    }
    for (Index i = first; i < first + 2 * columns; i += 2) {
        complex.faces.push_back(std::vector<Index>{i, i + 2, i + 3, i + 1});
        complex.face_angles.push_back(90.0);
        complex.face_sheets.push_back(complex.sheets);
    }
    ++complex.sheets;
    build_edges(complex, {});
}

TEST(ViewData, KeepsTheColoursOfSheets) {
    MedialComplex first;  // strips of 10 × 1 above each other
    add_strip(first, 0, 10, 0);
    add_strip(first, 0, 10, 5);
    add_strip(first, 0, 10, 10);
    add_strip(first, 0, 10, 15);
    MedialComplex second;
    add_strip(second, 2, 9, 10.3);    // moved by less than half a radius
    add_strip(second, 0, 10, 0.7);    // moved by more: another one
    add_strip(second, 0, 4, 5.1, 3);  // one that fell into two: the larger part keeps its colour
    add_strip(second, 5, 10, 4.9, 5);
    add_strip(second, -2, 2.5, 15);      // a little more than half of it beneath
    add_strip(second, -20, 0.5, 0, 50);  // most of it is new
    MedialComplex third;
    add_strip(third, 0, 1, 0.6);   // the one that was new
    add_strip(third, 3, 10, 5.0);  // on both parts, more of it on the second one
    add_strip(third, 2, 9, 20);    // new again
    ViewedModel model;
    model.axes.push_back({test::with_scale(third, 2.0), {}, ""});
    model.axes.push_back({test::with_scale(first, 1.0), {}, ""});
    model.axes.push_back({test::with_scale(second, 1.5), {}, ""});
    const Decoded decoded(view_data(model));
    using Numbers = std::vector<std::uint32_t>;
    const std::vector<Numbers> truth{{0, 1, 2, 3}, {2, 4, 5, 1, 3, 6}, {4, 1, 7}};
    for (std::size_t i = 0; i < truth.size(); ++i) {
        EXPECT_EQ(decoded.header["axes"][i]["scale"], 1.0 + 0.5 * static_cast<double>(i));
        EXPECT_EQ(decoded.integers(decoded.header["axes"][i]["colors"]), truth[i]) << i;
    }
}

/// A grid of triangles, the worst case: polygons take less for each of their triangles.
TEST(ViewData, KeepsWithinItsSize) {
    constexpr int kSide = 300;
    ViewedModel model;
    model.axes.resize(1);
    MedialComplex& complex = model.axes[0].complex;
    for (int i = 0; i < kSide; ++i) {
        for (int j = 0; j < kSide; ++j) {
            // No order that a compressor could find, and many sheets.
            complex.vertices.push_back(
                {std::sin(i * 12.9898 + j * 78.233), std::cos(i * 39.3468 + j), std::sin(i * j)});
            complex.radii.push_back(std::abs(std::sin(i * 7.77 + j * 3.33)));
            complex.vertex_origins.push_back({});
            if (i + 1 < kSide && j + 1 < kSide) {
                const Index v = i * kSide + j;
                complex.faces.push_back(std::vector<Index>{v, v + kSide, v + kSide + 1});
                complex.faces.push_back(std::vector<Index>{v, v + kSide + 1, v + 1});
            }
        }
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        complex.face_sheets.push_back(static_cast<Index>(f));
        complex.face_angles.push_back(std::abs(90 * std::sin(static_cast<double>(f))));
    }
    complex.sheets = static_cast<Index>(complex.faces.size());
    build_edges(complex, {});
    for (const Point& p : complex.vertices) {
        model.shape.vertices.push_back(p);
    }
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        model.shape.triangles.push_back({complex.faces[f][0], complex.faces[f][1], complex.faces[f][2]});
    }
    const std::size_t triangles = 2 * complex.faces.size();
    const Decoded decoded(view_data(model));
    EXPECT_LE(decoded.bytes.size(), 24 * complex.vertices.size() + 24 * triangles + 10000);
}

class ViewPage : public test::FolderTest {};

TEST_F(ViewPage, IsTheTemplateWithData) {
    const std::filesystem::path file = folder() / "page.html";
    const std::string title = "a </script><script>alert(1)</script>";
    const std::vector<std::string> models{view_data(small_model()), std::string("\xFF\x00\x01", 3)};
    write_view(file, title, ViewLayout::kContactSheet, models);
    const std::string page = content(file.string());
    const std::string frame = content(SCALEAXIS_SOURCE_DIR "/viewer/dist/template.html");
    const std::string place = "<!--scaleaxis:data-->";
    ASSERT_NE(frame.find(place), std::string::npos);
    EXPECT_EQ(frame.find(place), frame.rfind(place));
    const std::string before = frame.substr(0, frame.find(place));
    const std::string after = frame.substr(frame.find(place) + place.size());
    ASSERT_TRUE(page.starts_with(before));
    ASSERT_TRUE(page.ends_with(after));

    std::istringstream lines(page.substr(before.size(), page.size() - before.size() - after.size()));
    std::string line;
    std::getline(lines, line);
    const std::string tag = R"(<script type="application/json" id="page">)";
    ASSERT_TRUE(line.starts_with(tag));
    EXPECT_EQ(line.find("</script>"), line.size() - 9);  // nothing in it ends the element
    const Json about = Json::parse(line.substr(tag.size(), line.size() - tag.size() - 9));
    EXPECT_EQ(about["title"], title);
    EXPECT_EQ(about["layout"], "contact-sheet");
    std::getline(lines, line);
    EXPECT_TRUE(line.starts_with("<script type=\"application/x-scaleaxis\">e")) << line.substr(0, 60);
    std::getline(lines, line);
    EXPECT_EQ(line, "<script type=\"application/x-scaleaxis\">/wAB</script>");
}

TEST_F(ViewPage, HasANameInHtml) {
    EXPECT_NO_THROW(check_view_output(folder() / "page.html"));
    EXPECT_NO_THROW(check_view_output(folder() / "page.HTM"));
    EXPECT_THROW(check_view_output(folder() / "page.ply"), FileError);
    EXPECT_THROW(check_view_output(folder() / "nowhere" / "page.html"), FileError);
    EXPECT_TRUE(std::filesystem::is_empty(folder()));
}

TEST_F(ViewPage, NeedsNothingFromTheNetwork) {
    const std::string frame = content(SCALEAXIS_SOURCE_DIR "/viewer/dist/template.html");
    EXPECT_NE(frame.find("default-src 'none'"), std::string::npos);
    EXPECT_EQ(frame.find("src=\"http"), std::string::npos);
    EXPECT_EQ(frame.find("src=\"/"), std::string::npos);
}

}  // namespace
}  // namespace scaleaxis
