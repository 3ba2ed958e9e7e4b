// SPDX-License-Identifier: Apache-2.0
//
// glTF 2.0, as text or binary (Khronos Group, "glTF 2.0 Specification"), with KHR_mesh_quantization and
// EXT_mesh_gpu_instancing: the triangles of all nodes of a scene at their places. Materials, skins, poses and
// animations are passed over.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "base/faults.hpp"
#include "base/files.hpp"
#include "base/formats/base64.hpp"
#include "base/formats/json.hpp"
#include "base/text.hpp"
#include "base/vectors.hpp"
#include "io/formats.hpp"
#include "io/input_file.hpp"
#include "io/meshes/placement.hpp"
#include "io/number_type.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace gltf {
namespace {

/// A piece of the JSON, and what it is called in messages. Positions count from 0, as those of the file do.
struct Element {
    const Json* json = nullptr;  ///< null: it is absent
    std::string name;

    explicit operator bool() const { return json != nullptr; }
};

FileError no_such(const Element& element, const char* key, const std::string& what) {
    return damaged(element.name + " of the glTF has no '" + key + "' that is " + what);
}

Json parsed_json(std::string_view text) {
    bool is_valid = false;
    Json json = Json::parse(text, &is_valid);
    return is_valid ? json : throw FileError(Diagnostic{"file.syntax", "this is no JSON: the file is damaged"});
}

/// A member of an object; `null` is as good as none.
Element member(const Element& element, const char* key) {
    const Json* found = element ? element.json->find(key) : nullptr;
    return {found != nullptr && !found->is_null() ? found : nullptr, element.name};
}

std::uint64_t whole_number(const Json* json, const Element& element, const char* key) {
    const double value = json != nullptr && json->is_number() ? json->get<double>() : -1.0;
    if (!(value >= 0.0 && value <= 0x1p53 && value == std::floor(value))) {
        throw no_such(element, key, "a whole number from 0 up");
    }
    return static_cast<std::uint64_t>(value);
}

std::optional<std::uint64_t> integer(const Element& element, const char* key) {
    const Element found = member(element, key);
    return found ? std::optional(whole_number(found.json, element, key)) : std::nullopt;
}

std::uint64_t needed_integer(const Element& element, const char* key) {
    return whole_number(member(element, key).json, element, key);
}

/// The pieces of a list; none if it is absent.
std::vector<Element> list(const Element& element, const char* key) {
    const Element found = member(element, key);
    if (found && !found.json->is_array()) {
        throw no_such(element, key, "a list");
    }
    std::vector<Element> result;
    for (std::size_t i = 0; found && i < found.json->size(); ++i) {
        result.push_back({&found.json->elements()[i], element.name});
    }
    return result;
}

std::vector<std::uint64_t> integers(const Element& element, const char* key) {
    return each_of<std::uint64_t>(list(element, key),
                                  [&](const Element& item) { return whole_number(item.json, element, key); });
}

/// `count` numbers; `otherwise` if there are none.
template <std::size_t count>
std::array<double, count> numbers(const Element& element, const char* key, const std::array<double, count>& otherwise) {
    const std::vector<Element> found = list(element, key);
    if (found.empty()) {
        return otherwise;
    }
    std::array<double, count> result{};
    for (std::size_t i = 0; i < std::max(count, found.size()); ++i) {
        if (i >= std::min(count, found.size()) || !found[i].json->is_number()) {
            throw no_such(element, key, "a list of " + std::to_string(count) + " numbers");
        }
        result[i] = found[i].json->get<double>();
    }
    return result;
}

bool is_true(const Element& element, const char* key) {
    const Element found = member(element, key);
    return found && *found.json == Json(true);
}

/// Empty if it is absent.
std::string text(const Element& element) {
    return element && element.json->is_string() ? element.json->get<std::string>() : std::string();
}

std::uint64_t u32_at(std::string_view content, std::size_t at) {
    return from_bytes<std::uint32_t>(content.data() + at, std::endian::little);
}

FileError wrong_version(const std::string& version) {
    return unsupported("it is glTF " + version + ", and only 2.0 is read: convert it, as by `gltf-pipeline -i FILE`");
}

struct Chunks {
    std::string_view json;
    std::optional<std::string_view> binary;
};

/// The chunks of a binary file: after a head of 12 bytes, each with a head of 8. They should be aligned, but may not
/// be.
Chunks chunks_of(std::string_view content) {
    constexpr std::size_t kHead = 12;
    constexpr std::size_t kChunkHead = 8;
    if (content.size() < kHead + kChunkHead) {
        throw truncated("the file ends within its head: it is truncated");
    }
    if (u32_at(content, 4) != 2) {
        throw wrong_version(std::to_string(u32_at(content, 4)) + ".0");
    }
    const std::uint64_t length = u32_at(content, 8);
    const auto check = [&](std::uint64_t promised) {
        if (promised > std::min<std::uint64_t>(length, content.size())) {
            throw truncated("its head announces " + std::to_string(promised) + " bytes, the file has " +
                            std::to_string(content.size()) + ": it is truncated or damaged");
        }
    };
    check(length);
    Chunks result;
    for (std::uint64_t at = kHead; at + kChunkHead <= length;) {
        const std::string_view type = content.substr(at + 4, 4);
        const std::uint64_t size = u32_at(content, at);
        check(at + kChunkHead + size);
        const std::string_view data = content.substr(at + kChunkHead, size);
        if (type == "JSON" && result.json.empty()) {
            result.json = data;
        } else if (type == std::string_view("BIN\0", 4) && !result.binary) {
            result.binary = data;
        }
        at += kChunkHead + size;
    }
    // Some programs fill up with zeros.
    result.json = result.json.substr(0, result.json.find_last_not_of('\0') + 1);
    return result;
}

/// The name of a file with `%20` and the like replaced.
std::string without_escapes(std::string_view uri) {
    std::string result;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const std::optional<double> code =
            uri[i] == '%' && i + 2 < uri.size() ? parse_number("0x" + std::string(uri.substr(i + 1, 2))) : std::nullopt;
        result += code ? static_cast<char>(static_cast<int>(*code)) : uri[i];
        i += code ? 2 : 0;
    }
    return result;
}

