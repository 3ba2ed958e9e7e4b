// SPDX-License-Identifier: Apache-2.0
/// \file
/// 3MF (3D Manufacturing Format: core specification 1.3, and paths of the production extension 1.2). Own code: in
/// doubles, with components, of which the models of most slicers are made, and in Python's wheels too.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/archive.hpp"
#include "io/faults.hpp"
#include "io/formats.hpp"
#include "io/text_reader.hpp"
#include "io/xml_tags.hpp"

namespace scaleaxis::io {
namespace {

/// An object of a model: of the part of the archive that has it, and its number there.
using Key = std::pair<std::string, std::string>;

/// An object at a place within another, or of what is to be built.
struct Placed {
    Key key;
    Eigen::Affine3d place;
};

struct Object {
    std::string name;
    PolygonMesh mesh;
    std::vector<Placed> components;
};

struct Model {
    std::map<Key, Object> objects;
    std::vector<Placed> items;  ///< of the part that comes first
};

/// The archive names its parts without the first `/`, paths have it.
std::string part_name(std::string_view path) { return std::string(path.substr(path.starts_with('/') ? 1 : 0)); }

double number_of(const XmlTag& tag, std::string_view attribute) {
    const std::string_view* text = tag.find(attribute);
    const std::optional<double> value = text != nullptr ? parse_number(*text) : std::nullopt;
    if (!value) {
        throw damaged("a <" + std::string(tag.name) + "> has no number '" + std::string(attribute) + "'" +
                      (text != nullptr ? " but " + quoted(*text) : ""));
    }
    return *value;
}

Index index_of(const XmlTag& tag, std::string_view attribute) {
    const std::string_view* text = tag.find(attribute);
    const std::optional<std::int64_t> value = text != nullptr ? parse_integer(*text) : std::nullopt;
    return value ? to_index(*value) : kNone;
}

/// Twelve numbers: where the axes go, and the origin.
Eigen::Affine3d transform_of(const XmlTag& tag) {
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (const std::string_view* text = tag.find("transform")) {
        TextReader reader(*text);
        for (int row = 0; row < 4; ++row) {
            for (int k = 0; k < 3; ++k) {
                const std::string_view word = reader.any_word();
                const std::optional<double> value = parse_number(word);
                if (!value) {
                    throw damaged("the transform " + quoted(*text) + " has to have twelve numbers");
                }
                result.matrix()(k, row) = *value;
            }
        }
    }
    return result;
}

Placed placed_of(const XmlTag& tag, const std::string& part) {
    const std::string_view* id = tag.find("objectid");
    const std::string_view* path = tag.find("path");
    return {{path != nullptr ? part_name(*path) : part, id != nullptr ? std::string(*id) : std::string()},
            transform_of(tag)};
}

void read_model(std::string_view text, const std::string& part, Model& model) {
    XmlTags tags(text);
    Object* object = nullptr;
    bool is_model = false;
    bool is_complete = false;
    for (const XmlTag* tag = &tags.next(); !tag->name.empty(); tag = &tags.next()) {
        if (tag->name == "model") {
            is_model = is_model || tag->opens;
            is_complete = tag->closes;
        }
        if (tag->name == "object") {
            object = nullptr;
        }
        if (!tag->opens) {
            continue;
        }
        if (tag->name == "object") {
            const std::string_view* id = tag->find("id");
            const std::string_view* name = tag->find("name");
            object = &model.objects[{part, id != nullptr ? std::string(*id) : std::string()}];
            *object = {name != nullptr ? without_entities(*name) : std::string(), {}, {}};
        } else if (tag->name == "item") {
            model.items.push_back(placed_of(*tag, part));
        } else if (object != nullptr && tag->name == "vertex") {
            object->mesh.vertices.push_back({number_of(*tag, "x"), number_of(*tag, "y"), number_of(*tag, "z")});
        } else if (object != nullptr && tag->name == "triangle") {
            object->mesh.polygons.push_back(
                std::array{index_of(*tag, "v1"), index_of(*tag, "v2"), index_of(*tag, "v3")});
        } else if (object != nullptr && tag->name == "component") {
            object->components.push_back(placed_of(*tag, part));
        }
    }
    if (!is_model) {
        throw damaged("the part " + quoted(std::string_view(part)) + " has no <model>");
    }
    if (!is_complete) {
        throw truncated("the part " + quoted(std::string_view(part)) + " ends within its <model>");
    }
}

/// The parts of the archive, unpacked as they are asked for.
class Parts {
   public:
    explicit Parts(std::string_view archive) : parts_(archive_parts(archive)) {}

