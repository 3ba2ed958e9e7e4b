// SPDX-License-Identifier: Apache-2.0
#include "scaleaxis/robot.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <pugixml.hpp>
#include <set>
#include <sstream>
#include <utility>

#include "base/angles.hpp"
#include "base/faults.hpp"
#include "base/formats/xml.hpp"
#include "base/vectors.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis::inline v1 {

// In no unnamed namespace, for `Robot::Content` has them.
namespace robot_parts {

struct Frame {
    std::array<Point, 3> axes{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
    Point origin;

    Point turned(const Point& p) const { return p.x * axes[0] + p.y * axes[1] + p.z * axes[2]; }
    Point operator()(const Point& p) const { return origin + turned(p); }
    Frame composed(const Frame& f) const {
        return {{turned(f.axes[0]), turned(f.axes[1]), turned(f.axes[2])}, (*this)(f.origin)};
    }
};

inline Frame rotation(const Point& axis, double angle) {
    const auto turned = [&](const Point& p) {
        const auto [cosine, sine] = at_angle(angle);
        return cosine * p + sine * cross(axis, p) + (1.0 - cosine) * dot(axis, p) * axis;
    };
    return {{turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})}, {}};
}

// Where a link is in the frame of its parent when its joint is at a position.
struct Mount {
    RobotJoint joint;
    Frame origin;
    Point axis;

    Frame placed() const {
        if (joint.type == "prismatic") {
            return origin.composed({.origin = joint.rest * axis});
        }
        return joint.type == "revolute" || joint.type == "continuous" ? origin.composed(rotation(axis, joint.rest))
                                                                      : origin;
    }
};

}  // namespace robot_parts