std::string read_beside(std::string_view uri, const std::filesystem::path& head) {
    const std::filesystem::path file = path_of(without_escapes(uri));
    try {
        if (head.empty() || !file.is_relative() || std::ranges::find(file, "..") != file.end()) {
            throw FileError(Diagnostic{
                "file.open", head.empty() ? "it can only be read beside the file that refers to it, on a disk"
                                          : "only files in the folder of the one that refers to it are read"});
        }
        return read_file(head.parent_path() / file);
    } catch (const FileError& error) {
        throw with_prefix("its part " + quoted(std::string_view(utf8_of(file))) + ": ", error);
    }
}

std::string decoded(std::string_view data_uri) {
    const std::size_t comma = data_uri.find(',');
    if (comma == data_uri.npos || !data_uri.substr(0, comma).ends_with(";base64")) {
        throw unsupported("its data within the text are not base64");
    }
    std::string padded(data_uri.substr(comma + 1));
    padded.resize((padded.size() + 3) / 4 * 4, '=');  // some programs leave these out
    return decoded_base64(padded);
}

constexpr std::string_view kUnpack =
    "unpack its meshes, as by `gltfpack -noq -i in.glb -o out.glb`, by gltf-transform or in Blender";

/// What a file must not need: the names of extensions that change no triangle begin like this.
void check_extensions(const Element& root) {
    constexpr std::array<std::string_view, 8> kHarmless{
        "KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
        "KHR_materials_",        "KHR_texture_",
        "EXT_texture_",          "KHR_lights_",
        "EXT_lights_",           "KHR_xmp",
    };
    for (const Element& item : list(root, "extensionsRequired")) {
        const std::string name = text(item);
        if (std::ranges::any_of(kHarmless, [&](std::string_view known) { return name.starts_with(known); })) {
            continue;
        }
        const bool is_packed = name.find("_compression") != name.npos;
        constexpr std::size_t kLongestName = 60;
        throw unsupported("it needs the glTF extension " + quoted(std::string_view(name), kLongestName) +
                          ", which is not read: " +
                          (is_packed ? std::string(kUnpack) : "export it without, or convert it to STL, PLY or OBJ"));
    }
}

