// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/output_file.hpp"

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "scaleaxis/errors.hpp"

namespace scaleaxis::io {

OutputFile::OutputFile(std::filesystem::path file) : file_(std::move(file)) {
    std::error_code error;
    if (std::filesystem::is_directory(file_, error)) {
        fail(EISDIR);
    }
    // "x": fails if the file exists, so that two writers never share a temporary file.
    for (int i = 0; stream_ == nullptr; ++i) {
        temporary_ = file_;
        temporary_ += ".part" + std::to_string(i);
        stream_ = std::fopen(temporary_.c_str(), "wbx");
        if (stream_ == nullptr && errno != EEXIST) {
            fail(errno);
        }
    }
}

OutputFile::~OutputFile() {
    if (stream_ != nullptr) {
        std::fclose(stream_);
    }
    if (!temporary_.empty()) {
        std::error_code ignored;
        std::filesystem::remove(temporary_, ignored);
    }
}

void OutputFile::flush() {
    if (std::fwrite(buffer_.data(), 1, buffer_.size(), stream_) != buffer_.size()) {
        fail(errno);
    }
    buffer_.clear();
}

void OutputFile::commit() {
    flush();
    if (std::fclose(std::exchange(stream_, nullptr)) != 0) {
        fail(errno);
    }
    std::error_code error;
    std::filesystem::rename(temporary_, file_, error);
    if (error) {
        fail(error.value());
    }
    temporary_.clear();
}

void OutputFile::fail(int error) const {
    throw FileError("cannot write " + file_.string() + ": " + std::generic_category().message(error) +
                    "; check the folder, its permissions and the free space, or choose another place");
}

}  // namespace scaleaxis::io
