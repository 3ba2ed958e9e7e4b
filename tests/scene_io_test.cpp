// SPDX-License-Identifier: Apache-2.0
//
// Files with several objects at places of their own: 3MF, and what Assimp reads.
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "file_errors.hpp"
#include "folder.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"

namespace scaleaxis {
namespace {

using test::error_of;
using test::expect_error;

namespace fs = std::filesystem;
constexpr bool kReadsAssimp = SCALEAXIS_READS_ASSIMP;

class SceneIo : public test::FolderTest {};

class AssimpIo : public SceneIo {
   protected:
    void SetUp() override {
        SceneIo::SetUp();
        if (!kReadsAssimp) {
            GTEST_SKIP() << "built without Assimp";
        }
    }
};

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

TEST_F(AssimpIo, PlacesTheNodesOfGltf) {
    write("parts of it.bin", gltf_buffer());
    fs::create_directory(path("deeper"));
    write("deeper/part.bin", gltf_buffer());
    for (const fs::path& file :
         {write("a.glb", glb()), write("a", glb()), write("a.gltf", gltf(R"("uri":"parts of it.bin",)")),
          write("b.gltf", gltf(R"("uri":"deeper/part.bin",)"))}) {
        SCOPED_TRACE(file);
        EXPECT_EQ(file_kind(file), FileKind::kMesh);
        const MeshObjects read = read_objects(file);
        expect_pair(read);
        EXPECT_EQ(read.objects[0].name, "large");
        EXPECT_EQ(read.objects[1].name, "mirrored");
        EXPECT_TRUE(read.warnings.empty());
        EXPECT_EQ(read_mesh(file).vertices.size(), 8u);
        EXPECT_EQ(volume(read_mesh(file)), 16 * kVolume);
    }
    const std::string content = glb();
    expect_pair(read_objects(FileBytes{std::as_bytes(std::span(content)), "upload"}));
}

TEST_F(AssimpIo, ReadsNothingButTheFolderOfAGltf) {
    fs::create_directory(path("inner"));
    write("part.bin", gltf_buffer());
    expect_error([&] { read_mesh(write("inner/a.gltf", gltf(R"("uri":"../part.bin",)"))); },
                 {"inner/a.gltf: ", "part.bin", "only files in the folder"});
    expect_error([&] { read_mesh(write("a.gltf", gltf("\"uri\":\"" + path("part.bin").string() + "\","))); },
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

TEST_F(AssimpIo, CountsPointsAndLines) {
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

TEST_F(AssimpIo, DamagedGltfIsAnErrorInOneLine) {
    const std::string whole = glb();
    for (std::size_t length = 1; length < whole.size(); ++length) {
        const std::string message = error_of([&] { read_mesh(write("cut.glb", whole.substr(0, length))); });
        EXPECT_NE(message, "") << length;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    const std::string json = gltf("");
    expect_error([&] { read_mesh(write("a.glb", glb(replaced(json, "\"count\":12", "\"count\":4000000000")))); },
                 {"a.glb: "});
    expect_error([&] { read_mesh(write("a.glb", glb(replaced(json, "\"byteLength\":48", "\"byteLength\":4800")))); },
                 {"a.glb: "});
    expect_error([&] { read_mesh(write("a.glb", glb(replaced(json, "\"mesh\":0", "\"mesh\":7")))); }, {"a.glb: "});
    expect_error(
        [&] {
            read_mesh(write(
                "a.glb", "glTF" + bytes(std::uint32_t{2}) + bytes(std::uint32_t{4000000000}) + std::string(20, ' ')));
        },
        {"a.glb: ", "4000000000", "truncated"});
    std::string content = glb();
    content.replace(content.size() - 72, 4, bytes(std::uint32_t{0x7fc00000}));
    expect_error([&] { read_mesh(write("a.glb", content)); }, {"a.glb: ", "large", "not a finite number"});
}

// ---------------------------------------------------------------------------------------------------------------------
// Other formats of Assimp
// ---------------------------------------------------------------------------------------------------------------------

const std::string kCollada = R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">0 0 0 1.5 0 0 0 2.25 0 0 0 3.125</float_array>
<technique_common><accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="4"><input semantic="VERTEX" source="#v" offset="0"/><p>0 2 1 0 1 3 1 2 3 0 3 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="all"><scale>2 2 2</scale>
<node id="large"><translate>1 2 3</translate><instance_geometry url="#g"/></node>
<node id="mirrored"><matrix>-1 0 0 10 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";

const std::string kFbx = R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
Objects:  {
	Geometry: 10, "Geometry::g", "Mesh" {
		Vertices: *12 {
			a: 0,0,0,1.5,0,0,0,2.25,0,0,0,3.125
		}
		PolygonVertexIndex: *12 {
			a: 0,2,-2,0,1,-4,1,2,-4,0,3,-3
		}
		GeometryVersion: 124
	}
	Model: 1, "Model::all", "Null" {
		Version: 232
		Properties70:  {
			P: "Lcl Scaling", "Lcl Scaling", "", "A",2,2,2
		}
	}
	Model: 2, "Model::large", "Mesh" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",1,2,3
		}
	}
	Model: 3, "Model::mirrored", "Mesh" {
		Version: 232
		Properties70:  {
			P: "Lcl Translation", "Lcl Translation", "", "A",10,0,0
			P: "Lcl Scaling", "Lcl Scaling", "", "A",-1,1,1
		}
	}
}
Connections:  {
	C: "OO",1,0
	C: "OO",2,1
	C: "OO",3,1
	C: "OO",10,2
	C: "OO",10,3
}
)";

std::string amf_object(const std::string& id) {
    std::string result = "<object id=\"" + id + "\"><mesh><vertices>\n";
    for (const Point& p : kCorners) {
        result += "<vertex><coordinates><x>" + std::to_string(p.x) + "</x><y>" + std::to_string(p.y) + "</y><z>" +
                  std::to_string(p.z) + "</z></coordinates></vertex>\n";
    }
    result += "</vertices><volume>\n";
    for (const auto& [a, b, c] : kFaces) {
        result += "<triangle><v1>" + std::to_string(a) + "</v1><v2>" + std::to_string(b) + "</v2><v3>" +
                  std::to_string(c) + "</v3></triangle>\n";
    }
    return result + "</volume></mesh></object>\n";
}

const std::string kAmf = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<amf unit=\"millimeter\" version=\"1.1\">" +
                         amf_object("0") + "</amf>\n";

TEST_F(AssimpIo, PlacesTheNodesOfEveryFormat) {
    const std::map<std::string, std::string> contents{{"a.dae", kCollada}, {"a.fbx", kFbx}};
    for (const auto& [name, content] : contents) {
        SCOPED_TRACE(name);
        EXPECT_EQ(file_kind(write("anything", content)), FileKind::kMesh) << "by its content";
        expect_pair(read_objects(path("anything")));
        expect_pair(read_objects(write(name, content)));
    }
    const MeshObjects amf = read_objects(write("a.amf", kAmf));
    ASSERT_EQ(amf.objects.size(), 1u);
    EXPECT_EQ(places(amf.objects[0].mesh), places({kCorners, kFaces}));
    EXPECT_EQ(volume(amf.objects[0].mesh), kVolume);
}

TEST_F(AssimpIo, EveryTruncationIsAnErrorInOneLineOrAMesh) {
    const std::map<std::string, std::string> contents{{"a.dae", kCollada}, {"a.amf", kAmf}};
    for (const auto& [name, content] : contents) {
        for (std::size_t length = 1; length < content.size() - 4; length += 3) {
            try {
                read_mesh(write(name, content.substr(0, length)));
            } catch (const FileError& error) {
                const std::string message = error.what();
                EXPECT_NE(message.find(name), std::string::npos) << message;
                EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            }
        }
    }
}

TEST_F(SceneIo, WithoutAssimpTheOptionIsNamed) {
    if (kReadsAssimp) {
        GTEST_SKIP() << "built with Assimp";
    }
    EXPECT_EQ(file_kind(write("a.glb", glb())), FileKind::kMesh);
    expect_error([&] { read_mesh(path("a.glb")); }, {"a.glb: .glb", "SCALEAXIS_WITH_ASSIMP", "trimesh"});
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
    const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    expect(threemf(model(small, "<item objectid=\"7\"/>")), {"a.3mf: ", "object '7'", "does not exist"});
    expect(threemf(model(replaced(small, "x=\"0.000000\"", "x=\"zero\""), item)), {"<vertex>", "'x'", "'zero'"});
    expect(threemf(model(replaced(small, "x=\"0.000000\"", ""), item)), {"<vertex>", "'x'"});
    expect(threemf(model(replaced(small, "x=\"0.000000\"", "x=\"nan\""), item)), {"object 'small'", "vertex 1 of 4"});
    expect(threemf(model(replaced(small, "v1=\"0\"", "v1=\"9\""), item)), {"face 1 of 4", "does not exist"});
    expect(threemf(model(replaced(small, "v1=\"0\"", ""), item)), {"face 1 of 4"});
    expect(threemf(model(small, "<item objectid=\"1\" transform=\"1 0 0\"/>")), {"'1 0 0'", "twelve numbers"});
    expect(threemf(model(replaced(small, "</vertices>", "</vertices"), item)), {"a.3mf: "});
    expect(threemf(kModel.substr(0, kModel.size() - 9)), {"3dmodel.model", "ends within"});
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
}

}  // namespace
}  // namespace scaleaxis
