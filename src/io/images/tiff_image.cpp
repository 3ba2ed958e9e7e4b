// SPDX-License-Identifier: Apache-2.0
//
// TIFF with several pages, by libtiff, and how far voxels are apart as ImageJ, the Open Microscopy Environment
// (OME-XML) and tifffile (JSON) write it.
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/faults.hpp"
#include "base/formats/json.hpp"
#include "base/formats/xml.hpp"
#include "io/formats.hpp"
#include "io/images/stored_image.hpp"
#include "io/text_reader.hpp"

namespace scaleaxis::io {
namespace {

/// A file in memory, as libtiff reads it.
struct TiffBytes {
    std::string_view content;
    std::uint64_t at = 0;
    bool has_failed = false;                    ///< libtiff has said that something is wrong
    std::uint16_t unit_unknown_to_libtiff = 0;  ///< of the resolution; 0: none
};

TiffBytes& bytes_of(thandle_t handle) { return *static_cast<TiffBytes*>(handle); }

tmsize_t read_tiff_bytes(thandle_t handle, void* to, tmsize_t size) {
    TiffBytes& bytes = bytes_of(handle);
    const std::size_t begin = std::min<std::uint64_t>(bytes.at, bytes.content.size());
    const std::size_t count = bytes.content.substr(begin).copy(static_cast<char*>(to), static_cast<std::size_t>(size));
    bytes.at += count;
    return static_cast<tmsize_t>(count);
}

tmsize_t write_no_tiff_bytes(thandle_t, void*, tmsize_t) { return 0; }

toff_t seek_tiff_bytes(thandle_t handle, toff_t offset, int whence) {
    TiffBytes& bytes = bytes_of(handle);
    bytes.at = offset + (whence == SEEK_CUR ? bytes.at : whence == SEEK_END ? bytes.content.size() : 0);
    return bytes.at;
}

int close_tiff_bytes(thandle_t) { return 0; }
toff_t size_of_tiff_bytes(thandle_t handle) { return bytes_of(handle).content.size(); }

// Units of resolution of a later draft of TIFF, which tifffile writes. libtiff refuses their values.
constexpr std::uint16_t kMillimetre = 4;
constexpr std::uint16_t kMicrometre = 5;

/// One of these units, if this is what libtiff's words of an error are about; else 0.
std::uint16_t unit_in_error(std::string_view text) {
    for (const std::uint16_t unit : {kMillimetre, kMicrometre}) {
        if (text.ends_with("Bad value " + std::to_string(unit) + " for \"ResolutionUnit\" tag")) {
            return unit;
        }
    }
    return 0;
}

int note_tiff_error(TIFF*, void* to, const char*, const char* format, va_list arguments) {
    constexpr std::size_t kMost = 128;  // that of a unit has half as many
    std::array<char, kMost> text{};
    std::vsnprintf(text.data(), text.size(), format, arguments);
    auto& bytes = *static_cast<TiffBytes*>(to);
    if (const std::uint16_t unit = unit_in_error(text.data()); unit != 0) {
        bytes.unit_unknown_to_libtiff = unit;
    } else {
        bytes.has_failed = true;
    }
    return 1;  // and nobody else is told
}

int ignore_tiff_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

/// Largest ratio of an unpacked page to the file.
constexpr std::uint64_t kMostFromTiffByte = 10'000;
std::uint64_t most_bytes(std::string_view content) {
    constexpr std::uint64_t kLeast = 1 << 20;
    return std::max(kLeast, content.size() * kMostFromTiffByte);
}

using Tiff = std::unique_ptr<TIFF, void (*)(TIFF*)>;

Tiff open_tiff(TiffBytes& bytes) {
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                               &TIFFOpenOptionsFree);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), note_tiff_error, &bytes);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_tiff_warning, nullptr);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), static_cast<tmsize_t>(most_bytes(bytes.content)));
    // No map of the file: strips are copied, and their bounds checked.
    Tiff tiff(TIFFClientOpenExt("image", "rm", &bytes, read_tiff_bytes, write_no_tiff_bytes, seek_tiff_bytes,
                                close_tiff_bytes, size_of_tiff_bytes, nullptr, nullptr, options.get()),
              &TIFFClose);
    if (!tiff) {
        throw damaged("its first page is damaged, or the file is truncated");
    }
    return tiff;
}

