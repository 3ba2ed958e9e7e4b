// SPDX-License-Identifier: Apache-2.0
/// \file
/// 3MF (3D Manufacturing Format): the core specification 1.3, paths of the production extension 1.2, the beam lattice
/// extension 1.2, and what slicers say of the parts of their projects. In doubles.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/faults.hpp"
#include "base/formats/xml.hpp"
#include "io/archive.hpp"
#include "io/formats.hpp"
#include "io/meshes/placement.hpp"
#include "io/text_reader.hpp"
#include "surface/beam_mesh.hpp"

namespace scaleaxis::io {
namespace threemf {
namespace {

using pugi::xml_node;

constexpr std::size_t kLongestName = 100;  // in messages
constexpr std::size_t kMostBeams = 150'000;

/// An object of a model: of the part of the archive that has it, and its number there.
using Key = std::pair<std::string, std::string>;

/// An object at a place within another, or of what is to be built.
struct Placed {
    Key key;
    Eigen::Affine3d place;
};

struct Object {
    std::string name;
    std::string type;
    PolygonMesh mesh;
    std::vector<Placed> components;
};

struct Model {
    std::map<Key, Object> objects;
    std::vector<Placed> items;  ///< of the part that comes first
    std::string unit;
};

/// The archive names its parts without the first `/`, paths have it.
std::string part_name(std::string_view path) { return std::string(path.substr(path.starts_with('/') ? 1 : 0)); }

double number_of(const xml_node& element, std::string_view attribute) {
    const pugi::xml_attribute found = attribute_of(element, attribute);
    const std::optional<double> value = parse_number(found.value());
    if (!value) {
        throw damaged("a <" + std::string(local_name(element.name())) + "> has no number '" + std::string(attribute) +
                      "'" + (found ? " but " + quoted(std::string_view(found.value())) : ""));
    }
    return *value;
}

Index index_of(const xml_node& element, std::string_view attribute) {
    const std::optional<std::int64_t> value = parse_integer(attribute_of(element, attribute).value());
    return value ? to_index(*value) : kNone;
}

/// Twelve numbers: where the axes go, and the origin.
Eigen::Affine3d transform_of(const xml_node& element) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (const pugi::xml_attribute found = attribute_of(element, "transform")) {
        TextReader reader(found.value());
        for (int row = 0; row < 4; ++row) {
            for (int k = 0; k < 3; ++k) {
                const std::optional<double> value = parse_number(reader.any_word());
                if (!value) {
                    throw damaged("the transform " + quoted(std::string_view(found.value())) +
                                  " has to have twelve numbers");
                }
                result.matrix()(k, row) = *value;
            }
        }
    }
    return result;
}

Placed placed_of(const xml_node& element, const std::string& part) {
    const pugi::xml_attribute path = attribute_of(element, "path");
    return {{path ? part_name(path.value()) : part, attribute_of(element, "objectid").value()}, transform_of(element)};
}

/// The children with this local name of the first child with another one.
std::vector<xml_node> items_of(const xml_node& element, std::string_view list, std::string_view name) {
    std::vector<xml_node> result;
    std::ranges::copy_if(child_of(element, list).children(), std::back_inserter(result),
                         [&](const xml_node& child) { return local_name(child.name()) == name; });
    return result;
}

/// The mesh of some of its polygons, without the vertices that none of them has.
PolygonMesh kept_part(const PolygonMesh& mesh, const std::vector<bool>& is_kept) {
    PolygonMesh result;
    std::vector<Index> vertices(mesh.vertices.size(), kNone);
    for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
        if (!is_kept[f]) {
            continue;
        }
        std::vector<Index> corners;
        for (const Index v : mesh.polygons[f]) {
            const bool exists = v != kNone && static_cast<std::size_t>(v) < vertices.size();
            if (exists && vertices[v] == kNone) {
                vertices[v] = static_cast<Index>(result.vertices.size());
                result.vertices.push_back(mesh.vertices[v]);
            }
            corners.push_back(exists ? vertices[v] : kNone);
        }
        result.polygons.push_back(corners);
    }
    return result;
}

bool is_round(const xml_node& element, std::string_view attribute, bool otherwise) {
    const std::string_view cap = attribute_of(element, attribute).as_string(otherwise ? "sphere" : "butt");
    if (cap != "sphere" && cap != "hemisphere" && cap != "butt") {
        throw damaged("a beam ends in a " + quoted(cap) + ", which 3MF does not know");
    }
    return cap != "butt";
}

double radius_of(const xml_node& element, std::string_view attribute, double otherwise) {
    const double radius = attribute_of(element, attribute) ? number_of(element, attribute) : otherwise;
    return radius > 0.0 && std::isfinite(radius) ? radius : throw damaged("the radius of a beam is not positive");
}

/// The beams between points of a mesh, without those that are too short to count.
std::vector<Beam> beams_of(const xml_node& lattice, const PolygonMesh& mesh) {
    if (attribute_of(lattice, "clippingmode").as_string("none") != std::string_view("none")) {
        throw unsupported("its beams are clipped by another mesh, which is not read: export it as triangles");
    }
    const double radius = radius_of(lattice, "radius", 0.0);
    const double shortest = attribute_of(lattice, "minlength") ? number_of(lattice, "minlength") : 0.0;
    const bool are_round = is_round(lattice, "cap", true);
    std::vector<Beam> beams;
    for (const xml_node& element : items_of(lattice, "beams", "beam")) {
        Beam beam;
        beam.radii[0] = radius_of(element, "r1", radius);
        beam.radii[1] = radius_of(element, "r2", beam.radii[0]);
        beam.is_round = {is_round(element, "cap1", are_round), is_round(element, "cap2", are_round)};
        const std::array<Index, 2> vertices{index_of(element, "v1"), index_of(element, "v2")};
        for (std::size_t end = 0; end < 2; ++end) {
            if (vertices[end] == kNone || static_cast<std::size_t>(vertices[end]) >= mesh.vertices.size()) {
                throw damaged("a beam refers to a vertex that does not exist");
            }
            beam.ends[end] = mesh.vertices[vertices[end]];
        }
        if (distance(beam.ends[0], beam.ends[1]) > shortest) {
            beams.push_back(beam);
            if (beams.size() > kMostBeams) {
                throw unsupported("its lattice has more than " + std::to_string(kMostBeams) +
                                  " beams: save parts of it on their own");
            }
        }
    }
    return beams;
}

Object object_of(const xml_node& element, const std::string& part) {
    Object object{attribute_of(element, "name").value(), attribute_of(element, "type").as_string("model"), {}, {}};
    const xml_node mesh = child_of(element, "mesh");
    for (const xml_node& vertex : items_of(mesh, "vertices", "vertex")) {
        object.mesh.vertices.push_back({number_of(vertex, "x"), number_of(vertex, "y"), number_of(vertex, "z")});
    }
    for (const xml_node& triangle : items_of(mesh, "triangles", "triangle")) {
        object.mesh.polygons.push_back(
            std::array{index_of(triangle, "v1"), index_of(triangle, "v2"), index_of(triangle, "v3")});
    }
    if (const xml_node lattice = child_of(mesh, "beamlattice")) {
        const std::vector<Beam> beams = beams_of(lattice, object.mesh);
        object.mesh = kept_part(object.mesh, std::vector<bool>(object.mesh.polygons.size(), true));
        const TriangleMesh surface = beam_mesh(beams);
        PolygonMesh polygons{surface.vertices, {}};
        for (const std::array<Index, 3>& triangle : surface.triangles) {
            polygons.polygons.push_back(triangle);
        }
        append_placed(polygons, Eigen::Affine3d::Identity(), object.mesh);
    }
    for (const xml_node& component : items_of(element, "components", "component")) {
        object.components.push_back(placed_of(component, part));
    }
    return object;
}

/// What a file must not need: extensions that change the shape, except those that are read.
void check_extensions(const xml_node& model) {
    for (const std::string_view prefix : words_of(attribute_of(model, "requiredextensions").value(), " \t\r\n")) {
        const std::string name = "xmlns:" + std::string(prefix);
        const std::string uri = model.attribute(name.c_str()).as_string(std::string(prefix).c_str());
        const bool is_read =
            std::ranges::any_of(std::array{"/production/", "/material/", "/trianglesets/", "/beamlattice/2017"},
                                [&](const char* known) { return uri.find(known) != uri.npos; });
        if (!is_read) {
            throw unsupported("it needs the 3MF extension " + quoted(std::string_view(uri), kLongestName) +
                              ", which is not read: export it without, or as STL");
        }
    }
}

std::string unit_of(const xml_node& model) {
    constexpr std::array<std::pair<std::string_view, const char*>, 6> kUnits{
        {{"micron", "um"}, {"millimeter", "mm"}, {"centimeter", "cm"}, {"meter", "m"}, {"inch", "in"}, {"foot", "ft"}}};
    const std::string name = attribute_of(model, "unit").as_string("millimeter");
    const auto found = std::ranges::find(kUnits, name, &std::pair<std::string_view, const char*>::first);
    return found != kUnits.end()
               ? found->second
               : throw damaged("its unit is " + quoted(std::string_view(name)) + ", which 3MF does not know");
}

Model model_of(std::string_view text, const std::string& part) {
    const pugi::xml_document document = parsed_xml(text);
    const xml_node root = child_of(document, "model");
    if (!root) {
        throw damaged("it has no <model>");
    }
    check_extensions(root);
    Model result;
    result.unit = unit_of(root);
    for (const xml_node& element : items_of(root, "resources", "object")) {
        result.objects[{part, attribute_of(element, "id").value()}] = object_of(element, part);
    }
    for (const xml_node& element : items_of(root, "build", "item")) {
        result.items.push_back(placed_of(element, part));
    }
    return result;
}

using Parts = std::vector<ArchivePart>;

/// Null if the archive has no such part.
const ArchivePart* find_part(const Parts& parts, std::string_view name) {
    const auto found = std::ranges::find(parts, name, &ArchivePart::name);
    return found == parts.end() ? nullptr : &*found;
}

/// What `read` makes of the text of a part; its errors with the name of the part.
template <class Read>
auto read_part(const Parts& parts, const std::string& name, const Read& read) {
    const ArchivePart* part = find_part(parts, name);
    if (part == nullptr) {
        throw damaged("the archive has no part " + quoted(std::string_view(name)) + "; is it a 3MF file?");
    }
    const std::string text = unpacked(*part);
    try {
        return read(text);
    } catch (const FileError& error) {
        throw with_prefix("the part " + quoted(std::string_view(name), kLongestName) + ": ", error);
    }
}

pugi::xml_document tree_of(const Parts& parts, const std::string& name) {
    return read_part(parts, name, [](const std::string& text) { return parsed_xml(text); });
}

/// The name of the part that comes first.
std::string first_part(const Parts& parts) {
    const pugi::xml_document document = tree_of(parts, "_rels/.rels");
    for (const xml_node& relation : child_of(document, "Relationships").children()) {
        const pugi::xml_attribute target = attribute_of(relation, "Target");
        if (target && std::string_view(attribute_of(relation, "Type").value()).ends_with("/3dmodel")) {
            return part_name(target.value());
        }
    }
    throw damaged("the archive names no 3D model; is it a 3MF file?");
}

/// The first part, and those that its items and all components lie in.
Model read_all(const Parts& parts) {
    Model model;
    std::vector<std::string> names{first_part(parts)};
    const auto need = [&](const std::vector<Placed>& all) {
        for (const Placed& placed : all) {
            if (std::ranges::find(names, placed.key.first) == names.end()) {
                names.push_back(placed.key.first);
            }
        }
    };
    for (std::size_t i = 0; i < names.size(); ++i) {
        const std::string name = names[i];
        Model one = read_part(parts, name, [&](const std::string& text) { return model_of(text, name); });
        for (const auto& [key, object] : one.objects) {
            need(object.components);
        }
        if (i == 0) {
            need(one.items);
            model = std::move(one);
        } else {
            model.objects.merge(one.objects);
        }
    }
    return model;
}

// ---------------------------------------------------------------------------------------------------------------------
// What slicers say of the parts of their projects
// ---------------------------------------------------------------------------------------------------------------------

/// Leaves out triangles that PrusaSlicer's project says to be no part of the object. \returns how many volumes
std::size_t drop_volumes(const xml_node& settings, Object& object) {
    std::size_t dropped = 0;
    std::vector<bool> is_kept(object.mesh.polygons.size(), true);
    for (const xml_node& volume : settings.children("volume")) {
        const std::string_view type =
            volume.find_child_by_attribute("metadata", "key", "volume_type").attribute("value").as_string("ModelPart");
        if (type != "ModelPart") {
            ++dropped;
            const auto last = static_cast<std::size_t>(index_of(volume, "lastid"));  // `kNone`: to the end
            for (std::size_t f = std::max<Index>(index_of(volume, "firstid"), 0); f <= last && f < is_kept.size();
                 ++f) {
                is_kept[f] = false;
            }
        }
    }
    if (dropped > 0) {
        object.mesh = kept_part(object.mesh, is_kept);
    }
    return dropped;
}

/// The same of the components that projects of Bambu Studio and OrcaSlicer say to be none.
std::size_t drop_components(const xml_node& settings, Object& object) {
    std::set<std::string> dropped;
    for (const xml_node& part : settings.children("part")) {
        if (std::string_view(part.attribute("subtype").as_string("normal_part")) != "normal_part") {
            dropped.insert(part.attribute("id").value());
        }
    }
    return std::erase_if(object.components,
                         [&](const Placed& component) { return dropped.contains(component.key.second); });
}

/// Leaves out what the slicer's settings call a modifier, a negative volume or a support. \returns how many of them
std::size_t drop_modifiers(const Parts& parts, Model& model) {
    std::size_t dropped = 0;
    for (const std::string name : {"Metadata/Slic3r_PE_model.config", "Metadata/model_settings.config"}) {
        if (find_part(parts, name) == nullptr) {
            continue;
        }
        const pugi::xml_document document = tree_of(parts, name);
        for (const xml_node& settings : document.child("config").children("object")) {
            const std::string_view id = settings.attribute("id").value();
            for (auto& [key, object] : model.objects) {
                if (key.second == id) {
                    dropped += drop_volumes(settings, object) + drop_components(settings, object);
                }
            }
        }
    }
    return dropped;
}

/// Puts objects together, as often as they are asked for.
class Assembly {
   public:
    explicit Assembly(const Model& model) : model_(model) {}

