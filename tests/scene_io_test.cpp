// SPDX-License-Identifier: Apache-2.0
//
// Files with several objects at places of their own: 3MF and glTF.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "file_errors.hpp"
#include "folder.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/mesh.hpp"

namespace scaleaxis {
namespace {

using test::error_of;
using test::expect_error;

namespace fs = std::filesystem;

class SceneIo : public test::FolderTest {};

/// Volume on the left of the triangles.
double volume(const TriangleMesh& mesh) {
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        sum += dot(mesh.vertices[a], cross(mesh.vertices[b], mesh.vertices[c])) / 6.0;
    }
    return sum;
}

// A tetrahedron, outward; its coordinates and all places below are exact in single precision.
const std::vector<Point> kCorners{{0, 0, 0}, {1.5, 0, 0}, {0, 2.25, 0}, {0, 0, 3.125}};
const std::vector<std::array<Index, 3>> kFaces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
const double kVolume = 1.5 * 2.25 * 3.125 / 6.0;

/// The places of the corners without order, which some formats change.
std::vector<std::array<double, 3>> places(const TriangleMesh& mesh) {
    std::vector<std::array<double, 3>> result;
    for (const Point& p : mesh.vertices) {
        result.push_back({p.x, p.y, p.z});
    }
    std::ranges::sort(result);
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

/// A tetrahedron twice as large at (2, 4, 6), and the same mirrored at x = 20.
void expect_pair(const MeshObjects& read) {
    ASSERT_EQ(read.objects.size(), 2u);
    TriangleMesh large{kCorners, kFaces};
    TriangleMesh mirrored{kCorners, kFaces};
    for (std::size_t v = 0; v < kCorners.size(); ++v) {
        const Point& p = kCorners[v];
        large.vertices[v] = {2 * p.x + 2, 2 * p.y + 4, 2 * p.z + 6};
        mirrored.vertices[v] = {20 - 2 * p.x, 2 * p.y, 2 * p.z};
    }
    EXPECT_EQ(places(read.objects[0].mesh), places(large));
    EXPECT_EQ(places(read.objects[1].mesh), places(mirrored));
    EXPECT_EQ(volume(read.objects[0].mesh), 8 * kVolume);
    EXPECT_EQ(volume(read.objects[1].mesh), 8 * kVolume) << "mirrored triangles are turned round";
    for (const MeshObject& object : read.objects) {
        EXPECT_EQ(object.mesh.triangles.size(), 4u);
    }
}

template <class T>
std::string bytes(T number) {
    return {reinterpret_cast<const char*>(&number), sizeof(number)};  // little endian, as all tests assume
}

// ---------------------------------------------------------------------------------------------------------------------
// glTF
// ---------------------------------------------------------------------------------------------------------------------

/// Corners as floats and faces as 16-bit numbers, and two corners of a line.
std::string gltf_buffer() {
    std::string result;
    for (const Point& p : kCorners) {
        result += bytes(static_cast<float>(p.x)) + bytes(static_cast<float>(p.y)) + bytes(static_cast<float>(p.z));
    }
    for (const auto& face : kFaces) {
        for (const Index v : face) {
            result += bytes(static_cast<std::uint16_t>(v));
        }
    }
    return result;
}

/// \param buffer what the buffer has besides its length, \param primitives further ones of the mesh
std::string gltf(const std::string& buffer, const std::string& primitives = "") {
    return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[
{"name":"all","scale":[2,2,2],"children":[1,2]},
{"name":"large","translation":[1,2,3],"mesh":0},
{"name":"mirrored","matrix":[-1,0,0,0, 0,1,0,0, 0,0,1,0, 10,0,0,1],"mesh":0}],
"meshes":[{"name":"tetrahedron","primitives":[{"attributes":{"POSITION":0},"indices":1})" +
           primitives + R"(]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[1.5,2.25,3.125]},
{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],
"buffers":[{)" +
           buffer + R"("byteLength":72}]})";
}

std::string glb(std::string json = gltf("")) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::string buffer = gltf_buffer();
    const auto size = [](const std::string& text) { return bytes(static_cast<std::uint32_t>(text.size())); };
    const std::string chunks = size(json) + "JSON" + json + size(buffer) + std::string("BIN\0", 4) + buffer;
    return "glTF" + bytes(std::uint32_t{2}) + bytes(static_cast<std::uint32_t>(chunks.size() + 12)) + chunks;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

std::string base64(const std::string& content) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string result;
    for (std::size_t i = 0; i + 2 < content.size(); i += 3) {  // the contents here are multiples of 3
        const auto byte = [&](std::size_t k) { return std::uint32_t{static_cast<unsigned char>(content[i + k])}; };
        const std::uint32_t word = byte(0) << 16 | byte(1) << 8 | byte(2);
        for (const int shift : {18, 12, 6, 0}) {
            result += digits[word >> shift & 63];
        }
    }
    return result;
}

MeshObjects read_bytes_of(const std::string& content, const std::string& name) {
    return read_objects(FileBytes{std::as_bytes(std::span(content)), name});
}

TEST_F(SceneIo, PlacesTheNodesOfGltf) {
    write("parts of it.bin", gltf_buffer());
    fs::create_directory(path("deeper"));
    write("deeper/part.bin", gltf_buffer());
    const std::string binary = glb();
    std::string external = gltf(R"("uri":"deeper/part.bin",)");
    external = "glTF" + bytes(std::uint32_t{2}) + bytes(static_cast<std::uint32_t>(external.size() + 20)) +
               bytes(static_cast<std::uint32_t>(external.size())) + "JSON" + external;
    for (const fs::path& file :
         {write("a.glb", binary), write("a", binary), write("longer.glb", binary + "and more"),
          write("external.glb", external), write("a.gltf", gltf(R"("uri":"parts of it.bin",)")),
          write("b.gltf", gltf(R"("uri":"deeper/part.bin",)")),
          write("c.gltf", gltf(R"("uri":"parts%20of%20it.bin",)")),
          write("bom.gltf", "\xEF\xBB\xBF \n" + gltf(R"("uri":"deeper/part.bin",)")),
          write("d.gltf", gltf(R"("uri":"data:application/octet-stream;base64,)" + base64(gltf_buffer()) + "\","))}) {
        SCOPED_TRACE(file);
        EXPECT_EQ(file_kind(file), FileKind::kMesh);
        const MeshObjects read = read_objects(file);
        expect_pair(read);
        EXPECT_EQ(read.objects[0].name, "large");
        EXPECT_EQ(read.objects[1].name, "mirrored");
        EXPECT_EQ(read.unit, "");
        EXPECT_TRUE(read.warnings.empty());
        EXPECT_EQ(read_mesh(file).vertices.size(), 8u);
        EXPECT_EQ(volume(read_mesh(file)), 16 * kVolume);
    }
    expect_pair(read_bytes_of(glb(), "upload"));
}

/// Accessors, and the buffer that they see; each starts with some bytes that are not its own.
class Accessors {
   public:
    /// \param type of OpenGL, \param more further members of the accessor, \param of_view of its view
    int add(const std::string& content, int type, std::size_t count, const std::string& shape,
            const std::string& more = "", const std::string& of_view = "") {
        accessors_ += (count_ > 0 ? "," : "") + (R"({"bufferView":)" + std::to_string(count_)) +
                      R"(,"byteOffset":4,"componentType":)" + std::to_string(type) +
                      ",\"count\":" + std::to_string(count) + ",\"type\":\"" + shape + '"' + more + '}';
        views_ += (count_ > 0 ? "," : "") + (R"({"buffer":0,"byteOffset":)" + std::to_string(buffer_.size())) +
                  ",\"byteLength\":" + std::to_string(content.size() + 4) + of_view + '}';
        buffer_ += "~~~~" + content;
        return count_++;
    }
    template <class T>
    int add(const std::vector<T>& numbers, int type, const std::string& shape, std::size_t components) {
        std::string content;
        for (const T number : numbers) {
            content += bytes(number);
        }
        return add(content, type, numbers.size() / components, shape);
    }
    int add_corners() {
        std::vector<float> numbers;
        for (const Point& p : kCorners) {
            numbers.insert(numbers.end(), {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        }
        return add(numbers, 5126, "VEC3", 3);
    }
    int add_faces() {
        std::vector<std::uint8_t> numbers;
        for (const auto& face : kFaces) {
            numbers.insert(numbers.end(), face.begin(), face.end());
        }
        return add(numbers, 5121, "SCALAR", 1);
    }

    /// A file with the nodes and meshes given, in a scene of node 0.
    std::string file(const std::string& nodes, const std::string& meshes, const std::string& more = "") const {
        return content(R"("scenes":[{"nodes":[0]}],"nodes":[)" + nodes + "],\"meshes\":[" + meshes + ']' + more);
    }
    std::string content(const std::string& members) const {
        std::string json = R"({"asset":{"version":"2.0"},)" + members + ",\"accessors\":[" + accessors_ +
                           "],\"bufferViews\":[" + views_ + R"(],"buffers":[{"byteLength":)" +
                           std::to_string(buffer_.size()) + "}]}";
        const auto size = [](const std::string& text) { return bytes(static_cast<std::uint32_t>(text.size())); };
        const std::string chunks = size(json) + "JSON" + json + size(buffer_) + std::string("BIN\0", 4) + buffer_;
        return "glTF" + bytes(std::uint32_t{2}) + bytes(static_cast<std::uint32_t>(chunks.size() + 12)) + chunks;
    }

   private:
    int count_ = 0;
    std::string buffer_;
    std::string views_;
    std::string accessors_;
};

std::string mesh_of(int position, int indices, const std::string& more = "") {
    return R"({"primitives":[{"attributes":{"POSITION":)" + std::to_string(position) + '}' +
           (indices < 0 ? "" : ",\"indices\":" + std::to_string(indices)) + more + "}]}";
}

TEST_F(SceneIo, ReadsGltfNumbersOfEveryType) {
    const auto expect = [](const std::string& content, double scale) {
        TriangleMesh expected{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, kFaces};
        for (Point& p : expected.vertices) {
            p = scale * p;
        }
        const MeshObjects read = read_bytes_of(content, "a.glb");
        ASSERT_EQ(read.objects.size(), 1u);
        EXPECT_EQ(read.objects[0].mesh.vertices, expected.vertices);
        EXPECT_EQ(read.objects[0].mesh.triangles, expected.triangles);
    };
    // Positions 0 and `one`, packed or a byte apart; indices of three types.
    const auto check = [&]<class T>(int type, T one, bool is_normalized, double scale) {
        SCOPED_TRACE(type);
        for (const std::size_t stride : {std::size_t{0}, 3 * sizeof(T) + 1}) {
            std::string content;
            for (const std::array<int, 3>& p : {std::array{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
                for (const int coordinate : p) {
                    content += bytes(coordinate == 0 ? T{} : one);
                }
                content += stride == 0 ? "" : "!";
            }
            Accessors numbers;
            const int position = numbers.add(content, type, 4, "VEC3", is_normalized ? ",\"normalized\":true" : "",
                                             stride == 0 ? "" : ",\"byteStride\":" + std::to_string(stride));
            const std::vector<std::uint32_t> corners{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};
            const int u32 = numbers.add(corners, 5125, "SCALAR", 1);
            const int u16 = numbers.add(std::vector<std::uint16_t>(corners.begin(), corners.end()), 5123, "SCALAR", 1);
            const int u8 = numbers.add(std::vector<std::uint8_t>(corners.begin(), corners.end()), 5121, "SCALAR", 1);
            for (const int indices : {u8, u16, u32}) {
                expect(numbers.file(R"({"mesh":0})", mesh_of(position, indices)), scale);
            }
        }
    };
    check(5120, std::int8_t{-128}, false, -128.0);
    check(5120, std::int8_t{127}, true, 1.0);
    check(5120, std::int8_t{-128}, true, -1.0);  // as -127
    check(5121, std::uint8_t{200}, false, 200.0);
    check(5121, std::uint8_t{51}, true, 0.2);
    check(5122, std::int16_t{-32768}, false, -32768.0);
    check(5122, std::int16_t{-32767}, true, -1.0);
    check(5123, std::uint16_t{65535}, false, 65535.0);
    check(5123, std::uint16_t{13107}, true, 0.2);
    check(5126, 1.5F, false, 1.5);
    // Corners one by one, of which the last two are no triangle.
    Accessors numbers;
    std::vector<float> list;
    for (const auto& face : kFaces) {
        for (const Index v : face) {
            const Point& p = kCorners[v];
            list.insert(list.end(), {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
        }
    }
    list.resize(list.size() + 6);
    const int position = numbers.add(list, 5126, "VEC3", 3);
    const MeshObjects read = read_bytes_of(numbers.file(R"({"mesh":0})", mesh_of(position, -1)), "a.glb");
    EXPECT_EQ(read.objects.at(0).mesh.triangles.size(), 4u);
    EXPECT_EQ(volume(read.objects.at(0).mesh), kVolume);
}

TEST_F(SceneIo, ReadsStripsAndFansOfGltf) {
    Accessors numbers;
    const int position = numbers.add_corners();
    // Round the tetrahedron, and once more with a turn.
    const int strip = numbers.add(std::vector<std::uint8_t>{0, 2, 1, 3, 0, 2}, 5121, "SCALAR", 1);
    const int fan = numbers.add(std::vector<std::uint8_t>{0, 2, 1, 3, 2}, 5121, "SCALAR", 1);
    const int last = numbers.add(std::vector<std::uint8_t>{1, 2, 3}, 5121, "SCALAR", 1);
    const auto triangles = [&](const std::string& mesh) {
        const MeshObjects read = read_bytes_of(numbers.file(R"({"mesh":0})", mesh), "a.glb");
        EXPECT_EQ(volume(read.objects.at(0).mesh), kVolume);
        EXPECT_EQ(read.objects.at(0).mesh.vertices, kCorners) << "primitives share the vertices of an accessor";
        return read.objects.at(0).mesh.triangles.size();
    };
    EXPECT_EQ(triangles(mesh_of(position, strip, ",\"mode\":5")), 4u);
    const std::string first = mesh_of(position, fan, ",\"mode\":6");
    const std::string second = mesh_of(position, last);
    EXPECT_EQ(triangles(replaced(first, "]}", "," + second.substr(second.find('[') + 1))), 4u);
}

TEST_F(SceneIo, ReadsSparseNumbersOfGltf) {
    const auto sparse = [](int count, int index_view, int value_view) {
        return R"(,"sparse":{"count":)" + std::to_string(count) +
               R"(,"indices":{"byteOffset":4,"componentType":5121,"bufferView":)" + std::to_string(index_view) +
               R"(},"values":{"byteOffset":4,"bufferView":)" + std::to_string(value_view) + "}}";
    };
    Accessors numbers;
    const int where = numbers.add(std::vector<std::uint8_t>{1, 3}, 5121, "SCALAR", 1);
    const int what = numbers.add(std::vector<float>{1.5F, 0, 0, 0, 0, 3.125F}, 5126, "VEC3", 3);
    const int faces = numbers.add_faces();
    std::string content;
    for (const float number : {0.F, 0.F, 0.F, 9.F, 9.F, 9.F, 0.F, 2.25F, 0.F, 9.F, 9.F, 9.F}) {
        content += bytes(number);
    }
    const int position = numbers.add(content, 5126, 4, "VEC3", sparse(2, where, what));
    const std::string file = numbers.file(R"({"mesh":0})", mesh_of(position, faces));
    EXPECT_EQ(read_bytes_of(file, "a.glb").objects.at(0).mesh.vertices, kCorners);
    // Without numbers of its own: all others are 0.
    const std::string view = R"({"bufferView":3,"byteOffset":4,"componentType":5126)";
    const std::string none = replaced(file, view, R"({"componentType":5126)" + std::string(view.size() - 21, ' '));
    std::vector<Point> expected = kCorners;
    expected[2] = {0, 0, 0};
    EXPECT_EQ(read_bytes_of(none, "a.glb").objects.at(0).mesh.vertices, expected);
    const auto expect = [&](const std::string& from, const std::string& to, const std::vector<std::string>& words) {
        expect_error([&] { read_bytes_of(replaced(file, from, to), "a.glb"); }, words);
    };
    expect("\x01\x03", "\x01\x04", {"replaces an element that does not exist"});
    expect("\"sparse\":{\"count\":2", "\"sparse\":{\"count\":3", {"cannot hold"});
    const std::string large = replaced(replaced(none, "      ", ""), "\"count\":4", "\"count\":9999999");
    expect_error([&] { read_bytes_of(large, "a.glb"); }, {"has no data"});
}

TEST_F(SceneIo, TurnsAndNestsTheNodesOfGltf) {
    Accessors numbers;
    const int position = numbers.add_corners();
    const std::string mesh = mesh_of(position, numbers.add_faces());
    // A quarter turn about z, of no unit length, behind it a scale; above both a matrix, column by column.
    const std::string nodes = R"({"name":"top","children":[2,1],"matrix":[1,0,0,0, 0,0,1,0, 0,-1,0,0, 10,20,30,1]},
{"name":"b","mesh":0},{"name":"a","translation":[1,2,3],"rotation":[0,0,0.7,0.7],"scale":[1,2,4],"mesh":0})";
    const MeshObjects read = read_bytes_of(numbers.file(nodes, mesh), "a.glb");
    ASSERT_EQ(read.objects.size(), 2u);
    EXPECT_EQ(read.objects[0].name, "a") << "in the order of the children";
    EXPECT_EQ(read.objects[1].name, "b");
    for (std::size_t v = 0; v < kCorners.size(); ++v) {
        const Point& p = kCorners[v];
        const Point below{1 - 2 * p.y, 2 + p.x, 3 + 4 * p.z};
        const Point expected{10 + below.x, 20 - below.z, 30 + below.y};
        EXPECT_NEAR(distance(read.objects[0].mesh.vertices[v], expected), 0.0, 1e-14);
    }
    // The scene that is shown, or the first one.
    const std::string scenes = "\"nodes\":[" + nodes + "],\"meshes\":[" + mesh + ']';
    const auto count = [&](const std::string& more) {
        return read_bytes_of(numbers.content(scenes + more), "a.glb").objects.size();
    };
    EXPECT_EQ(count(R"(,"scenes":[{"nodes":[0]},{"nodes":[1]}],"scene":1)"), 1u);
    EXPECT_EQ(count(R"(,"scenes":[{"nodes":[1]},{"nodes":[0]}])"), 1u);
    EXPECT_EQ(count(R"(,"scenes":[{}])"), 0u);
    const auto expect = [&](const std::string& content, const std::vector<std::string>& words) {
        expect_error([&] { read_bytes_of(content, "a.glb"); }, words);
    };
    expect(numbers.content(scenes), {"scene 0 ", "does not exist"});
    expect(numbers.content(scenes + R"(,"scenes":[{"nodes":[3]}])"), {"node 3 ", "does not exist"});
    expect(numbers.content(scenes + R"(,"scenes":[{"nodes":[0]}],"scene":1)"), {"scene 1 ", "does not exist"});
    expect(numbers.content(scenes + R"(,"scenes":[{"nodes":[0,1]}])"), {"node 1 is in the scene twice"});
    expect(numbers.file(R"({"children":[1]},{"children":[0]})", mesh), {"node 0 is in the scene twice"});
    expect(numbers.file(R"({"mesh":0,"scale":[1,2]})", mesh), {"node 0 ", "'scale'", "3 numbers"});
    expect(numbers.file(R"({"mesh":0,"matrix":[1]})", mesh), {"node 0 ", "'matrix'", "16 numbers"});
}

TEST_F(SceneIo, PlacesInstancesOfGltf) {
    Accessors numbers;
    const int position = numbers.add_corners();
    const std::string mesh = mesh_of(position, numbers.add_faces());
    const int moved = numbers.add(std::vector<float>{0, 0, 0, 8, 0, 0}, 5126, "VEC3", 3);
    const int turned = numbers.add(std::vector<std::int8_t>{0, 0, 0, 127, 0, 0, 127, 0}, 5120, "VEC4", 4);
    const int scaled = numbers.add(std::vector<float>{1, 1, 1, 2, 2, 2}, 5126, "VEC3", 3);
    std::string file = numbers.file(
        R"({"name":"n","translation":[0,0,1],"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":)" +
            std::to_string(moved) + ",\"ROTATION\":" + std::to_string(turned) + ",\"SCALE\":" + std::to_string(scaled) +
            "}}}}",
        mesh, R"(,"extensionsRequired":["EXT_mesh_gpu_instancing"])");
    file = replaced(file, "\"type\":\"VEC4\"", "\"type\":\"VEC4\",\"normalized\":true");
    // The JSON has become longer.
    const std::size_t longer = std::string(",\"normalized\":true").size();
    for (const std::size_t at : {std::size_t{8}, std::size_t{12}}) {
        std::uint32_t size = 0;
        std::copy_n(file.data() + at, 4, reinterpret_cast<char*>(&size));
        file.replace(at, 4, bytes(static_cast<std::uint32_t>(size + longer)));
    }
    const MeshObjects read = read_bytes_of(file, "a.glb");
    ASSERT_EQ(read.objects.size(), 2u);
    for (std::size_t v = 0; v < kCorners.size(); ++v) {
        const Point& p = kCorners[v];
        EXPECT_EQ(read.objects[0].mesh.vertices[v], (Point{p.x, p.y, p.z + 1}));
        EXPECT_EQ(read.objects[1].mesh.vertices[v],
                  (Point{8 - 2 * p.x, -2 * p.y, 2 * p.z + 1}));  // half a turn about z
    }
    EXPECT_EQ(read.objects[1].name, "n");
}

TEST_F(SceneIo, RefusesWhatItDoesNotKnowOfGltf) {
    Accessors numbers;
    const int position = numbers.add_corners();
    const std::string mesh = mesh_of(position, numbers.add_faces());
    const auto expect = [&](const std::string& name, const std::vector<std::string>& words) {
        const std::string file = numbers.file(R"({"mesh":0})", mesh, ",\"extensionsRequired\":[\"" + name + "\"]");
        expect_error([&] { read_bytes_of(file, "a.glb"); }, words);
    };
    expect("ACME_geometry", {"a.glb: ", "'ACME_geometry'", "export it without"});
    expect("KHR_draco_mesh_compression", {"'KHR_draco_mesh_compression'", "gltf-transform"});
    expect("EXT_meshopt_compression", {"'EXT_meshopt_compression'", "gltfpack -noq"});
    for (const std::string name : {"KHR_mesh_quantization", "KHR_materials_unlit", "KHR_texture_transform"}) {
        const std::string file = numbers.file(R"({"mesh":0})", mesh, ",\"extensionsRequired\":[\"" + name + "\"]");
        EXPECT_EQ(read_bytes_of(file, "a.glb").objects.size(), 1u) << name;
    }
    const std::string whole = glb();
    expect_error([&] { read_bytes_of(replaced(whole, "\"2.0\"", "\"1.0\""), "a.glb"); }, {"glTF 1.0", "gltf-pipeline"});
    expect_error([&] { read_bytes_of(replaced(whole, "glTF\x02", "glTF\x01"), "a.glb"); },
                 {"glTF 1.0", "gltf-pipeline"});
    // As Draco's meshes look without the data that it packs.
    const std::string packed =
        replaced(gltf(R"("uri":"data:;base64,)" + base64(gltf_buffer()) + "\","), "\"bufferView\":0,", "");
    expect_error([&] { read_bytes_of(packed, "a.gltf"); }, {"accessor 0 has no data", "gltfpack"});
}

TEST_F(SceneIo, ReadsNothingButTheFolderOfAGltf) {
    fs::create_directory(path("inner"));
    write("part.bin", gltf_buffer());
    expect_error([&] { read_mesh(write("inner/a.gltf", gltf(R"("uri":"../part.bin",)"))); },
                 {"inner/a.gltf: ", "part.bin", "only files in the folder"});
    expect_error([&] { read_mesh(write("a.gltf", gltf("\"uri\":\"" + path("part.bin").generic_string() + "\","))); },
                 {"a.gltf: its part ", "only files in the folder"});
    expect_error([&] { read_mesh(write("a.gltf", gltf(R"("uri":"absent.bin",)"))); },
                 {"a.gltf: ", "absent.bin", "No such file"});
    const std::string content = gltf(R"("uri":"part.bin",)");
    expect_error(
        [&] {
            read_mesh(FileBytes{std::as_bytes(std::span(content)), "upload.gltf"});
        },
        {"upload.gltf: ", "part.bin", "beside the file"});
}

TEST_F(SceneIo, CountsPointsAndLines) {
    const std::string json =
        gltf("", R"(,{"attributes":{"POSITION":0},"mode":0},{"attributes":{"POSITION":0},"mode":1})");
    const fs::path file = write("a.glb", glb(json));
    const MeshObjects read = read_objects(file);
    expect_pair(read);
    ASSERT_EQ(read.warnings.size(), 1u);
    EXPECT_EQ(read.warnings[0].code, "mesh.no_faces");
    EXPECT_TRUE(read.warnings[0].message.starts_with("8 points and 4 lines")) << read.warnings[0].message;
    EXPECT_EQ(load_solid(file).warnings[0].code, "mesh.no_faces");
}

TEST_F(SceneIo, TellsThatBonesAndShapeKeysAreNotApplied) {
    const std::string json = gltf("");
    for (const auto& [what, with] :
         {std::pair{"\"mesh\":0", "\"mesh\":0,\"skin\":0"}, {"\"mesh\":0", "\"mesh\":0,\"weights\":[0,1]"}}) {
        const MeshObjects read = read_objects(write("a.glb", glb(replaced(json, what, with))));
        ASSERT_EQ(read.warnings.size(), 1u) << with;
        EXPECT_EQ(read.warnings[0].code, "mesh.pose");
        EXPECT_TRUE(read.warnings[0].message.starts_with("1 mesh has bones")) << read.warnings[0].message;
    }
    const std::string at_rest = replaced(json, "\"mesh\":0", "\"mesh\":0,\"weights\":[0,0]");
    EXPECT_TRUE(read_objects(write("a.glb", glb(at_rest))).warnings.empty());
}

TEST_F(SceneIo, DamagedGltfIsAnErrorInOneLine) {
    const std::string whole = glb();
    for (std::size_t length = 1; length < whole.size(); ++length) {
        const std::string message = error_of([&] { read_bytes_of(whole.substr(0, length), "cut.glb"); });
        EXPECT_NE(message, "") << length;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    const std::string text = gltf(R"("uri":"data:;base64,)" + base64(gltf_buffer()) + "\",");
    for (std::size_t length = 1; length < text.size(); ++length) {
        EXPECT_NE(error_of([&] { read_bytes_of(text.substr(0, length), "cut.gltf"); }), "") << length;
    }
    const std::string json = gltf("");
    const auto expect = [&](const std::string& from, const std::string& to, const std::vector<std::string>& words) {
        expect_error([&] { read_bytes_of(glb(replaced(json, from, to)), "a.glb"); }, words);
    };
    expect("\"count\":12", "\"count\":4000000000", {"a.glb: "});
    expect("\"count\":12", "\"count\":13", {"accessor 1 has 13 elements", "cannot hold"});
    expect("\"count\":12", "\"count\":-1", {"accessor 1 ", "'count'", "whole number"});
    expect("\"count\":12", "\"count\":1.5", {"accessor 1 ", "'count'", "whole number"});
    expect("\"count\":12", "\"count\":1e999", {"this is no JSON"});
    expect("\"count\":12", "\"count\":\"12\"", {"accessor 1 ", "'count'", "whole number"});
    expect("\"count\":12", "\"cont\":12", {"accessor 1 ", "'count'"});
    expect("\"count\":12,\"type\":\"SCALAR\"", "\"count\":4,\"type\":\"VEC3\"", {"accessor 1 has another type"});
    expect("5123", "5122", {"accessor 1 has another type"});
    expect("5123", "5127", {"accessor 1 ", "'componentType'"});
    expect("\"byteLength\":48", "\"byteLength\":4800", {"buffer view 0 ends behind its buffer, of 72 bytes"});
    expect("\"byteOffset\":48", "\"byteOffset\":49", {"buffer view 1 ends behind"});
    expect("\"byteOffset\":0", "\"byteStride\":16,\"byteOffset\":0", {"accessor 0 has 4 elements", "cannot hold"});
    expect("\"byteOffset\":0", "\"byteStride\":8,\"byteOffset\":0", {"accessor 0 "});
    expect("\"mesh\":0", "\"mesh\":7", {"mesh 7 ", "does not exist"});
    expect("\"indices\":1", "\"indices\":2", {"accessor 2 ", "does not exist"});
    expect("\"POSITION\":0", "\"POSITION\":1", {"accessor 1 has another type"});
    expect("{\"bufferView\":1", "{\"bufferView\":9", {"buffer view 9 ", "does not exist"});
    expect("{\"buffer\":0", "{\"buffer\":3", {"buffer 3 ", "does not exist"});
    expect("\"byteLength\":72", "\"byteLength\":73", {"buffer 0 should have 73 bytes and has 72"});
    expect("\"indices\":1", "\"indices\":1,\"mode\":7", {"'mode'"});
    expect("\"children\":[1,2]", "\"children\":[1,\"2\"]", {"node 0 ", "'children'"});
    expect("\"children\":[1,2]", "\"children\":3", {"node 0 ", "'children'", "a list"});
    expect("\"asset\":{", "\"asset\":3,\"a\":{", {"no asset with a version"});
    expect("\"nodes\":[\n", "\"nodes\":3,\"n\":[\n", {"'nodes'", "a list"});
    expect("{", "[[", {"this is no JSON"});
    expect_error([&] { read_bytes_of(replaced(text, "base64,AAAA", "base64,A?AA"), "a.gltf"); },
                 {"a.gltf: ", "base64"});
    expect_error([&] { read_bytes_of(replaced(text, ";base64", ""), "a.gltf"); }, {"a.gltf: ", "base64"});
    expect_error(
        [&] {
            read_bytes_of("glTF" + bytes(std::uint32_t{2}) + bytes(std::uint32_t{4000000000}) + std::string(20, ' '),
                          "a.glb");
        },
        {"a.glb: ", "4000000000", "truncated"});
    std::string content = whole;
    content.replace(content.size() - 72, 4, bytes(std::uint32_t{0x7fc00000}));
    expect_error([&] { read_bytes_of(content, "a.glb"); }, {"a.glb: ", "large", "not a finite number"});
    content = whole;
    content.replace(content.size() - 2, 2, bytes(std::uint16_t{4}));
    expect_error([&] { read_bytes_of(content, "a.glb"); }, {"object 'large'", "face 4 of 4", "does not exist"});
    const std::string deep = "{\"asset\":" + std::string(1000000, '[');
    expect_error([&] { read_bytes_of(deep, "a.gltf"); }, {"this is no JSON"});
    expect_error([&] { read_bytes_of(deep + std::string(1000000, ']') + "}", "a.gltf"); }, {"this is no JSON"});
}

/// Reads `whole` with some of its bytes changed, many times: it may only throw a `FileError` of one line.
void expect_no_crash(const std::string& whole, const std::function<MeshObjects(const std::string&)>& read,
                     std::uint32_t seed, int rounds) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    constexpr std::string_view kTelling = "0123456789-.eE{}[]<>\"/:, \x01\xFF";
    for (int round = 0; round < rounds; ++round) {
        std::string content = whole;
        for (std::uint32_t changes = 1 + random() % 4; changes > 0; --changes) {
            const std::size_t at = random() % content.size();
            switch (random() % 3) {
                case 0:
                    content[at] = static_cast<char>(random());
                    break;
                case 1:
                    content[at] = kTelling[random() % kTelling.size()];
                    break;
                default:
                    content.insert(at, content.substr(random() % content.size(), random() % 8));
            }
        }
        try {
            read(content);
        } catch (const FileError& error) {
            ASSERT_EQ(std::string_view(error.what()).find('\n'), std::string::npos) << error.what();
            ASSERT_NE(error.diagnostic().code, "file.memory") << "round " << round;
        }
    }
}

TEST_F(SceneIo, SurvivesMutationsOfGltf) {
    expect_no_crash(
        glb(), [](const std::string& content) { return read_bytes_of(content, "a.glb"); }, 1, 20000);
    const std::string text = gltf(R"("uri":"data:;base64,)" + base64(gltf_buffer()) + "\",");
    expect_no_crash(
        text, [](const std::string& content) { return read_bytes_of(content, "a.gltf"); }, 2, 20000);
}

// ---------------------------------------------------------------------------------------------------------------------
// 3MF
// ---------------------------------------------------------------------------------------------------------------------

std::string deflated(const std::string& content) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    std::string result(content.size() + 100, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
    stream.avail_in = static_cast<uInt>(content.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    deflate(&stream, Z_FINISH);
    result.resize(result.size() - stream.avail_out);
    deflateEnd(&stream);
    return result;
}

using Parts = std::vector<std::pair<std::string, std::string>>;

std::string zip(const Parts& parts, bool is_stored = false) {
    const auto u16 = [](std::size_t n) { return bytes(static_cast<std::uint16_t>(n)); };
    const auto u32 = [](std::size_t n) { return bytes(static_cast<std::uint32_t>(n)); };
    std::string archive;
    std::string directory;
    for (const auto& [name, content] : parts) {
        const std::string packed = is_stored ? content : deflated(content);
        const uLong sum = crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size()));
        const std::string head = u16(20) + u16(0) + u16(is_stored ? 0 : 8) + u32(0) + u32(sum) + u32(packed.size()) +
                                 u32(content.size()) + u16(name.size()) + u16(0);
        directory += "PK\x01\x02" + u16(20) + head + u16(0) + u16(0) + u16(0) + u32(0) + u32(archive.size()) + name;
        archive += "PK\x03\x04" + head + name + packed;
    }
    return archive + directory + "PK\x05\x06" + u32(0) + u16(parts.size()) + u16(parts.size()) + u32(directory.size()) +
           u32(archive.size()) + u16(0);
}

const std::string kRelations =
    "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
    "<Relationship Id=\"rel0\" Target=\"/3D/3dmodel.model\" "
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>";

std::string mesh_object(const std::string& id, const std::string& name) {
    std::string result = "<object id=\"" + id + "\" name=\"" + name + "\" type=\"model\"><mesh><vertices>";
    for (const Point& p : kCorners) {
        result += "<vertex x=\"" + std::to_string(p.x) + "\" y=\"" + std::to_string(p.y) + "\" z=\"" +
                  std::to_string(p.z) + "\"/>";
    }
    result += "</vertices><triangles>";
    for (const auto& [a, b, c] : kFaces) {
        result += "<triangle v1=\"" + std::to_string(a) + "\" v2=\"" + std::to_string(b) + "\" v3=\"" +
                  std::to_string(c) + "\"/>";
    }
    return result + "</triangles></mesh></object>\n";
}

std::string model(const std::string& resources, const std::string& items) {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<!-- a comment with a <model> -->\n"
           "<model unit=\"millimeter\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
           "<metadata name=\"Title\">a title</metadata><resources>\n" +
           resources + "</resources>\n<build>" + items + "</build></model>\n";
}

std::string threemf(const std::string& text) { return zip({{"_rels/.rels", kRelations}, {"3D/3dmodel.model", text}}); }

const std::string kAssembly =
    "<object id=\"2\" name=\"twice &amp; moved\"><components>"
    "<component objectid=\"1\" transform=\"2 0 0 0 2 0 0 0 2 0 0 0\"/></components></object>\n";
const std::string kItems =
    "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 2 4 6\"/>"
    "<item objectid=\"1\" transform=\"-2 0 0 0 2 0 0 0 2 20 0 0\"/>";
const std::string kModel = model(mesh_object("1", "small") + kAssembly, kItems);

TEST_F(SceneIo, BuildsTheItemsOf3mf) {
    const std::string stored = zip({{"_rels/.rels", kRelations}, {"3D/3dmodel.model", kModel}}, true);
    for (const fs::path& file : {write("a.3mf", threemf(kModel)), write("stored", stored)}) {
        SCOPED_TRACE(file);
        EXPECT_EQ(file_kind(file), FileKind::kMesh);
        const MeshObjects read = read_objects(file);
        expect_pair(read);
        EXPECT_EQ(read.unit, "mm");
        EXPECT_EQ(read.objects[0].name, "twice & moved");
        EXPECT_EQ(read.objects[1].name, "small");
    }
}

TEST_F(SceneIo, Follows3mfToOtherParts) {
    const std::string here =
        "<object id=\"2\"><components><component p:path=\"/3D/Objects/one.model\" objectid=\"1\" "
        "transform=\"2 0 0 0 2 0 0 0 2 0 0 0\"/></components></object>";
    const std::string items =
        "<item objectid=\"2\" transform=\"1 0 0 0 1 0 0 0 1 2 4 6\"/>"
        "<item objectid=\"1\" p:path=\"/3D/Objects/one.model\" transform=\"-2 0 0 0 2 0 0 0 2 20 0 0\"/>";
    // What another part wants to build does not count.
    const std::string there = model(mesh_object("1", "small"), "<item objectid=\"1\"/>");
    expect_pair(read_objects(write("a.3mf", zip({{"_rels/.rels", kRelations},
                                                 {"3D/3dmodel.model", model(here, items)},
                                                 {"3D/Objects/one.model", there}}))));
}

TEST_F(SceneIo, NamesTheFaultOfABad3mf) {
    const auto expect = [&](const std::string& content, const std::vector<std::string>& words) {
        expect_error([&] { read_mesh(write("a.3mf", content)); }, words);
    };
    const std::string small = mesh_object("1", "small");
    const std::string item = "<item objectid=\"1\"/>";
    expect(threemf(model(small, "<item objectid=\"7\"/>")), {"a.3mf: ", "object '7'", "does not exist"});
    expect(threemf(model(replaced(small, "x=\"0.000000\"", "x=\"zero\""), item)), {"<vertex>", "'x'", "'zero'"});
    expect(threemf(model(replaced(small, "x=\"0.000000\"", ""), item)), {"<vertex>", "'x'"});
    expect(threemf(model(replaced(small, "x=\"0.000000\"", "x=\"nan\""), item)), {"object 'small'", "vertex 1 of 4"});
    expect(threemf(model(replaced(small, "v1=\"0\"", "v1=\"9\""), item)), {"face 1 of 4", "does not exist"});
    expect(threemf(model(replaced(small, "v1=\"0\"", ""), item)), {"face 1 of 4"});
    expect(threemf(model(small, "<item objectid=\"1\" transform=\"1 0 0\"/>")), {"'1 0 0'", "twelve numbers"});
    expect(threemf(model(replaced(small, "</vertices>", "</vertices"), item)), {"a.3mf: "});
    expect(threemf(kModel.substr(0, kModel.size() - 9)), {"'3D/3dmodel.model'", "line 8: this is no XML", "truncated"});
    expect(threemf("<nothing/>"), {"no <model>"});
    expect(zip({{"_rels/.rels", kRelations}, {"3D/other.model", kModel}}), {"'3D/3dmodel.model'"});
    expect(zip({{"3D/3dmodel.model", kModel}}), {"'_rels/.rels'"});
    // Objects that contain themselves, and those that double 60 times.
    expect(threemf(model("<object id=\"1\"><components><component objectid=\"1\"/></components></object>", item)),
           {"contain each other"});
    std::string doubling = mesh_object("0", "small");
    for (int i = 1; i <= 60; ++i) {
        const std::string component = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
        doubling +=
            "<object id=\"" + std::to_string(i) + "\"><components>" + component + component + "</components></object>";
    }
    const std::string none = "<object id=\"0\"><mesh/></object>";
    expect(threemf(model(none + doubling.substr(mesh_object("0", "small").size()), "<item objectid=\"60\"/>")),
           {"contain each other, or too many others"});
}

TEST_F(SceneIo, TakesTheUnitOf3mfAlong) {
    const std::vector<std::pair<std::string, std::string>> units{
        {"micron", "um"}, {"millimeter", "mm"}, {"centimeter", "cm"}, {"meter", "m"}, {"inch", "in"}, {"foot", "ft"}};
    for (const auto& [name, unit] : units) {
        const std::string file = threemf(replaced(kModel, "unit=\"millimeter\"", "unit=\"" + name + "\""));
        EXPECT_EQ(read_bytes_of(file, "a.3mf").unit, unit);
        EXPECT_EQ(unit_of(load_solid(write("a.3mf", file)).input), unit);
        LoadOptions options;
        options.solid = {.kind = SolidKind::kWrap, .opening = 1.0};
        EXPECT_EQ(unit_of(load_solid(path("a.3mf"), options).input), unit);
    }
    EXPECT_EQ(read_bytes_of(threemf(replaced(kModel, "unit=\"millimeter\"", "")), "a.3mf").unit, "mm");
    expect_error([&] { read_bytes_of(threemf(replaced(kModel, "unit=\"millimeter\"", "unit=\"cubit\"")), "a.3mf"); },
                 {"'cubit'"});
    EXPECT_EQ(unit_of(load_solid(write("a.off",
                                       "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"))
                          .input),
              "");
}

TEST_F(SceneIo, LeavesOutWhatIsNoPartOf3mf) {
    const auto expect = [](const MeshObjects& read, double expected, const std::string& words) {
        ASSERT_EQ(read.objects.size(), 1u);
        EXPECT_EQ(volume(read.objects[0].mesh), expected);
        EXPECT_EQ(read.objects[0].mesh.vertices.size(), 4u);
        ASSERT_EQ(read.warnings.size(), 1u);
        EXPECT_EQ(read.warnings[0].code, "mesh.left_out");
        EXPECT_TRUE(read.warnings[0].message.starts_with(words)) << read.warnings[0].message;
    };
    const std::string items = "<item objectid=\"1\"/><item objectid=\"2\"/>";
    for (const std::string type : {"support", "solidsupport", "other"}) {
        const std::string other = replaced(mesh_object("2", "s"), "type=\"model\"", "type=\"" + type + '"');
        expect(read_bytes_of(threemf(model(mesh_object("1", "m") + other, items)), "a.3mf"), kVolume,
               "1 object is left out");
    }
    // As PrusaSlicer says that of eight triangles the second four are a volume to be subtracted.
    std::string eight = mesh_object("1", "m");
    const std::string more = mesh_object("1", "m");
    const auto inner = [](const std::string& text, const std::string& tag) {
        const std::size_t begin = text.find('<' + tag + '>') + tag.size() + 2;
        return text.substr(begin, text.find("</" + tag + '>') - begin);
    };
    std::string second = inner(more, "triangles");
    for (int v = 3; v >= 0; --v) {
        for (std::size_t at = 0; (at = second.find("=\"" + std::to_string(v) + '"', at)) != std::string::npos;
             at += 4) {
            second.replace(at + 2, 1, std::to_string(v + 4));
        }
    }
    eight = replaced(eight, "</vertices>", inner(more, "vertices") + "</vertices>");
    eight = replaced(eight, "</triangles>", second + "</triangles>");
    const std::string text = model(eight, "<item objectid=\"1\"/>");
    const auto project = [&](const std::string& name, const std::string& settings) {
        return read_bytes_of(
            zip({{"_rels/.rels", kRelations}, {"3D/3dmodel.model", text}, {"Metadata/" + name, settings}}), "a.3mf");
    };
    const auto volume_of = [](const std::string& ids, const std::string& type) {
        return "<volume " + ids +
               "><metadata type=\"volume\" key=\"name\" value=\"v\"/><metadata type=\"volume\" key=\"volume_type\" "
               "value=\"" +
               type + "\"/></volume>";
    };
    for (const std::string type : {"NegativeVolume", "ParameterModifier", "SupportBlocker", "SupportEnforcer"}) {
        const MeshObjects read =
            project("Slic3r_PE_model.config", "<config><object id=\"1\">" +
                                                  volume_of("firstid=\"0\" lastid=\"3\"", "ModelPart") +
                                                  volume_of("firstid=\"4\" lastid=\"7\"", type) + "</object></config>");
        expect(read, kVolume, "1 part is left out");
    }
    EXPECT_TRUE(project("Slic3r_PE_model.config", "<config><object id=\"1\">" +
                                                      volume_of("firstid=\"0\" lastid=\"7\"", "ModelPart") +
                                                      "</object></config>")
                    .warnings.empty());
    expect_error([&] { project("Slic3r_PE_model.config", "<config>"); }, {"Slic3r_PE_model.config", "this is no XML"});
    // As Bambu Studio says it of components.
    const std::string parts =
        mesh_object("1", "a") + mesh_object("2", "b") +
        "<object id=\"3\"><components><component objectid=\"1\"/><component objectid=\"2\"/></components></object>";
    const std::string settings =
        "<config><object id=\"3\"><part id=\"1\" subtype=\"normal_part\"/>"
        "<part id=\"2\" subtype=\"negative_part\"/></object></config>";
    expect(read_bytes_of(zip({{"_rels/.rels", kRelations},
                              {"3D/3dmodel.model", model(parts, "<item objectid=\"3\"/>")},
                              {"Metadata/model_settings.config", settings}}),
                         "a.3mf"),
           kVolume, "1 part is left out");
}

std::string beam_model(const std::string& lattice, const std::string& beams) {
    const std::string object =
        "<object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"10\"/>"
        "<vertex x=\"7\" y=\"0\" z=\"0\"/></vertices><triangles/><b:beamlattice " +
        lattice + "><b:beams>" + beams + "</b:beams></b:beamlattice></mesh></object>";
    return replaced(model(object, "<item objectid=\"1\"/>"), "<model ",
                    "<model xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02\" "
                    "requiredextensions=\"b\" ");
}

TEST_F(SceneIo, MakesTrianglesOfBeamsOf3mf) {
    constexpr double kPi = 3.14159265358979;
    // The volume lies up to 2 % below that of the cone and its ends; their surface is closed.
    const auto expect = [](const std::string& text, double expected) {
        const MeshObjects read = read_bytes_of(threemf(text), "a.3mf");
        ASSERT_EQ(read.objects.size(), 1u);
        EXPECT_LT(volume(read.objects[0].mesh), expected);
        EXPECT_GT(volume(read.objects[0].mesh), 0.98 * expected);
        const RepairedMesh repaired = repair(read.objects[0].mesh);
        EXPECT_TRUE(repaired.report.is_closed());
        EXPECT_EQ(repaired.report.components, 1);
        EXPECT_EQ(repaired.report.genus, 0);
        EXPECT_TRUE(repaired.report.warnings().empty());
    };
    const std::string lattice = "radius=\"0.5\" minlength=\"0.001\"";
    const std::string beam = "<b:beam v1=\"0\" v2=\"1\"/>";
    const double cylinder = kPi * 0.25 * 10.0;
    const double ball = 4.0 / 3.0 * kPi * 0.125;
    expect(beam_model(lattice, beam), cylinder + ball);
    expect(beam_model(lattice + " cap=\"butt\"", beam), cylinder);
    expect(beam_model(lattice + " cap=\"butt\"", replaced(beam, "/>", " cap2=\"hemisphere\"/>")), cylinder + ball / 2);
    expect(beam_model(lattice, replaced(beam, "/>", " r1=\"1\" r2=\"2\" cap1=\"butt\" cap2=\"butt\"/>")),
           kPi * 10.0 / 3.0 * 7.0);
    expect(beam_model(lattice, beam + "<b:beam v1=\"1\" v2=\"1\"/>"), cylinder + ball);  // the second has no length
    // Beams that meet share a ball: that of one of them.
    const std::string two = beam_model(lattice, beam + "<b:beam v1=\"0\" v2=\"2\"/>");
    const double expected = cylinder + ball + kPi * 0.25 * 7.0 + ball / 2;
    const double found = volume(read_bytes_of(threemf(two), "a.3mf").objects[0].mesh);
    EXPECT_LT(found, expected);
    EXPECT_GT(found, 0.98 * expected);
    const auto fail = [&](const std::string& text, const std::vector<std::string>& words) {
        expect_error([&] { read_bytes_of(threemf(text), "a.3mf"); }, words);
    };
    fail(beam_model(lattice, "<b:beam v1=\"0\" v2=\"3\"/>"), {"a beam refers to a vertex that does not exist"});
    fail(beam_model("radius=\"-1\"", beam), {"radius of a beam"});
    fail(beam_model("", beam), {"radius of a beam"});
    fail(beam_model(lattice + " cap=\"cone\"", beam), {"'cone'"});
    fail(beam_model(lattice + " clippingmode=\"inside\" clippingmesh=\"2\"", beam), {"clipped"});
    fail(replaced(beam_model(lattice, beam), "beamlattice/2017/02", "volumetric/2022/01"),
         {"3MF extension", "volumetric"});
}

TEST_F(SceneIo, DamagedArchivesAreErrors) {
    const std::string whole = threemf(kModel);
    for (std::size_t length = 1; length < whole.size(); ++length) {
        EXPECT_NE(error_of([&] { read_mesh(write("cut.3mf", whole.substr(0, length))); }), "") << length;
    }
    // Whatever byte is damaged: an error, or a name or time that does not matter.
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(~damaged[i]);
        try {
            const MeshObjects read = read_objects(write("a.3mf", damaged));
            expect_pair(read);
        } catch (const FileError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
    // A size of 3 GB, before memory is taken for it.
    std::string large = whole;
    large.replace(large.rfind("PK\x01\x02") + 24, 4, bytes(std::uint32_t{3000000000}));
    expect_error([&] { read_mesh(write("a.3mf", large)); }, {"a.3mf: ", "cannot have the size"});
}

TEST_F(SceneIo, SurvivesMutationsOf3mf) {
    // Of the model, since the sums of archives find all others.
    expect_no_crash(
        kModel, [](const std::string& text) { return read_bytes_of(threemf(text), "a.3mf"); }, 3, 5000);
    const std::string beams = beam_model("radius=\"0.5\" minlength=\"0.001\"", "<b:beam v1=\"0\" v2=\"1\"/>");
    expect_no_crash(
        beams, [](const std::string& text) { return read_bytes_of(threemf(text), "a.3mf"); }, 4, 5000);
    for (std::size_t length = 0; length + 2 < kModel.size(); ++length) {
        EXPECT_NE(error_of([&] { read_bytes_of(threemf(kModel.substr(0, length)), "a.3mf"); }), "") << length;
    }
    std::string deep;
    std::string closing;
    for (int i = 0; i < 1000000; ++i) {
        deep += "<a>";
        closing += "</a>";
    }
    const std::string metadata = "<metadata name=\"Title\">a title</metadata>";
    expect_pair(read_bytes_of(threemf(replaced(kModel, metadata, deep + closing)), "a.3mf"));
    expect_error([&] { read_bytes_of(threemf(replaced(kModel, metadata, deep)), "a.3mf"); }, {"this is no XML"});
    // Entities that stand for others are not replaced.
    const std::string bomb =
        "<!DOCTYPE m [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;\">]>\n";
    const std::string text = replaced(replaced(kModel, "<model ", bomb + "<model "), "a title", "&b;&b;&b;");
    expect_pair(read_bytes_of(threemf(text), "a.3mf"));
}

// ---------------------------------------------------------------------------------------------------------------------
// Some objects of several
// ---------------------------------------------------------------------------------------------------------------------

TEST_F(SceneIo, SolidsOfSomeObjects) {
    const fs::path file = write("a.3mf", threemf(kModel));
    const auto volume_of = [&](const std::vector<Index>& objects) {
        LoadOptions options;
        options.objects = objects;
        return std::get<MeshReport>(load_solid(file, options).input).volume;
    };
    EXPECT_DOUBLE_EQ(volume_of({}), 16 * kVolume);
    EXPECT_DOUBLE_EQ(volume_of({1}), 8 * kVolume);
    EXPECT_DOUBLE_EQ(volume_of({2, 2}), 8 * kVolume);
    EXPECT_DOUBLE_EQ(volume_of({2, 1}), 16 * kVolume);
    for (const Index absent : {0, 3, -1}) {
        try {
            volume_of({absent});
            ADD_FAILURE() << absent;
        } catch (const InvalidOption& error) {
            EXPECT_NE(std::string(error.what()).find("the file has 2 (1 'twice & moved', 2 'small')"),
                      std::string::npos)
                << error.what();
        }
    }
    LoadOptions options;
    options.objects = {1};
    write("points.xyz", "0 0 0.5\n1 0 0\n");
    EXPECT_THROW(load_solid(path("points.xyz"), options), InvalidOption);
}

TEST_F(SceneIo, FilesWithoutObjectsAreOne) {
    const MeshObjects read = read_objects(write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    ASSERT_EQ(read.objects.size(), 1u);
    EXPECT_EQ(read.objects[0].name, "");
    EXPECT_EQ(read.objects[0].mesh.triangles.size(), 1u);
}

TEST_F(SceneIo, KnownFormatsThatAreNotReadSayWhatToDo) {
    expect_error([&] { file_kind(write("a.e57", "ASTM-E57 and so on")); },
                 {"a.e57: ", "pdal translate", "CloudCompare"});
    expect_error([&] { read_points(path("a.e57")); }, {"pdal translate"});
    expect_error([&] { file_kind(write("a.step", "ISO-10303-21;\nHEADER;\n")); }, {"a.step: ", "STL"});
    expect_error([&] { file_kind(write("a.wrl", "#VRML V2.0 utf8\n")); }, {"a.wrl: ", "PLY"});
    const std::string collada = "<?xml version=\"1.0\"?>\n<COLLADA version=\"1.4.1\"><library_geometries/></COLLADA>\n";
    expect_error([&] { read_mesh(write("a.dae", collada)); }, {"a.dae: COLLADA", "assimp export", "Blender"});
    expect_error([&] { file_kind(write("a", "\xEF\xBB\xBF\n" + collada)); }, {"COLLADA"});
    expect_error([&] { read_mesh(write("a.fbx", "; FBX 7.4.0 project file\n")); }, {"a.fbx: FBX", "assimp export"});
    expect_error([&] { read_mesh(write("b.fbx", "Kaydara FBX Binary  " + std::string(200, '\0'))); }, {"b.fbx: FBX"});
    expect_error([&] { read_mesh(write("a.amf", "<?xml version=\"1.0\"?>\n<amf unit=\"inch\"></amf>")); },
                 {"a.amf: AMF", "3MF"});
}

}  // namespace
}  // namespace scaleaxis
