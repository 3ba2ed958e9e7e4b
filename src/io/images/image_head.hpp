// SPDX-License-Identifier: Apache-2.0
/// \file
/// Heads of images that are text: fields with names and values, one a line. Errors name the line.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "io/images/stored_image.hpp"
#include "scaleaxis/geometry.hpp"

namespace scaleaxis::io {

struct HeadField {
    std::string name;
    std::string_view value;
    std::size_t line = 0;

    [[noreturn]] void fail(const std::string& what) const;
    /// \throws FileError unless there are `count`
    std::vector<std::string_view> words(std::size_t count) const;
    /// Integers from 1 up, as many as that.
    std::vector<std::int64_t> sizes(std::size_t count) const;
    std::int64_t integer(std::int64_t least, std::int64_t most = std::numeric_limits<Index>::max()) const;
    /// Words as numbers of a place. \param may_be_absent NaN for `nan` and `none`
    std::vector<double> numbers(const std::vector<std::string_view>& words, bool may_be_absent = false) const;
    /// The type that a table says for its value in lower case, as `short i2 ushort u2`; see `number_type`.
    NumberType type(std::string_view table) const { return type(table, value); }
    NumberType type(std::string_view table, std::string_view name) const;
};

class ImageHead {
   public:
    /// \throws FileError if there is one of that name
    void add(const HeadField& field);
    /// Null if there is none.
    const HeadField* find(std::string_view name) const;
    /// \throws FileError if there is none
    const HeadField& at(std::string_view name) const;
    /// The value in lower case; empty if there is none.
    std::string text(std::string_view name) const;
    std::int64_t integer(std::string_view name, std::int64_t least, std::int64_t otherwise) const;

   private:
    std::vector<HeadField> fields_;
};

/// The files that a head names: one; `LIST`, then one a line in `list`; or a pattern with the numbers that it is
/// filled with, as `slice%03d.raw 1 20 1`. \param head its file; empty: it is in memory, and none can be found
std::vector<StoredData> data_files(std::string_view name, std::string_view list, const std::filesystem::path& head);

}  // namespace scaleaxis::io
