// SPDX-License-Identifier: Apache-2.0
//
// The files of data/, which real programs wrote: a model, meshes with faults, and one image in several encodings.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "complexes.hpp"
#include "scaleaxis/distance.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/image.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/medial_axis.hpp"
#include "scaleaxis/mesh.hpp"
#include "scaleaxis/scale_axis.hpp"
#include "scaleaxis/solid.hpp"
#include "solids.hpp"
#include "spatial/nearest_triangle.hpp"
#include "triangle_distances.hpp"
#include "unions.hpp"

namespace scaleaxis {
namespace {

using namespace test;
namespace fs = std::filesystem;

fs::path bundled() { return fs::path(SCALEAXIS_SOURCE_DIR) / "data"; }
TriangleMesh cat() { return read_mesh(bundled() / "cat.obj"); }

TEST(Cat, DistancesToItAreThoseOfAnotherLibrary) {
    const TriangleMesh mesh = cat();
    const Bvh bvh = build_bvh(mesh);
    const TriangleBounds bounds = triangle_bounds(bvh);
    const Box box = surface_bounds(mesh);
    Random random(51);
    std::vector<Point> points;
    std::vector<double> found;
    for (int i = 0; i < 20000; ++i) {
        const double reach = (i % 2 == 0 ? 0.6 : 3.0) * box.diagonal();
        points.push_back(midpoint(box.min, box.max) + random_point(random, reach));
        found.push_back(std::sqrt(nearest_triangle(bvh, bounds, points.back()).squared_distance));
    }
    std::ranges::sort(found);
    const std::vector<double> expected = Triangles(mesh).distances_of(points);
    for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_NEAR(found[i], expected[i], 1e-9 * box.diagonal());
    }
}

struct DirtyFile {
    const char* name;
    const char* outcome;          ///< "axis", the code of the fault, or that of the error
    std::int64_t components = 0;  ///< of an axis
    std::int64_t tunnels = 0;
};

void PrintTo(const DirtyFile& file, std::ostream* out) { *out << file.name; }

class DirtyMesh : public testing::TestWithParam<DirtyFile> {};

// Each bounds a solid, once repaired, or there is one line that tells why not.
TEST_P(DirtyMesh, GivesAnAxisOrAReason) {
    const DirtyFile& file = GetParam();
    std::string reason;
    std::string outcome;
    try {
        const SolidOfTriangles made = solid_of_triangles(read_mesh(bundled() / "dirty" / file.name), {}, {});
        if (made.solid) {
            outcome = "axis";
            const Topology truth = known_topology(file.components, file.tunnels, 0);
            const ScaleAxis result = scale_axis(*made.solid, {.delta = Length::relative(0.02), .scales = {1.0}});
            EXPECT_EQ(result.solid_topology.value_or(truth), truth);
            const AxisAtScale& at = result.axes.at(0);
            expect_well_formed(at.complex);
            EXPECT_EQ(at.medial_statistics.dual_complex, truth);
            EXPECT_EQ(topology(at.complex), at.medial_statistics.dual_complex);
        } else {
            reason = made.report.fault.message;
            outcome = made.report.fault.code;
        }
    } catch (const Error& error) {
        reason = error.what();
        outcome = error.diagnostic().code;
    }
    EXPECT_EQ(outcome, file.outcome) << reason;
    EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    EXPECT_EQ(reason.empty(), outcome == "axis");
}

INSTANTIATE_TEST_SUITE_P(
    Files, DirtyMesh,
    testing::Values(DirtyFile{"boxNotManifold.obj", "axis", 1, 0}, DirtyFile{"comments.off", "axis", 1, 0},
                    DirtyFile{"empty.obj", "file.syntax"}, DirtyFile{"empty.ply", "mesh.empty"},
                    DirtyFile{"empty.stl", "mesh.empty"}, DirtyFile{"fan3.obj", "mesh.sheet"},
                    DirtyFile{"hourglass_ico.obj", "axis", 2, 0}, DirtyFile{"joined_tetrahedra.obj", "axis", 1, 0},
                    DirtyFile{"moebius.obj", "mesh.one_sided"}, DirtyFile{"multibody.stl", "axis", 2, 0},
                    DirtyFile{"negative_indices.obj", "axis", 1, 0}, DirtyFile{"not_convex.obj", "axis", 1, 2},
                    DirtyFile{"notenoughindices.obj", "file.value"}, DirtyFile{"perturb3A.obj", "axis", 1, 0},
                    DirtyFile{"platonic_shelf.obj", "axis", 5, 0}, DirtyFile{"soup.stl", "mesh.sheet"},
                    DirtyFile{"triple_vierbein.obj", "mesh.sheet"}, DirtyFile{"wallhole.obj", "axis", 1, 0},
                    DirtyFile{"whitespace.off", "axis", 1, 0}),
    [](const auto& file) {
        std::string name = file.param.name;
        std::ranges::replace(name, '.', '_');
        return name;
    });

// One ball of 30 × 30 × 30 voxels, as NRRD in four encodings and as NIfTI. The comments of two of the files tell that
// lines and bytes before the data are to be skipped.
TEST(BallOfVoxels, IsTheSameInEveryEncoding) {
    const Image expected = read_image(bundled() / "images" / "BallBinary30x30x30.nrrd");
    EXPECT_EQ(expected.sizes, (std::array<Index, 3>{30, 30, 30}));
    EXPECT_EQ(std::ranges::count_if(expected.values, [](float value) { return value != 0.0F; }), 14328);
    for (const char* name : {"BallBinary30x30x30.nhdr", "BallBinary30x30x30.nii.gz", "BallBinary30x30x30_gz.nrrd",
                             "BallBinary30x30x30_gz_byteskip_minus_one.nrrd", "BallBinary30x30x30_gz_lineskip.nrrd"}) {
        SCOPED_TRACE(name);
        const Image image = read_image(bundled() / "images" / name);
        EXPECT_EQ(image.sizes, expected.sizes);
        EXPECT_TRUE(std::ranges::equal(image.values, expected.values));
    }
}

TEST(BallOfVoxels, HasTheTopologyOfABall) {
    for (const double width : {0.0, 0.7}) {
        SCOPED_TRACE(width);
        const Image image = read_image(bundled() / "images" / "BallBinary30x30x30_gz.nrrd");
        const auto solid = image_solid(smoothed_mask(mask(image, {}), {width}), {});
        const ScaleAxis axis = scale_axis(*solid, {.delta = Length::relative(0.03), .scales = {1.0}});
        EXPECT_TRUE(agree(axis.axes.at(0).medial_statistics.dual_complex, known_topology(1, 0, 0)));
    }
}

}  // namespace
}  // namespace scaleaxis
