// SPDX-License-Identifier: Apache-2.0
//
// The formats of scenes that Assimp reads. The only source that knows it.
#include <assimp/config.h>
#include <assimp/scene.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/faults.hpp"
#include "io/formats.hpp"
#include "io/input_file.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

/// Some content as a file.
class ContentStream : public Assimp::IOStream {
   public:
    explicit ContentStream(std::string_view content) : content_(content) {}
    explicit ContentStream(std::string owned) : owned_(std::move(owned)), content_(owned_) {}

    std::size_t Read(void* to, std::size_t size, std::size_t count) override {
        const std::size_t items = size == 0 ? 0 : std::min(count, (content_.size() - position_) / size);
        std::memcpy(to, content_.data() + position_, items * size);
        position_ += items * size;
        return items;
    }
    std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
    aiReturn Seek(std::size_t offset, aiOrigin origin) override {
        const std::size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? position_ : content_.size();
        if (const std::size_t place = base + offset; place <= content_.size()) {  // the sum may wrap: backwards
            position_ = place;
            return aiReturn_SUCCESS;
        }
        return aiReturn_FAILURE;
    }
    std::size_t Tell() const override { return position_; }
    std::size_t FileSize() const override { return content_.size(); }
    void Flush() override {}

   private:
    std::string owned_;
    std::string_view content_;
    std::size_t position_ = 0;
};

/// The files that Assimp sees: the content under the name `scene` and, where there is a folder, those in it.
class SceneFiles : public Assimp::IOSystem {
   public:
    SceneFiles(std::string_view content, std::string name, std::filesystem::path folder)
        : content_(content), name_(std::move(name)), folder_(std::move(folder)) {}

    bool Exists(const char* file) const override { return name_ == file || is_inside(file); }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* file, const char* mode) override {
        if (std::strchr(mode, 'r') == nullptr) {
            return nullptr;
        }
        if (name_ == file) {
            return new ContentStream(content_);
        }
        try {
            if (!is_inside(file)) {
                throw FileError(Diagnostic{
                    "file.open", folder_.empty() ? "it can only be read beside the file that refers to it, on a disk"
                                                 : "only files in the folder of the one that refers to it are read"});
            }
            return new ContentStream(read_file(folder_ / file));
        } catch (const FileError& error) {
            if (!fault_) {
                fault_ = with_prefix("its part " + quoted(file) + ": ", error);
            }
            return nullptr;
        }
    }
    void Close(Assimp::IOStream* stream) override { delete stream; }

    /// Why a file could not be opened.
    const std::optional<FileError>& fault() const { return fault_; }

   private:
    bool is_inside(const std::filesystem::path& file) const {
        return !folder_.empty() && file.is_relative() && std::ranges::find(file, "..") == file.end();
    }

    std::string_view content_;
    std::string name_;
    std::filesystem::path folder_;
    std::optional<FileError> fault_;
};

/// What an error of Assimp says, in one line and without its own names.
std::string in_one_line(std::string text) {
    if (const std::size_t end = text.find(": "); end != text.npos && text.substr(0, end).find(' ') == text.npos) {
        text = text.substr(end + 2);
    }
    std::string result;
    for (const char c : text) {
        const bool is_blank = c == ' ' || static_cast<unsigned char>(c) < ' ';
        if (!is_blank || (!result.empty() && result.back() != ' ')) {
            result += is_blank ? ' ' : c;
        }
    }
    constexpr std::size_t kLongest = 200;  // some quote the rest of the file
    if (result.size() > kLongest) {
        result = result.substr(0, kLongest) + "...";
    }
    return result.empty() ? "it is damaged" : result;
}

/// Nothing but the triangles is wanted, at the places and in the units of the file.
void configure(Assimp::Importer& importer) {
    importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_CAMERAS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_LIGHTS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
}

/// A node of the scene, with what brings it to its place.
struct PlacedNode {
    const aiNode* node;
    Eigen::Affine3d place;
};

Eigen::Affine3d transform_of(const aiNode& node) {
    Eigen::Affine3d result;
    const aiMatrix4x4& m = node.mTransformation;
    result.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0.0, 0.0, 0.0, 1.0;
    return result;
}

/// All nodes, each before its children.
std::vector<PlacedNode> placed_nodes(const aiScene& scene) {
    std::vector<PlacedNode> result;
    std::vector<PlacedNode> waiting;
    if (scene.mRootNode != nullptr) {
        waiting.push_back({scene.mRootNode, transform_of(*scene.mRootNode)});
    }
    while (!waiting.empty()) {
        const PlacedNode next = waiting.back();
        waiting.pop_back();
        result.push_back(next);
        for (unsigned i = next.node->mNumChildren; i-- > 0;) {
            const aiNode* child = next.node->mChildren[i];
            waiting.push_back({child, next.place * transform_of(*child)});
        }
    }
    return result;
}