/// The type of components, if it is one of glTF's, which have the numbers of OpenGL.
NumberType component_type(const Element& element) {
    const std::optional<NumberType> type = number_type_in("5120 i1 5121 u1 5122 i2 5123 u2 5125 u4 5126 f4",
                                                          std::to_string(needed_integer(element, "componentType")));
    return type ? *type : throw no_such(element, "componentType", "one of glTF's");
}

/// What is 1 where numbers are normalised; only short integers are.
double largest_of(NumberType type) {
    const bool is_signed = type == NumberType::kI1 || type == NumberType::kI2;
    const auto bits = static_cast<int>(8 * bytes_per_number(type)) - (is_signed ? 1 : 0);
    return bits <= 16 ? std::ldexp(1.0, bits) - 1.0 : 1.0;
}

void check_corners(std::uint64_t count) {
    if (count > kMostCorners) {
        throw unsupported("its objects have more corners than " + std::to_string(kMostCorners) +
                          " together: save parts of it on their own");
    }
}

class Asset {
   public:
    Asset(std::string_view content, std::filesystem::path file) : file_(std::move(file)), most_(content.size()) {
        const Chunks chunks = is_glb(content) ? chunks_of(content) : Chunks{content, {}};
        binary_ = chunks.binary;
        json_ = parsed_json(chunks.json);
        const std::string version = text(member(member(root(), "asset"), "version"));
        if (!version.starts_with("2.")) {
            throw version.empty() ? damaged("the glTF has no asset with a version") : wrong_version(version);
        }
        check_extensions(root());
    }

    Element root() const { return {&json_, "the root"}; }

    /// \param kind as messages call it, \param index from 0
    Element item(const char* list, const std::string& kind, std::uint64_t index) const {
        const Element items = member(root(), list);
        if (!items || !items.json->is_array() || index >= items.json->size()) {
            throw damaged("the " + kind + ' ' + std::to_string(index) + " is asked for and does not exist");
        }
        return {&items.json->elements()[index], "the " + kind + ' ' + std::to_string(index)};
    }
    Element accessor(std::uint64_t index) const { return item("accessors", "accessor", index); }

    /// The numbers of all elements of an accessor, one after the other. \param components of each element
    std::vector<double> values(std::uint64_t index, std::size_t components) {
        const Element accessor = this->accessor(index);
        const NumberType type = component_type(accessor);
        const std::string shape = components == 1 ? "SCALAR" : "VEC" + std::to_string(components);
        const bool is_unsigned = type == NumberType::kU1 || type == NumberType::kU2 || type == NumberType::kU4;
        if (text(member(accessor, "type")) != shape || (components == 1 ? !is_unsigned : type == NumberType::kU4)) {
            throw damaged(accessor.name + " has another type than its use needs");
        }
        const std::uint64_t count = needed_integer(accessor, "count");
        check_corners(count);
        const std::optional<std::uint64_t> view = integer(accessor, "bufferView");
        const Element sparse = member(accessor, "sparse");
        std::vector<double> result;
        if (view) {
            result = elements(accessor, *view, count, type, components);
        } else if (sparse && count <= most_) {  // all others are 0
            result.resize(count * components);
        } else {
            throw damaged(accessor.name + " has no data: " + std::string(kUnpack));
        }
        if (sparse) {
            replace(sparse, count, type, components, result);
        }
        if (const double largest = largest_of(type); largest > 1.0 && is_true(accessor, "normalized")) {
            std::ranges::transform(result, result.begin(),
                                   [&](double value) { return std::max(value / largest, -1.0); });
        }
        return result;
    }

   private:
    /// \throws FileError if they do not lie within their data
    std::vector<double> elements(const Element& element, std::uint64_t view_index, std::uint64_t count, NumberType type,
                                 std::size_t components) {
        const Element view = item("bufferViews", "buffer view", view_index);
        const std::string_view all = buffer(needed_integer(view, "buffer"));
        const std::uint64_t begin = integer(view, "byteOffset").value_or(0);
        const std::uint64_t length = needed_integer(view, "byteLength");
        const std::uint64_t offset = integer(element, "byteOffset").value_or(0);
        const std::size_t component = bytes_per_number(type);
        const std::uint64_t size = component * components;
        const std::uint64_t stride = integer(view, "byteStride").value_or(size);
        if (begin > all.size() || length > all.size() - begin) {
            throw truncated(view.name + " ends behind its buffer, of " + std::to_string(all.size()) + " bytes");
        }
        if (stride < size || offset > length || count > (length - offset + stride - size) / stride) {
            throw truncated(element.name + " has " + std::to_string(count) + " elements, which " + view.name + ", of " +
                            std::to_string(length) + " bytes, cannot hold");
        }
        std::vector<double> result;
        result.reserve(count * components);
        for (std::uint64_t i = 0; i < count; ++i) {
            const char* data = all.data() + begin + offset + i * stride;
            for (std::size_t k = 0; k < components; ++k) {
                result.push_back(number_at(data + k * component, type, std::endian::little));
            }
        }
        return result;
    }

