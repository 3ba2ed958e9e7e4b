// SPDX-License-Identifier: Apache-2.0
#include "io/output_file.hpp"

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "base/files.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::io {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int error) {
    const fs::path folder = file.parent_path();
    std::error_code ignored;
    const std::string what =
        !folder.empty() && !fs::exists(folder, ignored)
            ? "there is no folder " + utf8_of(folder) + "; make it, or choose another place"
            : std::generic_category().message(error) +
                  "; check the folder, its permissions and the free space, or choose another place";
    throw FileError(Diagnostic{"file.write", "cannot write " + utf8_of(file) + ": " + what});
}

/// Where it stands: a file that stdout was redirected to is neither emptied nor replaced.
bool is_stdout(const fs::path& file) { return file == "/dev/stdout"; }

/// A pipe or a device takes the bytes as they come: there is nothing to rename.
bool takes_bytes_at_once(const fs::path& file) {
    std::error_code error;
    const fs::file_status status = fs::status(file, error);
    return fs::is_fifo(status) || fs::is_character_file(status) || fs::is_socket(status);
}

}  // namespace

OutputFile::OutputFile(fs::path file) : file_(std::move(file)) {
    std::error_code error;
    if (fs::is_directory(file_, error)) {
        fail(file_, EISDIR);
    }
    if (error == std::errc::filename_too_long) {
        fail(file_, ENAMETOOLONG);
    }
    if (is_stdout(file_) || takes_bytes_at_once(file_)) {
        stream_ = is_stdout(file_) ? open_stdout() : open_stream(file_, "wb");
        if (stream_ == nullptr) {
            fail(file_, errno);
        }
        return;
    }
    // "x": fails if the file exists, so two writers never share a temporary file, and what a killed one has left behind
    // is never written to.
    bool is_too_long = false;  // the name with what is appended, so that this stands alone
    for (int i = 0; stream_ == nullptr;) {
        fs::path name = is_too_long ? file_.parent_path() / "" : file_;
        name += ".part" + std::to_string(i);
        stream_ = open_stream(name, "wbx");
        if (stream_ != nullptr) {
            temporary_ = std::move(name);
        } else if (errno == ENAMETOOLONG && !is_too_long) {
            is_too_long = true;
        } else if (errno == EEXIST) {
            ++i;
        } else {
            fail(file_, errno);
        }
    }
}

OutputFile::~OutputFile() {
    if (stream_ != nullptr) {
        std::fclose(stream_);
    }
    if (!temporary_.empty()) {
        std::error_code ignored;
        fs::remove(temporary_, ignored);
    }
}

void OutputFile::flush() {
    if (std::fwrite(buffer_.data(), 1, buffer_.size(), stream_) != buffer_.size()) {
        fail(file_, errno);
    }
    buffer_.clear();
}

void OutputFile::commit() {
    flush();
    if (std::fclose(std::exchange(stream_, nullptr)) != 0) {
        fail(file_, errno);
    }
    if (temporary_.empty()) {
        return;
    }
    std::error_code error;
    fs::rename(temporary_, file_, error);
    if (error) {
        fail(file_, error.value());
    }
    temporary_.clear();
}

void check_output_file(const fs::path& file) {
    if (is_stdout(file)) {
        return;
    }
    if (!takes_bytes_at_once(file)) {
        const OutputFile probe(file);
    } else if (const int error = why_not_writable(file); error != 0) {
        fail(file, error);
    }
}

}  // namespace scaleaxis::io
