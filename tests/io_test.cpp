// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/io.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "complexes.hpp"
#include "file_errors.hpp"
#include "folder.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/mesh.hpp"

// Windows lets files grow.
#if !defined(_WIN32)
#include <sys/resource.h>
#define SCALEAXIS_HAS_LIMITS
#endif

namespace scaleaxis {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::expect_consistent;
using test::expect_error;
using Edge = std::array<Index, 2>;
using Triangle = std::array<Index, 3>;

class Io : public test::FolderTest {};

template <class... Numbers>
std::string bytes(std::endian order, Numbers... numbers) {
    std::string result;
    const auto add = [&](auto number) {
        auto raw = std::bit_cast<std::array<char, sizeof(number)>>(number);
        if (order != std::endian::native) {
            std::ranges::reverse(raw);
        }
        result.append(raw.data(), raw.size());
    };
    (add(numbers), ...);
    return result;
}

template <class T>
T take(const std::string& content, std::size_t& position) {
    T value;
    std::memcpy(&value, content.data() + position, sizeof(T));
    position += sizeof(T);
    return value;
}

// ---------------------------------------------------------------------------------------------------------------------
// Meshes: the same tetrahedron in every dress
// ---------------------------------------------------------------------------------------------------------------------

const std::vector<Point> kCorners{{0.0, 0.0, 0.0}, {1.5, 0.0, 0.0}, {0.0, 2.25, 0.0}, {0.0, 0.0, -3.125}};
const std::vector<Triangle> kFaces{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}};

void expect_tetrahedron(const TriangleMesh& mesh) {
    EXPECT_EQ(mesh.vertices, kCorners);
    EXPECT_EQ(mesh.triangles, kFaces);
}

const std::string kOffVertices = "0 0 0\n1.5 0 0\n0 2.25 0\n0 0 -3.125\n";
const std::string kOffFaces = "3 0 1 2\n3 0 3 1\n3 1 3 2\n3 0 2 3\n";
const std::string kOff = "OFF\n4 4 6\n" + kOffVertices + kOffFaces;
const std::string kObj =
    "v 0 0 0\nv 1.5 0 0\nv 0 2.25 0\nv 0 0 -3.125\n"
    "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n";
const std::string kPlyHeader =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
const std::string kPly = "ply\nformat ascii 1.0\n" + kPlyHeader + kOffVertices + kOffFaces;

std::string binary_ply(std::endian order) {
    std::string result = std::string("ply\nformat binary_") + (order == std::endian::little ? "little" : "big") +
                         "_endian 1.0\n" + kPlyHeader;
    for (const Point& p : kCorners) {
        result += bytes(order, static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
    }
    for (const auto& [a, b, c] : kFaces) {
        result += bytes(order, std::uint8_t{3}, a, b, c);
    }
    return result;
}

std::string binary_stl(const std::string& comment) {
    std::string result = comment + std::string(80 - comment.size(), ' ');
    result += bytes(std::endian::little, std::uint32_t{4});
    for (const Triangle& face : kFaces) {
        result += bytes(std::endian::little, 0.0f, 0.0f, 0.0f);
        for (const Index v : face) {
            const Point& p = kCorners[v];
            result +=
                bytes(std::endian::little, static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
        }
        result += bytes(std::endian::little, std::uint16_t{0});
    }
    return result;
}

std::string ascii_stl(bool is_upper_case) {
    std::ostringstream out;
    out << "solid a name\n";
    for (const Triangle& face : kFaces) {
        out << " facet normal 0 0 1\n  outer loop\n";
        for (const Index v : face) {
            out << "   vertex " << kCorners[v].x << ' ' << kCorners[v].y << ' ' << kCorners[v].z << '\n';
        }
        out << "  endloop\n endfacet\n";
    }
    out << "endsolid a name\n";
    std::string result = out.str();
    if (is_upper_case) {
        std::ranges::transform(result, result.begin(),
                               [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    }
    return result;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t i = text.find(from); i != text.npos; i = text.find(from, i + to.size())) {
        text.replace(i, from.size(), to);
    }
    return text;
}

TEST_F(Io, ReadsEveryDialectOfOff) {
    const std::vector<std::string> dialects{
        kOff,
        "OFF 4 4 6\n" + kOffVertices + kOffFaces,
        "\t   OFF4 4 6 # no blank\n" + kOffVertices + kOffFaces,
        "OFF\n4 4\n" + kOffVertices + kOffFaces,
        "4 4 6\n" + kOffVertices + kOffFaces,
        "# before\nOFF\n# between\n\n4 4 0\n\n" + replaced(kOffVertices, "\n", " # behind\n\n") + kOffFaces,
        "COFF\n4 4 0\n" + replaced(kOffVertices, "\n", " 255 0 0 255\n") +
            replaced(kOffFaces, "\n", " 1.0 0.5 0.5 0.75\n"),
        "NOFF\n4 4 0\n" + replaced(kOffVertices, "\n", " 0 0 1\n") + kOffFaces,
        replaced(kOff, "\n", "\r\n"),
        replaced(kOff, "\n", "\r"),
        replaced(kOff, " ", " \t "),
        "\xEF\xBB\xBF" + kOff,
        kOff.substr(0, kOff.size() - 1),
        kOff + "<!DOCTYPE FilterScript>\n<FilterScript>\n</FilterScript>\n",
        "OFF\n4 4 6\n" + replaced(kOffVertices, "1.5", "+1.5E+0") + kOffFaces,
    };
    for (const std::string& dialect : dialects) {
        SCOPED_TRACE(dialect);
        expect_tetrahedron(read_mesh(write("mesh.off", dialect)));
    }
}

TEST_F(Io, ReadsEveryDialectOfObj) {
    const std::string vertices = kObj.substr(0, kObj.find('f'));
    const std::vector<std::string> dialects{
        kObj,
        "# comment\nmtllib a.mtl\no name\ng\ns off\nusemtl x\nvt 0 0\nvn 0 0 nan\nl 1 2\n" + kObj,
        vertices + "f -4 -3 -2\nf -4 -1 -3\nf -3 -1 -2\nf -4 -2 -1\n",
        vertices + "f 1/1 2/2 3/3\nf 1//1 4//1 2//1\nf 2/1/1 4/1/1 3/1/1\nf 1/ 3// 4\n",
        vertices + "f 1 \\\n2 3\nf 1 4 2 # comment\nf\t2  4\t3 \n\nf 1 3 4",
        replaced(kObj, "\n", "\r\n"),
        replaced(kObj, "1.5", "0x1.8p0"),
        replaced(kObj, "0\n", "0 0.5 0.25 1\n"),
        kObj.substr(kObj.find('f')) + vertices,
    };
    for (const std::string& dialect : dialects) {
        SCOPED_TRACE(dialect);
        expect_tetrahedron(read_mesh(write("mesh.obj", dialect)));
    }
}

TEST_F(Io, ReadsEveryDialectOfPly) {
    const std::string little = binary_ply(std::endian::little);
    const std::string header = "ply\nformat ascii 1.0\ncomment with words\nobj_info and more\n";
    const std::vector<std::string> dialects{
        kPly,
        little,
        binary_ply(std::endian::big),
        replaced(kPly, "vertex_indices", "vertex_index"),
        replaced(kPly, "float", "float64"),
        replaced(kPly, "uchar int", "uint8 uint32"),
        replaced(kPly.substr(0, kPly.find("end_header")), "\n", "\r\n") + kPly.substr(kPly.find("end_header")),
        replaced(little.substr(0, little.find("end_header")), "\n", "\r\n") + "end_header\r\n" +
            little.substr(little.find("end_header\n") + 11),
        header +
            "element camera 1\nproperty list uchar float view\nproperty int id\n"
            "element vertex 4\nproperty uchar red\nproperty double z\nproperty double x\nproperty float nx\nproperty "
            "double y\n"
            "element face 4\nproperty int group\nproperty list uchar float uv\nproperty list uchar int vertex_indices\n"
            "element edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n"
            "2 0.5 0.5 7\n255 0 0 nan 0\n0 0 1.5 0 0\n0 0 0 0 2.25\n0 -3.125 0 0 0\n"
            "9 0 3 0 1 2\n9 2 0.5 0.5 3 0 3 1\n9 0 3 1 3 2\n9 0 3 0 2 3\n0 1\n",
        header + kPlyHeader + replaced(kOffVertices, "\n", " ") + replaced(kOffFaces, "\n", " "),
    };
    for (const std::string& dialect : dialects) {
        SCOPED_TRACE(dialect.substr(0, dialect.find("end_header")));
        expect_tetrahedron(read_mesh(write("mesh.ply", dialect)));
    }
}

// As Stanford's and Georgia Tech's models have them: one list for all strips, which -1 ends, and corners twice where
// parts of a strip are joined.
TEST_F(Io, ReadsTriangleStripsOfPly) {
    const std::string head =
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 2\nproperty list int int vertex_indices\nend_header\n";
    // 0 1 2, then 0 3 1 and, turned, 1 3 2; a repeated corner and the last face in the other strip.
    const std::vector<std::vector<Index>> strips{{0, 1, 2, -1, 0, 3, 1, -1}, {1, 3, 2, 2, 0, 2, 3, -1}};
    const std::vector<Triangle> faces{{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {0, 2, 3}};
    std::string ascii = "ply\nformat ascii 1.0\n" + head + kOffVertices;
    std::map<std::endian, std::string> binary;
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        std::string& content = binary[order];
        content = std::string("ply\nformat binary_") + (order == std::endian::little ? "little" : "big") +
                  "_endian 1.0\n" + head;
        for (const Point& p : kCorners) {
            content += bytes(order, static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
        }
        for (const std::vector<Index>& strip : strips) {
            content += bytes(order, static_cast<Index>(strip.size()));
            for (const Index v : strip) {
                content += bytes(order, v);
            }
        }
    }
    for (const std::vector<Index>& strip : strips) {
        ascii += std::to_string(strip.size());
        for (const Index v : strip) {
            ascii += ' ' + std::to_string(v);
        }
        ascii += '\n';
    }
    for (const std::string& content : {ascii, binary[std::endian::little], binary[std::endian::big]}) {
        EXPECT_EQ(file_kind(write("a.ply", content)), FileKind::kMesh);
        const TriangleMesh mesh = read_mesh(path("a.ply"));
        EXPECT_EQ(mesh.vertices, kCorners);
        ASSERT_EQ(mesh.triangles.size(), faces.size());
        for (std::size_t f = 0; f < faces.size(); ++f) {
            Triangle turned = mesh.triangles[f];
            std::rotate(turned.begin(), std::ranges::min_element(turned), turned.end());
            EXPECT_EQ(turned, faces[f]) << f;
        }
    }
    const auto with_strip = [&](const std::string& strip) {
        return "ply\nformat ascii 1.0\n" + head + kOffVertices + strip + "\n0\n";
    };
    // A strip of six around the middle: every other triangle is turned.
    write("a.ply", with_strip("4 0 1 2 3"));
    EXPECT_EQ(read_mesh(path("a.ply")).triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}}));
    write("a.ply", with_strip("4 0 -1 1 2"));
    EXPECT_TRUE(read_mesh(path("a.ply")).triangles.empty()) << "too short for a triangle";
    expect_error([&] { read_mesh(write("a.ply", with_strip("4 0 1 9 3"))); }, {"face 1 of 2", "does not exist"});
    expect_error([&] { read_mesh(write("a.ply", with_strip("4 0 1 -2 3"))); }, {"face 1 of 2", "does not exist"});
    expect_error([&] { read_mesh(write("a.ply", with_strip("4000000 0 1 2"))); }, {"longer than the rest"});
    expect_error(
        [&] { read_mesh(write("a.ply", replaced(with_strip("3 0 1 2"), "list int int vertex_indices", "int n"))); },
        {"tristrips", "vertex_indices"});
}

TEST_F(Io, ReadsAndWeldsEveryDialectOfStl) {
    const std::string two_solids = replaced(ascii_stl(false), " facet normal 0 0 1\n  outer loop\n   vertex 1.5 0 0",
                                            "endsolid\nsolid\n facet normal 0 0 1\n  outer loop\n   vertex 1.5 0 0");
    ASSERT_NE(two_solids, ascii_stl(false));
    for (const std::string& dialect : {ascii_stl(false), ascii_stl(true), replaced(ascii_stl(false), "\n", "\r\n"),
                                       two_solids, binary_stl("a comment"), binary_stl("solid and yet binary"),
                                       binary_stl("solid") + "behind", replaced(ascii_stl(false), " 0 ", " -0 ")}) {
        SCOPED_TRACE(dialect.substr(0, 80));
        expect_tetrahedron(read_mesh(write("mesh.stl", dialect)));
    }
}

/// The same with normals; each facet is followed by a payload, and its last two bytes say of how many bytes.
std::string binary_stl_with(std::uint32_t count, const std::string& payload) {
    std::string result(80, ' ');
    result += bytes(std::endian::little, count);
    for (const Triangle& face : kFaces) {
        const std::array<Point, 3> p{kCorners[face[0]], kCorners[face[1]], kCorners[face[2]]};
        for (const Point& q : {unit(cross(p[1] - p[0], p[2] - p[0])), p[0], p[1], p[2]}) {
            result +=
                bytes(std::endian::little, static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z));
        }
        result += bytes(std::endian::little, static_cast<std::uint16_t>(payload.size())) + payload;
    }
    return result;
}