    /// Puts the elements of their own that a sparse accessor has in place of others.
    void replace(const Element& sparse, std::uint64_t count, NumberType type, std::size_t components,
                 std::vector<double>& values) {
        const std::uint64_t replaced = needed_integer(sparse, "count");
        const Element where = member(sparse, "indices");
        const Element what = member(sparse, "values");
        const std::vector<double> indices =
            elements(where, needed_integer(where, "bufferView"), replaced, component_type(where), 1);
        const std::vector<double> replacing =
            elements(what, needed_integer(what, "bufferView"), replaced, type, components);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            if (!(indices[i] >= 0.0 && indices[i] < static_cast<double>(count))) {
                throw damaged(sparse.name + " replaces an element that does not exist");
            }
            std::copy_n(
                replacing.begin() + static_cast<std::ptrdiff_t>(i * components), components,
                values.begin() + static_cast<std::ptrdiff_t>(indices[i]) * static_cast<std::ptrdiff_t>(components));
        }
    }

    std::string_view buffer(std::uint64_t index) {
        const Element element = item("buffers", "buffer", index);
        const std::string uri = text(member(element, "uri"));
        if (uri.empty() && (index != 0 || !binary_)) {
            throw damaged(element.name + " has no data: if they are packed, " + std::string(kUnpack));
        }
        std::string_view bytes = binary_.value_or("");
        if (!uri.empty()) {
            auto found = loaded_.find(index);
            if (found == loaded_.end()) {
                found = loaded_.emplace(index, uri.starts_with("data:") ? decoded(uri) : read_beside(uri, file_)).first;
                most_ += found->second.size();
            }
            bytes = found->second;
        }
        const std::uint64_t length = needed_integer(element, "byteLength");
        if (length > bytes.size()) {
            throw truncated(element.name + " should have " + std::to_string(length) + " bytes and has " +
                            std::to_string(bytes.size()));
        }
        return bytes.substr(0, length);
    }

    Json json_;
    std::optional<std::string_view> binary_;
    std::filesystem::path file_;
    std::map<std::uint64_t, std::string> loaded_;  // buffers of other files, or within the text
    std::uint64_t most_ = 0;                       // bytes that were read
};

/// What is drawn of a list of n corners.
enum Mode : std::uint8_t { kPoints, kLines, kLineLoop, kLineStrip, kTriangles, kTriangleStrip, kTriangleFan };

struct Mesh {
    PolygonMesh triangles;
    std::uint64_t points = 0;
    std::uint64_t lines = 0;
};

void add_triangles(std::uint64_t mode, const std::vector<Index>& corners, IndexLists& to) {
    const std::size_t step = mode == kTriangles ? 3 : 1;
    check_corners(to.items.size() + corners.size() / step * 3);
    for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
        const bool is_turned = mode == kTriangleStrip && i % 2 == 1;
        const Index first = corners[mode == kTriangleFan ? 0 : i + (is_turned ? 1 : 0)];
        to.push_back(std::array{first, corners[i + (is_turned ? 0 : 1)], corners[i + 2]});
    }
}

