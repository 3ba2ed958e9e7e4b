// SPDX-License-Identifier: Apache-2.0
#include "readable.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <system_error>
#include <vector>

#include "base/files.hpp"
#include "inputs.hpp"
#include "interrupts.hpp"
#include "scaleaxis/io.hpp"
#include "status.hpp"
#include "terminal.hpp"

#if defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <windows.h>
#else
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>
#endif

namespace scaleaxis::app {

namespace fs = std::filesystem;

namespace {

constexpr std::uintmax_t kMostInput = std::numeric_limits<std::int32_t>::max();  // as the library reads

constexpr const char* kStdinPath = "/dev/stdin";

/// Pipes, sockets and devices are read once, in order, and so is standard input where it is no file, as on Windows.
bool is_read_once(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    if (file == kStdinPath && !fs::exists(status)) {
        return true;
    }
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

#if defined(_WIN32)

constexpr int kStdin = 0;

/// An empty file with this extension.
fs::path new_temporary(const fs::path& input, const std::string& extension) {
    const std::string stem = "scaleaxis-" + std::to_string(GetCurrentProcessId()) + "-";
    for (int i = 0;; ++i) {
        const fs::path file = fs::temp_directory_path() / (stem + std::to_string(i) + extension);
        if (std::FILE* const stream = open_stream(file, "wbx"); stream != nullptr) {
            std::fclose(stream);
            return file;
        }
        if (errno != EEXIST) {
            throw FileError("cannot create a temporary file for " + input.string() + " in " +
                            fs::temp_directory_path().string() + ": " + std::generic_category().message(errno));
        }
    }
}

void close_source(int source) { ::_close(source); }
int open_source(const fs::path& file) { return ::_wopen(file.c_str(), _O_RDONLY | _O_BINARY); }

/// Waits for as long as nothing comes; a second Ctrl-C ends that.
std::ptrdiff_t read_some(int source, std::vector<char>& buffer) {
    ::_setmode(source, _O_BINARY);
    return ::_read(source, buffer.data(), static_cast<unsigned>(buffer.size()));
}

#else

constexpr int kStdin = STDIN_FILENO;

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

void close_source(int source) { close(source); }
int open_source(const fs::path& file) { return open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC); }

/// Fails with EAGAIN if nothing comes for long, so that Ctrl-C can be asked for.
std::ptrdiff_t read_some(int source, std::vector<char>& buffer) {
    constexpr int kPatience = 100;  // milliseconds
    pollfd event{source, POLLIN, 0};
    if (poll(&event, 1, kPatience) == 0) {
        errno = EAGAIN;
        return -1;
    }
    return read(source, buffer.data(), buffer.size());
}

#endif

/// Closes it in the end.
struct Descriptor {
    int number = -1;  ///< -1: none

    ~Descriptor() {
        if (number >= 0) {
            close_source(number);
        }
    }
};

/// Copies a pipe or a device to its end. It may bring nothing for long, or never end.
void copy_all(int source, const fs::path& input, std::ostream& copy) {
    constexpr std::size_t kChunk = std::size_t{1} << 20;
    std::vector<char> buffer(kChunk);
    std::uintmax_t bytes = 0;
    while (copy) {
        stop_if_requested(current_interrupts());
        const std::ptrdiff_t count = read_some(source, buffer);
        if (count == 0) {
            return;
        }
        if (count < 0 && errno != EINTR && errno != EAGAIN) {
            throw FileError(input.string() + ": cannot be read: " + std::generic_category().message(errno));
        }
        bytes += static_cast<std::uintmax_t>(std::max<std::ptrdiff_t>(0, count));
        if (bytes > kMostInput) {
            throw FileError(
                Diagnostic{"file.open", input.string() + ": it does not end after 2 GiB, the most that can be read"});
        }
        copy.write(buffer.data(), std::max<std::ptrdiff_t>(0, count));
    }
}

}  // namespace

ReadableFile::ReadableFile(const fs::path& input, const std::string& format)
    : input_(input), path_(input == "-" ? kStdinPath : input) {
    std::error_code error;
    if (!is_read_once(path_) && (format.empty() || fs::is_directory(path_, error))) {
        return;
    }
    const bool is_stdin = path_ == kStdinPath;
    // Standard input is open already: a named pipe would wait for another writer if it were opened again.
    const int source = is_stdin ? kStdin : open_source(path_);
    if (source < 0) {
        throw FileError(input.string() + ": cannot be read: " + std::generic_category().message(errno));
    }
    const Descriptor opened{is_stdin ? -1 : source};
    path_ = new_temporary(path_, format.empty() ? path_.extension().string() : "." + format);
    copy_.emplace(path_);
    std::ofstream copy(path_, std::ios::binary);
    copy_all(source, input, copy);
    copy.close();
    if (!copy) {
        throw FileError(input.string() + ": cannot be copied to " + path_.string() + "; is there enough space?");
    }
}

TriangleMesh read_mesh_with_warnings(const fs::path& file, const fs::path& name) {
    MeshObjects read = read_objects(file);
    for (const Diagnostic& warning : read.warnings) {
        print_warning(name.string() + ": " + with_hints(warning));
    }
    return joined(std::move(read.objects));
}

FileError ReadableFile::renamed(const FileError& error) const {
    Diagnostic diagnostic = error.diagnostic();
    // What else a folder may have in it, as slices of DICOM, has a code and an advice of its own.
    if (diagnostic.code == "file.open" && is_folder_without_inputs(input_)) {
        diagnostic.message = input_.string() +
                             ": cannot read: no file in this folder has the ending of an input; name a file with "
                             "another one itself";
    }
    const std::string copy = path_.string();
    for (std::size_t at = diagnostic.message.find(copy); copy != input_.string() && at != std::string::npos;
         at = diagnostic.message.find(copy, at + input_.string().size())) {
        diagnostic.message.replace(at, copy.size(), input_.string());
    }
    return FileError(std::move(diagnostic));
}

}  // namespace scaleaxis::app
