// SPDX-License-Identifier: Apache-2.0
//
// In the place of scene.cpp where the library is built without Assimp.
#include "io/faults.hpp"
#include "io/formats.hpp"

namespace scaleaxis::io {

PolygonObjects read_scene(std::string_view, std::string_view extension, const std::filesystem::path&) {
    throw unsupported(std::string(extension) +
                      " files need Assimp, and this program was built without it (SCALEAXIS_WITH_ASSIMP=OFF): convert "
                      "it to PLY, OBJ or STL, as by Blender or `assimp export`; in Python, give what "
                      "trimesh.load(file, force=\"mesh\") returns");
}

}  // namespace scaleaxis::io
