// SPDX-License-Identifier: Apache-2.0
/// \file
/// Descriptions of robots (URDF): what their links collide with, and spheres in its place.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "scaleaxis/geometry.hpp"
#include "sphere_files.hpp"

namespace scaleaxis::app {

/// What a link collides with, in its own frame.
struct LinkShape {
    std::string link;
    TriangleMesh mesh;          ///< meshes, boxes and cylinders: all triangles
    std::vector<Ball> spheres;  ///< those that the description has already
};

class Robot {
   public:
    /// Reads a description and the meshes that it names: relative to its folder, `file://`, or `package://NAME/PATH`,
    /// which is looked for in the packages, and in the folders above the description.
    /// \param packages folders of packages, or folders that packages are in
    /// \throws FileError naming the link, and what is wrong
    Robot(const std::filesystem::path& file, const std::vector<std::filesystem::path>& packages);
    ~Robot();
    Robot(Robot&&) noexcept;

    const std::string& name() const;
    /// Links that collide with something, in the order of the description.
    const std::vector<LinkShape>& links() const;

    /// The description with spheres in place of all that the links named collided with.
    std::string with_spheres(const std::vector<LinkSpheres>& links) const;

   private:
    struct Content;
    std::unique_ptr<Content> content_;
};

/// Is the file named as a URDF is?
bool is_urdf(const std::filesystem::path& file);

}  // namespace scaleaxis::app
