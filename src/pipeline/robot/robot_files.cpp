// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include "base/faults.hpp"
#include "base/formats/json.hpp"
#include "scaleaxis/robot.hpp"

namespace scaleaxis::inline v1 {
namespace {

std::string number_text(double value) { return Json(value).dump(); }

std::string attribute_text(const std::string& text) {
    std::string result;
    for (const char c : text) {
        result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    }
    return result;
}

/// Block style; lists of plain values in one line. Strings are quoted, whose escapes are those of JSON.
std::string yaml_of(const Json& value, const std::string& indent = "") {
    std::string text;
    const auto is_plain = [](const Json& item) { return !item.is_object() && !item.is_array(); };
    const auto below = [&](const Json& item) {
        const bool is_short =
            is_plain(item) || item.size() == 0 || (item.is_array() && std::ranges::all_of(item.elements(), is_plain));
        return is_short ? " " + item.dump() + "\n" : "\n" + yaml_of(item, indent + "  ");
    };
    if (value.is_object()) {
        for (const auto& [name, item] : value.members()) {
            text.append(indent).append(Json(name).dump()).append(":").append(below(item));
        }
    } else {
        for (const Json& item : value.elements()) {
            std::string inner = yaml_of(item, indent + "  ");
            inner.replace(indent.size(), 1, "-");
            text += inner;
        }
    }
    return text;
}

Json centers_of(const std::vector<Ball>& balls) {
    Json centers = Json::array();
    for (const auto& [c, radius] : balls) {
        centers.push_back(Json::array({c.x, c.y, c.z}));
    }
    return centers;
}

std::string curobo_text(const Robot& robot, std::span<const LinkBalls> links) {
    Json names = Json::array(), spheres = Json::object(), buffers = Json::object(), ignored = Json::object();
    for (const auto& [link, balls] : links) {
        names.push_back(link);
        buffers[link] = 0.0;
        Json list = Json::array();
        for (const auto& [c, radius] : balls) {
            list.push_back({{"center", Json::array({c.x, c.y, c.z})}, {"radius", radius}});
        }
        spheres[link] = list;
    }
    for (const IgnoredPair& pair : robot.ignored_pairs(links)) {
        ignored[pair.first].push_back(pair.second);
    }
    Json joints = Json::array(), rest = Json::array(), ones = Json::array();
    for (const RobotJoint& joint : robot.joints()) {
        if (joint.is_driven) {
            joints.push_back(joint.name);
            rest.push_back(joint.rest);
            ones.push_back(1.0);
        }
    }
    std::filesystem::path urdf = robot.file();
    if (urdf.extension() == ".xacro") {
        urdf.replace_extension(urdf.stem().extension() == ".urdf" ? "" : ".urdf");
    }
    // Accelerations and jerks are no part of a URDF: these are the values of cuRobo's own robots.
    const Json space{{"joint_names", joints},          {"default_joint_position", rest}, {"null_space_weight", ones},
                     {"cspace_distance_weight", ones}, {"max_acceleration", 15.0},       {"max_jerk", 500.0}};
    const Json kinematics{{"format_version", 2.0},
                          {"urdf_path", urdf.string()},
                          {"asset_root_path", urdf.parent_path().string()},
                          {"base_link", robot.base()},
                          {"tool_frames", Json(robot.tips())},
                          {"collision_link_names", names},
                          {"mesh_link_names", names},
                          {"collision_sphere_buffer", 0.0},
                          {"self_collision_buffer", buffers},
                          {"self_collision_ignore", ignored},
                          {"cspace", space},
                          {"collision_spheres", spheres}};
    return yaml_of(Json{{"robot_cfg", Json{{"kinematics", kinematics}}}});
}

std::string ballpark_text(const Robot& robot, std::span<const LinkBalls> links) {
    Json spheres = Json::object(), pairs = Json::array();
    for (const auto& [link, balls] : links) {
        Json radii = Json::array();
        std::ranges::for_each(balls, [&](const Ball& ball) { radii.push_back(ball.radius); });
        spheres[link] = Json{{"centers", centers_of(balls)}, {"radii", radii}};
    }
    for (const IgnoredPair& pair : robot.ignored_pairs(links)) {
        pairs.push_back(Json::array({pair.first, pair.second}));
    }
    return Json{{"spheres", spheres}, {"ignore_pairs", pairs}}.dump(2) + "\n";
}

std::string srdf_of(const Robot& robot, std::span<const LinkBalls> links) {
    std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"" + attribute_text(robot.name()) + "\">\n";
    for (const auto& [link, balls] : links) {
        text += "  <link_sphere_approximation link=\"" + attribute_text(link) + "\">\n";
        for (const auto& [c, radius] : balls) {
            text += "    <sphere center=\"" + number_text(c.x) + ' ' + number_text(c.y) + ' ' + number_text(c.z) +
                    "\" radius=\"" + number_text(radius) + "\"/>\n";
        }
        text += "  </link_sphere_approximation>\n";
    }
    // MoveIt's words for the two reasons.
    for (const IgnoredPair& pair : robot.ignored_pairs(links)) {
        text += "  <disable_collisions link1=\"" + attribute_text(pair.first) + "\" link2=\"" +
                attribute_text(pair.second) + "\" reason=\"" + (pair.is_adjacent ? "Adjacent" : "Default") + "\"/>\n";
    }
    return text + "</robot>\n";
}

// The configuration of cricket: it names the type of the robot in C++.
std::string cricket_text(const Robot& robot, const std::string& name) {
    std::string type = name;
    std::ranges::replace_if(
        type, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
    type.insert(0, !type.empty() && std::isdigit(static_cast<unsigned char>(type.front())) != 0 ? "R" : "");
    type.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(type.front())));
    return Json{{"name", type},
                {"urdf", name + "_spherized.urdf"},
                {"srdf", name + "_spherized.srdf"},
                {"end_effectors", Json::array({robot.tips().back()})},
                {"resolution", 32},
                {"template", "templates/fk_template.hh"},
                {"subtemplates", Json::array({Json{{"name", "ccfk"}, {"template", "templates/ccfk_template.hh"}}})},
                {"output", name + "_fk.hh"}}
               .dump(2) +
           "\n";
}

}  // namespace

std::vector<TextFile> robot_files(const Robot& robot, std::span<const LinkBalls> links, const std::string& format,
                                  const std::string& name, Index large) {
    if (format == "curobo") {
        return {{name + ".yml", curobo_text(robot, links)}};
    }
    if (format == "ballpark") {
        return {{name + ".json", ballpark_text(robot, links)}};
    }
    if (format == "srdf") {
        return {{name + ".srdf", srdf_of(robot, links)}};
    }
    if (format == "urdf") {
        return {{name + ".urdf", robot.with_balls(links)}};
    }
    require(format == "vamp", "\"" + format + "\" is no format of a robot: curobo, vamp, ballpark, srdf and urdf are");
    std::vector<LinkBalls> upper;
    for (const auto& [link, balls] : links) {
        upper.push_back({link, balls.empty() ? balls : enclosing_balls(balls, large)});
    }
    return {{name + "_spherized.urdf", robot.with_balls(links)},
            {name + "_spherized_1.urdf", robot.with_balls(upper)},
            {name + "_spherized.srdf", srdf_of(robot, links)},
            {name + ".json", cricket_text(robot, name)}};
}

}  // namespace scaleaxis::inline v1