/// The value of a field that has one number.
template <class Value>
Value tiff_field(TIFF* tiff, std::uint32_t tag, Value otherwise) {
    Value value = otherwise;
    return TIFFGetField(tiff, tag, &value) == 1 ? value : otherwise;
}

std::uint16_t resolution_unit(TIFF* tiff) {
    const std::uint16_t unit = bytes_of(TIFFClientdata(tiff)).unit_unknown_to_libtiff;
    return unit != 0 ? unit : tiff_field(tiff, TIFFTAG_RESOLUTIONUNIT, std::uint16_t{RESUNIT_NONE});
}

/// What all pages of a volume have in common.
struct TiffPage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint16_t bits = 1;
    std::uint16_t samples = 1;
    std::uint16_t format = SAMPLEFORMAT_UINT;

    bool operator==(const TiffPage&) const = default;
};

TiffPage tiff_page(TIFF* tiff) {
    return {tiff_field(tiff, TIFFTAG_IMAGEWIDTH, std::uint32_t{0}),
            tiff_field(tiff, TIFFTAG_IMAGELENGTH, std::uint32_t{0}),
            tiff_field(tiff, TIFFTAG_BITSPERSAMPLE, std::uint16_t{1}),
            tiff_field(tiff, TIFFTAG_SAMPLESPERPIXEL, std::uint16_t{1}),
            tiff_field(tiff, TIFFTAG_SAMPLEFORMAT, std::uint16_t{SAMPLEFORMAT_UINT})};
}

/// Masks of one bit are unpacked to bytes.
NumberType tiff_type(const TiffPage& page) {
    const std::string kind = page.format == SAMPLEFORMAT_INT ? "i" : page.format == SAMPLEFORMAT_IEEEFP ? "f" : "u";
    const bool is_kind = page.format <= SAMPLEFORMAT_IEEEFP || page.format == SAMPLEFORMAT_VOID;
    const bool is_mask = page.bits == 1 && kind == "u";
    const std::optional<NumberType> type = page.bits % 8 == 0 ? number_type(kind + std::to_string(page.bits / 8))
                                           : is_mask          ? number_type("u1")
                                                              : std::nullopt;
    if (!type || !is_kind) {
        throw unsupported("its values have " + std::to_string(page.bits) +
                          " bits in a form that cannot be read: save it with 8, 16 or 32 bits");
    }
    return *type;
}

/// The pages that are parts of the image, by their numbers from 0: neither previews nor masks.
std::vector<tdir_t> pages_of(TIFF* tiff, const TiffBytes& bytes, TiffPage& first) {
    std::vector<tdir_t> pages;
    tdir_t number = 0;
    do {
        const auto name = [&] { return "its page " + std::to_string(number + 1); };
        if (bytes.has_failed) {
            throw damaged(name() + " is damaged");
        }
        const auto kind = tiff_field(tiff, TIFFTAG_SUBFILETYPE, std::uint32_t{0});
        if ((kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)) == 0) {
            const TiffPage page = tiff_page(tiff);
            first = pages.empty() ? page : first;
            if (page.width != first.width || page.height != first.height) {
                throw damaged(name() + " has another size than those before it");
            }
            if (page != first) {
                throw damaged(name() + " has values of another kind than those before it");
            }
            if (tiff_field(tiff, TIFFTAG_IMAGEDEPTH, std::uint32_t{1}) > 1) {
                throw unsupported(name() + " holds several slices: save each as a page of its own");
            }
            if (const auto packing = tiff_field(tiff, TIFFTAG_COMPRESSION, std::uint16_t{COMPRESSION_NONE});
                TIFFIsCODECConfigured(packing) == 0) {
                throw unsupported(name() + " is packed in a way that cannot be read (" + std::to_string(packing) +
                                  "): save it packed by LZW or Deflate, or not at all");
            }
            pages.push_back(number);
        }
        ++number;
    } while (TIFFReadDirectory(tiff) == 1);
    if (bytes.has_failed || TIFFLastDirectory(tiff) == 0) {  // the chain of pages is torn, or leads back
        throw damaged("its page " + std::to_string(number + 1) + " is damaged, or the file ends before it does");
    }
    return pages;
}

