// SPDX-License-Identifier: Apache-2.0
#include "urdf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <pugixml.hpp>
#include <sstream>
#include <utility>

#include "base/angles.hpp"
#include "base/formats/xml.hpp"
#include "readable.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis::app {

namespace {

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

struct Frame {
    std::array<Point, 3> axes{Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}};
    Point origin;

    Point operator()(const Point& p) const { return origin + p.x * axes[0] + p.y * axes[1] + p.z * axes[2]; }
};

// Roll, pitch and yaw are about the fixed axes x, y and z, one after the other.
Frame frame_of(const xml_node& collision, const std::string& where) {
    const xml_node origin = collision.child("origin");
    const auto xyz = numbers(attribute(origin, "xyz", "0 0 0"), 3, where + ": xyz");
    const auto rpy = numbers(attribute(origin, "rpy", "0 0 0"), 3, where + ": rpy");
    const auto [cr, sr] = at_angle(rpy[0]);
    const auto [cp, sp] = at_angle(rpy[1]);
    const auto [cy, sy] = at_angle(rpy[2]);
    return {{Point{cy * cp, sy * cp, -sp}, Point{cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr},
             Point{cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr}},
            {xyz[0], xyz[1], xyz[2]}};
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
        fail(where + ": " + name + " is not found above " + folder.string() +
             "; name the folder of its package by --package");
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
                   const std::vector<fs::path>& packages, const std::string& where) {
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
            append(shape.mesh, read_mesh_with_warnings(file, file), frame, {scale[0], scale[1], scale[2]});
        } else if (kind == "box") {
            const auto size = numbers(attribute(element, "size"), 3, where + ": size");
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

}  // namespace

struct Robot::Content {
    pugi::xml_document document;
    std::string name;
    std::vector<LinkShape> links;
};

Robot::Robot(const fs::path& file, const std::vector<fs::path>& packages) : content_(std::make_unique<Content>()) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) {
        fail(file.string() + ": cannot be opened");
    }
    const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
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
    for (const xml_node& link : robot.children("link")) {
        if (!link.child("collision")) {
            continue;
        }
        LinkShape shape{attribute(link, "name"), {}, {}};
        for (const xml_node& collision : link.children("collision")) {
            add_collision(shape, collision, file, packages, file.string() + ": link " + shape.link);
        }
        content_->links.push_back(std::move(shape));
    }
    if (content_->links.empty()) {
        fail(file.string() + ": no link collides with anything");
    }
}

Robot::~Robot() = default;
Robot::Robot(Robot&&) noexcept = default;

const std::string& Robot::name() const { return content_->name; }
const std::vector<LinkShape>& Robot::links() const { return content_->links; }

std::string Robot::with_spheres(const std::vector<LinkSpheres>& links) const {
    pugi::xml_document document;
    document.reset(content_->document);
    for (xml_node link : document.child("robot").children("link")) {
        const auto found = std::ranges::find(links, attribute(link, "name"), &LinkSpheres::link);
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

bool is_urdf(const fs::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
    return extension == ".urdf";
}

}  // namespace scaleaxis::app