TEST_F(Io, TheLengthOfAnStlTellsWhereItsHeadIsWrong) {
    const std::string right = binary_stl_with(4, "");
    struct Case {
        std::string content;
        std::string warning;  ///< a part of it; empty: none
    };
    for (const auto& [content, warning] :
         {Case{right, ""}, Case{binary_stl_with(0, ""), "says 0 facets, but there are 4"},
          Case{binary_stl_with(1, ""), "says 1 facet, but there are 4"}, Case{binary_stl_with(4, "abcd"), ""},
          Case{right.substr(0, 80) + right.substr(84), "lacks the number of facets"},
          Case{std::string(80, ' ') + binary_stl("").substr(84), "lacks the number of facets"},
          Case{right + "abc", "the 3 bytes behind them are left out"}}) {
        SCOPED_TRACE(warning);
        const MeshObjects objects = read_objects(write("mesh.stl", content));
        expect_tetrahedron(objects.objects.at(0).mesh);
        ASSERT_EQ(objects.warnings.size(), warning.empty() ? 0u : 1u);
        if (!warning.empty()) {
            EXPECT_EQ(objects.warnings[0].code, "file.repaired");
            EXPECT_NE(objects.warnings[0].message.find(warning), std::string::npos) << objects.warnings[0].message;
        }
    }
    expect_error([&] { read_mesh(write("none.stl", binary_stl_with(0, "ab"))); }, {"says 0 facets", "no facets"});
    expect_error([&] { read_mesh(write("torn.stl", right.substr(0, 80 + 150))); }, {"2 of 4 facets", "truncated"});
}

// Written by VTK 9.5: a box of 2 x 3 x 4 as quads, triangles or strips, in legacy and XML files, one beside a line.
TEST_F(Io, ReadsSurfacesOfVtk) {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(SCALEAXIS_SOURCE_DIR "/tests/fuzz/corpus/mesh")) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with("vtk-")) {
            continue;
        }
        SCOPED_TRACE(name);
        EXPECT_EQ(file_kind(entry.path()), FileKind::kMesh);
        const MeshObjects objects = read_objects(entry.path());
        const RepairedMesh repaired = repair(objects.objects.at(0).mesh);
        EXPECT_NEAR(repaired.report.volume, 24.0, 1e-9);
        EXPECT_EQ(repaired.report.reversed_triangles + repaired.report.reversed_components, 0);
        EXPECT_EQ(objects.warnings.size(), name == "vtk-line.vtp" ? 1u : 0u);
        ++count;
    }
    EXPECT_EQ(count, 10);
}

TEST_F(Io, RecognisesTheContentWhateverTheName) {
    for (const std::string& content : {kOff, kObj, kPly, binary_ply(std::endian::little), ascii_stl(false),
                                       binary_stl("comment"), binary_stl("solid")}) {
        for (const std::string name : {"mesh", "mesh.off", "mesh.OBJ", "mesh.Ply", "mesh.STL", "mesh.txt", "a.b.c"}) {
            SCOPED_TRACE(name + ": " + content.substr(0, 20));
            expect_tetrahedron(read_mesh(write(name, content)));
        }
    }
}

TEST_F(Io, ReadsCoordinatesAsTheNearestDoubles) {
    const std::vector<std::pair<std::string, double>> numbers{
        {"0.1", 0.1},
        {"0.1000000000000000055511151231257827", 0.1},
        {"-1e-300", -1e-300},
        {"4.9e-324", 4.9e-324},
        {"1e-400", 0.0},
        {"1e18", 1e18},
        {"123456789012345678.901234567890", 123456789012345678.901234567890},
        {"-.5", -0.5},
        {"5.", 5.0},
        {"-0x1.cf66949252defp-2", -0x1.cf66949252defp-2},
    };
    for (const auto& [text, value] : numbers) {
        SCOPED_TRACE(text);
        const std::string vertices = text + " 0 0\n1 0 0\n0 1 0\n";
        EXPECT_EQ(read_mesh(write("a.off", "OFF\n3 1 0\n" + vertices + "3 0 1 2\n")).vertices[0].x, value);
        EXPECT_EQ(read_mesh(write("a.obj", "v " + text + " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")).vertices[0].x, value);
    }
}

