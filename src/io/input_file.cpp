// SPDX-License-Identifier: Apache-2.0
#include "io/input_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <memory>
#include <system_error>
#include <utility>

#include "base/faults.hpp"
#include "base/files.hpp"
#include "io/formats.hpp"

namespace scaleaxis::io {
namespace {

FileError cannot_read(const std::string& what) { return FileError(Diagnostic{"file.open", "cannot read: " + what}); }

using Stream = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// To its end, which is known for a file, and of a pipe or a device not before it is reached.
/// \param content the beginning, which has been read \param expected bytes
std::string read_to_end(std::FILE* stream, std::string content, std::size_t expected) {
    constexpr std::size_t kLeastRead = std::size_t{1} << 20;
    std::size_t read = content.size();
    // One byte more than there should be: the end of the file is not known before it is passed.
    content.resize(std::max(read, expected) + 1);
    read += std::fread(content.data() + read, 1, content.size() - read, stream);
    while (read == content.size() && std::feof(stream) == 0 && std::ferror(stream) == 0) {
        content.resize(read + std::max(kLeastRead, read));
        read += std::fread(content.data() + read, 1, content.size() - read, stream);
        check_size(std::max<std::size_t>(read, 1));
    }
    if (std::ferror(stream) != 0) {
        throw cannot_read("it could not be read to its end: " + std::generic_category().message(errno));
    }
    content.resize(read);
    check_size(read);
    return content;
}

/// For a folder with slices of DICOM what to do; else empty.
std::string advice_for_folder(const std::filesystem::path& folder) {
    constexpr std::size_t kHead = 132;  // of DICOM: its mark ends there
    std::error_code error;
    for (const std::filesystem::directory_entry& entry : std::filesystem::directory_iterator(folder, error)) {
        std::string head(kHead, '\0');
        if (entry.is_regular_file(error) && std::ifstream(entry.path(), std::ios::binary).read(head.data(), kHead)) {
            if (std::string advice = advice_for_dicom(head); !advice.empty()) {
                return advice;
            }
        }
    }
    return {};
}

}  // namespace

std::string read_file(const std::filesystem::path& file, bool is_enough(std::string_view beginning)) {
    constexpr std::uintmax_t kBeginning = std::uintmax_t{1} << 24;  // heads with names of segments have some 100 kB
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (error) {
        throw cannot_read(error.message());
    }
    if (std::filesystem::is_directory(status)) {
        const std::string advice = advice_for_folder(file);
        throw advice.empty() ? cannot_read("it is a folder; name a file in it") : unsupported(advice);
    }
    const Stream stream(open_stream(file, "rb"), &std::fclose);
    if (!stream) {
        throw cannot_read(std::generic_category().message(errno));
    }
    if (!std::filesystem::is_regular_file(status)) {
        return read_to_end(stream.get(), {}, 0);
    }
    const std::uintmax_t size = std::filesystem::file_size(file);
    std::string beginning(static_cast<std::size_t>(std::min(size, kBeginning)), '\0');
    beginning.resize(std::fread(beginning.data(), 1, beginning.size(), stream.get()));
    if (is_enough != nullptr && is_enough(beginning)) {
        return beginning;
    }
    check_size(size);
    return read_to_end(stream.get(), std::move(beginning), static_cast<std::size_t>(size));
}

bool is_plain_file(const std::filesystem::path& file) {
    std::error_code ignored;
    return std::filesystem::is_regular_file(file, ignored);
}

std::uintmax_t size_of_file(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) {
        throw FileError(Diagnostic{"file.open", "its data file " + utf8_of(file.filename()) + ": " + error.message()});
    }
    return size;
}

ByteSource bytes_of_file(const std::filesystem::path& file, std::uintmax_t begin) {
    const auto stream = std::make_shared<std::ifstream>(file, std::ios::binary);
    if (!stream->seekg(static_cast<std::streamoff>(begin))) {
        throw FileError(Diagnostic{"file.open", "its data file " + utf8_of(file.filename()) + " cannot be read"});
    }
    return [stream](char* to, std::size_t most) {
        return static_cast<std::size_t>(stream->read(to, static_cast<std::streamsize>(most)).gcount());
    };
}

}  // namespace scaleaxis::io