Mesh read_mesh(std::uint64_t index, Asset& asset) {
    Mesh mesh;
    PolygonMesh& to = mesh.triangles;
    std::map<std::uint64_t, std::pair<std::size_t, std::size_t>>
        ranges;  // of vertices: primitives may share an accessor
    for (const Element& primitive : list(asset.item("meshes", "mesh", index), "primitives")) {
        const std::optional<std::uint64_t> position = integer(member(primitive, "attributes"), "POSITION");
        const std::optional<std::uint64_t> indices = integer(primitive, "indices");
        const std::uint64_t mode = integer(primitive, "mode").value_or(kTriangles);
        if (mode > kTriangleFan) {
            throw no_such(primitive, "mode", "one of glTF's");
        }
        if (!position) {
            continue;
        }
        if (mode < kTriangles) {
            const std::uint64_t count = needed_integer(asset.accessor(indices.value_or(*position)), "count");
            const std::uint64_t joints = mode == kLineStrip && count > 0 ? 1 : 0;
            (mode == kPoints ? mesh.points : mesh.lines) += mode == kLines ? count / 2 : count - joints;
            continue;
        }
        const auto [range, is_new] = ranges.try_emplace(*position, to.vertices.size(), 0);
        auto& [first, count] = range->second;
        if (is_new) {
            const std::vector<double> values = asset.values(*position, 3);
            count = values.size() / 3;
            check_corners(first + count);
            for (std::size_t i = 0; i < values.size(); i += 3) {
                to.vertices.push_back({values[i], values[i + 1], values[i + 2]});
            }
        }
        std::vector<Index> corners(count);
        std::iota(corners.begin(), corners.end(), static_cast<Index>(first));
        if (indices) {
            const std::vector<double> values = asset.values(*indices, 1);
            corners.resize(values.size());
            std::ranges::transform(values, corners.begin(), [first = first, count = count](double v) {
                return v < static_cast<double>(count) ? static_cast<Index>(first + static_cast<std::size_t>(v)) : kNone;
            });
        }
        add_triangles(mode, corners, to.polygons);
    }
    return mesh;
}

Eigen::Affine3d place_of(const std::array<double, 3>& translation, const std::array<double, 4>& rotation,
                         const std::array<double, 3>& scale) {
    Eigen::Quaterniond turn(rotation[3], rotation[0], rotation[1], rotation[2]);
    turn.normalize();  // quantized ones are not of length 1; zero stays zero
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    result.linear() = turn.toRotationMatrix() * Eigen::Vector3d(scale[0], scale[1], scale[2]).asDiagonal();
    result.translation() << translation[0], translation[1], translation[2];
    return result;
}

constexpr std::array<double, 3> kNoTranslation{0, 0, 0};
constexpr std::array<double, 4> kNoRotation{0, 0, 0, 1};
constexpr std::array<double, 3> kNoScale{1, 1, 1};

Eigen::Affine3d place_of(const Element& node) {
    if (member(node, "matrix")) {
        const std::array<double, 16> matrix =
            numbers<16>(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
        Eigen::Affine3d result = Eigen::Affine3d::Identity();
        for (int column = 0; column < 4; ++column) {
            for (int row = 0; row < 3; ++row) {
                result.matrix()(row, column) = matrix[static_cast<std::size_t>(4 * column + row)];
            }
        }
        return result;
    }
    return place_of(numbers(node, "translation", kNoTranslation), numbers(node, "rotation", kNoRotation),
                    numbers(node, "scale", kNoScale));
}

struct PlacedNode {
    Element node;
    Eigen::Affine3d place;
};

/// All nodes of the scene, each before its children.
std::vector<PlacedNode> placed_nodes(const Asset& asset) {
    std::vector<PlacedNode> result;
    std::vector<bool> is_placed(list(asset.root(), "nodes").size());
    std::vector<std::pair<std::uint64_t, Eigen::Affine3d>> waiting;  // with the place of the one above
    const auto wait = [&](const std::vector<std::uint64_t>& nodes, const Eigen::Affine3d& place) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
            waiting.emplace_back(*node, place);
        }
    };
    const std::uint64_t scene = integer(asset.root(), "scene").value_or(0);
    wait(integers(asset.item("scenes", "scene", scene), "nodes"), Eigen::Affine3d::Identity());
    while (!waiting.empty()) {
        const auto [index, above] = waiting.back();
        waiting.pop_back();
        const Element node = asset.item("nodes", "node", index);
        if (is_placed[index]) {
            throw damaged(node.name + " is in the scene twice: nodes have to be a tree");
        }
        is_placed[index] = true;
        result.push_back({node, above * place_of(node)});
        const Eigen::Affine3d place = result.back().place;
        wait(integers(node, "children"), place);
    }
    return result;
}