TEST_F(Io, NamesTheFaultOfABadMesh) {
    const std::string little = binary_ply(std::endian::little);
    const std::string stl = binary_stl("comment");
    const std::string absurd_list = replaced(little, "list uchar", "list uint");
    std::string infinite = little;
    const float infinity = std::numeric_limits<float>::infinity();
    std::memcpy(infinite.data() + infinite.find("end_header\n") + 11, &infinity, sizeof infinity);
    struct Case {
        std::string name;
        std::string content;
        std::vector<std::string> words;
    };
    const std::vector<Case> cases{
        {"empty.off", "", {"empty"}},
        {"blank.off", "\n \n", {"blank.off", "truncated"}},
        {"comment.obj", "# nothing\n", {"vertex"}},
        {"words.txt", "Dear reader,\n", {".ply", ".off", ".stl", ".obj"}},
        {"words.off", "Dear reader,\n", {"line 1", "'Dear'", "integer"}},
        {"words.obj", "v 0 0 0\n?! 1 2 3\n", {"line 2", "'?!'"}},
        {"words.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertes 0 0 0\n", {"line 4", "'vertes'", "`vertex`"}},
        {"glued.stl", replaced(ascii_stl(false), "-3.125", "-3.1z25"), {"line 12", "'-3.1z25'", "number"}},
        {"skipped.stl", replaced(ascii_stl(false), " facet normal", " fazet normal"), {"line 2", "'fazet'"}},
        {"garbage.ply", std::string("\x01\x02\n\xff\x00zz", 7), {"line 1", "ply"}},
        {"garbage.stl", std::string(200, '\xff'), {"facets"}},
        {"short.stl", "abc", {"too short"}},
        {"number.off", replaced(kOff, "1.5", "1,5"), {"line 4", "'1,5'", "number"}},
        {"glued.off", replaced(kOff, "-3.125", "-3.1z25"), {"line 6", "'-3.1z25'", "number"}},
        {"glued.obj", replaced(kObj, "-3.125", "-3.1z25"), {"line 4", "'-3.1z25'", "number"}},
        {"real.off", replaced(kOff, "3 1 3 2", "3 1 3 2.9"), {"line 9", "'2.9'", "integer"}},
        {"corner.obj", replaced(kObj, "f 2 4 3", "f 2 4 3 x1"), {"line 7", "'x1'"}},
        {"number.obj", replaced(kObj, "2.25", "two"), {"line 3", "'two'", "number"}},
        {"missing.obj", replaced(kObj, "v 1.5 0 0", "v 1.5 0"), {"line 2", "missing"}},
        {"nan.off", replaced(kOff, "1.5", "nan"), {"vertex 2 of 4", "finite"}},
        {"inf.obj", replaced(kObj, "1.5", "-inf"), {"vertex 2 of 4", "finite"}},
        {"large.off", replaced(kOff, "1.5", "1e999"), {"vertex 2 of 4", "finite"}},
        {"inf.ply", infinite, {"vertex 1 of 4", "finite"}},
        {"nan.stl", replaced(ascii_stl(false), "1.5", "NaN"), {"finite"}},
        {"range.off", replaced(kOff, "3 1 3 2", "3 1 3 4"), {"face 3 of 4", "does not exist", "4"}},
        {"negative.off", replaced(kOff, "3 1 3 2", "3 1 3 -2"), {"face 3 of 4", "does not exist"}},
        {"range.obj", replaced(kObj, "f 2 4 3", "f 2 5 3"), {"face 3 of 4", "does not exist"}},
        {"negative.obj", replaced(kObj, "f 2 4 3", "f 2 -5 3"), {"face 3 of 4", "does not exist"}},
        {"zero.obj", replaced(kObj, "f 2 4 3", "f 2 0 3"), {"line 7", "'0'", "1"}},
        {"real.obj", replaced(kObj, "f 2 4 3", "f 2 4.5 3"), {"line 7", "'4.5'"}},
        {"huge.obj", replaced(kObj, "f 2 4 3", "f 2 99999999999 3"), {"face 3 of 4", "does not exist"}},
        {"range.ply", replaced(kPly, "3 1 3 2", "3 1 3 4"), {"face 3 of 4", "does not exist"}},
        {"real.ply", replaced(kPly, "3 1 3 2", "3 1 3 1.5"), {"face 3 of 4", "does not exist"}},
        {"two.off", replaced(kOff, "3 1 3 2", "2 1 3"), {"face 3 of 4", "fewer than three corners"}},
        {"two.obj", replaced(kObj, "f 2 4 3", "f 2 4"), {"face 3 of 4", "fewer than three corners"}},
        {"none.obj", replaced(kObj, "f 2 4 3", "f"), {"face 3 of 4", "fewer than three corners"}},
        {"minus.off", replaced(kOff, "3 1 3 2", "-3 1 3 2"), {"line 9", "-3 corners"}},
        {"two.stl", replaced(ascii_stl(false), "   vertex 0 2.25 0\n", ""), {"line 6", "'endloop'", "`vertex`"}},
        {"facet.stl", replaced(ascii_stl(false), " endfacet\n", ""), {"line 8", "facet"}},
        {"vertex.stl", "solid\nvertex 0 0 0\n" + ascii_stl(false).substr(13), {"line 2", "'vertex'", "`facet`"}},
        {"truncated.off", kOff.substr(0, kOff.size() - 12), {"truncated"}},
        {"header.off", "OFF\n4", {"truncated"}},
        {"truncated.ply", kPly.substr(0, kPly.size() - 12), {"truncated", "face"}},
        {"little.ply", little.substr(0, little.size() - 1), {"truncated", "face"}},
        {"header.ply", kPly.substr(0, kPly.find("element face")), {"truncated", "header"}},
        {"truncated.stl", stl.substr(0, stl.size() - 1), {"3 of 4 facets", "truncated"}},
        {"solid.stl", binary_stl("solid").substr(0, 200), {"2 of 4 facets", "truncated"}},
        {"ascii.stl", ascii_stl(false).substr(0, 200), {"truncated"}},
        {"count.off", replaced(kOff, "4 4 6", "4000000000 4 6"), {"line 2", "4000000000 vertices"}},
        {"faces.off", replaced(kOff, "4 4 6", "4 4000000000 6"), {"line 2", "4000000000 faces"}},
        {"minus.off", replaced(kOff, "4 4 6", "-4 4 6"), {"line 2", "-4 vertices"}},
        {"corners.off", replaced(kOff, "3 1 3 2", "4000000000 1 3 2"), {"line 9", "4000000000 corners"}},
        {"count.ply", replaced(kPly, "vertex 4", "vertex 99999999999999"), {"99999999999999", "'vertex'", "too short"}},
        {"overflow.ply", replaced(kPly, "vertex 4", "vertex 99999999999999999999"), {"line 3", "number of elements"}},
        {"minus.ply", replaced(kPly, "vertex 4", "vertex -4"), {"line 3", "'-4'"}},
        {"list.ply", absurd_list, {"'face' 2 of 4", "list", "truncated"}},
        {"minus_list.ply", replaced(replaced(kPly, "uchar", "char"), "3 1 3 2", "-3 1 3 2"), {"'face' 3 of 4", "list"}},
        {"type.ply", replaced(kPly, "float y", "real y"), {"line 5", "'real'"}},
        {"length.ply", replaced(kPly, "uchar int", "float int"), {"integer"}},
        {"keyword.ply", replaced(kPly, "element face", "elephant face"), {"line 7", "'elephant'"}},
        {"format.ply", replaced(kPly, "ascii", "binary"), {"line 2", "'binary'"}},
        {"formatless.ply", replaced(kPly, "format ascii 1.0\n", ""), {"format"}},
        {"property.ply", replaced(kPly, "element vertex 4\n", ""), {"line 3", "property"}},
        {"coordinate.ply", replaced(kPly, "float y", "float u"), {"'vertex'", "'y'"}},
        {"corner.ply", replaced(kPly, "vertex_indices", "corners"), {"'face'", "'vertex_indices'"}},
        {"value.ply", replaced(kPly, "1.5", "x"), {"'vertex' 2 of 4", "'x'", "number"}},
        {"binary.off", "OFF BINARY\n" + std::string(40, '\0'), {"binary OFF", "convert"}},
        {"zero.obj", std::string("v 0 0 0\n\0\0\0\0\n", 13), {"line 2"}},
    };
    for (const auto& [name, content, words] : cases) {
        SCOPED_TRACE(name);
        std::vector<std::string> expected = words;
        expected.push_back(path(name).string());
        const auto file = write(name, content);
        expect_error([&] { read_mesh(file); }, expected);
    }
}

TEST_F(Io, NamesCoordinatesBeyondWhatTreesCompareWith) {
    for (const std::string number : {"3.4028234663852886e38", "-1e30", "1.1e18", "1e300"}) {
        SCOPED_TRACE(number);
        const std::vector<std::string> words{"vertex 2 of 4", "up to 1e18"};
        expect_error([&] { read_mesh(write("mark.off", replaced(kOff, "1.5", number))); }, words);
        expect_error([&] { read_mesh(write("mark.obj", replaced(kObj, "1.5", number))); }, words);
        expect_error([&] { read_mesh(write("mark.ply", replaced(kPly, "1.5", number))); }, words);
        expect_error([&] { read_mesh(write("mark.stl", replaced(ascii_stl(false), "1.5", number))); }, {"up to 1e18"});
        expect_error([&] { read_balls(write("mark.balls", "0 0 0 1\n0 " + number + " 0 1\n")); },
                     {"ball 2 of 2", "up to 1e18"});
        expect_error([&] { read_axis(write("mark.ma", "2 1 0\nv 0 0 0 1\nv 0 " + number + " 0 1\ne 0 1\n")); },
                     {"vertex 2 of 2", "up to 1e18"});
    }
    EXPECT_EQ(read_mesh(write("large.off", replaced(kOff, "1.5", "1e18"))).vertices[1].x, 1e18);
}

TEST_F(Io, EveryTruncationOfAMeshIsAnErrorOrTheMeshItself) {
    for (const std::string& whole :
         {kOff, kPly, binary_ply(std::endian::big), ascii_stl(false), binary_stl("comment")}) {
        const fs::path file = write("mesh.x", whole);
        for (std::size_t size = whole.size() - 1; size-- > 0;) {
            fs::resize_file(file, size);
            SCOPED_TRACE(whole.substr(0, 20) + "… up to " + std::to_string(size));
            if (error_of([&] { read_mesh(file); }).empty()) {
                // The last number may lose digits, the last word letters.
                EXPECT_LT(whole.size() - size, 12u);
                EXPECT_EQ(read_mesh(file).triangles.size(), 4u);
            }
        }
    }
}

TEST_F(Io, NamesWhatIsNoFile) {
    expect_error([&] { read_mesh(path("absent.off")); }, {"absent.off", "No such file"});
    fs::create_directory(path("folder.off"));
    expect_error([&] { read_mesh(path("folder.off")); }, {"folder.off", "folder"});
    expect_error([&] { read_mesh(write("empty.off", "")); }, {"empty"});
    expect_error([&] { read_balls(path("absent.ply")); }, {"absent.ply", "No such file"});
}

TEST_F(Io, ReadsFilesWithoutElements) {
    EXPECT_TRUE(read_mesh(write("a.off", "OFF 0 0 0\n")).triangles.empty());
    EXPECT_TRUE(read_mesh(write("a.stl", "solid Empty\nendsolid Empty")).triangles.empty());
    EXPECT_TRUE(read_mesh(write("a.ply", replaced(replaced(kPlyHeader, "vertex 4", "vertex 0"), "face 4", "face 0")
                                             .insert(0, "ply\nformat ascii 1.0\n")))
                    .triangles.empty());
    EXPECT_EQ(read_mesh(write("a.obj", "v 1 2 3\n")).vertices.size(), 1u);
}

// ---------------------------------------------------------------------------------------------------------------------
// Polygons
// ---------------------------------------------------------------------------------------------------------------------

double doubled_area(const Point& a, const Point& b, const Point& c) { return norm(cross(b - a, c - a)); }

/// The corners in a tilted plane, as one polygon.
TriangleMesh triangulated(const fs::path& file, const std::vector<std::array<double, 2>>& corners) {
    std::ofstream out(file);
    out.precision(17);
    out << "OFF\n" << corners.size() << " 1 0\n";
    for (const auto& [u, v] : corners) {
        const Point p = u * Point{2.0 / 3.0, -2.0 / 3.0, 1.0 / 3.0} + v * Point{1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0};
        out << p.x << ' ' << p.y << ' ' << p.z << '\n';
    }
    out << corners.size();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        out << ' ' << i;
    }
    out << '\n';
    out.close();
    return read_mesh(file);
}

/// The triangles cover the polygon once: their areas add up to that of the polygon, and none is turned over.
void expect_covers(const TriangleMesh& mesh, const std::vector<std::array<double, 2>>& corners) {
    double area = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto& [ax, ay] = corners[i];
        const auto& [bx, by] = corners[(i + 1) % corners.size()];
        area += ax * by - ay * bx;
    }
    ASSERT_GT(area, 0.0);
    ASSERT_EQ(mesh.vertices.size(), corners.size());
    ASSERT_EQ(mesh.triangles.size(), corners.size() - 2);
    const Point normal{-2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0};
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Point& p = mesh.vertices[a];
        const double part = dot(normal, cross(mesh.vertices[b] - p, mesh.vertices[c] - p));
        EXPECT_GT(part, 0.0);
        sum += doubled_area(p, mesh.vertices[b], mesh.vertices[c]);
    }
    EXPECT_NEAR(sum, area, 1e-12 * area);
}