/// A row of a strip or tile.
void read_row(const char* from, std::uint32_t count, const TiffPage& page, float* to) {
    if (page.bits != 1) {
        read_numbers(from, count, tiff_type(page), std::endian::native, to);
        return;
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        to[i] = static_cast<float>(static_cast<unsigned char>(from[i / 8]) >> (7 - i % 8) & 1);
    }
}

/// Reads the current page, of tiles or of strips, which are as wide as it. \returns false if it is damaged
bool read_page(TIFF* tiff, const TiffPage& page, std::uint64_t most_bytes, float* to) {
    const bool is_tiled = TIFFIsTiled(tiff) != 0;
    const std::uint32_t width = is_tiled ? tiff_field(tiff, TIFFTAG_TILEWIDTH, std::uint32_t{0}) : page.width;
    const std::uint32_t height = is_tiled ? tiff_field(tiff, TIFFTAG_TILELENGTH, std::uint32_t{0})
                                          : std::min(page.height, tiff_field(tiff, TIFFTAG_ROWSPERSTRIP, page.height));
    const std::uint64_t row_bytes = (std::uint64_t{width} * page.bits + 7) / 8;
    const std::uint64_t bytes = is_tiled ? TIFFTileSize64(tiff) : TIFFStripSize64(tiff);
    if (width == 0 || height == 0 || bytes > most_bytes || bytes != row_bytes * height) {
        return false;
    }
    std::vector<char> block(bytes);
    for (std::uint32_t y = 0, n = 0; y < page.height; y += height) {
        const std::uint32_t rows = std::min(height, page.height - y);
        for (std::uint32_t x = 0; x < page.width; x += width, ++n) {
            const auto size = static_cast<tmsize_t>(is_tiled ? bytes : row_bytes * rows);
            if (size != (is_tiled ? TIFFReadEncodedTile : TIFFReadEncodedStrip)(tiff, n, block.data(), size)) {
                return false;
            }
            for (std::uint32_t row = 0; row < rows; ++row) {
                read_row(block.data() + row * row_bytes, std::min(width, page.width - x), page,
                         to + std::size_t{y + row} * page.width + x);
            }
        }
    }
    return true;
}

/// Some pages begin with their last row.
void set_upright(TIFF* tiff, const TiffPage& page, float* values) {
    const auto orientation = tiff_field(tiff, TIFFTAG_ORIENTATION, std::uint16_t{ORIENTATION_TOPLEFT});
    if (orientation == ORIENTATION_BOTLEFT) {
        const std::size_t row = page.width;
        for (std::size_t y = 0; y < page.height / 2; ++y) {
            std::swap_ranges(values + y * row, values + (y + 1) * row, values + (page.height - 1 - y) * row);
        }
    } else if (orientation != ORIENTATION_TOPLEFT) {
        throw unsupported("its pages are turned (orientation " + std::to_string(orientation) + "): save it upright");
    }
}

/// How far voxels are apart, and of how many slices.
struct Calibration {
    std::array<double, 3> spacing{1, 1, 1};
    std::string unit;
    std::int64_t slices = 0;  ///< 0: a page is one
};

/// As other formats name it; "µm" is UTF-8, with either letter, Latin-1, or as Java escapes it.
std::string unit_named(std::string_view name) {
    constexpr auto kMicrometres = std::to_array<std::string_view>(
        {"micron", "microns", "micrometer", "um", "\xC2\xB5m", "\xCE\xBCm", "\xB5m", "\\u00B5m"});
    constexpr auto kNoUnits = std::to_array<std::string_view>({"pixel", "pixels", "voxel", "reference frame"});
    return std::ranges::find(kMicrometres, name) != kMicrometres.end() ? "um"
           : std::ranges::find(kNoUnits, name) != kNoUnits.end()       ? ""
                                                                       : std::string(name);
}

