// SPDX-License-Identifier: Apache-2.0
#include "sphere_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "outputs.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis::app {

namespace {

namespace fs = std::filesystem;

const std::set<std::string> kTexts{"json", "yaml", "yml", "csv", "srdf", "urdf"};

// Of robots alone, with the extensions of their files.
const std::map<std::string, std::string> kPlanners{{"curobo", "yml"}, {"vamp", "json"}, {"ballpark", "json"}};

std::string triple(const Point& p, const std::string& separator) {
    return shortest(p.x) + separator + shortest(p.y) + separator + shortest(p.z);
}

std::string escaped_xml(const std::string& text) {
    std::string result;
    for (const char c : text) {
        result += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '"' ? "&quot;" : std::string(1, c);
    }
    return result;
}

// Double quotes have the same escapes in YAML and JSON.
std::string json_string(const std::string& text) { return Json(text).dump(); }

std::string json_text(const std::string& name, const std::vector<NamedSpheres>& links,
                      const std::vector<IgnoredPair>& pairs) {
    Json document = new_document("scaleaxis.spheres/1");
    document["name"] = name;
    document["links"] = Json::array();
    for (const NamedSpheres& link : links) {
        Json spheres = Json::array();
        for (const auto& [center, radius] : link.balls) {
            spheres.push_back({{"center", {center.x, center.y, center.z}}, {"radius", radius}});
        }
        document["links"].push_back({{"link", link.link}, {"spheres", spheres}, {"statistics", link.statistics}});
    }
    for (const IgnoredPair& pair : pairs) {
        document["ignored_pairs"].push_back({{"links", Json::array({pair.first, pair.second})},
                                             {"reason", pair.is_adjacent ? "adjacent" : "touches at rest"}});
    }
    return to_text(document);
}

std::string yaml_text(const std::vector<NamedSpheres>& links) {
    std::ostringstream text;
    text << "collision_spheres:\n";
    for (const NamedSpheres& link : links) {
        text << "  " << json_string(link.link) << (link.balls.empty() ? ": []\n" : ":\n");
        for (const auto& [center, radius] : link.balls) {
            text << "    - center: [" << triple(center, ", ") << "]\n      radius: " << shortest(radius) << '\n';
        }
    }
    return text.str();
}

std::string csv_text(const std::vector<NamedSpheres>& links) {
    std::ostringstream text;
    text << "link,x,y,z,radius\n";
    for (const NamedSpheres& link : links) {
        std::string name = link.link;
        if (name.find_first_of(",\"\n") != std::string::npos) {
            for (std::size_t i = 0; (i = name.find('"', i)) != std::string::npos; i += 2) {
                name.insert(i, 1, '"');
            }
            name = '"' + name + '"';
        }
        for (const auto& [center, radius] : link.balls) {
            text << name << ',' << triple(center, ",") << ',' << shortest(radius) << '\n';
        }
    }
    return text.str();
}

std::string srdf_text(const std::string& name, const std::vector<NamedSpheres>& links) {
    std::ostringstream text;
    text << "<?xml version=\"1.0\"?>\n<robot name=\"" << escaped_xml(name) << "\">\n";
    for (const NamedSpheres& link : links) {
        text << "  <link_sphere_approximation link=\"" << escaped_xml(link.link) << "\">\n";
        for (const auto& [center, radius] : link.balls) {
            text << "    <sphere center=\"" << triple(center, " ") << "\" radius=\"" << shortest(radius) << "\"/>\n";
        }
        text << "  </link_sphere_approximation>\n";
    }
    text << "</robot>\n";
    return text.str();
}

std::string urdf_text(const std::string& name, const std::vector<NamedSpheres>& links) {
    std::ostringstream text;
    text << "<?xml version=\"1.0\"?>\n<robot name=\"" << escaped_xml(name) << "\">\n";
    for (const NamedSpheres& link : links) {
        text << "  <link name=\"" << escaped_xml(link.link) << "\">\n";
        for (const auto& [center, radius] : link.balls) {
            text << "    <collision>\n      <origin xyz=\"" << triple(center, " ")
                 << "\" rpy=\"0 0 0\"/>\n      <geometry>\n        <sphere radius=\"" << shortest(radius)
                 << "\"/>\n      </geometry>\n    </collision>\n";
        }
        text << "  </link>\n";
    }
    text << "</robot>\n";
    return text.str();
}

}  // namespace

std::string shortest(double value) {
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
    return {buffer.data(), end};
}

bool is_robot_format(const fs::path& file, const std::string& format) {
    const std::string kind = format_of(file, format);
    return kPlanners.contains(kind) || kind == "srdf" || kind == "urdf";
}

std::string spheres_extension(const std::string& format) {
    const auto planner = kPlanners.find(format_of({}, format));
    return planner == kPlanners.end() ? format : planner->second;
}

void check_spheres_output(const fs::path& file, const std::string& format, bool is_robot) {
    const std::string kind = format_of(file, format);
    if (kPlanners.contains(kind) && !is_robot) {
        throw FileError("the format " + kind + " is for robots (.urdf, .xacro)");
    }
    if (is_stdout(file) && kind == "vamp") {
        throw FileError("VAMP reads several files, which standard output cannot hold: name a file or folder");
    }
    if (is_stdout(file) && (kTexts.contains(kind) || kPlanners.contains(kind))) {
        return;
    }
    if (!kTexts.contains(kind) && !kPlanners.contains(kind)) {
        try {
            check_balls_output(file, format);
        } catch (const FileError& error) {
            throw FileError(std::string(error.what()) + "; or .json, .yaml, .csv, .urdf, .srdf" +
                            (is_robot ? ", or curobo, vamp, ballpark by --output-format" : ""));
        }
        return;
    }
    check_balls_output(file, "balls");  // the folder
}

void write_robot(const fs::path& file, const std::string& format, const Robot& robot,
                 const std::vector<NamedSpheres>& links, Index large) {
    std::vector<LinkBalls> balls;
    std::ranges::transform(links, std::back_inserter(balls), [](const NamedSpheres& link) {
        return LinkBalls{link.link, link.balls};
    });
    const std::string kind = format_of(file, format);
    std::string name = is_stdout(file) ? robot.name() : stem_of(file);
    // Names of files in a folder end so; those of VAMP have an ending of their own.
    if (kind == "vamp" && name.ends_with("-spheres")) {
        name.erase(name.size() - std::string("-spheres").size());
    }
    const std::vector<TextFile> files = robot_files(robot, balls, kind, name, large);
    for (const auto& [own_name, text] : files) {
        is_stdout(file)      ? print_text(text)
        : files.size() == 1U ? write_text(file, text)
                             : write_text(file.parent_path() / own_name, text);
    }
}

void write_spheres(const fs::path& file, const std::string& format, const std::string& name,
                   const std::vector<NamedSpheres>& links, const std::vector<IgnoredPair>& pairs) {
    const std::string kind = format_of(file, format);
    if (!kTexts.contains(kind)) {
        std::vector<Ball> balls;
        for (const NamedSpheres& link : links) {
            balls.insert(balls.end(), link.balls.begin(), link.balls.end());
        }
        write_balls(file, balls, format);
        return;
    }
    const std::string text = kind == "json"   ? json_text(name, links, pairs)
                             : kind == "csv"  ? csv_text(links)
                             : kind == "srdf" ? srdf_text(name, links)
                             : kind == "urdf" ? urdf_text(name, links)
                                              : yaml_text(links);
    if (is_stdout(file)) {
        print_text(text);
    } else {
        write_text(file, text);
    }
}

}  // namespace scaleaxis::app
