// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "folder.hpp"
#include "meshes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "solids.hpp"

namespace scaleaxis {
namespace {

using namespace test;
namespace fs = std::filesystem;

class WriteMesh : public test::FolderTest {};

TriangleMesh crooked_mesh() {
    TriangleMesh mesh = torus_mesh(1.0, 0.4, 12);
    for (Point& p : mesh.vertices) {
        p = {p.x / 3.0 + 1e5, p.y * 1e-7, p.z / 7.0};
    }
    return mesh;
}

TEST_F(WriteMesh, ReadsBackAsTheSameMesh) {
    const TriangleMesh mesh = crooked_mesh();
    for (const std::string extension : {".ply", ".obj", ".off", ".PLY"}) {
        SCOPED_TRACE(extension);
        write_mesh(folder() / ("mesh" + extension), mesh);
        const TriangleMesh read = read_mesh(folder() / ("mesh" + extension));
        EXPECT_EQ(read.vertices, mesh.vertices);
        EXPECT_EQ(read.triangles, mesh.triangles);
    }
    // STL has corners instead of vertices; reading makes equal ones one.
    write_mesh(folder() / "mesh.stl", mesh);
    const TriangleMesh read = read_mesh(folder() / "mesh.stl");
    EXPECT_EQ(read.vertices.size(), mesh.vertices.size());
    ASSERT_EQ(read.triangles.size(), mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            ASSERT_EQ(read.vertices[read.triangles[t][k]], mesh.vertices[mesh.triangles[t][k]]);
        }
    }
}

TEST_F(WriteMesh, NothingIsLeftOfAFileThatCannotBeWritten) {
    EXPECT_THROW(write_mesh(folder() / "mesh.vtk", crooked_mesh()), FileError);
    EXPECT_THROW(check_mesh_output(folder() / "mesh.ma"), FileError);
    EXPECT_THROW(check_mesh_output(folder() / "nowhere" / "mesh.ply"), FileError);
    check_mesh_output(folder() / "mesh.off");
    EXPECT_TRUE(fs::is_empty(folder()));
}

TEST_F(WriteMesh, OfNoTrianglesIsStillAFile) {
    for (const std::string extension : {".ply", ".off"}) {
        write_mesh(folder() / ("mesh" + extension), {});
        EXPECT_TRUE(read_mesh(folder() / ("mesh" + extension)).vertices.empty());
    }
}

}  // namespace
}  // namespace scaleaxis