/// How many micrometres a unit has; none: it is not known.
std::optional<double> micrometres_of(std::string_view unit) {
    constexpr auto kUnits = std::to_array<std::pair<std::string_view, double>>(
        {{"nm", 1e-3}, {"um", 1.0}, {"mm", 1e3}, {"cm", 1e4}, {"m", 1e6}});
    const auto known = std::ranges::find(kUnits, unit, [](const auto& pair) { return pair.first; });
    return known == kUnits.end() ? std::nullopt : std::optional(known->second);
}

/// The unit of a resolution, as other formats name it; empty: none.
std::string_view name_of_unit(std::uint16_t unit) {
    return unit == RESUNIT_INCH         ? "inch"
           : unit == RESUNIT_CENTIMETER ? "cm"
           : unit == kMillimetre        ? "mm"
           : unit == kMicrometre        ? "um"
                                        : "";
}

/// A number of voxels a unit of length, as that length.
double length_of(double resolution) { return std::isfinite(resolution) && resolution > 0.0 ? 1.0 / resolution : 1.0; }

/// The resolution of pages, in millimetres if it is that of a length. Nothing says how far they are apart.
Calibration calibration_of_pages(TIFF* tiff) {
    const std::uint16_t unit = resolution_unit(tiff);
    constexpr double kInch = 25'400.0;  // micrometres
    const double length = micrometres_of(name_of_unit(unit)).value_or(kInch) / 1000.0;
    Calibration result;
    for (const int axis : {0, 1}) {
        const float resolution = tiff_field(tiff, axis == 0 ? TIFFTAG_XRESOLUTION : TIFFTAG_YRESOLUTION, 0.0F);
        if (unit != RESUNIT_NONE && resolution > 0.0F) {
            result.spacing[axis] = length * length_of(resolution);
        }
    }
    return result;
}

/// The value of a line `key=value`; none if there is none.
std::optional<std::string_view> value_of_line(std::string_view text, std::string_view key) {
    while (!text.empty()) {
        const std::string_view line = take_line(text);
        if (line.starts_with(key) && line.substr(key.size()).starts_with('=')) {
            return line.substr(key.size() + 1);
        }
    }
    return std::nullopt;
}

[[noreturn]] void fail_at_series(const std::string& what) {
    throw unsupported("it has several " + what + ": save one of them by itself");
}

[[noreturn]] void fail_at_pages(std::int64_t promised, std::size_t found) {
    throw unsupported("it says that it has " + std::to_string(promised) + " slices, but has " + std::to_string(found) +
                      " pages: the others may be in files of their own; save all as one stack");
}

/// ImageJ's, in lines after its name.
Calibration calibration_of_imagej(TIFF* tiff, std::string_view text, std::size_t pages) {
    const auto count = [&](std::string_view key) {
        return parse_integer(value_of_line(text, key).value_or("1")).value_or(1);
    };
    if (count("channels") > 1 || count("frames") > 1) {
        fail_at_series(count("channels") > 1 ? "channels" : "frames");
    }
    const std::string_view unit = name_of_unit(resolution_unit(tiff));
    const double depth = parse_number(value_of_line(text, "spacing").value_or("1")).value_or(1.0);
    return {{length_of(tiff_field(tiff, TIFFTAG_XRESOLUTION, 0.0F)),
             length_of(tiff_field(tiff, TIFFTAG_YRESOLUTION, 0.0F)), std::abs(depth)},
            unit_named(value_of_line(text, "unit").value_or(unit)),
            std::max(count("images"), static_cast<std::int64_t>(pages))};
}

/// The first element of that name, whatever the prefix of its namespace is.
pugi::xml_node element_named(const pugi::xml_node& root, std::string_view name) {
    return root.find_node([&](const pugi::xml_node& node) { return local_name(node.name()) == name; });
}