    std::string content(std::string_view name) const {
        const auto found = std::ranges::find(parts_, name, &ArchivePart::name);
        if (found == parts_.end()) {
            throw damaged("the archive has no part " + quoted(name) + "; is it a 3MF file?");
        }
        return unpacked(*found);
    }

   private:
    std::vector<ArchivePart> parts_;
};

/// The name of the part that comes first.
std::string first_part(const Parts& parts) {
    const std::string relations = parts.content("_rels/.rels");
    XmlTags tags(relations);
    for (const XmlTag* tag = &tags.next(); !tag->name.empty(); tag = &tags.next()) {
        const std::string_view* type = tag->find("Type");
        const std::string_view* target = tag->find("Target");
        if (tag->name == "Relationship" && type != nullptr && target != nullptr && type->ends_with("/3dmodel")) {
            return part_name(*target);
        }
    }
    throw damaged("the archive names no 3D model; is it a 3MF file?");
}

/// The parts that components and items lie in, and that are not read yet.
std::optional<std::string> missing_part(const Model& model, const std::vector<std::string>& read) {
    const auto is_missing = [&](const Placed& placed) {
        return std::ranges::find(read, placed.key.first) == read.end();
    };
    for (const auto& [key, object] : model.objects) {
        for (const Placed& placed : object.components) {
            if (is_missing(placed)) {
                return placed.key.first;
            }
        }
    }
    const auto item = std::ranges::find_if(model.items, is_missing);
    return item == model.items.end() ? std::nullopt : std::optional(item->key.first);
}

Model read_all(const Parts& parts) {
    Model model;
    std::vector<std::string> read;
    std::optional<std::string> next = first_part(parts);
    while (next) {
        Model one;
        read_model(parts.content(*next), *next, one);
        model.objects.merge(one.objects);
        if (read.empty()) {
            model.items = std::move(one.items);
        }
        read.push_back(*next);
        next = missing_part(model, read);
    }
    return model;
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
        ++placed_;
        corners_ += object.mesh.vertices.size() + object.mesh.polygons.items.size();
        if (depth > kDeepest || placed_ > kMostPlaced || corners_ > kMostCorners) {
            throw unsupported("its objects contain each other, or too many others: more than " +
                              std::to_string(kMostPlaced) + ", or " + std::to_string(kMostCorners) + " corners");
        }
        const auto first = static_cast<Index>(to.vertices.size());
        for (const Point& p : object.mesh.vertices) {
            const Eigen::Vector3d q = placed.place * Eigen::Vector3d(p.x, p.y, p.z);
            to.vertices.push_back({q.x(), q.y(), q.z()});
        }
        const bool is_mirrored = placed.place.linear().determinant() < 0.0;
        for (std::size_t f = 0; f < object.mesh.polygons.size(); ++f) {
            std::vector<Index> corners;
            for (const Index v : object.mesh.polygons[f]) {
                const bool exists = v != kNone && static_cast<std::size_t>(v) < object.mesh.vertices.size();
                corners.push_back(exists ? first + v : kNone);
            }
            if (is_mirrored) {
                std::ranges::reverse(corners);
            }
            to.polygons.push_back(corners);
        }
        for (const Placed& component : object.components) {
            add({component.key, placed.place * component.place}, to, depth + 1);
        }
        return object.name;
    }

   private:
    const Model& model_;
    std::uint64_t placed_ = 0;   // objects
    std::uint64_t corners_ = 0;  // and vertices
};

}  // namespace

bool is_3mf(std::string_view content) {
    return content.starts_with("PK\x03\x04") && content.find(".model") != content.npos;
}

PolygonObjects read_3mf(std::string_view content, std::string_view, const std::filesystem::path&) {
    const Model model = read_all(Parts(content));
    Assembly assembly(model);
    PolygonObjects result;
    for (const Placed& item : model.items) {
        PolygonObjects::Object object;
        object.name = assembly.add(item, object.mesh);
        result.objects.push_back(std::move(object));
    }
    return result;
}

}  // namespace scaleaxis::io