namespace {

using robot_parts::Frame;
using robot_parts::Mount;

namespace fs = std::filesystem;
using pugi::xml_node;

// A cylinder becomes a prism of so many sides, around it, so that what covers the prism covers the cylinder.
constexpr int kSides = 64;

std::string attribute(const xml_node& element, const char* name, const char* otherwise = "") {
    return element.attribute(name).as_string(otherwise);
}

[[noreturn]] void fail(const std::string& what) { throw FileError(what); }

/// \param where for messages
std::vector<double> numbers(const std::string& text, std::size_t count, const std::string& where) {
    std::istringstream stream(text);
    std::vector<double> values(count);
    for (double& value : values) {
        if (!(stream >> value) || !std::isfinite(value)) {
            fail(where + " should have " + std::to_string(count) + (count == 1 ? " number" : " numbers") + ": \"" +
                 text + "\"");
        }
    }
    return values;
}

double positive(const xml_node& element, const char* name, const std::string& where) {
    const double value = numbers(attribute(element, name), 1, where + ": " + name).front();
    if (value <= 0.0) {
        fail(where + ": " + name + " should be positive");
    }
    return value;
}

std::string shortest(double value) {
    std::array<char, 32> buffer{};
    return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

// The columns of a rotation: by roll, pitch and yaw about the fixed axes x, y and z, one after the other, or, since
// version 1.1 of URDF, a quaternion.
std::array<Point, 3> rotation_of(const xml_node& origin, const std::string& where) {
    if (!origin.attribute("quat_xyzw")) {
        const auto rpy = numbers(attribute(origin, "rpy", "0 0 0"), 3, where + ": rpy");
        const auto [cr, sr] = at_angle(rpy[0]);
        const auto [cp, sp] = at_angle(rpy[1]);
        const auto [cy, sy] = at_angle(rpy[2]);
        return {Point{cy * cp, sy * cp, -sp}, Point{cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr},
                Point{cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr}};
    }
    if (origin.attribute("rpy")) {
        fail(where + " has both rpy and quat_xyzw: leave one out");
    }
    const auto xyzw = numbers(attribute(origin, "quat_xyzw"), 4, where + ": quat_xyzw");
    const Eigen::Vector4d given(xyzw[0], xyzw[1], xyzw[2], xyzw[3]);
    if (given.isZero(0.0)) {
        fail(where + ": quat_xyzw should not be 0");
    }
    const Eigen::Matrix3d columns = Eigen::Quaterniond(Eigen::Vector4d(given.stableNormalized())).toRotationMatrix();
    const auto column = [&](int k) { return Point{columns(0, k), columns(1, k), columns(2, k)}; };
    return {column(0), column(1), column(2)};
}

Frame frame_of(const xml_node& element, const std::string& where) {
    const xml_node origin = element.child("origin");
    const auto xyz = numbers(attribute(origin, "xyz", "0 0 0"), 3, where + ": xyz");
    return {rotation_of(origin, where), {xyz[0], xyz[1], xyz[2]}};
}

TriangleMesh box(const Point& size) {
    TriangleMesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.vertices.push_back({((corner & 1) != 0 ? 0.5 : -0.5) * size.x, ((corner & 2) != 0 ? 0.5 : -0.5) * size.y,
                                 ((corner & 4) != 0 ? 0.5 : -0.5) * size.z});
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

TriangleMesh cylinder(double radius, double length) {
    TriangleMesh mesh;
    const double around = radius / on_circle(0.5 / kSides)[0];
    for (int i = 0; i < kSides; ++i) {
        const auto [cosine, sine] = on_circle(1.0 * i / kSides);
        for (const double z : {-0.5 * length, 0.5 * length}) {
            mesh.vertices.push_back({around * cosine, around * sine, z});
        }
    }
    const Index low = 2 * kSides, high = low + 1;
    mesh.vertices.push_back({0.0, 0.0, -0.5 * length});
    mesh.vertices.push_back({0.0, 0.0, 0.5 * length});
    for (Index i = 0; i < kSides; ++i) {
        const Index a = 2 * i, b = 2 * ((i + 1) % kSides);
        mesh.triangles.push_back({a, b, b + 1});
        mesh.triangles.push_back({a, b + 1, a + 1});
        mesh.triangles.push_back({low, b, a});
        mesh.triangles.push_back({high, a + 1, b + 1});
    }
    return mesh;
}

void append(TriangleMesh& all, const TriangleMesh& part, const Frame& frame, const Point& scale) {
    const auto first = static_cast<Index>(all.vertices.size());
    for (const Point& p : part.vertices) {
        all.vertices.push_back(frame({scale.x * p.x, scale.y * p.y, scale.z * p.z}));
    }
    const bool is_mirrored = scale.x * scale.y * scale.z < 0.0;
    for (auto [a, b, c] : part.triangles) {
        if (is_mirrored) {
            std::swap(b, c);
        }
        all.triangles.push_back({first + a, first + b, first + c});
    }
}

// Where the file of a mesh is.
fs::path resolved(const std::string& name, const fs::path& urdf, const std::vector<fs::path>& packages,
                  const std::string& where) {
    const fs::path folder = fs::absolute(urdf).parent_path();
    std::string path = name;
    for (const std::string scheme : {"package://", "model://"}) {
        if (!name.starts_with(scheme)) {
            continue;
        }
        path.erase(0, scheme.size());
        const fs::path inside = fs::path(path).lexically_relative(*fs::path(path).begin());
        std::vector<fs::path> roots = packages;
        for (fs::path above = folder; above != above.root_path(); above = above.parent_path()) {
            roots.push_back(above);
        }
        for (const fs::path& root : roots) {
            for (const fs::path& candidate : {root / path, root / inside}) {
                if (fs::is_regular_file(candidate)) {
                    return candidate;
                }
            }
        }
        fail(where + ": " + name + " is not found above " + folder.string() + "; name the folder of its package");
    }
    if (path.starts_with("file://")) {
        path.erase(0, std::string("file://").size());
    }
    const fs::path file = folder / path;
    if (!fs::is_regular_file(file)) {
        fail(where + ": there is no file " + file.string());
    }
    return file;
}

void add_collision(LinkShape& shape, const xml_node& collision, const fs::path& urdf,
                   const std::vector<fs::path>& packages, const std::string& where, std::vector<Diagnostic>& warnings) {
    const Frame frame = frame_of(collision, where);
    const xml_node geometry = collision.child("geometry");
    if (!geometry) {
        fail(where + " has a collision without geometry");
    }
    for (const xml_node& element : geometry.children()) {
        const std::string kind = element.name();
        if (kind == "mesh") {
            const std::string name = attribute(element, "filename");
            const auto scale = numbers(attribute(element, "scale", "1 1 1"), 3, where + ": scale");
            const fs::path file = resolved(name, urdf, packages, where);
            MeshObjects read = read_objects(file);
            for (Diagnostic& warning : read.warnings) {
                warning.message.insert(0, file.string() + ": ");
                warnings.push_back(std::move(warning));
            }
            append(shape.mesh, joined(std::move(read.objects)), frame, {scale[0], scale[1], scale[2]});
        } else if (kind == "box") {
            const auto size = numbers(attribute(element, "size"), 3, where + ": size");
            if (std::ranges::min(size) <= 0.0) {
                fail(where + ": size should be positive");
            }
            append(shape.mesh, box({size[0], size[1], size[2]}), frame, {1, 1, 1});
        } else if (kind == "cylinder") {
            append(shape.mesh, cylinder(positive(element, "radius", where), positive(element, "length", where)), frame,
                   {1, 1, 1});
        } else if (kind == "sphere") {
            shape.spheres.push_back({frame.origin, positive(element, "radius", where)});
        } else if (element.type() == pugi::node_element) {
            fail(where + " collides with a " + kind + ", which is not known: mesh, box, cylinder and sphere are");
        }
    }
}

void append_collision(xml_node& link, const Ball& ball) {
    const auto& [c, radius] = ball;
    xml_node collision = link.append_child("collision");
    xml_node origin = collision.append_child("origin");
    origin.append_attribute("xyz") = (shortest(c.x) + " " + shortest(c.y) + " " + shortest(c.z)).c_str();
    origin.append_attribute("rpy") = "0 0 0";
    collision.append_child("geometry").append_child("sphere").append_attribute("radius") = shortest(radius).c_str();
}

/// Elements within elements: pugixml calls itself for each where it removes them.
void check_depth(pugi::xml_document& document, const fs::path& file) {
    constexpr int kDeepest = 1000;
    struct Walker : pugi::xml_tree_walker {
        bool for_each(xml_node&) override { return depth() < kDeepest; }
    } walker;
    if (!document.traverse(walker)) {
        fail(file.string() + ": its elements are nested more than " + std::to_string(kDeepest) + " deep");
    }
}

Mount mount_of(const xml_node& element, const std::string& where) {
    Mount mount{{attribute(element, "name"), attribute(element, "type"), attribute(element.child("parent"), "link"),
                 attribute(element.child("child"), "link")},
                frame_of(element, where),
                {}};
    const auto axis = numbers(attribute(element.child("axis"), "xyz", "1 0 0"), 3, where + ": axis");
    const Point given{axis[0], axis[1], axis[2]};
    mount.axis = norm(given) > 0.0 ? unit(given) : given;
    const std::string& type = mount.joint.type;
    mount.joint.is_driven =
        (type == "revolute" || type == "continuous" || type == "prismatic") && !element.child("mimic");
    const xml_node limit = element.child("limit");
    if (limit && type != "continuous") {
        const double lower = numbers(attribute(limit, "lower", "0"), 1, where + ": lower").front();
        const double upper = numbers(attribute(limit, "upper", "0"), 1, where + ": upper").front();
        mount.joint.rest = lower <= 0.0 && 0.0 <= upper ? 0.0 : 0.5 * (lower + upper);
    }
    return mount;
}

std::vector<Mount> mounts_of(const xml_node& robot, const std::string& file,
                             const std::map<std::string, double>& rest) {
    std::vector<Mount> mounts;
    std::map<std::string, std::size_t> by_name;
    std::set<std::string> moved;
    for (const xml_node& element : robot.children("joint")) {
        Mount mount = mount_of(element, file + ": joint " + attribute(element, "name"));
        if (!moved.insert(mount.joint.child).second) {
            fail(file + ": joint " + mount.joint.name + ": its child " + mount.joint.child + " has another parent too");
        }
        by_name[mount.joint.name] = mounts.size();
        mounts.push_back(std::move(mount));
    }
    for (const auto& [name, position] : rest) {
        const auto found = by_name.find(name);
        require(found != by_name.end() && mounts[found->second].joint.is_driven,
                file + " has no joint " + name + " that can be moved");
        mounts[found->second].joint.rest = position;
    }
    std::size_t i = 0;
    for (const xml_node& element : robot.children("joint")) {
        Mount& mount = mounts[i++];
        if (const xml_node mimic = element.child("mimic")) {
            const std::string where = file + ": joint " + mount.joint.name + ": mimic";
            const auto leader = by_name.find(attribute(mimic, "joint"));
            if (leader == by_name.end()) {
                fail(where + ": there is no joint " + attribute(mimic, "joint"));
            }
            if (&mounts[leader->second] == &mount) {
                fail(where + ": a joint cannot follow itself");
            }
            mount.joint.rest =
                numbers(attribute(mimic, "multiplier", "1"), 1, where).front() * mounts[leader->second].joint.rest +
                numbers(attribute(mimic, "offset", "0"), 1, where).front();
        }
    }
    return mounts;
}

bool do_touch(const std::vector<Ball>& some, const std::vector<Ball>& others) {
    return std::ranges::any_of(some, [&](const Ball& a) {
        return std::ranges::any_of(others, [&](const Ball& b) {
            const double reach = a.radius + b.radius;
            return squared_distance(a.center, b.center) <= reach * reach;
        });
    });
}

}  // namespace

struct Robot::Content {
    pugi::xml_document document;
    std::string name;
    fs::path file;
    std::vector<std::string> names;  // of all links
    std::vector<LinkShape> links;
    std::vector<Mount> mounts;
    std::vector<RobotJoint> joints;
    std::string base;
    std::vector<std::string> tips;
    std::vector<Diagnostic> warnings;

    const Mount* mount_of_link(const std::string& link) const {
        const auto found = std::ranges::find(mounts, link, [](const Mount& mount) { return mount.joint.child; });
        return found == mounts.end() ? nullptr : &*found;
    }

    // The links above one, the nearest first; one more than there are where joints go in a circle.
    std::vector<const Mount*> way_up(const std::string& link) const {
        std::vector<const Mount*> way;
        for (const Mount* next = mount_of_link(link); next != nullptr && way.size() <= mounts.size();
             next = mount_of_link(next->joint.parent)) {
            way.push_back(next);
        }
        return way;
    }

    // Joints lead from one link, the base, to all others.
    void check_tree() const {
        std::set<std::string> known;
        for (const std::string& link : names) {
            if (!known.insert(link).second) {
                fail(file.string() + ": two links are named " + link);
            }
        }
        for (const RobotJoint& joint : joints) {
            for (const std::string& link : {joint.parent, joint.child}) {
                if (!known.contains(link)) {
                    fail(file.string() + ": joint " + joint.name + ": there is no link " + link);
                }
            }
        }
        for (const std::string& link : names) {
            const std::vector<const Mount*> way = way_up(link);
            if (way.size() > mounts.size()) {
                fail(file.string() + ": joints lead from link " + link + " back to it");
            }
            if (const std::string& top = way.empty() ? link : way.back()->joint.parent; top != base) {
                fail(file.string() + ": no joint leads from link " + base + " to link " + top);
            }
        }
    }
};

namespace {

std::string content_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        fail(file.string() + ": cannot be opened");
    }
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace

Robot::Robot(const fs::path& file, const RobotOptions& options) : Robot(content_of(file), file, options) {}

Robot::Robot(const std::string& text, const fs::path& file, const RobotOptions& options)
    : content_(std::make_unique<Content>()) {
    try {
        content_->document = parsed_xml(text, pugi::parse_default | pugi::parse_comments | pugi::parse_pi);
    } catch (const FileError& error) {
        fail(file.string() + ": " + error.what());
    }
    check_depth(content_->document, file);
    const xml_node robot = content_->document.child("robot");
    if (!robot) {
        fail(file.string() + ": no <robot>, so it is no URDF");
    }
    content_->name = robot.attribute("name").as_string(file.stem().string().c_str());
    content_->file = file;
    content_->mounts = mounts_of(robot, file.string(), options.rest);
    content_->joints = each_of<RobotJoint>(content_->mounts, &Mount::joint);
    for (const xml_node& link : robot.children("link")) {
        const std::string& name = content_->names.emplace_back(attribute(link, "name"));
        if (content_->base.empty() && content_->mount_of_link(name) == nullptr) {
            content_->base = name;
        }
        if (std::ranges::find(content_->joints, name, &RobotJoint::parent) == content_->joints.end()) {
            content_->tips.push_back(name);
        }
        if (!link.child("collision")) {
            continue;
        }
        LinkShape shape{name, {}, {}};
        for (const xml_node& collision : link.children("collision")) {
            add_collision(shape, collision, file, options.packages, file.string() + ": link " + name,
                          content_->warnings);
        }
        content_->links.push_back(std::move(shape));
    }
    content_->check_tree();
    if (content_->links.empty()) {
        fail(file.string() + ": no link collides with anything");
    }
}

Robot::~Robot() = default;
Robot::Robot(Robot&&) noexcept = default;

const std::string& Robot::name() const { return content_->name; }
const fs::path& Robot::file() const { return content_->file; }
const std::vector<LinkShape>& Robot::links() const { return content_->links; }
const std::vector<RobotJoint>& Robot::joints() const { return content_->joints; }
const std::string& Robot::base() const { return content_->base; }
const std::vector<std::string>& Robot::tips() const { return content_->tips; }
const std::vector<Diagnostic>& Robot::warnings() const { return content_->warnings; }

std::string Robot::with_balls(std::span<const LinkBalls> links) const {
    pugi::xml_document document;
    document.reset(content_->document);
    for (xml_node link : document.child("robot").children("link")) {
        const auto found = std::ranges::find(links, attribute(link, "name"), &LinkBalls::link);
        if (found == links.end()) {
            continue;
        }
        while (link.remove_child("collision")) {
        }
        for (const Ball& ball : found->balls) {
            append_collision(link, ball);
        }
    }
    std::ostringstream text;
    text << "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n";
    document.save(text, "  ", pugi::format_indent | pugi::format_no_declaration, pugi::encoding_utf8);
    return text.str();
}

std::vector<IgnoredPair> Robot::ignored_pairs(std::span<const LinkBalls> links) const {
    std::vector<std::vector<Ball>> placed;
    std::vector<std::string> above;  // the nearest link with balls
    for (const auto& [name, balls] : links) {
        Frame frame;
        std::string parent;
        for (const Mount* mount : content_->way_up(name)) {
            frame = mount->placed().composed(frame);
            const auto found = std::ranges::find(links, mount->joint.parent, &LinkBalls::link);
            if (parent.empty() && found != links.end() && !found->balls.empty()) {
                parent = found->link;
            }
        }
        above.push_back(parent);
        std::vector<Ball>& own = placed.emplace_back(balls);
        std::ranges::for_each(own, [&](Ball& ball) { ball.center = frame(ball.center); });
    }
    std::vector<IgnoredPair> pairs;
    for (std::size_t a = 0; a < links.size(); ++a) {
        for (std::size_t b = a + 1; b < links.size(); ++b) {
            const bool is_adjacent = above[a] == links[b].link || above[b] == links[a].link;
            if (is_adjacent || do_touch(placed[a], placed[b])) {
                pairs.push_back({links[a].link, links[b].link, is_adjacent});
            }
        }
    }
    return pairs;
}

}  // namespace scaleaxis::inline v1