/// Of OME-XML. Lengths in several units become micrometres.
std::optional<Calibration> calibration_of_ome(std::string_view text, std::size_t pages) {
    pugi::xml_document document;
    document.load_buffer(text.data(), text.size(), pugi::parse_minimal);
    const pugi::xml_node image = element_named(document, "Pixels");
    if (!image) {
        return std::nullopt;
    }
    for (const char* name : {"SizeC", "SizeT"}) {
        if (image.attribute(name).as_int(1) > 1) {
            fail_at_series(name[4] == 'C' ? "channels" : "times");
        }
    }
    if (const int slices = image.attribute("SizeZ").as_int(1); slices > static_cast<int>(pages)) {
        fail_at_pages(slices, pages);
    }
    Calibration result;
    std::array<std::string, 3> units;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string name = std::string("PhysicalSize") + "XYZ"[axis];
        double size = parse_number(image.attribute(name.c_str()).as_string()).value_or(0.0);
        size = is_spacing(size) ? size : 0.0;
        units[axis] = size > 0.0 ? unit_named(image.attribute((name + "Unit").c_str()).as_string("um")) : "";
        result.spacing[axis] = size > 0.0 ? size : 1.0;
    }
    if (units[0] == units[1] && units[0] == units[2]) {
        result.unit = units[0];
        return result;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::optional<double> unit = micrometres_of(units[axis]);
        if (!unit) {
            return result;  // lengths that cannot be compared have no unit
        }
        result.spacing[axis] *= *unit;
    }
    result.unit = "um";
    return result;
}

/// Of tifffile's JSON: the shape of an array, whose last two axes are those of a page, names of its axes, and what the
/// caller has added, which are mostly ImageJ's `spacing` and `unit`.
std::optional<Calibration> calibration_of_array(TIFF* tiff, std::string_view text, std::size_t pages) {
    const Json json = Json::parse(text);
    const Json* const shape = json.find("shape");
    if (shape == nullptr || !shape->is_array() || shape->size() < 2 ||
        !std::ranges::all_of(shape->elements(), &Json::is_number)) {
        return std::nullopt;
    }
    const auto text_of = [&](std::string_view name) {
        const Json* const member = json.find(name);
        return member != nullptr && member->is_string() ? member->get<std::string>() : std::string();
    };
    Calibration result = calibration_of_pages(tiff);
    result.slices = 1;
    for (std::size_t axis = 0; axis + 2 < shape->size(); ++axis) {
        const auto size = shape->elements()[axis].get<std::int64_t>();
        if (size <= 1) {
            continue;
        }
        const std::string axes = text_of("axes");
        const char name = axis < axes.size() ? axes[axis] : 'Z';
        if (name == 'C' || name == 'S' || name == 'T' || result.slices > 1) {
            fail_at_series(name == 'T' ? "times" : result.slices > 1 ? "volumes" : "channels");
        }
        result.slices = size;
    }
    if (result.slices == 1) {
        result.slices = static_cast<std::int64_t>(pages);  // each page has been written as an image
    } else if (result.slices < static_cast<std::int64_t>(pages)) {
        fail_at_series("volumes");
    }
    if (const Json* const spacing = json.find("spacing"); spacing != nullptr && spacing->is_number()) {
        const auto depth = std::abs(spacing->get<double>());
        result.spacing[2] = is_spacing(depth) ? depth : 1.0;
    }
    result.unit = unit_named(text_of("unit"));
    if (!result.unit.empty()) {
        // In that unit as in ImageJ; inches are what tifffile writes where nothing is said.
        const std::optional<double> metric = micrometres_of(name_of_unit(resolution_unit(tiff)));
        const double length = metric ? *metric / micrometres_of(result.unit).value_or(*metric) : 1.0;
        result.spacing[0] = length * length_of(tiff_field(tiff, TIFFTAG_XRESOLUTION, 0.0F));
        result.spacing[1] = length * length_of(tiff_field(tiff, TIFFTAG_YRESOLUTION, 0.0F));
    }
    return result;
}

