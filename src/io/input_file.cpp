// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/input_file.hpp"

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <system_error>

#include "scaleaxis/errors.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::io {

std::string read_file(const std::filesystem::path& file) {
    const auto fail = [](const std::string& what) { throw FileError("cannot read: " + what); };
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (error) {
        fail(error.message());
    }
    if (!std::filesystem::is_regular_file(status)) {
        fail(std::filesystem::is_directory(status) ? "it is a folder; name a file in it" : "it is not a regular file");
    }
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
    if (!stream) {
        fail(std::generic_category().message(errno));
    }
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error) {
        fail(error.message());
    }
    if (size == 0) {
        fail("the file is empty");
    }
    // So every count of elements in it can be held in an `Index`.
    if (size > static_cast<std::uintmax_t>(std::numeric_limits<Index>::max())) {
        fail("the file has " + std::to_string(size) + " bytes; the largest that can be read has 2 GiB");
    }
    std::string content(size, '\0');
    if (std::fread(content.data(), 1, size, stream.get()) != size) {
        fail("the file changed or could not be read to its end");
    }
    return content;
}

}  // namespace scaleaxis::io
