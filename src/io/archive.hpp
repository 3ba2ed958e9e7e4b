// SPDX-License-Identifier: Apache-2.0
/// \file
/// The parts of a ZIP archive, which formats of several files are.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace scaleaxis::io {

struct ArchivePart {
    std::string name;
    std::string_view packed;  ///< a piece of the archive
    std::uint64_t size = 0;   ///< unpacked
    std::uint32_t sum = 0;    ///< CRC-32 of what is unpacked
    bool is_stored = false;   ///< as it is, not deflated
};

/// The parts that the directory at the end of an archive lists. \see APPNOTE 6.3, of PKWARE
/// \throws FileError also for parts that cannot have the size that they claim, or have more than 2 GiB together
std::vector<ArchivePart> archive_parts(std::string_view archive);

/// \throws FileError if the data are not what the directory promises
std::string unpacked(const ArchivePart& part);

}  // namespace scaleaxis::io
