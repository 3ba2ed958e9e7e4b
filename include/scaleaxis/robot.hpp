// SPDX-License-Identifier: Apache-2.0
/// \file
/// Robots: what their links collide with, spheres in its place, and the files in which planners read those.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scaleaxis/execution.hpp"
#include "scaleaxis/export.hpp"
#include "scaleaxis/few_balls.hpp"
#include "scaleaxis/geometry.hpp"
#include "scaleaxis/length.hpp"
#include "scaleaxis/load.hpp"
#include "scaleaxis/scale_axis.hpp"

namespace scaleaxis::inline v1 {

/// What a link collides with, in its own frame.
struct LinkShape {
    std::string link;
    TriangleMesh mesh;          ///< meshes, boxes and cylinders: all triangles
    std::vector<Ball> spheres;  ///< those that the description has already
};

struct LinkBalls {
    std::string link;
    std::vector<Ball> balls;
};

/// Links whose collisions are not to be looked for.
struct IgnoredPair {
    std::string first;  ///< in the order of the description
    std::string second;
    bool is_adjacent = false;  ///< no link with spheres lies between them; if not, their spheres touch at rest
};

struct RobotJoint {
    std::string name;
    std::string type;
    std::string parent;
    std::string child;
    double rest = 0.0;       ///< see `RobotOptions::rest`
    bool is_driven = false;  ///< moves, and follows no other joint
};

struct RobotOptions {
    /// Folders of packages that `package://NAME/PATH` names, or folders that packages are in. The folders above the
    /// description are looked through too.
    std::vector<std::filesystem::path> packages = {};
    /// Positions of joints at rest. Others are at 0, or in the middle of their limits where 0 lies outside, as MoveIt
    /// has it.
    std::map<std::string, double> rest = {};
};

/// A description of a robot (URDF), and the meshes that it names.
class SCALEAXIS_EXPORT Robot {
   public:
    /// \throws FileError naming the link or joint, and what is wrong; InvalidOption for a joint that is not there
    explicit Robot(const std::filesystem::path& file, const RobotOptions& options = {});
    /// \param text of the description \param file that it comes from: for messages, and its folder for meshes
    Robot(const std::string& text, const std::filesystem::path& file, const RobotOptions& options = {});
    ~Robot();
    Robot(Robot&&) noexcept;

    const std::string& name() const;
    const std::filesystem::path& file() const;
    /// Links that collide with something, in the order of the description.
    const std::vector<LinkShape>& links() const;
    const std::vector<RobotJoint>& joints() const;
    /// The link that no joint moves, and those that no joint is on.
    const std::string& base() const;
    const std::vector<std::string>& tips() const;
    /// What reading meshes has left out or repaired.
    const std::vector<Diagnostic>& warnings() const;

    /// The description with spheres in place of all that the links named collided with.
    std::string with_balls(std::span<const LinkBalls> links) const;

    /// Links next to each other, those between them without spheres left out of account, and links whose spheres touch
    /// at rest.
    std::vector<IgnoredPair> ignored_pairs(std::span<const LinkBalls> links) const;

   private:
    struct Content;
    std::unique_ptr<Content> content_;
};

struct RobotSpheresOptions {
    FewBallsKind kind = FewBallsKind::kCover;
    std::optional<Index> count = {};  ///< for each link
    std::optional<Index> total = {};  ///< for all links together, see `shared_balls`; in place of `count`
    std::optional<Length> error = {};
    std::map<std::string, std::vector<HalfSpace>> clip = {};  ///< by link, in its frame
    double effort = 1.0;
    Length delta = kDefaultDelta;
    Sizing sizing = Sizing::kAdaptive;
    std::uint64_t seed = 1;
    SolidOptions solid = {};  ///< how the triangles of a link become a solid
};

/// Spheres of a link. Those that it has already come last; statistics and scores are about the others.
struct LinkSpheres {
    std::string link;
    std::vector<Ball> balls;
    std::optional<FewBallsStatistics> statistics = {};
    std::optional<BallScores> scores = {};
    double diagonal = 0.0;  ///< of the solid
};

/// Spheres for each link. Those that a link has already stay, and count.
/// \throws InvalidOption, also for links that are not there; UnusableInput naming the link; Cancelled
SCALEAXIS_EXPORT std::vector<LinkSpheres> robot_spheres(const Robot& robot, const RobotSpheresOptions& options,
                                                        const Execution& execution = {});

/// Points at which balls that stand for a solid are measured: of its surface, other than those that it was sampled at,
/// and of triangles that it left out, as dense.
SCALEAXIS_EXPORT std::vector<Point> points_to_score(const Solid& solid, const Samples& samples,
                                                    const TriangleMesh& left_out, std::uint64_t seed = 1,
                                                    const Execution& execution = {});

struct TextFile {
    std::string name;
    std::string text;
};

/// The complete files of a program that plans motions:
///   "curobo"    NAME.yml, the configuration of a robot as of version 2
///   "vamp"      NAME_spherized.urdf and .srdf, NAME_spherized_1.urdf with `large` spheres a link around those of the
///               first, and NAME.json for cricket, which makes VAMP's code of them
///   "ballpark"  NAME.json: spheres by link and pairs that are ignored, as pyroki reads them too
///   "srdf"      NAME.srdf: spheres of links and collisions that are disabled, as MoveIt reads them
///   "urdf"      NAME.urdf: the description with spheres
/// \param name of the files \throws InvalidOption for another format
SCALEAXIS_EXPORT std::vector<TextFile> robot_files(const Robot& robot, std::span<const LinkBalls> links,
                                                   const std::string& format, const std::string& name, Index large = 1);

}  // namespace scaleaxis::inline v1