    /// Adds all meshes of an object to a mesh. \returns its name
    std::string add(const Placed& placed, PolygonMesh& to, int depth = 0) {
        constexpr int kDeepest = 100;
        constexpr std::uint64_t kMostPlaced = 1'000'000;
        const auto found = model_.objects.find(placed.key);
        if (found == model_.objects.end()) {
            throw damaged("an object " + quoted(std::string_view(placed.key.second)) +
                          " is asked for and does not exist");
        }
        const Object& object = found->second;
        if (object.type == "support" || object.type == "solidsupport" || object.type == "other") {
            ++left_out_;
            return {};
        }
        ++placed_;
        corners_ += object.mesh.vertices.size() + object.mesh.polygons.items.size();
        if (depth > kDeepest || placed_ > kMostPlaced || corners_ > kMostCorners) {
            throw unsupported("its objects contain each other, or too many others: more than " +
                              std::to_string(kMostPlaced) + ", or " + std::to_string(kMostCorners) + " corners");
        }
        append_placed(object.mesh, placed.place, to);
        for (const Placed& component : object.components) {
            add({component.key, placed.place * component.place}, to, depth + 1);
        }
        return object.name;
    }

    /// Of objects that are not of the model.
    std::uint64_t left_out() const { return left_out_; }

   private:
    const Model& model_;
    std::uint64_t placed_ = 0;   // objects
    std::uint64_t corners_ = 0;  // and vertices
    std::uint64_t left_out_ = 0;
};

Diagnostic left_out(std::uint64_t count, const std::string& kind, const std::string& what) {
    return {"mesh.left_out",
            std::to_string(count) + (count == 1 ? " " + kind + " is" : " " + kind + "s are") + " left out: " + what};
}

}  // namespace
}  // namespace threemf

bool is_3mf(std::string_view content) {
    return content.starts_with("PK\x03\x04") && content.find(".model") != content.npos;
}

PolygonObjects read_3mf(std::string_view content, const std::filesystem::path&) {
    using namespace threemf;
    const Parts parts = archive_parts(content);
    Model model = read_all(parts);
    PolygonObjects result;
    result.unit = model.unit;
    if (const std::size_t dropped = drop_modifiers(parts, model); dropped > 0) {
        result.warnings.push_back(
            threemf::left_out(dropped, "part",
                              "the slicer's project has negative volumes, modifiers or supports; export "
                              "the result as STL where they should count"));
    }
    Assembly assembly(model);
    for (const Placed& item : model.items) {
        const std::uint64_t left_out = assembly.left_out();
        PolygonObjects::Object object;
        object.name = assembly.add(item, object.mesh);
        if (assembly.left_out() == left_out || !object.mesh.vertices.empty()) {
            result.objects.push_back(std::move(object));
        }
    }
    if (assembly.left_out() > 0) {
        result.warnings.push_back(threemf::left_out(assembly.left_out(), "object", "of a type that is no model"));
    }
    return result;
}

}  // namespace scaleaxis::io
