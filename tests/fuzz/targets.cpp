// SPDX-License-Identifier: Apache-2.0
#include "targets.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <stdexcept>
#include <string>

#include "documents.hpp"
#include "expression.hpp"
#include "scaleaxis/cloud.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis::test {
namespace {

namespace fs = std::filesystem;

/// Errors are right, but not those that show that a file has made the program ask for memory that there is not.
template <class Read>
void expect_value_or_error(const Read& read) {
    try {
        read();
    } catch (const FileError& error) {
        if (error.diagnostic().code == "file.memory") {
            throw std::runtime_error(error.what());
        }
    } catch (const Error&) {
    }
}

/// Under each of these names, since where the content does not tell the format the name does.
template <class Read>
void read_as(std::span<const std::byte> bytes, std::initializer_list<const char*> names, const Read& read) {
    for (const char* name : names) {
        const FileBytes file{bytes, name};
        expect_value_or_error([&] { file_kind(file); });
        expect_value_or_error([&] { read(file); });
    }
}

void read_meshes(std::span<const std::byte> bytes) {
    read_as(bytes, {"a.off", "a.obj", "a.ply", "a.stl", "a.gltf", "a.3mf", "a.vtk"},
            [](const FileBytes& file) { read_mesh(file); });
}

void read_clouds(std::span<const std::byte> bytes) {
    read_as(bytes, {"a.xyz", "a.pcd", "a.ply", "a.off"}, [](const FileBytes& file) { read_points(file); });
}

void read_unions(std::span<const std::byte> bytes) {
    read_as(bytes, {"a.balls", "a.woff", "a.ply"}, [](const FileBytes& file) { read_balls(file); });
}

void read_axes(std::span<const std::byte> bytes) {
    read_as(bytes, {"a.ma", "a.ply"}, [](const FileBytes& file) {
        stored_scale(file);
        read_axis(file);
    });
}

void read_images(std::span<const std::byte> bytes) {
    read_as(bytes, {"a.nrrd"}, [](const FileBytes& file) { read_image(file); });
}

void read_expression(std::span<const std::byte> bytes) {
    const std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    expect_value_or_error([&] { app::compiled(text)({0.1, -0.2, 0.3}); });
}

/// A file with these bytes, gone at the end.
class ShortLivedFile {
   public:
    ShortLivedFile(std::span<const std::byte> bytes, const std::string& extension)
        : path_(fs::temp_directory_path() / ("scaleaxis-fuzz-" + std::to_string(::getpid()) + extension)) {
        std::ofstream(path_, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    ~ShortLivedFile() { fs::remove(path_); }
    ShortLivedFile(const ShortLivedFile&) = delete;
    ShortLivedFile& operator=(const ShortLivedFile&) = delete;

    const fs::path& path() const { return path_; }

   private:
    fs::path path_;
};

void read_documents(std::span<const std::byte> bytes) {
    for (const char* extension : {".json", ".jsonl"}) {
        const ShortLivedFile file(bytes, extension);
        expect_value_or_error([&] { app::read_statistics(file.path()); });
    }
}

}  // namespace

const std::vector<FuzzTarget>& fuzz_targets() {
    static const std::vector<FuzzTarget> targets{
        {"mesh", read_meshes},  {"points", read_clouds},         {"balls", read_unions},        {"axis", read_axes},
        {"image", read_images}, {"expression", read_expression}, {"statistics", read_documents}};
    return targets;
}

}  // namespace scaleaxis::test