constexpr unsigned kPolygonCorners = 3;

bool has_polygons(const aiMesh& mesh) {
    return std::any_of(mesh.mFaces, mesh.mFaces + mesh.mNumFaces,
                       [](const aiFace& face) { return face.mNumIndices >= kPolygonCorners; });
}

/// Adds the polygons of a mesh, with its vertices, if it has any.
void add(const aiMesh& mesh, const Eigen::Affine3d& place, PolygonMesh& to) {
    if (!has_polygons(mesh)) {
        return;
    }
    const auto first = static_cast<Index>(to.vertices.size());
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        const aiVector3D& p = mesh.mVertices[v];
        const Eigen::Vector3d q = place * Eigen::Vector3d(p.x, p.y, p.z);
        to.vertices.push_back({q.x(), q.y(), q.z()});
    }
    const bool is_mirrored = place.linear().determinant() < 0.0;
    std::vector<Index> corners;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices < kPolygonCorners) {
            continue;
        }
        corners.clear();
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            const unsigned v = face.mIndices[k];
            corners.push_back(v < mesh.mNumVertices ? first + static_cast<Index>(v) : kNone);
        }
        if (is_mirrored) {
            std::ranges::reverse(corners);
        }
        to.polygons.push_back(corners);
    }
}

/// How much the meshes of all nodes hold: a mesh may be at many.
struct Amount {
    std::uint64_t corners = 0;  ///< and vertices
    std::uint64_t points = 0;
    std::uint64_t lines = 0;
};

Amount amount(const aiMesh& mesh) {
    Amount result;
    result.corners = mesh.mNumVertices;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const unsigned corners = mesh.mFaces[f].mNumIndices;
        result.points += corners == 1 ? 1 : 0;
        result.lines += corners == 2 ? 1 : 0;
        result.corners += corners;
    }
    return result;
}

std::vector<const aiMesh*> meshes_of(const aiScene& scene, const aiNode& node) {
    std::vector<const aiMesh*> result;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) {
        if (node.mMeshes[i] >= scene.mNumMeshes) {
            throw damaged("the node " + quoted(node.mName.C_Str()) + " has a mesh that does not exist");
        }
        result.push_back(scene.mMeshes[node.mMeshes[i]]);
    }
    return result;
}

PolygonObjects objects_of(const aiScene& scene) {
    std::vector<Amount> amounts;
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
        amounts.push_back(amount(*scene.mMeshes[i]));
    }
    const std::vector<PlacedNode> nodes = placed_nodes(scene);
    Amount all;
    for (const PlacedNode& placed : nodes) {
        for (unsigned i = 0; i < placed.node->mNumMeshes; ++i) {
            if (const unsigned mesh = placed.node->mMeshes[i]; mesh < amounts.size()) {
                all.corners += amounts[mesh].corners;
                all.points += amounts[mesh].points;
                all.lines += amounts[mesh].lines;
            }
        }
        if (all.corners > kMostCorners) {
            throw unsupported("its objects have more corners than " + std::to_string(kMostCorners) +
                              " together: save parts of it on their own");
        }
    }
    PolygonObjects result;
    for (const PlacedNode& placed : nodes) {
        PolygonObjects::Object object{placed.node->mName.C_Str(), {}};
        for (const aiMesh* mesh : meshes_of(scene, *placed.node)) {
            add(*mesh, placed.place, object.mesh);
        }
        if (object.mesh.polygons.size() > 0) {
            result.objects.push_back(std::move(object));
        }
    }
    if (all.points + all.lines > 0) {
        result.warnings.push_back({"mesh.no_faces", std::to_string(all.points) + " points and " +
                                                        std::to_string(all.lines) +
                                                        " lines are left out, which bound no solid"});
    }
    return result;
}

}  // namespace

PolygonObjects read_scene(std::string_view content, std::string_view extension, const std::filesystem::path& folder) {
    check_scene(content);
    const std::string name = "scene" + std::string(extension);
    // No other format has parts in files of their own that matter.
    auto* files = new SceneFiles(content, name, extension == ".gltf" ? folder : std::filesystem::path());
    Assimp::Importer importer;
    importer.SetIOHandler(files);  // which owns it from now on
    configure(importer);
    const aiScene* scene = importer.ReadFile(name, 0);
    if (scene == nullptr) {
        throw files->fault() ? *files->fault() : damaged(in_one_line(importer.GetErrorString()));
    }
    return objects_of(*scene);
}

}  // namespace scaleaxis::io