template <std::size_t count>
std::array<double, count> row(const std::vector<double>& rows, std::size_t i, std::array<double, count> otherwise) {
    if (!rows.empty()) {
        std::copy_n(rows.data() + i * count, count, otherwise.data());
    }
    return otherwise;
}

/// Where the mesh of a node is: at its place, or at those of its instances.
std::vector<Eigen::Affine3d> places_of(const PlacedNode& placed, Asset& asset) {
    const Element instancing = member(member(placed.node, "extensions"), "EXT_mesh_gpu_instancing");
    if (!instancing) {
        return {placed.place};
    }
    std::optional<std::size_t> count;
    const auto rows = [&](const char* name, std::size_t components) {
        const std::optional<std::uint64_t> accessor = integer(member(instancing, "attributes"), name);
        std::vector<double> result = accessor ? asset.values(*accessor, components) : std::vector<double>();
        if (accessor && result.size() / components != count.value_or(result.size() / components)) {
            throw damaged(placed.node.name + " has instances with and without '" + name + "'");
        }
        count = accessor ? result.size() / components : count;
        return result;
    };
    const std::vector<double> translations = rows("TRANSLATION", 3);
    const std::vector<double> rotations = rows("ROTATION", 4);
    const std::vector<double> scales = rows("SCALE", 3);
    std::vector<Eigen::Affine3d> result;
    for (std::size_t i = 0; i < count.value_or(0); ++i) {
        result.push_back(placed.place * place_of(row(translations, i, kNoTranslation), row(rotations, i, kNoRotation),
                                                 row(scales, i, kNoScale)));
    }
    return result;
}

/// Is the mesh of a node drawn in another shape than it is stored in?
bool is_posed(const Element& node, const Element& mesh) {
    const std::vector<Element> weights = list(member(node, "weights") ? node : mesh, "weights");
    return member(node, "skin") || std::ranges::any_of(weights, [](const Element& weight) {
               return weight.json->is_number() && weight.json->get<double>() != 0.0;
           });
}

PolygonObjects objects_of(Asset& asset) {
    PolygonObjects result;
    std::map<std::uint64_t, Mesh> meshes;
    std::uint64_t corners = 0;  // and vertices
    std::uint64_t points = 0;
    std::uint64_t lines = 0;
    std::int64_t posed = 0;
    for (const PlacedNode& placed : placed_nodes(asset)) {
        const std::optional<std::uint64_t> index = integer(placed.node, "mesh");
        if (!index) {
            continue;
        }
        auto found = meshes.find(*index);
        if (found == meshes.end()) {
            found = meshes.emplace(*index, read_mesh(*index, asset)).first;
        }
        const Mesh& mesh = found->second;
        posed += is_posed(placed.node, asset.item("meshes", "mesh", *index)) ? 1 : 0;
        for (const Eigen::Affine3d& place : places_of(placed, asset)) {
            points += mesh.points;
            lines += mesh.lines;
            corners += mesh.triangles.vertices.size() + mesh.triangles.polygons.items.size();
            check_corners(corners);
            if (mesh.triangles.polygons.size() > 0) {
                result.objects.push_back({text(member(placed.node, "name")), {}});
                append_placed(mesh.triangles, place, result.objects.back().mesh);
            }
        }
    }
    if (points + lines > 0) {
        result.warnings.push_back({"mesh.no_faces", std::to_string(points) + " points and " + std::to_string(lines) +
                                                        " lines are left out, which bound no solid"});
    }
    if (posed > 0) {
        result.warnings.push_back({"mesh.pose", counted(posed, "mesh has", "meshes have") +
                                                    " bones or shape keys, which are not applied: place and size may "
                                                    "be others; apply them before export, as in Blender"});
    }
    return result;
}

}  // namespace
}  // namespace gltf

bool is_gltf(std::string_view content) {
    return text_beginning(content).starts_with('{') && content.find("\"asset\"") != content.npos;
}

bool is_glb(std::string_view content) { return content.starts_with("glTF"); }

PolygonObjects read_gltf(std::string_view content, const std::filesystem::path& file) {
    gltf::Asset asset(content, file);
    return gltf::objects_of(asset);
}

}  // namespace scaleaxis::io
