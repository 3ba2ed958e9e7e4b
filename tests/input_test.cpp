// SPDX-License-Identifier: Apache-2.0
// Where content comes from and goes to, whatever its format: bytes, pipes, devices; and what errors say as data.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "folder.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

// Windows has no pipes and devices in folders.
#if !defined(_WIN32)
#include <sys/stat.h>
#define SCALEAXIS_HAS_PIPES
#endif

namespace scaleaxis {
namespace {

namespace fs = std::filesystem;

const std::string kTetrahedron = "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

class Input : public test::FolderTest {
#if defined(SCALEAXIS_HAS_PIPES)
   protected:
    fs::path pipe(const std::string& name) const {
        EXPECT_EQ(::mkfifo(path(name).c_str(), 0600), 0);
        return path(name);
    }
#endif
};

FileBytes bytes_of(const std::string& content, const std::string& name) {
    return {std::as_bytes(std::span(content)), name};
}

Diagnostic diagnostic_of(const std::function<void()>& call) {
    try {
        call();
    } catch (const FileError& error) {
        EXPECT_EQ(error.diagnostic().message, error.what());
        return error.diagnostic();
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
}

TEST_F(Input, BytesAreReadAsFilesAre) {
    EXPECT_EQ(file_kind(bytes_of(kTetrahedron, "upload")), FileKind::kMesh);
    EXPECT_EQ(read_mesh(bytes_of(kTetrahedron, "upload")).triangles.size(), 4u);
    const std::string balls = "0 0 0 1\n1 0 0 1\n";
    EXPECT_EQ(file_kind(bytes_of(balls, "upload")), FileKind::kBalls);
    EXPECT_EQ(read_balls(bytes_of(balls, "upload")).size(), 2u);
    const std::string points = "0 0 0.5\n1 0 0\n";
    EXPECT_EQ(read_points(bytes_of(points, "upload")).points.size(), 2u);
    const std::string axis = "2 1 0\nv 0 0 0 1\nv 1 0 0 1\ne 0 1\n";
    EXPECT_EQ(read_axis(bytes_of(axis, "upload")).edges.size(), 1u);
    // Three whole numbers may be points or the counts of another format: the name tells.
    EXPECT_EQ(file_kind(bytes_of("1 2 3\n4 5 6\n", "upload.xyz")), FileKind::kPoints);
    const Diagnostic fault = diagnostic_of([] { file_kind(bytes_of("\xff\xd8\xff", "picture.jpg")); });
    EXPECT_EQ(fault.code, "file.format");
    EXPECT_TRUE(fault.message.starts_with("picture.jpg: ")) << fault.message;
    EXPECT_EQ(diagnostic_of([] {
                  read_mesh(FileBytes{{}, "nothing"});
              }).message,
              "nothing: cannot read: the file is empty");
}

#if defined(SCALEAXIS_HAS_PIPES)
TEST_F(Input, PipesAreReadOnce) {
    const std::string large = [] {
        std::string text;
        for (int i = 0; i < 200'000; ++i) {
            text += "0 0 " + std::to_string(i) + " 1\n";
        }
        return text;
    }();
    const auto with_writer = [&](const std::string& content, const auto& read) {
        const fs::path file = pipe("pipe");
        std::thread writer([&] { std::ofstream(file, std::ios::binary) << content; });
        read(file);
        writer.join();
        fs::remove(file);
    };
    with_writer(kTetrahedron, [](const fs::path& file) { EXPECT_EQ(read_mesh(file).vertices.size(), 4u); });
    with_writer(kTetrahedron, [](const fs::path& file) { EXPECT_EQ(file_kind(file), FileKind::kMesh); });
    with_writer(large, [](const fs::path& file) { EXPECT_EQ(read_balls(file).size(), 200'000u); });
    with_writer(large, [&](const fs::path& file) {
        const std::vector<std::byte> bytes = read_bytes(file);
        EXPECT_TRUE(std::ranges::equal(bytes, std::as_bytes(std::span(large))));
    });
    with_writer("", [](const fs::path& file) {
        EXPECT_EQ(diagnostic_of([&] { read_mesh(file); }).message, file.string() + ": cannot read: the file is empty");
    });
}

TEST_F(Input, ImagesComeThroughPipes) {
    const std::string image = "X: 2\nY: 1\nZ: 1\nVersion: 2\n.\n\x01\x02";
    const fs::path file = pipe("pipe");
    std::thread writer([&] { std::ofstream(file, std::ios::binary) << image; });
    EXPECT_EQ(read_image(file).values, (std::vector<float>{1, 2}));
    writer.join();
}
#endif

TEST_F(Input, ErrorsAreData) {
    const auto fault = [&](const std::string& name, const std::string& content) {
        return diagnostic_of([&] {
            const fs::path file = write(name, content);
            switch (file_kind(file)) {
                case FileKind::kPoints:
                    read_points(file);
                    break;
                case FileKind::kBalls:
                    read_balls(file);
                    break;
                case FileKind::kAxis:
                    read_axis(file);
                    break;
                default:
                    read_mesh(file);
            }
        });
    };
    const auto expect = [&](const Diagnostic& found, const std::string& code, const std::string& element,
                            std::int64_t index) {
        EXPECT_EQ(found.code, code) << found.message;
        EXPECT_EQ(found.element, element) << found.message;
        EXPECT_EQ(found.index, index) << found.message;
    };
    expect(fault("a.obj", "v 0 0 0\nv 1 x 0\n"), "file.syntax", "line", 2);
    expect(fault("a.off", kTetrahedron.substr(0, 30)), "file.truncated", "line", 6);
    expect(fault("a.off", "OFF\n1000000 1 0\n0 0 0\n"), "file.truncated", "line", 2);
    expect(fault("a.off", "OFF BINARY\n"), "file.unsupported", "line", 1);
    expect(fault("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n"), "file.value", "face", 2);
    expect(fault("a.txt", "0 0 0 1\n0 0 0 -1\n"), "file.value", "ball", 2);
    expect(fault("a.ma", "2 1 0\nv 0 0 0 1\nv 1 0 0 -1\ne 0 1\n"), "file.value", "vertex", 2);
    expect(fault("a.ply",
                 "ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty float x\nproperty float y\n"
                 "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0123"),
           "file.truncated", "", -1);
    expect(diagnostic_of([&] { read_mesh(path("absent.off")); }), "file.open", "", -1);
    expect(diagnostic_of([&] { read_mesh(folder()); }), "file.open", "", -1);
    expect(diagnostic_of([&] { read_image(path("absent.nrrd")); }), "file.open", "", -1);
    expect(diagnostic_of([&] { write_mesh(path("a.xyz"), {}); }), "file.format", "", -1);
}

TEST_F(Input, AnAxisThatIsNoneIsNotWritten) {
    MedialComplex axis;
    axis.vertices = {{0, 0, 0}, {1, 0, 0}};
    axis.radii = {1, 1};
    axis.vertex_origins.resize(2);
    axis.edges = {{0, 1}};
    write_axis(path("good.ma"), axis);
    MedialComplex without_radii = axis;
    without_radii.radii.clear();
    MedialComplex without_end = axis;
    without_end.edges[0][1] = 2;
    for (const std::string name : {"a.ply", "a.ma", "a.vtp", "a.obj", "a.glb"}) {
        EXPECT_THROW(write_axis(path(name), without_radii), UnusableInput) << name;
        EXPECT_THROW(write_axis(path(name), without_end), UnusableInput) << name;
    }
    EXPECT_EQ(names(), std::set<std::string>{"good.ma"});
}

TEST_F(Input, TheFolderThatIsAbsentIsNamed) {
    const fs::path file = path("absent/deeper/a.ply");
    const Diagnostic fault = diagnostic_of([&] { write_mesh(file, {}); });
    EXPECT_EQ(fault.code, "file.write");
    EXPECT_NE(fault.message.find("there is no folder " + path("absent/deeper").string()), std::string::npos)
        << fault.message;
    EXPECT_EQ(diagnostic_of([&] { check_mesh_output(file); }).message, fault.message);
}

#if defined(SCALEAXIS_HAS_PIPES)
TEST_F(Input, PipesAndDevicesAreWrittenToDirectly) {
    fs::create_symlink("/dev/full", path("full.txt"));
    const std::vector<Ball> balls(10, Ball{{1, 2, 3}, 4});
    check_balls_output(path("full.txt"));
    const Diagnostic fault = diagnostic_of([&] { write_balls(path("full.txt"), balls); });
    EXPECT_EQ(fault.code, "file.write");
    EXPECT_NE(fault.message.find("space"), std::string::npos) << fault.message;
    EXPECT_TRUE(fs::is_symlink(path("full.txt")));

    const fs::path file = pipe("pipe.txt");
    check_balls_output(file);
    std::string received;
    std::thread reader([&] {
        std::ifstream stream(file, std::ios::binary);
        received.assign(std::istreambuf_iterator<char>(stream), {});
    });
    write_balls(file, balls);
    reader.join();
    EXPECT_EQ(read_balls(bytes_of(received, "pipe")).size(), 10u);
    EXPECT_TRUE(fs::is_fifo(file));
    EXPECT_EQ(names(), (std::set<std::string>{"full.txt", "pipe.txt"}));
}
#endif

}  // namespace
}  // namespace scaleaxis