Calibration calibration_of(TIFF* tiff, std::size_t pages) {
    const char* const description = tiff_field<const char*>(tiff, TIFFTAG_IMAGEDESCRIPTION, "");
    const std::string_view text = description;
    if (text.starts_with("ImageJ=")) {
        return calibration_of_imagej(tiff, text, pages);
    }
    const std::optional<Calibration> found = text.starts_with('<')   ? calibration_of_ome(text, pages)
                                             : text.starts_with('{') ? calibration_of_array(tiff, text, pages)
                                                                     : std::nullopt;
    return found ? *found : calibration_of_pages(tiff);
}

/// The values of slices that have one page together, as ImageJ writes large stacks and tifffile truncated ones: one
/// after the other behind the place that the page names. Nothing if they are not there.
std::optional<StoredData> slices_of_page(TIFF* tiff, std::string_view content, std::uint64_t bytes) {
    const std::uint64_t begin = TIFFGetStrileOffset(tiff, 0);
    const bool is_plain = TIFFIsTiled(tiff) == 0 &&
                          tiff_field(tiff, TIFFTAG_COMPRESSION, std::uint16_t{COMPRESSION_NONE}) == COMPRESSION_NONE;
    if (!is_plain || begin > content.size() || content.size() - begin < bytes) {
        return std::nullopt;
    }
    return StoredData{content.substr(begin)};
}

}  // namespace

bool is_tiff(std::string_view content) {
    using namespace std::string_view_literals;
    return content.starts_with("II*\0"sv) || content.starts_with("MM\0*"sv) || content.starts_with("II+\0"sv) ||
           content.starts_with("MM\0+"sv);
}

Image read_tiff_image(std::string_view content, const std::filesystem::path&) {
    TiffBytes bytes{content};
    const Tiff tiff = open_tiff(bytes);
    TiffPage page;
    const std::vector<tdir_t> pages = pages_of(tiff.get(), bytes, page);
    TIFFSetDirectory(tiff.get(), 0);
    StoredImage head;
    head.channels = page.samples;
    auto [spacing, unit, slices] = calibration_of(tiff.get(), pages.size());
    slices = slices == 0 ? static_cast<std::int64_t>(pages.size()) : slices;
    head.sizes = {page.width, page.height, slices};
    if (slices < 2) {
        head.sizes.pop_back();  // and is refused
    }
    head.frame.steps = {Point{spacing[0], 0, 0}, Point{0, spacing[1], 0}, Point{0, 0, spacing[2]}};
    head.frame.unit = unit;
    Image image = frame_of(head);
    const std::size_t slice = std::size_t{page.width} * page.height;
    if (slices > static_cast<std::int64_t>(pages.size())) {
        const std::uint64_t all = slice * static_cast<std::uint64_t>(slices) * bytes_per_number(tiff_type(page));
        const std::optional<StoredData> data =
            pages.size() == 1 && page.bits != 1 ? slices_of_page(tiff.get(), content, all) : std::nullopt;
        if (!data) {
            fail_at_pages(slices, pages.size());
        }
        head.type = tiff_type(page);
        head.order = TIFFIsBigEndian(tiff.get()) != 0 ? std::endian::big : std::endian::little;
        head.parts = {*data};
        return read_stored(head);
    }
    const std::uint64_t promised = slice * pages.size() * bytes_per_number(tiff_type(page));
    check_packed_bytes(promised, content.size(), kMostFromTiffByte);
    image.values.resize(slice * pages.size());
    float* to = image.values.data();
    for (tdir_t number = 0; number <= pages.back(); ++number, TIFFReadDirectory(tiff.get())) {
        if (!std::ranges::binary_search(pages, number)) {
            continue;
        }
        if (!read_page(tiff.get(), page, most_bytes(content), to)) {
            throw damaged("its page " + std::to_string(number + 1) + " is damaged, or the file is truncated");
        }
        set_upright(tiff.get(), page, to);
        to += slice;
    }
    return image;
}

}  // namespace scaleaxis::io