TEST_F(Io, CutsPolygonsIntoTrianglesThatCoverThem) {
    const std::vector<std::vector<std::array<double, 2>>> polygons{
        {{0, 0}, {4, 0}, {4, 3}, {0, 3}},  // convex
        {{0, 0}, {4, 1}, {8, 0}, {4, 6}},  // an arrowhead, at each corner
        {{4, 1}, {8, 0}, {4, 6}, {0, 0}},
        {{8, 0}, {4, 6}, {0, 0}, {4, 1}},
        {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {4, 3}, {4, 4}, {0, 4}},                          // a C
        {{0, 0}, {6, 0}, {6, 5}, {5, 5}, {5, 1}, {4, 5}, {3, 1}, {2, 5}, {1, 1}, {1, 5}, {0, 5}},  // a comb
        {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {2, 2}, {1, 2}, {0, 2}, {0, 1}},  // corners on straight sides
        // A square hole, with a bridge to it that is walked twice.
        {{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {3, 3}, {3, 6}, {6, 6}, {6, 3}, {3, 3}},
        // Two triangular holes with bridges to one corner.
        {{0, 0},
         {9, 0},
         {9, 9},
         {0, 9},
         {0, 0},
         {1, 4},
         {1, 8},
         {3, 6},
         {1, 4},
         {0, 0},
         {4, 1},
         {6, 3},
         {8, 1},
         {4, 1}},
        // A slit that forks, walked around.
        {{0, 0}, {8, 0}, {3, 3}, {6, 1}, {3, 3}, {4, 4}, {3, 3}, {8, 0}, {8, 8}, {0, 8}},
    };
    for (const auto& polygon : polygons) {
        SCOPED_TRACE(polygon.size());
        expect_covers(triangulated(path("polygon.off"), polygon), polygon);
    }
}

TEST_F(Io, CutsRandomPolygonsIntoTrianglesThatCoverThem) {
    constexpr std::uint64_t kSeed = 7;
    SCOPED_TRACE("seed " + std::to_string(kSeed));
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> radius(0.1, 1.0);
    for (std::size_t n = 4; n < 120; ++n) {
        std::vector<std::array<double, 2>> polygon;  // a star
        for (std::size_t i = 0; i < n; ++i) {
            const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
            const double r = radius(random);
            polygon.push_back({r * std::cos(angle), r * std::sin(angle)});
        }
        SCOPED_TRACE(n);
        expect_covers(triangulated(path("star.off"), polygon), polygon);
    }
}

TEST_F(Io, CutsALongSpiralIntoTrianglesThatCoverIt) {
    std::vector<std::array<double, 2>> outside;
    std::vector<std::array<double, 2>> inside;
    for (int i = 0; i < 1500; ++i) {
        const double angle = 0.02 * i;
        const double r = 1.0 + angle;
        outside.push_back({(r + 2.0) * std::cos(angle), (r + 2.0) * std::sin(angle)});
        inside.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    std::vector<std::array<double, 2>> polygon = outside;
    polygon.insert(polygon.end(), inside.rbegin(), inside.rend());
    expect_covers(triangulated(path("spiral.off"), polygon), polygon);
}

TEST_F(Io, KeepsTheBoundaryOfPolygonsThatCannotBeCovered) {
    const std::vector<std::vector<std::array<double, 2>>> polygons{
        {{0, 0}, {1, 0}, {2, 0}, {3, 0}},          // on a line
        {{0, 0}, {2, 2}, {2, 0}, {0, 2}, {1, 3}},  // crosses itself
        {{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}},
    };
    for (const auto& polygon : polygons) {
        const TriangleMesh mesh = triangulated(path("polygon.off"), polygon);
        ASSERT_EQ(mesh.triangles.size(), polygon.size() - 2);
        std::map<Edge, int> sides;  // minus the reverse ones
        for (const Triangle& t : mesh.triangles) {
            for (int k = 0; k < 3; ++k) {
                ++sides[{t[k], t[(k + 1) % 3]}];
                --sides[{t[(k + 1) % 3], t[k]}];
            }
        }
        const auto n = static_cast<Index>(polygon.size());
        for (const auto& [side, count] : sides) {
            const bool is_side = side[1] == (side[0] + 1) % n;
            const bool is_reverse_side = side[0] == (side[1] + 1) % n;
            EXPECT_EQ(count, is_side ? 1 : is_reverse_side ? -1 : 0) << side[0] << ' ' << side[1];
        }
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Balls
// ---------------------------------------------------------------------------------------------------------------------

std::vector<Ball> random_balls() {
    constexpr std::uint64_t kSeed = 3;
    ::testing::Test::RecordProperty("seed", static_cast<int>(kSeed));
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> normal;
    std::vector<Ball> balls{{{0.1, -0.0, 1.0 / 3.0}, 5e-324}, {{1e18, -1e-300, 123456789.0}, 1e18}};
    for (int i = 0; i < 1000; ++i) {
        balls.push_back(
            {{normal(random), 1e9 * normal(random), 1e-9 * normal(random)}, std::exp(10.0 * normal(random))});
    }
    return balls;
}

TEST_F(Io, BallsComeBackAsTheyWere) {
    const std::vector<Ball> balls = random_balls();
    for (const std::string name : {"a.ply", "a.balls", "a.txt", "a.xyzr", "a.woff", "B.PLY"}) {
        SCOPED_TRACE(name);
        write_balls(path(name), balls);
        EXPECT_EQ(read_balls(path(name)), balls);
        write_balls(path(name), std::vector<Ball>{});
        EXPECT_TRUE(read_balls(path(name)).empty());
    }
    EXPECT_EQ(names(), (std::set<std::string>{"a.ply", "a.balls", "a.txt", "a.xyzr", "a.woff", "B.PLY"}));
}

TEST_F(Io, ReadsEveryDialectOfBalls) {
    const std::vector<Ball> balls{{{1.0, 2.0, 3.0}, 0.5}, {{-1.0, 0.25, 0.0}, 4.0}};
    const std::string header =
        "element vertex 2\nproperty float radius\nproperty uchar red\nproperty double z\nproperty float x\nproperty "
        "float y\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const auto binary = [&](std::endian order, const std::string& name) {
        return "ply\nformat binary_" + name + "_endian 1.0\n" + header +
               bytes(order, 0.5f, std::uint8_t{9}, 3.0, 1.0f, 2.0f) +
               bytes(order, 4.0f, std::uint8_t{9}, 0.0, -1.0f, 0.25f) + bytes(order, std::uint8_t{2}, 0, 1);
    };
    for (const std::string& content :
         {std::string("1 2 3 0.5\n-1 0.25 0 4\n"), std::string("# balls\n\n 1\t2 3 .5 # first\r\n\r\n-1 0.25 0 4e0"),
          std::string("WOFF 2 0 0\n1 2 3 0.5\n-1 0.25 0 4\n"), std::string("WOFF\n2 0 0\n\n1 2 3 0.5\n-1 0.25 0 4"),
          "ply\nformat ascii 1.0\n" + header + "0.5 9 3 1 2\n4 9 0 -1 0.25\n2 0 1\n",
          binary(std::endian::little, "little"), binary(std::endian::big, "big")}) {
        for (const std::string name : {"balls", "b.ply", "b.txt", "b.woff"}) {
            SCOPED_TRACE(name + ": " + content.substr(0, 30));
            EXPECT_EQ(read_balls(write(name, content)), balls);
        }
    }
}

TEST_F(Io, NamesTheFaultOfBadBalls) {
    const std::vector<std::array<std::string, 3>> cases{
        {"a.txt", "0 0 0 1\n0 0 0 -1\n", "ball 2 of 2"},
        {"a.txt", "0 0 0 0\n", "radius 0"},
        {"a.txt", "0 0 0 nan\n", "radius"},
        {"a.txt", "0 0 0 inf\n", "radius"},
        {"a.txt", "0 0 0 1\n0 nan 0 1\n", "ball 2 of 2"},
        {"a.txt", "0 0 0 1\n\n0 0 1\n", "line 3"},
        {"a.txt", "0 0 0 1 2\n", "line 1"},
        {"a.txt", "0 0 0 1\nsome words\n", "line 2"},
        {"a.woff", "WOFF 3 0 0\n0 0 0 1\n", "3 balls"},
        {"a.woff", "WOFF 1 0 0\n0 0 0 1\n0 0 0 1\n", "1 balls"},
        {"a.woff", "WOFF x 0 0\n0 0 0 1\n", "line 1"},
        {"a.woff", "nothing\n", "WOFF"},
        {"a.ply", kPly, "'radius'"},
        {"a.balls", "", "empty"},
        {"a.jpg", "\xff\xd8\xff", ".woff"},
    };
    for (const auto& [name, content, words] : cases) {
        SCOPED_TRACE(content);
        const auto file = write(name, content);
        expect_error([&] { read_balls(file); }, {path(name).string(), words});
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Axes
// ---------------------------------------------------------------------------------------------------------------------

/// A square and a pentagon with a side in common, a curve of two edges, an isolated ball. Shared by the diagonals of
/// two fans: the square's first corner and the pentagon's.
MedialComplex sample_axis() {
    MedialComplex c;
    c.vertices = {{0.1, 0.2, 0.3},  {1.0 / 3.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 1e-17}, {2.0, 0.5, 0.0},
                  {2.0, -1.0, 0.0}, {1.0, -2.0, 0.0},      {5.0, 5.0, 5.0}, {6.0, 5.0, 5.0},   {9.0, 9.0, -9.0}};
    c.radii = {0.1, 0.2, 1.0 / 3.0, 0.4, 1e-9, 0.6, 0.7, 0.8, 0.9, 1e9};
    for (const Index ball : {kNone, kNone, 3, kNone, kNone, kNone, 4, kNone, 8, 0}) {
        c.vertex_origins.push_back(origin_of(ball, 1.0));
    }
    c.edges = {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {2, 4}, {4, 5}, {5, 6}, {1, 6}, {3, 7}, {7, 8}};
    c.faces.push_back(std::vector<Index>{0, 1, 2, 3});
    c.faces.push_back(std::vector<Index>{1, 6, 5, 4, 2});
    c.face_edges.push_back(std::vector<Index>{0, 1, 2, 3});
    c.face_edges.push_back(std::vector<Index>{7, 6, 5, 4, 1});
    c.face_angles = {89.9, 1.0 / 7.0};
    c.face_sheets = {1, 0};
    c.sheets = 2;
    return c;
}

TEST_F(Io, WritesAnAxisAsPly) {
    const MedialComplex axis = sample_axis();
    std::vector<double> values{1, 2, 3, 4, 5, 6, 7, 8, std::numeric_limits<double>::infinity(), 0.1};
    write_axis(path("axis.ply"), axis, {}, {.vertex_values = {{"erosion_thickness", values}}});
    const std::string written = content("axis.ply");
    const std::size_t end = written.find("end_header\n");
    EXPECT_EQ(written.substr(0, end),
              "ply\nformat ascii 1.0\ncomment made by scaleaxis\n"
              "element vertex 10\nproperty double x\nproperty double y\nproperty double z\nproperty double radius\n"
              "property double erosion_thickness\nproperty int ball\n"
              "element face 7\nproperty list uchar int vertex_indices\nproperty int sheet\nproperty double angle\n"
              "property int polygon\n");
    EXPECT_TRUE(written.substr(end).starts_with("end_header\n0.1 0.2 0.3 0.1 1 -1\n")) << written.substr(end);
    EXPECT_NE(written.find("6 5 5 0.9 -1 8\n"), std::string::npos) << "infinite: -1";
    EXPECT_TRUE(
        written.ends_with("3 0 1 2 1 89.9 0\n3 0 2 3 1 89.9 0\n"
                          "3 1 6 5 0 0.14285714285714285 1\n3 1 5 4 0 0.14285714285714285 1\n"
                          "3 1 4 2 0 0.14285714285714285 1\n3 3 7 7 -1 0 -1\n3 7 8 8 -1 0 -1\n"))
        << written;

    write_axis(path("axis.vtp"), axis, {}, {.vertex_values = {{"erosion_thickness", values}}});
    EXPECT_NE(content("axis.vtp").find("Name=\"erosion_thickness\" format=\"ascii\">\n1\n2\n"), std::string::npos);
    EXPECT_NE(content("axis.vtp").find("\n8\n-1\n0.1\n"), std::string::npos);
    for (const std::string name : {"radius", "", "two words", "x"}) {
        EXPECT_THROW(write_axis(path("bad.ply"), axis, {}, {.vertex_values = {{name, values}}}), InvalidOption) << name;
    }
    values.pop_back();
    EXPECT_THROW(write_axis(path("bad.ply"), axis, {}, {.vertex_values = {{"v", values}}}), InvalidOption);
    EXPECT_FALSE(fs::exists(path("bad.ply")));
}

TEST_F(Io, WritesThePolygonsOfAnAxisAsPly) {
    const MedialComplex axis = sample_axis();
    write_axis(path("axis.ply"), axis, {}, {.has_polygons = true});
    const std::string written = content("axis.ply");
    const std::string header =
        "element vertex 10\nproperty double x\nproperty double y\nproperty double z\nproperty double radius\n"
        "property int ball\nelement face 2\nproperty list uchar int vertex_indices\nproperty int sheet\n"
        "property double angle\nelement edge 10\nproperty int vertex1\nproperty int vertex2\nend_header\n";
    ASSERT_TRUE(written.starts_with("ply\nformat binary_little_endian 1.0\n"));
    std::size_t at = written.find(header);
    ASSERT_NE(at, std::string::npos);
    at += header.size();
    for (std::size_t v = 0; v < axis.vertices.size(); ++v) {
        for (const double value : {axis.vertices[v].x, axis.vertices[v].y, axis.vertices[v].z, axis.radii[v]}) {
            EXPECT_EQ(take<double>(written, at), value);
        }
        EXPECT_EQ(take<std::int32_t>(written, at), axis.vertex_origins[v].ball);
    }
    for (std::size_t f = 0; f < axis.faces.size(); ++f) {
        ASSERT_EQ(take<std::uint8_t>(written, at), axis.faces[f].size());
        for (const Index v : axis.faces[f]) {
            EXPECT_EQ(take<std::int32_t>(written, at), v);
        }
        EXPECT_EQ(take<std::int32_t>(written, at), axis.face_sheets[f]);
        EXPECT_EQ(take<double>(written, at), axis.face_angles[f]);
    }
    for (const auto& [a, b] : axis.edges) {
        EXPECT_EQ(take<std::int32_t>(written, at), a);
        EXPECT_EQ(take<std::int32_t>(written, at), b);
    }
    EXPECT_EQ(at, written.size());

    // The same file is a mesh and a union of balls.
    EXPECT_EQ(read_mesh(path("axis.ply")).triangles.size(), 5u);
    EXPECT_EQ(read_mesh(path("axis.ply")).vertices, axis.vertices);
    const std::vector<Ball> balls = read_balls(path("axis.ply"));
    ASSERT_EQ(balls.size(), axis.vertices.size());
    for (std::size_t v = 0; v < balls.size(); ++v) {
        EXPECT_EQ(balls[v], (Ball{axis.vertices[v], axis.radii[v]}));
    }
}

TEST_F(Io, WritesFacesOfManyCornersAsPly) {
    MedialComplex axis;
    std::vector<Index> corners;
    std::vector<Index> sides;
    for (Index i = 0; i < 300; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / 300.0;
        axis.vertices.push_back({std::cos(angle), std::sin(angle), 0.0});
        axis.edges.push_back(i < 299 ? Edge{i, i + 1} : Edge{0, i});
        corners.push_back(i);
        sides.push_back(i);
    }
    axis.radii.assign(300, 0.5);
    axis.vertex_origins.resize(300);
    axis.faces.push_back(corners);
    axis.face_edges.push_back(sides);
    axis.face_angles = {45.0};
    axis.face_sheets = {0};
    axis.sheets = 1;
    for (const bool has_polygons : {false, true}) {
        write_axis(path("axis.ply"), axis, {}, {.has_polygons = has_polygons});
        EXPECT_EQ(read_mesh(path("axis.ply")).triangles.size(), 298u);
        EXPECT_EQ(read_axis(path("axis.ply")).faces.items, axis.faces.items);
    }
}

TEST_F(Io, WritesAnAxisAsMa) {
    const MedialComplex axis = sample_axis();
    write_axis(path("axis.ma"), axis);
    std::istringstream in(content("axis.ma"));
    std::size_t vertices = 0;
    std::size_t edges = 0;
    std::size_t triangles = 0;
    in >> vertices >> edges >> triangles;
    ASSERT_EQ(vertices, axis.vertices.size());
    ASSERT_EQ(edges, 13u);  // ten, one diagonal of the square, two of the pentagon
    ASSERT_EQ(triangles, 5u);
    std::string token;
    for (std::size_t v = 0; v < vertices; ++v) {
        std::array<std::string, 4> values;
        in >> token >> values[0] >> values[1] >> values[2] >> values[3];
        ASSERT_EQ(token, "v");
        EXPECT_EQ(std::stod(values[0]), axis.vertices[v].x);
        EXPECT_EQ(std::stod(values[1]), axis.vertices[v].y);
        EXPECT_EQ(std::stod(values[2]), axis.vertices[v].z);
        EXPECT_EQ(std::stod(values[3]), axis.radii[v]);
    }
    std::set<Edge> listed;
    for (std::size_t e = 0; e < edges; ++e) {
        Edge edge;
        in >> token >> edge[0] >> edge[1];
        ASSERT_EQ(token, "e");
        std::ranges::sort(edge);
        EXPECT_TRUE(listed.insert(edge).second) << "edge " << edge[0] << ' ' << edge[1] << " twice";
    }
    for (const Edge& edge : axis.edges) {
        EXPECT_TRUE(listed.contains(edge));
    }
    for (std::size_t f = 0; f < triangles; ++f) {
        Triangle triangle;
        in >> token >> triangle[0] >> triangle[1] >> triangle[2];
        ASSERT_EQ(token, "f");
        std::ranges::sort(triangle);
        EXPECT_TRUE(listed.contains({triangle[0], triangle[1]}));
        EXPECT_TRUE(listed.contains({triangle[1], triangle[2]}));
        EXPECT_TRUE(listed.contains({triangle[0], triangle[2]}));
    }
    EXPECT_FALSE(in >> token) << token;
}

TEST_F(Io, ListsADiagonalOfTwoFacesOnceInMa) {
    // Two quadrilaterals over the same diagonal, and an edge of the complex along it.
    MedialComplex axis;
    axis.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    axis.radii.assign(6, 1.0);
    axis.vertex_origins.resize(6);
    for (const bool is_edge : {false, true}) {
        axis.edges = {{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 4}, {2, 4}, {2, 5}, {0, 5}};
        if (is_edge) {
            axis.edges.push_back({0, 2});
        }
        axis.faces = {};
        axis.face_edges = {};
        axis.faces.push_back(std::vector<Index>{0, 1, 2, 3});
        axis.faces.push_back(std::vector<Index>{0, 4, 2, 5});
        axis.face_edges.push_back(std::vector<Index>{0, 1, 2, 3});
        axis.face_edges.push_back(std::vector<Index>{4, 5, 6, 7});
        axis.face_angles = {1.0, 2.0};
        axis.face_sheets = {0, 1};
        axis.sheets = 2;
        write_axis(path("axis.ma"), axis);
        const std::string written = content("axis.ma");
        EXPECT_TRUE(written.starts_with("6 9 4\n")) << written;
        EXPECT_EQ(written.find("e 0 2\n"), written.rfind("e 0 2\n"));
        EXPECT_NE(written.find("e 0 2\n"), std::string::npos);
    }
}

TEST_F(Io, WritesAnAxisAsObj) {
    const MedialComplex axis = sample_axis();
    write_axis(path("axis.obj"), axis);
    const TriangleMesh mesh = read_mesh(path("axis.obj"));
    EXPECT_EQ(mesh.vertices, axis.vertices);
    EXPECT_EQ(mesh.triangles.size(), 5u);
    const std::string written = content("axis.obj");
    EXPECT_NE(written.find("\ng curve_0\nl 4 8\nl 8 9\ng sheet_0\nf 2 7 6 5 3\ng sheet_1\nf 1 2 3 4\n"),
              std::string::npos)
        << written;
    EXPECT_EQ(written.find("\nl 1 2"), std::string::npos) << "a side of a face is no curve";
    std::vector<double> radii;
    for (std::size_t at = written.find("\n#r "); at != written.npos; at = written.find("\n#r ", at + 1)) {
        radii.push_back(std::stod(written.substr(at + 4)));
    }
    EXPECT_EQ(radii, axis.radii);
}

/// The numbers of the array of this name.
std::vector<double> vtk_array(const std::string& written, const std::string& name, std::size_t from = 0) {
    const std::size_t begin = written.find('>', written.find("Name=\"" + name + "\"", from)) + 1;
    std::istringstream in(written.substr(begin, written.find('<', begin) - begin));
    std::vector<double> values;
    for (std::string word; in >> word;) {
        values.push_back(std::stod(word));
    }
    return values;
}

TEST_F(Io, LabelsOfAnAxis) {
    const MedialComplex one = sample_axis();
    MedialComplex all;
    append_labelled(all, one, 7);
    append_labelled(all, one, -2);
    check(all);
    const auto count = static_cast<Index>(one.vertices.size());
    EXPECT_EQ(all.vertices.size(), 2 * one.vertices.size());
    EXPECT_EQ(all.sheets, 2 * one.sheets);
    EXPECT_EQ(all.edges.back()[0], one.edges.back()[0] + count);
    EXPECT_EQ(all.face_sheets.back(), one.face_sheets.back() + one.sheets);
    EXPECT_EQ(std::ranges::count(all.vertex_labels, 7), count);

    write_axis(path("all.ply"), all);
    const MedialComplex read = read_axis(path("all.ply"));
    EXPECT_EQ(read.vertices, all.vertices);
    EXPECT_EQ(read.edges.size(), all.edges.size());
    EXPECT_EQ(read.faces.items, all.faces.items);
    EXPECT_EQ(read.face_sheets, all.face_sheets);
    EXPECT_EQ(read.vertex_labels, all.vertex_labels);

    write_axis(path("all.vtp"), all);
    const std::string written = content("all.vtp");
    std::vector<double> labels(2 * one.vertices.size(), 7.0);
    std::fill_n(labels.begin() + count, count, -2.0);
    EXPECT_EQ(vtk_array(written, "label"), labels);
    // Isolated balls, curves, faces: of either label.
    EXPECT_EQ(vtk_array(written, "label", written.find("<CellData")),
              (std::vector<double>{7, -2, 7, 7, -2, -2, 7, 7, -2, -2}));

    all.vertex_labels.pop_back();
    EXPECT_THROW(write_axis(path("bad.ply"), all), UnusableInput);
}

TEST_F(Io, WritesAnAxisAsVtp) {
    using Values = std::vector<double>;
    const MedialComplex axis = sample_axis();
    write_axis(path("axis.vtp"), axis);
    const std::string written = content("axis.vtp");
    EXPECT_NE(written.find("<Piece NumberOfPoints=\"10\" NumberOfVerts=\"1\" NumberOfLines=\"2\" NumberOfStrips=\"0\" "
                           "NumberOfPolys=\"2\">"),
              std::string::npos);
    EXPECT_EQ(vtk_array(written, "radius"), axis.radii);
    Values numbers(axis.vertex_origins.size());
    std::ranges::transform(axis.vertex_origins, numbers.begin(), stored_number);
    EXPECT_EQ(vtk_array(written, "ball"), numbers);
    EXPECT_EQ(vtk_array(written, "sheet"), (Values{-1, -1, -1, 1, 0}));
    EXPECT_EQ(vtk_array(written, "angle"), (Values{0, 0, 0, 89.9, 1.0 / 7.0}));
    const Values points = vtk_array(written, "Points");
    ASSERT_EQ(points.size(), 30u);
    for (std::size_t v = 0; v < 10; ++v) {
        EXPECT_EQ((Point{points[3 * v], points[3 * v + 1], points[3 * v + 2]}), axis.vertices[v]);
    }
    const auto cells = [&](const std::string& kind) {
        const std::size_t at = written.find("<" + kind + ">");
        return std::pair(vtk_array(written, "connectivity", at), vtk_array(written, "offsets", at));
    };
    EXPECT_EQ(cells("Verts"), std::pair(Values{9}, Values{1}));
    EXPECT_EQ(cells("Lines"), std::pair(Values{3, 7, 7, 8}, Values{2, 4}));
    EXPECT_EQ(cells("Polys"), std::pair(Values{0, 1, 2, 3, 1, 6, 5, 4, 2}, Values{4, 9}));

    // Every tag is closed, in order.
    std::vector<std::string> open;
    for (std::size_t at = written.find('<', 2); at != written.npos; at = written.find('<', at + 1)) {
        const std::size_t end = written.find_first_of(" >", at);
        const std::string tag = written.substr(at + 1, end - at - 1);
        if (tag.starts_with('/')) {
            ASSERT_FALSE(open.empty());
            EXPECT_EQ(open.back(), tag.substr(1));
            open.pop_back();
        } else {
            open.push_back(tag);
        }
    }
    EXPECT_TRUE(open.empty());
}

/// What Khronos' validator says of such files is among the tests in viewer/test.
TEST_F(Io, WritesAnAxisAsGlb) {
    const MedialComplex axis = sample_axis();
    write_axis(path("axis.glb"), axis);
    const std::string written = content("axis.glb");
    const auto word = [&](std::size_t at) {
        std::uint32_t value = 0;
        std::memcpy(&value, written.data() + at, sizeof(value));
        return value;
    };
    ASSERT_EQ(written.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2U);
    EXPECT_EQ(word(8), written.size());
    const std::size_t length = word(12);
    EXPECT_EQ(written.substr(16, 4), "JSON");
    EXPECT_EQ(length % 4, 0U);
    const auto json = nlohmann::json::parse(written.substr(20, length));
    EXPECT_EQ(written.substr(24 + length, 4), std::string("BIN\0", 4));
    EXPECT_EQ(word(20 + length), written.size() - length - 28);
    EXPECT_EQ(json["buffers"][0]["byteLength"], word(20 + length));

    const auto words = [&](const nlohmann::json& accessor, std::size_t components) {
        const std::size_t offset = json["bufferViews"][accessor["bufferView"].get<std::size_t>()]["byteOffset"];
        std::vector<std::uint32_t> result;
        for (std::size_t i = 0; i < accessor["count"].get<std::size_t>() * components; ++i) {
            result.push_back(word(28 + length + offset + 4 * i));
        }
        return result;
    };
    const auto& primitives = json["meshes"][0]["primitives"];
    ASSERT_EQ(primitives.size(), 4U);
    const std::vector<std::vector<std::uint32_t>> expected{
        {1, 6, 5, 1, 5, 4, 1, 4, 2}, {0, 1, 2, 0, 2, 3}, {3, 7, 7, 8}, {9}};
    const int modes[] = {4, 4, 1, 0};  // triangles, lines, points
    const std::vector<std::string> names{"sheet 0", "sheet 1", "curves", "isolated balls"};
    std::set<nlohmann::json> colors;
    const auto& middle = json["nodes"][0]["translation"];
    for (std::size_t p = 0; p < 4; ++p) {
        EXPECT_EQ(primitives[p]["mode"], modes[p]);
        const auto& material = json["materials"][primitives[p]["material"].get<std::size_t>()];
        EXPECT_EQ(material["name"], names[p]);
        colors.insert(material["pbrMetallicRoughness"]["baseColorFactor"]);
        EXPECT_EQ(words(json["accessors"][primitives[p]["indices"].get<std::size_t>()], 1), expected[p]);
        const auto& positions = json["accessors"][primitives[p]["attributes"]["POSITION"].get<std::size_t>()];
        const auto& radii = json["accessors"][primitives[p]["attributes"]["_RADIUS"].get<std::size_t>()];
        const std::vector<std::uint32_t> coordinates = words(positions, 3);
        const std::vector<std::uint32_t> radius = words(radii, 1);
        for (std::size_t v = 0; v < axis.vertices.size(); ++v) {
            EXPECT_EQ(std::bit_cast<float>(radius[v]), static_cast<float>(axis.radii[v]));
            EXPECT_NEAR(std::bit_cast<float>(coordinates[3 * v]) + middle[0].get<double>(), axis.vertices[v].x, 1e-6);
            EXPECT_NEAR(std::bit_cast<float>(coordinates[3 * v + 2]) + middle[2].get<double>(), axis.vertices[v].z,
                        1e-6);
        }
        EXPECT_NEAR(positions["min"][1].get<double>() + middle[1].get<double>(), -2.0, 1e-6);
        EXPECT_NEAR(positions["max"][1].get<double>() + middle[1].get<double>(), 9.0, 1e-6);
    }

    EXPECT_EQ(colors.size(), 3U) << "one of each sheet, one of curves and balls";

    const TriangleMesh large{{{0, 0, 0}, {1e39, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
    expect_error(
        [&] {
            write_surface(path("large.glb"), large, std::vector<VertexValues>{{"depth", {1, 2, 3}}});
        },
        {"large", ".ply"});
}

TEST_F(Io, NamesTheFaultOfABadSurfaceOfVtk) {
    const std::string good =
        "# vtk DataFile Version 4.2\na tetrahedron\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1.5 0 0\n0 2.25 0\n"
        "0 0 -3.125\nMETADATA\nINFORMATION 0\n\nPOLYGONS 4 16\n3 0 1 2\n3 0 3 1\n3 1 3 2\n3 2 3 0\nPOINT_DATA 4\n";
    EXPECT_EQ(read_mesh(write("good.vtk", good)).triangles.size(), 4u);
    const auto expect = [&](const std::string& from, const std::string& to, const std::vector<std::string>& words) {
        SCOPED_TRACE(from + " -> " + to);
        expect_error([&] { read_mesh(write("bad.vtk", replaced(good, from, to))); }, words);
    };
    expect("POINTS 4", "POINTS 400000000", {"1200000000 numbers", "line 6"});
    expect("1.5", "1,5", {"line 6", "'1,5'"});
    expect("3 0 3 1", "7 0 3 1", {"line 12", "cells"});
    expect("3 0 3 1", "99 0 3 1", {"line 12", "99 corners"});
    expect("3 0 3 1", "3 0 3 1.5", {"line 14", "'1.5'"});
    expect("3 0 3 1", "3 0 3 4", {"face 2 of 4", "does not exist"});
    expect("4 16", "5 16", {"line 12", "4 cells, not 5"});
    expect("POLYGONS", "CELLS", {"line 12", "'cells'"});
    expect("POLYDATA", "UNSTRUCTURED_GRID", {"Extract Surface"});
    expect_error([&] { read_mesh(write("words.vtp", "Dear reader,\n")); }, {"words.vtp", "no XML"});
    write_axis(path("axis.vtp"), sample_axis());
    expect_error([&] { read_mesh(path("axis.vtp")); }, {"axis", ".ma"});
    const std::string xml =
        content(std::string(SCALEAXIS_SOURCE_DIR "/tests/fuzz/corpus/mesh/vtk-quads-ascii-0-0-32.vtp"));
    expect_error([&] { read_mesh(write("few.vtp", replaced(xml, "NumberOfPoints=\"8\"", "NumberOfPoints=\"9\""))); },
                 {"'Points'", "27 numbers"});
}

TEST_F(Io, WritesAnEmptyAxis) {
    for (const std::string name : {"axis.ply", "axis.ma", "axis.obj", "axis.vtp", "axis.glb"}) {
        write_axis(path(name), MedialComplex{});
    }
    EXPECT_EQ(content("axis.ma"), "0 0 0\n");
    EXPECT_TRUE(read_axis(path("axis.ply")).vertices.empty());
    EXPECT_NE(content("axis.vtp").find("<Piece NumberOfPoints=\"0\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "),
              std::string::npos);
    EXPECT_EQ(content("axis.obj").find("\nv "), std::string::npos);
    EXPECT_TRUE(content("axis.glb").starts_with("glTF"));
}

// ---------------------------------------------------------------------------------------------------------------------
// Axes in
// ---------------------------------------------------------------------------------------------------------------------

std::set<Edge> edge_set(const MedialComplex& axis) { return {axis.edges.begin(), axis.edges.end()}; }

TEST_F(Io, AnAxisComesBackFromPlyAsItWas) {
    const MedialComplex axis = sample_axis();
    for (const bool has_polygons : {false, true}) {
        SCOPED_TRACE(has_polygons);
        const AxisFileOptions options{.has_polygons = has_polygons};
        write_axis(path("axis.ply"), axis, {}, options);
        const MedialComplex read = read_axis(path("axis.ply"));
        expect_consistent(read);
        EXPECT_EQ(read.vertices, axis.vertices);
        EXPECT_EQ(read.radii, axis.radii);
        EXPECT_EQ(read.vertex_origins, axis.vertex_origins);
        EXPECT_EQ(edge_set(read), edge_set(axis));
        EXPECT_EQ(read.faces.items, axis.faces.items);
        EXPECT_EQ(read.faces.offsets, axis.faces.offsets);
        EXPECT_EQ(read.face_angles, axis.face_angles);
        EXPECT_EQ(read.face_sheets, axis.face_sheets);
        EXPECT_EQ(read.sheets, axis.sheets);
        EXPECT_EQ(topology(read), topology(axis));
        // Once more: what was read is written as the same bytes.
        write_axis(path("again.ply"), read, {}, options);
        write_axis(path("third.ply"), read_axis(path("again.ply")), {}, options);
        EXPECT_EQ(content("third.ply"), content("again.ply"));
    }
}

TEST_F(Io, AnAxisInPlySaysByWhichFactorItsBallsHadBeenGrown) {
    const MedialComplex plain = sample_axis();
    const MedialComplex axis = test::with_scale(plain, 1.1);
    for (const bool has_polygons : {false, true}) {
        write_axis(path("axis.ply"), axis, {}, {.has_polygons = has_polygons});
        EXPECT_EQ(stored_scale(path("axis.ply")), 1.1);
        EXPECT_EQ(read_axis(path("axis.ply")).scale, 1.1);
        EXPECT_EQ(read_axis(path("axis.ply")).vertices, axis.vertices);
        write_axis(path("plain.ply"), plain, {}, {.has_polygons = has_polygons});
        EXPECT_EQ(stored_scale(path("plain.ply")), std::nullopt);
        EXPECT_EQ(read_axis(path("plain.ply")).scale, 1.0);
    }
    write_axis(path("axis.ma"), axis);
    EXPECT_EQ(stored_scale(path("axis.ma")), std::nullopt);
    const std::string rest =
        "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property float radius\nend_header\n0 0 0 1\ncomment scale 3\n";
    for (const char* comment : {"comment scale", "comment scale big", "comment scale 0.5", "comment scale inf",
                                "comment scale nan", "comment scaled 2", "obj_info scale 2"}) {
        const auto file = write("other.ply", std::string("ply\nformat ascii 1.0\n") + comment + "\n" + rest);
        EXPECT_EQ(stored_scale(file), std::nullopt) << comment;
        EXPECT_EQ(read_axis(file).scale, 1.0) << comment;
    }
    EXPECT_EQ(stored_scale(write("other.ply", "ply\nformat ascii 1.0\ncomment scale 2\n" + rest)), 2.0);
    EXPECT_THROW(stored_scale(path("absent.ply")), FileError);
}

TEST_F(Io, TrianglesOfOnePolygonThatAreNoFanStayTriangles) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
        "property float radius\nelement face 4\nproperty list uchar int vertex_indices\nproperty int sheet\n"
        "property int polygon\nend_header\n"
        "0 0 0 1\n1 0 0 1\n1 1 0 1\n0 1 0 1\n2 0 0 1\n2 1 0 1\n";
    const auto sizes = [&](const std::string& faces) {
        const MedialComplex axis = read_axis(write("axis.ply", head + faces));
        expect_consistent(axis);
        std::vector<std::size_t> result{axis.edges.size()};
        for (std::size_t f = 0; f < axis.faces.size(); ++f) {
            result.push_back(axis.faces[f].size());
        }
        return result;
    };
    using Sizes = std::vector<std::size_t>;  // edges, then the corners of each face
    EXPECT_EQ(sizes("3 0 1 2 0 7\n3 0 2 3 0 7\n3 1 4 5 1 8\n3 1 5 2 1 8\n"), (Sizes{7, 4, 4}));
    EXPECT_EQ(sizes("3 0 1 2 0 7\n3 0 2 3 0 6\n3 1 4 5 1 8\n3 1 5 2 1 8\n"), (Sizes{8, 3, 3, 4})) << "other polygons";
    EXPECT_EQ(sizes("3 0 1 2 0 7\n3 2 3 0 0 7\n3 1 4 5 1 8\n3 1 5 2 1 8\n"), (Sizes{8, 3, 3, 4})) << "turned round";
    EXPECT_EQ(sizes("3 0 2 3 0 7\n3 0 1 2 0 7\n3 1 4 5 1 8\n3 1 5 2 1 8\n"), (Sizes{8, 3, 3, 4})) << "exchanged";
    EXPECT_EQ(sizes("3 0 1 2 0 7\n3 0 2 3 0 7\n3 2 5 5 -1 -1\n3 1 4 4 -1 -1\n"), (Sizes{6, 4})) << "two curves";
}

TEST_F(Io, AnAxisComesBackFromMaAsTriangles) {
    const MedialComplex axis = sample_axis();
    write_axis(path("axis.ma"), axis);
    const MedialComplex read = read_axis(path("axis.ma"));
    expect_consistent(read);
    EXPECT_EQ(read.vertices, axis.vertices);
    EXPECT_EQ(read.radii, axis.radii);
    EXPECT_EQ(read.faces.size(), 5u);
    EXPECT_EQ(read.edges.size(), 13u);
    for (const Edge& edge : axis.edges) {
        EXPECT_TRUE(edge_set(read).contains(edge));
    }
    EXPECT_EQ(read.sheets, 1) << "the two polygons have a side that no third one has";
    EXPECT_EQ(read.face_angles, std::vector<double>(5, 0.0));
    EXPECT_EQ(read.vertex_origins, std::vector<VertexOrigin>(10, {VertexKind::kTouching}));
    EXPECT_EQ(topology(read), topology(axis));
    const MedialComplex of_union = read_axis(path("axis.ma"), 1.1);
    EXPECT_EQ(of_union.vertex_origins, std::vector<VertexOrigin>(10));
    EXPECT_EQ(of_union.scale, 1.1);
}

TEST_F(Io, AnEmptyAxisComesBack) {
    for (const std::string name : {"axis.ply", "axis.ma"}) {
        write_axis(path(name), MedialComplex{});
        const MedialComplex read = read_axis(path(name));
        expect_consistent(read);
        EXPECT_TRUE(read.vertices.empty());
        EXPECT_EQ(read.sheets, 0);
    }
}

const std::string kMa = "4 2 1\nv 0 0 0 1\nv 1 0 0 0.5\nv 0 1 0 0.25\nv 0 0 9 0\ne 2 0\ne 3 0\nf 0 1 2\n";
const std::string kAxisPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "property float radius\nelement face 1\nproperty list uchar int vertex_indices\n"
    "element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n"
    "0 0 0 1\n1 0 0 0.5\n0 1 0 0.25\n0 0 9 0\n3 0 1 2\n2 0\n3 0\n";

TEST_F(Io, ReadsAxesOfOtherPrograms) {
    for (const std::string& dialect : {kMa, replaced(kMa, "\n", "\r\n"), "# medial axis\n" + replaced(kMa, " ", "\t"),
                                       replaced(kMa, "4 2 1", "4 4 1\n\n") /* repeated and turned edges */, kAxisPly,
                                       replaced(kAxisPly, "indices", "index")}) {
        SCOPED_TRACE(dialect);
        const bool has_more_edges = dialect.find("4 4 1") != dialect.npos;
        const std::string text = has_more_edges ? replaced(dialect, "e 3 0\n", "e 3 0\ne 0 3\ne 0 2\n") : dialect;
        for (const std::string name : {"axis", "axis.ma", "axis.ply"}) {
            const MedialComplex axis = read_axis(write(name, text));
            expect_consistent(axis);
            EXPECT_EQ(axis.radii, (std::vector<double>{1, 0.5, 0.25, 0}));
            EXPECT_EQ(axis.edges, (std::vector<Edge>{{0, 1}, {0, 2}, {0, 3}, {1, 2}}));
            EXPECT_EQ(axis.faces.items, (std::vector<Index>{0, 1, 2}));
            EXPECT_EQ(axis.face_sheets, std::vector<Index>{0});
            EXPECT_EQ(axis.sheets, 1);
        }
    }
}

TEST_F(Io, NamesTheFaultOfABadAxis) {
    const std::string sheets = replaced(kAxisPly, "vertex_indices\n", "vertex_indices\nproperty int sheet\n");
    const std::string angles = replaced(kAxisPly, "vertex_indices\n", "vertex_indices\nproperty float angle\n");
    struct Case {
        std::string name;
        std::string content;
        std::vector<std::string> words;
    };
    const std::vector<Case> cases{
        {"edge.ma", replaced(kMa, "e 3 0", "e 4 0"), {"edge 2 of 2", "does not exist", "4"}},
        {"edge.ply", replaced(kAxisPly, "\n3 0\n", "\n-1 0\n"), {"edge 2 of 2", "does not exist"}},
        {"real.ply",
         replaced(replaced(kAxisPly, "int vertex1", "float vertex1"), "\n3 0\n", "\n2.5 0\n"),
         {"edge 2 of 2", "does not exist"}},
        {"loop.ma", replaced(kMa, "e 3 0", "e 3 3"), {"edge 2 of 2", "itself"}},
        {"face.ma", replaced(kMa, "f 0 1 2", "f 0 1 4"), {"face 1 of 1", "does not exist"}},
        {"minus.ma", replaced(kMa, "f 0 1 2", "f 0 -1 2"), {"face 1 of 1", "does not exist"}},
        {"face.ply", replaced(kAxisPly, "3 0 1 2", "3 0 1 7"), {"face 1 of 1", "does not exist"}},
        {"two.ply", replaced(kAxisPly, "3 0 1 2", "2 0 1"), {"face 1 of 1", "fewer than three corners"}},
        {"twice.ma", replaced(kMa, "f 0 1 2", "f 0 1 0"), {"face 1 of 1", "corner twice"}},
        {"again.ma",
         replaced(replaced(kMa, "4 2 1", "4 2 3"), "f 0 1 2\n", "f 0 1 2\nf 0 1 3\nf 1 2 0\n"),
         {"face 3 of 3", "same corners as another"}},
        {"negative.ma", replaced(kMa, "0.5", "-0.5"), {"vertex 2 of 4", "radius -0.5"}},
        {"negative.ply", replaced(kAxisPly, "0.5", "-0.5"), {"vertex 2 of 4", "radius -0.5"}},
        {"nan.ma", replaced(kMa, "0.5", "nan"), {"vertex 2 of 4", "radius"}},
        {"inf.ply", replaced(kAxisPly, "0.5", "inf"), {"vertex 2 of 4", "radius"}},
        {"point.ma", replaced(kMa, "v 1 0 0", "v 1 inf 0"), {"vertex 2 of 4", "coordinate"}},
        {"none.ply", replaced(kAxisPly, "float radius", "float r"), {"'vertex'", "'radius'"}},
        {"none.ma", replaced(kMa, "1 0 0 0.5", "1 0 0"), {"line 3", "a number is missing"}},
        {"more.ma", replaced(kMa, "0.5", "0.5 7"), {"line 3", "'7'", "end"}},
        {"quad.ma", replaced(kMa, "f 0 1 2", "f 0 1 2 3"), {"line 8", "'3'", "end"}},
        {"ends.ply", replaced(kAxisPly, "vertex2", "other"), {"'edge'", "'vertex2'"}},
        {"sheet.ply", replaced(sheets, "3 0 1 2", "3 0 1 2 1"), {"face 1 of 1", "sheet"}},
        {"minus_sheet.ply", replaced(sheets, "3 0 1 2", "3 0 1 2 -1"), {"face 1 of 1", "sheet"}},
        {"angle.ply", replaced(angles, "3 0 1 2", "3 0 1 2 nan"), {"face 1 of 1", "angle"}},
        {"fewer.ma", replaced(kMa, "4 2 1", "3 2 1"), {"line 5", "'v'", "`e`"}},
        {"later.ma", replaced(kMa, "4 2 1", "4 2 0"), {"line 8", "'f'", "counts"}},
        {"truncated.ma", kMa.substr(0, kMa.size() - 8), {"truncated", "`f`"}},
        {"count.ma", replaced(kMa, "4 2 1", "4000000000 2 1"), {"line 1", "4000000000 vertices"}},
        {"minus_count.ma", replaced(kMa, "4 2 1", "4 -2 1"), {"line 1", "-2 edges"}},
        {"words.ma", "Dear reader,\n", {"line 1", "'Dear'"}},
        {"mesh.off", kOff, {".ply", ".ma"}},
        {"empty.ma", "", {"empty"}},
    };
    for (const auto& [name, text, words] : cases) {
        SCOPED_TRACE(name);
        std::vector<std::string> expected = words;
        expected.push_back(path(name).string());
        const auto file = write(name, text);
        expect_error([&] { read_axis(file); }, expected);
    }
}

TEST_F(Io, EveryTruncationOfAnAxisIsAnErrorOrTheAxisItself) {
    write_axis(path("axis.ply"), sample_axis());
    for (const std::string& whole : {content("axis.ply"), kAxisPly, kMa}) {
        const fs::path file = write("axis.x", whole);
        for (std::size_t size = whole.size() - 1; size-- > 0;) {
            fs::resize_file(file, size);
            SCOPED_TRACE(whole.substr(0, 20) + "… up to " + std::to_string(size));
            if (error_of([&] { read_axis(file); }).empty()) {
                EXPECT_LT(whole.size() - size, 3u) << "only the last number may lose digits";
            }
        }
    }
}

TEST_F(Io, KnowsWhatAFileHolds) {
    const std::vector<Ball> balls{{{0, 0, 0}, 1}};
    for (const std::string name : {"balls.ply", "balls.txt", "balls.woff", "balls.xyzr"}) {
        write_balls(path(name), balls);
        EXPECT_EQ(file_kind(path(name)), FileKind::kBalls) << name;
    }
    for (const std::string name : {"axis.ply", "axis.ma"}) {
        write_axis(path(name), sample_axis());
        EXPECT_EQ(file_kind(path(name)), FileKind::kAxis) << name;
        fs::rename(path(name), path("axis"));
        EXPECT_EQ(file_kind(path("axis")), FileKind::kAxis) << "by its content";
    }
    for (const std::string& mesh : {kOff, kObj, kPly, ascii_stl(false), binary_stl("comment")}) {
        EXPECT_EQ(file_kind(write("mesh", mesh)), FileKind::kMesh);
    }
    EXPECT_EQ(file_kind(write("mesh.off", kOff.substr(4))), FileKind::kMesh) << "without its keyword, by its name";
    expect_error([&] { file_kind(write("words", "Dear reader,\n")); }, {"words", ".ply", ".ma", ".txt"});
    expect_error([&] { file_kind(path("absent.ma")); }, {"absent.ma", "No such file"});
}

// ---------------------------------------------------------------------------------------------------------------------
// Writing that fails
// ---------------------------------------------------------------------------------------------------------------------

TEST_F(Io, WritesNothingThatItWouldNotRead) {
    const double nan = std::nan("");
    TriangleMesh without_vertex{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}};
    TriangleMesh not_finite{{{0, 0, 0}, {1, 0, 0}, {0, nan, 0}}, {{0, 1, 2}}};
    for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl"}) {
        EXPECT_THROW(write_mesh(path(name), without_vertex), UnusableInput) << name;
        EXPECT_THROW(write_mesh(path(name), not_finite), UnusableInput) << name;
    }
    for (const char* name : {"a.ply", "a.vtp", "a.glb"}) {
        EXPECT_THROW(write_surface(path(name), without_vertex, {{{"value", {1, 2, 3}}}}), UnusableInput) << name;
        EXPECT_THROW(write_surface(path(name), not_finite, {{{"value", {1, 2, 3}}}}), UnusableInput) << name;
    }
    for (const Ball& ball : {Ball{{nan, 0, 0}, 1}, Ball{{0, 0, 0}, -1}, Ball{{0, 0, 0}, nan}}) {
        EXPECT_THROW(write_balls(path("a.txt"), std::span(&ball, 1)), UnusableInput);
    }
    EXPECT_TRUE(names().empty());
}

TEST_F(Io, RefusesNamesOfNoFormat) {
    const std::vector<Ball> balls{{{0, 0, 0}, 1}};
    expect_error([&] { write_balls(path("a.stl"), balls); }, {"a.stl", ".ply", ".woff"});
    expect_error([&] { write_axis(path("axis"), sample_axis()); }, {"axis", ".ply", ".ma", ".vtp", ".obj"});
    expect_error([&] { check_balls_output(path("a.vtp")); }, {"a.vtp", ".woff"});
    expect_error([&] { check_axis_output(path("a.woff")); }, {"a.woff", ".vtp"});
    EXPECT_TRUE(names().empty());
}

TEST_F(Io, RefusesPlacesThatCannotBeWritten) {
    const std::vector<Ball> balls{{{0, 0, 0}, 1}};
    fs::create_directory(path("folder.ply"));
    write("file", "");
    for (const std::string name : {"absent/a.ply", "folder.ply", "file/a.ply"}) {
        SCOPED_TRACE(name);
        expect_error([&] { write_balls(path(name), balls); }, {"cannot write", name});
        expect_error([&] { write_axis(path(name), sample_axis()); }, {"cannot write", name});
        expect_error([&] { check_balls_output(path(name)); }, {"cannot write", name});
        expect_error([&] { check_axis_output(path(name)); }, {"cannot write", name});
    }
    EXPECT_EQ(names(), (std::set<std::string>{"folder.ply", "file"}));
}

TEST_F(Io, ChecksLeaveNothingBehind) {
    check_balls_output(path("a.ply"));
    check_axis_output(path("a.vtp"));
    EXPECT_TRUE(names().empty());
    write("a.ply", "old");
    check_axis_output(path("a.ply"));
    EXPECT_EQ(content("a.ply"), "old");
    EXPECT_EQ(names(), std::set<std::string>{"a.ply"});
}

#if defined(SCALEAXIS_HAS_LIMITS)

/// Lets no file of this process grow beyond a size, as a full disk would.
class FileSizeLimit {
   public:
    explicit FileSizeLimit(rlim_t size) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &previous_);
        const rlimit limit{size, previous_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &previous_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

   private:
    rlimit previous_{};
    void (*handler_)(int);
};

TEST_F(Io, AFullDiskKeepsTheOldFileAndLeavesNoTemporaryOne) {
    for (const std::size_t count : {std::size_t{300}, std::size_t{100'000}}) {  // below and above the buffer's size
        const std::vector<Ball> balls(count, Ball{{0.123456789, 0.2, 0.3}, 0.4});
        for (const std::string name : {"a.ply", "a.txt", "a.woff"}) {
            SCOPED_TRACE(name);
            write(name, "old");
            std::string message;
            {
                const FileSizeLimit limit(4096);
                message = error_of([&] { write_balls(path(name), balls); });
            }
            EXPECT_NE(message.find("cannot write " + path(name).string()), std::string::npos) << message;
            EXPECT_NE(message.find("space"), std::string::npos) << message;
            EXPECT_EQ(content(name), "old");
        }
    }
    EXPECT_EQ(names(), (std::set<std::string>{"a.ply", "a.txt", "a.woff"}));
}

#endif

TEST_F(Io, LeavesTheTemporaryFilesOfOthersAlone) {
    write("a.txt.part0", "of another");
    write_balls(path("a.txt"), std::vector<Ball>{{{1, 2, 3}, 4}});
    EXPECT_EQ(content("a.txt.part0"), "of another");
    EXPECT_EQ(names(), (std::set<std::string>{"a.txt", "a.txt.part0"}));
}

}  // namespace
}  // namespace scaleaxis
