// SPDX-License-Identifier: Apache-2.0
//
// Point clouds in files.
#include <gtest/gtest.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "folder.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis {
namespace {

namespace fs = std::filesystem;

class PointsIo : public test::FolderTest {
   protected:
    /// The message of the error that reading leads to; empty if there is none.
    std::string error(const std::string& name, const std::string& content) const {
        try {
            read_points(write(name, content));
        } catch (const FileError& e) {
            return e.what();
        }
        return "";
    }
};

const std::vector<Point> kPoints{{0.5, -1.25, 2}, {3, 4, 5}, {-6, 7, 8.5}};
const std::vector<Point> kNormals{{0, 0, 1}, {0, -2, 0}, {1, 1, 1}};

template <class T>
std::string bytes(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string pcd_head(const std::string& fields, const std::string& size, const std::string& type,
                     const std::string& count, const std::string& data) {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size + "\nTYPE " + type + "\nCOUNT " + count +
           "\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 3\nDATA " + data + "\n";
}

TEST_F(PointsIo, ReadsText) {
    const std::string plain = "# points\n0.5 -1.25 2\n3 4 5\n\n-6 7 8.5\n";
    const std::string with_normals = "0.5 -1.25 2 0 0 1\r\n3 4 5 0 -2 0 \r\n-6\t7 8.5 1 1 1\r\n";
    for (const std::string name : {"a.xyz", "a.pts", "a.pwn", "a.txt", "a"}) {
        const fs::path file = write(name, plain);
        EXPECT_EQ(file_kind(file), FileKind::kPoints) << name;
        EXPECT_EQ(read_points(file).points, kPoints) << name;
        EXPECT_TRUE(read_points(file).normals.empty()) << name;
        const PointCloud cloud = read_points(write(name, with_normals));
        EXPECT_EQ(cloud.points, kPoints) << name;
        EXPECT_EQ(cloud.normals, kNormals) << name;
    }
}

TEST_F(PointsIo, ReadsTextWithACount) {
    EXPECT_EQ(read_points(write("a.pts", "3\n0.5 -1.25 2\n3 4 5\n-6 7 8.5\n")).points, kPoints);
    const std::string scan = "3\n0.5 -1.25 2 -100 255 0 3\n3 4 5 7 1 2 3\n-6 7 8.5 9 0 0 0\n";
    EXPECT_EQ(read_points(write("scan.pts", scan)).points, kPoints);
    EXPECT_TRUE(read_points(write("scan.pts", scan)).normals.empty());
    const PointCloud blocks = read_points(write("a.pwn", "3\n0.5 -1.25 2\n3 4 5\n-6 7 8.5\n0 0 1\n0 -2 0\n1 1 1\n"));
    EXPECT_EQ(blocks.points, kPoints);
    EXPECT_EQ(blocks.normals, kNormals);
}

TEST_F(PointsIo, TellsPointsFromBallsAndMeshes) {
    EXPECT_EQ(file_kind(write("a.xyz", "1 2 3 4\n")), FileKind::kBalls) << "four columns are balls";
    EXPECT_NE(error("a.xyz", "1 2 3 4\n").find("line 1: four numbers"), std::string::npos);
    EXPECT_EQ(file_kind(write("a.xyz", "1 2 3\n4 5 6\n")), FileKind::kPoints) << "by its name";
    EXPECT_EQ(file_kind(write("a.off", "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")), FileKind::kMesh);
    EXPECT_EQ(file_kind(write("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")), FileKind::kMesh);
    EXPECT_EQ(file_kind(write("a.off", "OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n")), FileKind::kPoints);
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    EXPECT_EQ(file_kind(write("a.ply", head + "end_header\n1 2 3\n")), FileKind::kPoints);
    EXPECT_EQ(
        file_kind(write("a.ply", head + "element face 0\nproperty list uchar int vertex_index\nend_header\n1 2 3\n")),
        FileKind::kPoints);
    EXPECT_EQ(
        file_kind(write("a.ply", head + "element face 1\nproperty list uchar int vertex_index\nend_header\n1 2 3\n")),
        FileKind::kMesh);
}

TEST_F(PointsIo, TellsColoursFromNormals) {
    EXPECT_TRUE(read_points(write("a.xyz", "1 2 3 117 73 49\n4 5 6 0 0 1\n")).normals.empty());
    EXPECT_EQ(read_points(write("a.xyz", "1 2 3 0 0 1\n4 5 6 0 1 0\n")).normals.size(), 2U) << "along the axes";
    EXPECT_EQ(read_points(write("a.xyz", "1 2 3 0 0 100\n4 5 6 0 -100 0\n")).normals.size(), 2U);
}

TEST_F(PointsIo, ReadsPly) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    EXPECT_EQ(read_points(write("a.ply", head + "end_header\n0.5 -1.25 2\n3 4 5\n-6 7 8.5\n")).points, kPoints);
    const PointCloud cloud =
        read_points(write("a.ply", head + "property float nx\nproperty float ny\nproperty float nz\nend_header\n"
                                          "0.5 -1.25 2 0 0 1\n3 4 5 0 -2 0\n-6 7 8.5 1 1 1\n"));
    EXPECT_EQ(cloud.points, kPoints);
    EXPECT_EQ(cloud.normals, kNormals);
}

TEST_F(PointsIo, ReadsOff) {
    EXPECT_EQ(read_points(write("a.off", "OFF\n3 0 0\n0.5 -1.25 2\n3 4 5\n-6 7 8.5\n")).points, kPoints);
    const PointCloud cloud =
        read_points(write("a.off", "NOFF 3 0 0\n0.5 -1.25 2 0 0 1\n3 4 5 0 -2 0\n-6 7 8.5 1 1 1\n"));
    EXPECT_EQ(cloud.points, kPoints);
    EXPECT_EQ(cloud.normals, kNormals);
}

TEST_F(PointsIo, TakesTheVerticesOfMeshes) {
    const std::string vertices = "v 0.5 -1.25 2\nv 3 4 5\nv -6 7 8.5\n";
    const std::string normals = "vn 0 0 1\nvn 0 -2 0\nvn 1 1 1\n";
    const auto expect = [&](const std::string& name, const std::string& content, const std::vector<Point>& expected) {
        const PointCloud cloud = read_points(write(name, content));
        EXPECT_EQ(cloud.points, kPoints) << content;
        EXPECT_EQ(cloud.normals, expected) << content;
    };
    expect("a.obj", vertices, {});
    EXPECT_EQ(file_kind(path("a.obj")), FileKind::kPoints) << "no faces";
    expect("a.obj", vertices + normals, kNormals);
    expect("a.obj", vertices + "vn 0 0 1\n", {});
    expect("a.obj", vertices + "f 1 2 3\n", {});
    EXPECT_EQ(file_kind(path("a.obj")), FileKind::kMesh);
    expect("a.obj", vertices + normals + "f 1 2 3\n", kNormals);
    expect("a.obj", vertices + "vn 1 1 1\nvn 0 -2 0\nvn 0 0 1\nf 1//3 2/7/2 -1//-3\n", kNormals);
    expect("a.obj", vertices + normals + "f 1//1 2//2 2//2\n", {});  // one has none
    expect("a.stl",
           "solid\nfacet normal 0 0 1\nouter loop\nvertex 0.5 -1.25 2\nvertex 3 4 5\nvertex -6 7 8.5\n"
           "endloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex -6 7 8.5\nvertex 3 4 5\n"
           "vertex 0.5 -1.25 2\nendloop\nendfacet\nendsolid\n",
           {});
    expect("a.ply",
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "property float nx\nproperty float ny\nproperty float nz\nelement face 1\n"
           "property list uchar int vertex_indices\nend_header\n"
           "0.5 -1.25 2 0 0 1\n3 4 5 0 -2 0\n-6 7 8.5 1 1 1\n3 0 1 2\n",
           kNormals);
    EXPECT_NE(error("a.obj", "v 1 2\n"), "");
}

TEST_F(PointsIo, ReadsTables) {
    const std::vector<std::string> plain{
        "0.5,-1.25,2\n3,4,5\n-6,7,8.5\n",
        "# a comment\n\n0.5; -1.25; 2\r\n3;4;5\r\n-6;7;8.5",
        "X,Y,Z\n0.5,-1.25,2\n3,4,5\n\n-6,7,8.5\n",
        "\xEF\xBB\xBFid\tz\tname\tx\ty\n1\t2\ta b\t0.5\t-1.25\n2\t5\t\t3\t4\n3\t8.5\tc\t-6\t7\n",
        "\"x\",\"y\",\"z\",\"text\"\n0.5,-1.25,2,\"a, b\"\n\"3\",4,5,\n-6,7,8.5,c\n",
        "//X;Y;Z;R\n0.5;-1.25;2;255\n3;4;5;0\n-6;7;8.5;1\n",
        "# x, y, z\n0.5,-1.25,2\n3,4,5\n-6,7,8.5\n",
        "0.5,-1.25,2,255,0,0\n3,4,5,1,2,3\n-6,7,8.5,0,0,0\n",
        "0.5,-1.25,2,1,0,0\n3,4,5,0.25,0.5,0.125\n-6,7,8.5,0,0,0\n"};
    for (const std::string& content : plain) {
        for (const std::string name : {"a.csv", "a.tsv", "a.txt", "a"}) {
            const fs::path file = write(name, content);
            EXPECT_EQ(file_kind(file), FileKind::kPoints) << content;
            EXPECT_EQ(read_points(file).points, kPoints) << content;
            EXPECT_TRUE(read_points(file).normals.empty()) << content;
        }
    }
    EXPECT_EQ(read_points(write("a.tsv", "0.5\t-1.25\t2\n3\t4\t5\n-6\t7\t8.5\n")).points, kPoints);
    for (const std::string& content :
         {std::string("0.5,-1.25,2,0,0,1\n3,4,5,0,-2,0\n-6,7,8.5,1,1,1\n"),
          std::string("nx,ny,nz,x,y,Z\n0,0,1,0.5,-1.25,2\n0,-2,0,3,4,5\n1,1,1,-6,7,8.5\n")}) {
        const PointCloud cloud = read_points(write("a.csv", content));
        EXPECT_EQ(cloud.points, kPoints) << content;
        EXPECT_EQ(cloud.normals, kNormals) << content;
    }
    EXPECT_TRUE(std::isnan(read_points(write("a.csv", "x,y,z\nnan,nan,nan\n1,2,3\n")).points[0].x));
}

TEST_F(PointsIo, NamesTheFaultOfATable) {
    const auto expect = [&](const std::string& content, const std::string& part) {
        const std::string message = error("a.csv", content);
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    };
    expect("x,y,z\n1,2,3\n1,2\n", "line 3: this line has 2 cells, the first one has 3");
    expect("x,y,z\n1,,3\n", "line 2: column 2: '' is not a number");
    expect("x;y;z\n1,5;2,5;3\n", "write decimals with a point");
    expect("1,2,3,4\n", "line 1: this line has 4 numbers");
    expect("a,b,c\n1,2,3\n", "begins with the names of its columns");
    expect("x,y\n1,2\n", "begins with the names of its columns");
}

/// A file of LAS with the points of all tests, at 0.25, 0.25 and 0.5 to a step from (100, 200, -300).
std::string las(int minor, int format, std::size_t record_size, const std::vector<int>& flags = {0, 0, 0}) {
    std::string head(minor >= 4 ? 375 : 227, '\0');
    const auto put = [&](std::size_t at, const std::string& value) { head.replace(at, value.size(), value); };
    put(0, "LASF");
    head[24] = 1;
    head[25] = static_cast<char>(minor);
    put(96, bytes<std::uint32_t>({static_cast<std::uint32_t>(head.size())}));
    head[104] = static_cast<char>(format);
    put(105, bytes<std::uint16_t>({static_cast<std::uint16_t>(record_size)}));
    if (minor >= 4) {
        put(247, bytes<std::uint64_t>({3}));
    } else {
        put(107, bytes<std::uint32_t>({3}));
    }
    put(131, bytes<double>({0.25, 0.25, 0.5, 100, 200, -300}));
    for (std::size_t i = 0; i < 3; ++i) {
        const Point& p = kPoints[i];
        std::string record = bytes<std::int32_t>({static_cast<std::int32_t>((p.x - 100) / 0.25),
                                                  static_cast<std::int32_t>((p.y - 200) / 0.25),
                                                  static_cast<std::int32_t>((p.z + 300) / 0.5)});
        record.resize(record_size, '\7');
        record[15] = static_cast<char>(flags[i]);
        head += record;
    }
    return head;
}

TEST_F(PointsIo, ReadsLas) {
    for (const std::string& content : {las(0, 0, 20), las(2, 3, 34), las(2, 1, 40), las(4, 6, 30), las(4, 10, 67)}) {
        const fs::path file = write("a.las", content);
        EXPECT_EQ(file_kind(file), FileKind::kPoints);
        EXPECT_EQ(read_points(file).points, kPoints);
        for (std::size_t length = 4; length < content.size(); ++length) {
            EXPECT_NE(error("cut.las", content.substr(0, length)).find("truncated"), std::string::npos) << length;
        }
    }
    // Withheld: bit 7 of the classification, or bit 2 of the flags.
    EXPECT_EQ(read_points(write("a.las", las(2, 3, 34, {4, 0x80, 0}))).points,
              (std::vector<Point>{kPoints[0], kPoints[2]}));
    EXPECT_EQ(read_points(write("a.las", las(4, 7, 36, {4, 0x80, 0}))).points,
              (std::vector<Point>{kPoints[1], kPoints[2]}));
}

TEST_F(PointsIo, NamesTheFaultOfALas) {
    const auto expect = [&](const std::string& name, const std::string& content, const std::string& part) {
        const std::string message = error(name, content);
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    expect("a.laz", las(2, 0x83, 34), "a.laz: it is LAZ");
    expect("a.laz", las(2, 0x83, 34), "pdal translate");
    expect("a.las", las(2, 11, 80), "point format is 11");
    expect("a.las", las(2, 3, 20), "20 bytes each");
    expect("a.las", las(2, 3, 34).replace(107, 4, bytes<std::uint32_t>({4000000000U})),
           "4000000000 points, the file has 3");
    expect("a.las", las(4, 6, 30).replace(247, 8, bytes<std::uint64_t>({std::uint64_t{1} << 62})), "the file has 3");
    expect("a.las", las(2, 3, 34).replace(131, 8, bytes<double>({0.0})), "scale");
    expect("a.las", las(2, 3, 34).replace(155, 8, bytes<double>({std::nan("")})), "offset");
    expect("a.las", las(2, 3, 34).replace(96, 4, bytes<std::uint32_t>({4000000000U})), "the file has 0");
}

TEST_F(PointsIo, ReadsPcd) {
    const std::string fields = "x y z rgb normal_x normal_y normal_z";
    const std::string sizes = "4 8 4 4 4 4 4";
    const std::string types = "F F F U F F F";
    const std::string counts = "1 1 1 2 1 1 1";
    const std::string ascii = pcd_head(fields, sizes, types, counts, "ascii") +
                              "0.5 -1.25 2 7 7 0 0 1\n3 4 5 7 7 0 -2 0\n-6 7 8.5 7 7 1 1 1\n";
    std::string by_point;
    for (int i = 0; i < 3; ++i) {
        by_point += bytes<float>({static_cast<float>(kPoints[i].x)}) + bytes<double>({kPoints[i].y}) +
                    bytes<float>({static_cast<float>(kPoints[i].z)}) + bytes<std::uint32_t>({7, 7}) +
                    bytes<float>({static_cast<float>(kNormals[i].x), static_cast<float>(kNormals[i].y),
                                  static_cast<float>(kNormals[i].z)});
    }
    const std::string binary = pcd_head(fields, sizes, types, counts, "binary") + by_point;
    for (const std::string& content : {ascii, binary}) {
        const fs::path file = write("a.pcd", content);
        EXPECT_EQ(file_kind(file), FileKind::kPoints);
        EXPECT_EQ(read_points(file).points, kPoints);
        EXPECT_EQ(read_points(file).normals, kNormals);
        for (std::size_t length = 0; length < content.size() - 4; length += 7) {
            EXPECT_NE(error("cut.pcd", content.substr(0, length)), "") << length;
        }
    }
}

TEST_F(PointsIo, UnpacksPcd) {
    // x: 1 1 1, y: 1 1 1, z: 1 1 1: four bytes as they are, then copies of them, overlapping.
    const std::string one = bytes<float>({1.0F});
    std::string packed = "\x03" + one;         // 4 bytes
    packed += std::string("\xE0\x17\x03", 3);  // 7 + 23 + 2 = 32 bytes from 4 back
    const std::string head = pcd_head("x y z", "4 4 4", "F F F", "1 1 1", "binary_compressed");
    const auto with_sizes = [&](std::uint32_t packed_size, std::uint32_t size, const std::string& data) {
        return head + bytes<std::uint32_t>({packed_size, size}) + data;
    };
    EXPECT_EQ(read_points(write("a.pcd", with_sizes(8, 36, packed))).points, std::vector<Point>(3, {1, 1, 1}));
    EXPECT_NE(error("a.pcd", with_sizes(8, 37, packed)), "") << "too short";
    EXPECT_NE(error("a.pcd", with_sizes(8, 35, packed)), "") << "too long";
    EXPECT_NE(error("a.pcd", with_sizes(9, 36, packed)), "") << "truncated";
    EXPECT_NE(error("a.pcd", with_sizes(8, 4000000000U, packed)), "") << "absurd";
    EXPECT_NE(error("a.pcd", with_sizes(8, 36, "\x03" + one + std::string("\xE0\x17\x09", 3))), "")
        << "before the data";
}

// Organised clouds have a NaN where the scanner saw nothing, also in their first point.
TEST_F(PointsIo, ReadsPointsThatAreNotFinite) {
    const float nan = std::nanf("");
    const std::vector<float> numbers{nan, nan, nan, 3, 4, 5, 1, INFINITY, 2};
    const std::string rows = "nan nan nan\n3 4 5\n1 inf 2\n";
    const std::string ply = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    const auto pcd = [&](const std::string& data) { return pcd_head("x y z", "4 4 4", "F F F", "1 1 1", data); };
    for (const fs::path& file :
         {write("a.xyz", rows), write("a.pcd", pcd("ascii") + rows), write("b.pcd", pcd("binary") + bytes(numbers)),
          write("a.ply", "ply\nformat ascii 1.0\n" + ply + rows),
          write("b.ply", "ply\nformat binary_little_endian 1.0\n" + ply + bytes(numbers))}) {
        SCOPED_TRACE(file);
        const std::vector<Point> points = read_points(file).points;
        ASSERT_EQ(points.size(), 3U);
        EXPECT_TRUE(std::isnan(points[0].x) && std::isnan(points[0].y) && std::isnan(points[0].z));
        EXPECT_EQ(points[1], (Point{3, 4, 5}));
        EXPECT_TRUE(std::isinf(points[2].y));
    }
}

TEST_F(PointsIo, NamesTheLineOfAnError) {
    const auto expect = [&](const std::string& content, const std::string& part) {
        const std::string message = error("a.xyz", content);
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
    };
    expect("1 2 3\n\n1 2\n", "line 3: this line has 2 numbers");
    expect("1.5 2 3\n1 x 3\n", "line 2: 'x' is not a number");
    expect("1 2 3 4 5\n", "line 1: a line of a point has three numbers");
    expect("4\n1 2 3\n4 5 6\n", "announces 4 points, but the file has 2");
    EXPECT_NE(error("a.pcd", pcd_head("x y w", "4 4 4", "F F F", "1 1 1", "ascii") + "1 2 3\n").find("'x', 'y', 'z'"),
              std::string::npos);
}

TEST_F(PointsIo, CountsOfPcdMeanSomething) {
    const auto expect = [&](const std::string& counts, const std::string& encoding, const std::string& part) {
        const std::string message = error("a.pcd", pcd_head("x y z", "4 4 4", "F F F", counts, encoding) + "1 2 3\n");
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    expect("0 1 1", "ascii", "line 6: '0' is not a count from 1 up");
    expect("0 0 0", "binary", "'0' is not a count");
    expect("-1 1 1", "ascii", "'-1' is not a count");
    // Their product with the size overflows to 0.
    expect("4611686018427387904 1 1", "binary", "is not a count");
    expect("2000000000 1 1", "binary", "the file is too short");
}

TEST_F(PointsIo, LengthsOfNormalsDoNotOverflow) {
    const PointCloud cloud = read_points(write("a.xyz", "0 0 0.5 0 0 3\n0 0 1 0 3e160 4e160\n0 0 2 -1e-200 0 0\n"));
    ASSERT_EQ(cloud.normals.size(), 3u);
    EXPECT_EQ(cloud.normals[0], (Point{0, 0, 3}));
    EXPECT_EQ(cloud.normals[1], (Point{0, 0.75, 1}));
    EXPECT_EQ(cloud.normals[2], (Point{-1, 0, 0}));
}

}  // namespace
}  // namespace scaleaxis
