// SPDX-License-Identifier: Apache-2.0
#include "readable.hpp"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <system_error>

namespace scaleaxis::app {

namespace fs = std::filesystem;

namespace {

/// Pipes, sockets and devices are read once, in order.
bool is_read_once(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// An empty file with this extension.
fs::path new_temporary(const fs::path& input, const std::string& extension) {
    std::string name = (fs::temp_directory_path() / "scaleaxis-XXXXXX").string() + extension;
    const int file = mkstemps(name.data(), static_cast<int>(extension.size()));
    if (file < 0) {
        throw FileError("cannot create a temporary file for " + input.string() + " in " +
                        fs::temp_directory_path().string() + ": " + std::generic_category().message(errno));
    }
    close(file);
    return name;
}

}  // namespace

ReadableFile::ReadableFile(const fs::path& input, const std::string& format)
    : input_(input), path_(input == "-" ? "/dev/stdin" : input) {
    std::error_code error;
    if (!is_read_once(path_) && (format.empty() || fs::is_directory(path_, error))) {
        return;
    }
    // Standard input is open already: a named pipe would wait for another writer if it were opened again.
    std::ifstream opened;
    if (path_ != "/dev/stdin") {
        opened.open(path_, std::ios::binary);
    }
    std::istream& source = path_ == "/dev/stdin" ? std::cin : opened;
    if (!source) {
        throw FileError(input.string() + ": cannot be read");
    }
    path_ = new_temporary(path_, format.empty() ? path_.extension().string() : "." + format);
    std::ofstream copy(path_, std::ios::binary);
    if (source.peek() != std::istream::traits_type::eof()) {
        copy << source.rdbuf();
    }
    copy.close();
    if (source.bad() || !copy) {
        std::error_code ignored;
        fs::remove(path_, ignored);
        throw FileError(input.string() + ": cannot be copied to " + path_.string() + "; is there enough space?");
    }
}

ReadableFile::~ReadableFile() {
    if (path_ != input_ && path_ != "/dev/stdin") {
        std::error_code ignored;
        fs::remove(path_, ignored);
    }
}

FileError ReadableFile::renamed(const FileError& error) const {
    Diagnostic diagnostic = error.diagnostic();
    const std::string copy = path_.string();
    for (std::size_t at = diagnostic.message.find(copy); copy != input_.string() && at != std::string::npos;
         at = diagnostic.message.find(copy, at + input_.string().size())) {
        diagnostic.message.replace(at, copy.size(), input_.string());
    }
    return FileError(std::move(diagnostic));
}

}  // namespace scaleaxis::app
