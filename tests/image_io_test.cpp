// SPDX-License-Identifier: Apache-2.0
// Readers of images: what is in a file, and what is wrong with it.
#include <bzlib.h>
#include <gtest/gtest.h>
#include <tiffio.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/bytes.hpp"
#include "folder.hpp"
#include "images.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"
#include "scaleaxis/load.hpp"

namespace scaleaxis {
namespace {

using namespace test;
namespace fs = std::filesystem;

class ImageIo : public test::FolderTest {
   protected:
    /// What reading a folder says.
    std::string error_of_folder() const {
        try {
            fs::create_directories(folder() / "series");
            read_image(folder() / "series");
        } catch (const FileError& error) {
            return error.what();
        }
        return "nothing was thrown";
    }
    /// What reading this content says.
    std::string error_of(const std::string& name, const std::string& content) const {
        try {
            read_image(write(name, content));
        } catch (const FileError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(name), std::string::npos) << "names the file";
            EXPECT_EQ(message.find('\n'), std::string::npos) << "is one line";
            return message;
        }
        return "nothing was thrown";
    }
};

void expect_in(const std::string& part, const std::string& message) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
}

std::string packed(const std::string& content, bool as_gzip) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, MAX_WBITS + (as_gzip ? 16 : 0), 9, Z_DEFAULT_STRATEGY);
    std::string result(deflateBound(&stream, content.size()), '\0');
    std::string copy = content;
    stream.next_in = reinterpret_cast<Bytef*>(copy.data());
    stream.avail_in = static_cast<uInt>(copy.size());
    stream.next_out = reinterpret_cast<Bytef*>(result.data());
    stream.avail_out = static_cast<uInt>(result.size());
    deflate(&stream, Z_FINISH);
    result.resize(stream.total_out);
    deflateEnd(&stream);
    return result;
}

std::string packed_by_bzip2(std::string content) {
    std::string result(content.size() + 1000, '\0');
    auto size = static_cast<unsigned>(result.size());
    BZ2_bzBuffToBuffCompress(result.data(), &size, content.data(), static_cast<unsigned>(content.size()), 9, 0, 0);
    result.resize(size);
    return result;
}

/// 2 x 3 x 4 bytes 1, 2, 3…
std::string bytes() {
    std::string result;
    for (int i = 0; i < 24; ++i) {
        result += static_cast<char>(i + 1);
    }
    return result;
}

/// The same as numbers with blanks between them.
std::string as_text(const std::string& bytes) {
    std::string result;
    for (const char c : bytes) {
        result += std::to_string(static_cast<unsigned char>(c)) + ' ';
    }
    return result;
}

void expect_bytes(const Image& image) {
    EXPECT_EQ(image.sizes, (std::array<Index, 3>{2, 3, 4}));
    ASSERT_EQ(image.values.size(), 24u);
    for (int i = 0; i < 24; ++i) {
        EXPECT_EQ(image.values[i], static_cast<float>(i + 1));
    }
}

std::string inr(const std::string& fields, const std::string& data) {
    std::string head = "#INRIMAGE-4#{\nXDIM=2\nYDIM=3\nZDIM=4\nVDIM=1\n" + fields;
    head.resize(252, '\n');
    return head + "##}\n" + data;
}

const std::string kInrBytes = "TYPE=unsigned fixed\nPIXSIZE=8 bits\nCPU=decm\nVX=0.5\nVY=2\nVZ=1.5\n";

TEST_F(ImageIo, Inr) {
    for (const std::string& content : {inr(kInrBytes, bytes()), packed(inr(kInrBytes, bytes()), true)}) {
        const fs::path file = write("image", content);
        EXPECT_EQ(file_kind(file), FileKind::kImage);
        const Image image = read_image(file);
        expect_bytes(image);
        EXPECT_EQ(image.steps[1], (Point{0, 2, 0}));
        EXPECT_EQ(image.steps[2], (Point{0, 0, 1.5}));
    }
    // Two bytes a value, the more significant one first.
    std::string shorts;
    for (const char c : bytes()) {
        shorts += {'\0', c};
    }
    expect_bytes(read_image(write("b.inr", inr("TYPE=signed fixed\nPIXSIZE=16 bits\nCPU=sun\n", shorts))));

    expect_in("24 bytes of data, but there are 23", error_of("a.inr", inr(kInrBytes, bytes().substr(1))));
    expect_in("24 bytes of data, but there are more", error_of("a.inr", inr(kInrBytes, bytes() + "x")));
    expect_in("no line 'TYPE'", error_of("a.inr", inr("", bytes())));
    expect_in("cannot be read", error_of("a.inr", inr("TYPE=packed\nPIXSIZE=12 bits\nCPU=pc\n", bytes())));
    const std::string gz = packed(inr(kInrBytes, bytes()), true);
    expect_in("24 bytes of data, but there are", error_of("a.inr.gz", gz.substr(0, gz.size() - 12)));
    expect_in("head does not end", error_of("a.inr", "#INRIMAGE-4#{\nXDIM=2\n"));
    std::string huge = inr(kInrBytes, bytes());
    huge.replace(huge.find("XDIM=2\n"), 7, "XDIM=9e");
    expect_in("line 2: '9eYDIM=3' cannot be the value of 'XDIM'", error_of("a.inr", huge));
    // The end of the head lies beyond the end of the file.
    std::string shifted = inr(kInrBytes, "0123456789");
    shifted.erase(252, 4);
    shifted += "##}\n";
    expect_in("there are 0", error_of("a.inr", shifted));
    expect_in("line 2", error_of("a.inr", "#INRIMAGE-4#{\nXDIM=3000000000\n" + std::string(222, '\n') + "##}\n"));
}

std::string vol(const std::string& version, const std::string& data) {
    return "Center-X: 1\nX: 2\nY: 3\nZ: 4\nVoxel-Size: 1\nVersion: " + version + "\n.\n" + data;
}

TEST_F(ImageIo, Vol) {
    for (const std::string& content : {vol("2", bytes()), vol("3", packed(bytes(), false))}) {
        EXPECT_EQ(file_kind(write("image", content)), FileKind::kImage);
        expect_bytes(read_image(write("image", content)));
    }
    expect_in("but there are 23", error_of("a.vol", vol("2", bytes().substr(1))));
    expect_in("24 bytes of data, but there are more", error_of("a.vol", vol("3", packed(bytes() + "xyz", false))));
    expect_in("24 bytes of data, but there are", error_of("a.vol", vol("3", packed(bytes(), false).substr(0, 12))));
    expect_in("damaged", error_of("a.vol", vol("3", bytes())));
    expect_in("has no line 'Z'", error_of("a.vol", "X: 2\nY: 3\n.\n"));
    expect_in("line 3: '-4'", error_of("a.vol", "X: 2\nY: 3\nZ: -4\n.\n"));
    expect_in("a size that no image has", error_of("a.vol", "X: 2000000\nY: 3000000\nZ: 4\n.\n"));
}

TEST_F(ImageIo, Pgm3d) {
    std::string text = "P2-3D\n# a comment\n2 3 4\n24\n";
    for (int i = 1; i <= 24; ++i) {
        text += std::to_string(i) + (i % 2 == 0 ? "\n" : " ");
    }
    expect_bytes(read_image(write("image", text)));
    expect_in("line", error_of("a.pgm3d", text.substr(0, text.size() - 3)));
    expect_in("more values than 24", error_of("a.pgm3d", text + "25\n"));
    expect_in("line 17", error_of("a.pgm3d", text + "?\n"));
    expect_in("too short", error_of("a.pgm3d", "P2-3D\n200 300 400\n255\n1 2 3\n"));
}

/// In base64, by itself.
std::string base64(const std::string& bytes) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned word = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k < bytes.size() + 1 ? digits[word >> (18 - 6 * k) & 63] : '=';
        }
    }
    return text;
}

template <class T>
std::string bytes_of(const std::vector<T>& numbers, std::endian order) {
    std::string result;
    for (const T number : numbers) {
        const auto part = to_bytes(number, order);
        result.append(part.begin(), part.end());
    }
    return result;
}

/// One of the ways in which VTK stores 1, 2, 3… in XML.
struct VtiWay {
    std::endian order = std::endian::little;
    bool has_long_words = false;
    bool is_packed = false;
    std::string format = {};    ///< of the array: ascii, binary or appended
    std::string encoding = {};  ///< of what is appended: raw or base64
};

std::string words(const std::vector<std::uint64_t>& numbers, const VtiWay& way) {
    return way.has_long_words ? bytes_of(numbers, way.order)
                              : bytes_of(std::vector<std::uint32_t>(numbers.begin(), numbers.end()), way.order);
}

/// The values of the array `s`; 2 x 3 x 4 of them fill the grid.
template <class T>
std::string vti(const VtiWay& way, const std::string& type, const std::vector<T>& values) {
    const bool is_base64 = way.format == "binary" || way.encoding == "base64";
    const auto encoded = [&](const std::string& bytes) { return is_base64 ? base64(bytes) : bytes; };
    std::string data;
    if (way.format == "ascii") {
        for (const T value : values) {
            data += std::to_string(value) + (data.size() % 7 == 0 ? "\n" : " ");
        }
    } else if (!way.is_packed) {
        const std::string bytes = bytes_of(values, way.order);
        data = encoded(words({bytes.size()}, way) + bytes);
    } else {
        // Blocks that do not end where values do.
        const std::string bytes = bytes_of(values, way.order);
        constexpr std::size_t kBlock = 7;
        const std::size_t count = (bytes.size() + kBlock - 1) / kBlock;
        std::vector<std::uint64_t> head{count, kBlock, bytes.size() % kBlock};
        std::string blocks;
        for (std::size_t i = 0; i < count; ++i) {
            const std::string block = packed(bytes.substr(i * kBlock, kBlock), false);
            head.push_back(block.size());
            blocks += block;
        }
        data = encoded(words(head, way)) + encoded(blocks);  // as VTK does: each with an end of its own
    }
    const bool is_appended = way.format == "appended";
    const std::string before = "....";  // another array could be there
    return "<?xml version=\"1.0\"?>\n<!-- a comment -->\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"" +
           std::string(way.order == std::endian::little ? "LittleEndian" : "BigEndian") + "\" header_type=\"" +
           (way.has_long_words ? "UInt64" : "UInt32") + "\"" +
           (way.is_packed ? " compressor=\"vtkZLibDataCompressor\"" : "") +
           ">\n<ImageData WholeExtent=\"1 2 0 2 0 3\" Origin=\"1 2 3\" Spacing=\"2 3 4\" "
           "Direction=\"0 -1 0 1 0 0 0 0 1\">\n<Piece Extent=\"1 2 0 2 0 3\">\n<PointData Scalars=\"s\">\n"
           "<DataArray type=\"UInt8\" Name=\"other\" format=\"ascii\">9</DataArray>\n<DataArray type=\"" +
           type + "\" Name=\"s\" NumberOfComponents=\"1\" format=\"" + way.format + "\"" +
           (is_appended ? " offset=\"4\"/>" : ">\n" + data + "\n</DataArray>") +
           "\n</PointData>\n<CellData>\n</CellData>\n</Piece>\n</ImageData>\n" +
           (is_appended
                ? "<AppendedData encoding=\"" + way.encoding + "\">\n   _" + before + data + "\n</AppendedData>\n"
                : "") +
           "</VTKFile>\n";
}

template <class T>
std::vector<T> counted() {
    std::vector<T> values;
    for (int i = 1; i <= 24; ++i) {
        values.push_back(static_cast<T>(i));
    }
    return values;
}

void expect_vti(const Image& image) {
    expect_bytes(image);
    // Turned by a right angle about z: the first axis is y. The grid begins at 1 along it.
    EXPECT_EQ(image.steps, (std::array{Point{0, 2, 0}, Point{-3, 0, 0}, Point{0, 0, 4}}));
    EXPECT_EQ(image.origin, (Point{1, 4, 3}));
}

TEST_F(ImageIo, VtiInAllItsWays) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        for (const bool has_long_words : {false, true}) {
            for (const bool is_packed : {false, true}) {
                for (const auto& [format, encoding] : std::vector<std::pair<std::string, std::string>>{
                         {"ascii", ""}, {"binary", ""}, {"appended", "raw"}, {"appended", "base64"}}) {
                    const VtiWay way{order, has_long_words, is_packed, format, encoding};
                    SCOPED_TRACE(format + ' ' + encoding + (is_packed ? " packed" : "") +
                                 (has_long_words ? " UInt64" : " UInt32") +
                                 (order == std::endian::big ? " big" : " little"));
                    const fs::path file = write("image", vti(way, "Int16", counted<std::int16_t>()));
                    EXPECT_EQ(file_kind(file), FileKind::kImage);
                    expect_vti(read_image(file));
                    expect_vti(read_image(write("image", vti(way, "Float64", counted<double>()))));
                    // Whatever is torn off within the values is missed.
                    std::string torn = vti(way, "Int16", counted<std::int16_t>());
                    torn.resize(format == "appended" ? torn.find("\n</AppendedData>") - 3
                                                     : torn.find("</DataArray>\n</P") - 5);
                    EXPECT_NE(error_of("torn.vti", torn), "nothing was thrown");
                }
            }
        }
    }
    const VtiWay binary{.format = "binary"};
    expect_vti(read_image(write("a", vti(binary, "UInt8", counted<std::uint8_t>()))));
    expect_vti(read_image(write("a", vti(binary, "Int64", counted<std::int64_t>()))));
    expect_vti(read_image(write("a", vti(binary, "Float32", counted<float>()))));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

// Written by VTK 9: 3 x 4 x 5 points with values from 0, and cells with values of their own.
TEST_F(ImageIo, VtiOfVtk) {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(SCALEAXIS_SOURCE_DIR "/tests/fuzz/corpus/image")) {
        if (!entry.path().filename().string().starts_with("vtk-")) {
            continue;
        }
        SCOPED_TRACE(entry.path().filename().string());
        const Image image = read_image(entry.path());
        EXPECT_EQ(image.sizes, (std::array<Index, 3>{3, 4, 5}));
        ASSERT_EQ(image.values.size(), 60u);
        for (std::size_t i = 0; i < 60; ++i) {
            EXPECT_EQ(image.values[i], static_cast<float>(i));
        }
        EXPECT_EQ(image.origin, (Point{1, 2, 3}));
        EXPECT_EQ(image.steps, (std::array{Point{0, 2, 0}, Point{-3, 0, 0}, Point{0, 0, 4}}));
        ++count;
    }
    EXPECT_EQ(count, 7);
}

TEST_F(ImageIo, VtiOfCells) {
    const std::string points = vti(VtiWay{.format = "ascii"}, "UInt8", counted<std::uint8_t>());
    // 2 x 3 x 4 cells between 3 x 4 x 5 points; their values are in the middle.
    std::string cells = replaced(replaced(points, "1 2 0 2 0 3", "1 3 0 3 0 4"), "1 2 0 2 0 3", "1 3 0 3 0 4");
    cells = replaced(replaced(cells, "<PointData Scalars=\"s\">", "<PointData/><CellData Scalars=\"s\">"),
                     "</PointData>\n<CellData>\n</CellData>", "</CellData>");
    const Image image = read_image(write("a.vti", cells));
    expect_bytes(image);
    EXPECT_EQ(image.origin, (Point{1 - 1.5, 4 + 1, 3 + 2}));
}

TEST_F(ImageIo, FaultsOfVti) {
    const std::string good = vti(VtiWay{.format = "ascii"}, "UInt8", counted<std::uint8_t>());
    const auto error = [&](const std::string& from, const std::string& to) {
        return error_of("a.vti", replaced(good, from, to));
    };
    expect_in("none of its arrays 'other', 's' is named as its Scalars", error("Scalars=\"s\"", ""));
    expect_in("values a voxel", error("NumberOfComponents=\"1\"", "NumberOfComponents=\"3\""));
    expect_in("its piece is a part of the image", error("<Piece Extent=\"1 2", "<Piece Extent=\"1 1"));
    expect_in("Spacing '2 0 4'", error("Spacing=\"2 3 4\"", "Spacing=\"2 0 4\""));
    expect_in("Direction", error("Direction=\"0 -1 0", "Direction=\"0 nan 0"));
    expect_in("type 'Bit'", error("type=\"UInt8\" Name=\"s\"", "type=\"Bit\" Name=\"s\""));
    expect_in("line 8: this is no XML",
              error("<DataArray type=\"UInt8\" Name=\"s\"", "<DataArray type=\"UInt8\" Name=s"));
    expect_in("24 values, but there are 25", error("24", "24 25"));
    expect_in("24 values, but there are 23", error("24", ""));
    expect_in("'2x4', which is no number", error("24", "2x4"));
    const VtiWay packed_way{.is_packed = true, .format = "binary"};
    const std::string packed_vti = vti(packed_way, "UInt8", counted<std::uint8_t>());
    expect_in("packed by 'vtkLZ4DataCompressor'", error_of("a.vti", replaced(packed_vti, "vtkZLib", "vtkLZ4")));
    expect_in("but there are 24",
              error_of("a.vti", replaced(vti(VtiWay{.format = "binary"}, "UInt8", counted<std::uint8_t>()),
                                         "\"UInt8\" Name=\"s\"", "\"UInt16\" Name=\"s\"")));
    expect_in("begin at '4000'", error_of("a.vti", replaced(vti(VtiWay{.format = "appended", .encoding = "raw"},
                                                                "UInt8", counted<std::uint8_t>()),
                                                            "offset=\"4\"", "offset=\"4000\"")));
    // Nothing is reserved for what the head promises.
    std::string huge =
        replaced(replaced(good, "1 2 0 2 0 3", "0 1500 0 1500 0 1500"), "1 2 0 2 0 3", "0 1500 0 1500 0 1500");
    expect_in("its head says", error_of("a.vti", huge));
    // What is nested deeply, and is no part of an image.
    std::string deep;
    std::string closing;
    for (int i = 0; i < 1000000; ++i) {
        deep += "<a>";
        closing += "</a>";
    }
    expect_in("this is no XML", error("<Piece", deep + "<Piece"));
    EXPECT_EQ(error("<Piece", deep + closing + "<Piece"), "nothing was thrown");
}

std::string nifti2(std::endian order, const std::string& magic, std::int64_t offset) {
    std::string head(544, '\0');
    const auto put = [&](std::size_t at, auto value) {
        std::ranges::copy(to_bytes(value, order), head.begin() + static_cast<std::ptrdiff_t>(at));
    };
    put(0, std::int32_t{540});
    head.replace(4, 8, magic + std::string("\0\r\n\x1a\n", 5));
    put(12, std::int16_t{512});  // unsigned short
    put(14, std::int16_t{16});
    const std::array<std::int64_t, 8> sizes{3, 2, 3, 4, 1, 1, 1, 1};
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        put(16 + 8 * i, sizes[i]);
        put(104 + 8 * i, i >= 1 && i <= 3 ? static_cast<double>(i + 1) : 1.0);
    }
    put(168, offset);
    put(176, 0.5);  // values are twice as large in the file
    put(348, std::int32_t{1});
    const std::array<double, 12> places{2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30};
    for (std::size_t i = 0; i < places.size(); ++i) {
        put(400 + 8 * i, places[i]);
    }
    return head;
}

void expect_nifti2(const Image& image) {
    expect_bytes(image);
    EXPECT_EQ(image.origin, (Point{10, 20, 30}));
    EXPECT_EQ(image.steps, (std::array{Point{2, 0, 0}, Point{0, 3, 0}, Point{0, 0, 4}}));
}

TEST_F(ImageIo, Nifti2) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        std::vector<std::uint16_t> values;
        for (int i = 1; i <= 24; ++i) {
            values.push_back(static_cast<std::uint16_t>(2 * i));
        }
        const std::string data = bytes_of(values, order);
        const std::string file = nifti2(order, "n+2", 544) + data;
        EXPECT_EQ(file_kind(write("a", file)), FileKind::kImage);
        expect_nifti2(read_image(write("a.nii", file)));
        expect_nifti2(read_image(write("a.nii.gz", packed(file, true))));
        expect_nifti2(read_image(FileBytes{std::as_bytes(std::span(file)), "a.nii"}));
        expect_in("there are 47", error_of("a.nii", file.substr(0, file.size() - 1)));
        expect_in("head does not end", error_of("a.nii", file.substr(0, 530)));

        // The head and the values in files of their own.
        const std::string head = nifti2(order, "ni2", 8);
        write("pair.img", "--------" + data);
        expect_nifti2(read_image(write("pair.hdr", head)));
        expect_in("alone.img", error_of("alone.hdr", head));
        expect_in("in a file of their own", [&] {
            try {
                read_image(FileBytes{std::as_bytes(std::span(head)), "pair.hdr"});
            } catch (const FileError& error) {
                return std::string(error.what());
            }
            return std::string("nothing was thrown");
        }());

        std::string large = file;
        std::ranges::copy(to_bytes(std::int64_t{1} << 40, order), large.begin() + 24);
        expect_in("a size that no image has", error_of("a.nii", large));
        std::string elsewhere = file;
        std::ranges::copy(to_bytes(std::int64_t{1} << 40, order), elsewhere.begin() + 168);
        expect_in("a place where they cannot be", error_of("a.nii", elsewhere));
    }
}

TEST_F(ImageIo, NrrdIsReadAsItWasWritten) {
    const Image image = sampled([](const Point& p) { return p.x + 10 * p.y - p.z; }, {5, 6, 7}, {1, 2, 3},
                                {Point{0.5, 0, 0}, Point{0, 0.25, 0.1}, Point{0, -0.3, 2}});
    const fs::path file = folder() / "image.nrrd";
    write_image(file, image);
    EXPECT_EQ(file_kind(file), FileKind::kImage);
    const Image read = read_image(file);
    EXPECT_EQ(read.sizes, image.sizes);
    EXPECT_EQ(read.values, image.values);
    EXPECT_LT(distance(read.origin, image.origin), 1e-12);
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_LT(distance(read.steps[axis], image.steps[axis]), 1e-6);
    }
    const std::string content = [&] {
        std::ifstream stream(file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(stream), {});
    }();
    EXPECT_NE(error_of("short.nrrd", content.substr(0, content.size() - 1)), "nothing was thrown");
    std::string nan = content;
    const float bad = NAN;
    std::memcpy(nan.data() + nan.size() - 4, &bad, 4);
    expect_in("voxel (4, 5, 6) is not a number", error_of("nan.nrrd", nan));
    expect_in("short.nrrd", error_of("short.nrrd", content.substr(0, 40)));
}

TEST_F(ImageIo, NiftiIsReadAsItWasWritten) {
    Image image = sampled([](const Point& p) { return p.x + 10 * p.y - p.z; }, {5, 6, 7}, {1, 2, 3},
                          {Point{0.4, 0.3, 0}, Point{-0.6, 0.8, 0}, Point{0, 0, 2}});
    for (const auto& [space, unit] : {std::array{"right-anterior-superior", "mm"},
                                      {"left-posterior-superior", "mm"},
                                      {"left-anterior-superior", "mm"},
                                      {"left-posterior-superior-time", "mm"},
                                      {"right-anterior-superior", "m"},
                                      {"right-anterior-superior", "um"},
                                      {"right-anterior-superior", ""}}) {
        SCOPED_TRACE(std::string(space) + ' ' + unit);
        image.space = space;
        image.unit = unit;
        write_image(folder() / "image.nii", image);
        const Image read = read_image(folder() / "image.nii");
        EXPECT_EQ(read.sizes, image.sizes);
        EXPECT_EQ(read.values, image.values);
        EXPECT_EQ(read.unit, unit);
        const double x = image.space.starts_with("left") ? -1.0 : 1.0;
        const double y = image.space.starts_with("left-posterior") ? -1.0 : 1.0;
        const auto turned = [&](const Point& p) { return Point{x * p.x, y * p.y, p.z}; };
        EXPECT_LT(distance(read.origin, turned(image.origin)), 1e-5);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LT(distance(read.steps[axis], turned(image.steps[axis])), 1e-5);
        }
    }
}

TEST_F(ImageIo, CoordinatesAreThoseOfTheFile) {
    const auto nrrd = [](const std::string& space) {
        return "NRRD0004\ntype: uchar\ndimension: 3\nspace: " + space +
               "\nsizes: 2 3 4\nspace directions: (2,0,0) (0,3,0) (0,0,4)\nkinds: domain domain domain\n"
               "encoding: raw\nspace origin: (10,20,30)\n\n" +
               bytes();
    };
    for (const std::string space :
         {"right-anterior-superior", "left-anterior-superior", "left-posterior-superior", "scanner-xyz"}) {
        const Image image = read_image(write("image.nrrd", nrrd(space)));
        expect_bytes(image);
        EXPECT_EQ(image.origin, (Point{10, 20, 30})) << space;
        EXPECT_EQ(image.steps[0], (Point{2, 0, 0})) << space;
        EXPECT_EQ(image.steps[1], (Point{0, 3, 0})) << space;
        EXPECT_EQ(image.steps[2], (Point{0, 0, 4})) << space;
    }
}

TEST_F(ImageIo, NrrdKeepsWhereCoordinatesPoint) {
    Image image = sampled([](const Point& p) { return p.x; }, {4, 5, 6}, {1, 2, 3},
                          {Point{1, 0, 0}, Point{0, 1, 0}, Point{0, 0, 1}});
    for (const std::string space :
         {"right-anterior-superior", "left-anterior-superior", "left-posterior-superior", "scanner-xyz", ""}) {
        image.space = space;
        write_image(folder() / "image.nrrd", image);
        const Image read = read_image(folder() / "image.nrrd");
        EXPECT_EQ(read.space, space);
        EXPECT_EQ(read.origin, image.origin);
        // Viewers refuse files that have both.
        const std::string written = content("image.nrrd");
        EXPECT_EQ(written.find("space dimension") == std::string::npos, !space.empty());
    }
}

std::string nifti(const std::string& data, const std::array<std::int16_t, 3>& sizes = {2, 3, 4});

TEST_F(ImageIo, UnitAndSpaceAreThoseOfTheFile) {
    const auto nrrd = [](const std::string& fields) {
        return "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n" + fields +
               "space directions: (2,0,0) (0,3,0) (0,0,4)\nspace origin: (10,20,30)\n\n" + bytes();
    };
    const Image image = read_image(write("a.nrrd", nrrd("space: RAS\nspace units: \"um\" \"um\" \"um\"\n")));
    expect_bytes(image);
    EXPECT_EQ(image.unit, "um");
    EXPECT_EQ(image.space, "right-anterior-superior");
    const Image mixed = read_image(write("b.nrrd", nrrd("space: scanner-xyz\nspace units: \"mm\" \"mm\" \"s\"\n")));
    EXPECT_EQ(mixed.unit, "");
    EXPECT_EQ(mixed.space, "scanner-xyz");
    EXPECT_EQ(read_image(write("c.nrrd", nrrd("space dimension: 3\n"))).space, "");

    for (const auto& [code, unit] :
         std::vector<std::pair<char, std::string>>{{0, ""}, {2, "mm"}, {2 | 8, "mm"}, {1, "m"}, {3, "um"}, {4, ""}}) {
        std::string content = nifti(bytes());
        content[123] = code;
        for (const bool is_packed : {false, true}) {
            const Image read =
                read_image(is_packed ? write("u.nii.gz", packed(content, true)) : write("u.nii", content));
            expect_bytes(read);
            EXPECT_EQ(read.unit, unit) << int{code};
            EXPECT_EQ(read.space, "right-anterior-superior");
        }
    }
}

std::string meta(const std::string& fields, const std::string& data) {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nOffset = 1 2 3\n"
           "ElementSpacing = 0.5 1 2\nDimSize = 2 3 4\n" +
           fields + "ElementDataFile = LOCAL\n" + data;
}

TEST_F(ImageIo, MetaImage) {
    const Image image = read_image(write("image.mha", meta("ElementType = MET_UCHAR\n", bytes())));
    expect_bytes(image);
    EXPECT_EQ(image.origin, (Point{1, 2, 3}));
    EXPECT_EQ(image.steps[0], (Point{0.5, 0, 0}));
    const std::string turned = "ElementType = MET_UCHAR\nTransformMatrix = 0 1 0 -1 0 0 0 0 1\n";
    EXPECT_EQ(read_image(write("image.mha", meta(turned, bytes()))).steps[0], (Point{0, 0.5, 0}));
    EXPECT_EQ(image.unit, "");
    for (const auto& [said, unit] : std::vector<std::pair<std::string, std::string>>{
             {"um", "um"}, {"mm", "mm"}, {"cm", "cm"}, {"?", ""}, {"inch", ""}}) {
        const std::string field = "ElementType = MET_UCHAR\nDistanceUnits = " + said + '\n';
        EXPECT_EQ(read_image(write("image.mha", meta(field, bytes()))).unit, unit) << said;
    }
    // Left, posterior, superior, which NIfTI has not.
    EXPECT_EQ(image.space, "left-posterior-superior");
    write_image(path("written.nii"), image);
    const Image turned_around = read_image(path("written.nii"));
    EXPECT_EQ(turned_around.origin, (Point{-1, -2, 3}));
    EXPECT_EQ(turned_around.steps, (std::array{Point{-0.5, 0, 0}, Point{0, -1, 0}, Point{0, 0, 2}}));
    write_image(path("written.nrrd"), image);
    EXPECT_EQ(read_image(path("written.nrrd")).space, image.space);
    Image micrometres = image;
    micrometres.unit = "um";
    write_image(path("written.nrrd"), micrometres);
    EXPECT_EQ(read_image(path("written.nrrd")).unit, "um");

    expect_in("24 bytes of data, but there are 21",
              error_of("short.mha", meta("ElementType = MET_UCHAR\n", bytes().substr(3))));
    expect_in("2 values a voxel",
              error_of("two.mha", meta("ElementType = MET_UCHAR\nElementNumberOfChannels = 2\n", bytes() + bytes())));
    std::string detached = meta("ElementType = MET_UCHAR\n", "");
    detached.replace(detached.find("LOCAL"), 5, "absent.raw");
    expect_in("absent.raw", error_of("absent.mhd", detached));
}

TEST_F(ImageIo, NeedsThreeDimensions) {
    expect_in("2 dimensions; three are needed",
              error_of("flat.nrrd", "NRRD0004\ntype: uchar\ndimension: 2\nsizes: 4 6\nencoding: raw\n\n" + bytes()));
    expect_in(
        "4 dimensions",
        error_of("four.nrrd", "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 2 3 2 2\nencoding: raw\n\n" + bytes()));
}

/// A number as files have it, the least significant byte first.
template <class T>
std::string little(T value) {
    const auto data = to_bytes(value, std::endian::little);
    return {data.begin(), data.end()};
}

/// Unsigned bytes, with the identity as their place.
std::string nifti(const std::string& data, const std::array<std::int16_t, 3>& sizes) {
    std::string head(352, '\0');
    const auto put = [&](std::size_t at, const std::string& field) { head.replace(at, field.size(), field); };
    put(0, little(348));
    for (int d = 0; d < 8; ++d) {
        put(40 + 2 * d, little(d == 0 ? std::int16_t{3} : d < 4 ? sizes[d - 1] : std::int16_t{1}));
        put(76 + 4 * d, little(1.0F));
    }
    put(70, little(std::int16_t{2}));
    put(72, little(std::int16_t{8}));
    put(108, little(352.0F));
    put(254, little(std::int16_t{1}));
    for (int row = 0; row < 3; ++row) {
        put(280 + 20 * row, little(1.0F));
    }
    put(344, "n+1");
    return head + data;
}

std::string vtk(const std::string& encoding, const std::string& sizes = "2 3 4") {
    return "# vtk DataFile Version 3.0\nan image\n" + encoding + "\nDATASET STRUCTURED_POINTS\nDIMENSIONS " + sizes +
           "\nSPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 24\nSCALARS values unsigned_char 1\nLOOKUP_TABLE default\n";
}

/// A page for each six bytes, of `width` x 3, with 50 and 20 points a unit. \param unit 1: none, 2: inch, 3: centimetre
std::string tiff(const std::string& data, std::uint32_t width = 2, const std::string& description = {},
                 std::uint32_t unit = 3) {
    constexpr std::uint32_t kPage = 6;
    std::string file = std::string("II*\0", 4) + little(std::uint32_t{0});
    std::size_t link = 4;  // where the place of the next page belongs
    for (std::size_t at = 0; at < data.size(); at += kPage) {
        const auto strip = static_cast<std::uint32_t>(file.size());
        file += data.substr(at, kPage);
        const auto resolutions = static_cast<std::uint32_t>(file.size());
        for (const std::uint32_t number : {50, 1, 20, 1}) {
            file += little(number);
        }
        const auto text = static_cast<std::uint32_t>(file.size());
        file += description + std::string(5, '\0');
        file.replace(link, 4, little(static_cast<std::uint32_t>(file.size())));
        struct Field {
            std::uint16_t tag, type;
            std::uint32_t value, count = 1;
        };
        std::vector<Field> fields{
            {256, 4, width},           {257, 4, 3},   {258, 3, 8}, {259, 3, 1},     {262, 3, 1},
            {273, 4, strip},           {277, 3, 1},   {278, 4, 3}, {279, 4, kPage}, {282, 5, resolutions},
            {283, 5, resolutions + 8}, {296, 3, unit}};
        if (!description.empty()) {
            fields.insert(fields.begin() + 5, {270, 2, text, static_cast<std::uint32_t>(description.size() + 5)});
        }
        file += little(static_cast<std::uint16_t>(fields.size()));
        for (const auto& [tag, type, value, count] : fields) {
            file += little(tag) + little(type) + little(count) + little(value);
        }
        link = file.size();
        file += little(std::uint32_t{0});
    }
    return file;
}

/// An array of NumPy.
std::string npy(const std::string& type, bool is_fortran, const std::string& shape, const std::string& data) {
    std::string head = "{'descr': '" + type + "', 'fortran_order': " + (is_fortran ? "True" : "False") +
                       ", 'shape': (" + shape + "), }";
    head.resize(118 - 1, ' ');
    head += '\n';
    return "\x93NUMPY" + std::string("\1\0", 2) + little(static_cast<std::uint16_t>(head.size())) + head + data;
}

/// As a slice of DICOM begins.
const std::string kSlice = std::string(128, '\0') + "DICM";

// What ends too early, for each format and way of packing.
TEST_F(ImageIo, NothingIsMadeUpOfDataThatAreMissing) {
    const auto expect_needs_its_end = [&](const std::string& name, const std::string& content) {
        SCOPED_TRACE(name);
        expect_bytes(read_image(write(name, content)));
        const auto expect_in_short = [&](std::size_t missing) {
            expect_in("bytes of data, but there are",
                      error_of("short-" + name, content.substr(0, content.size() - missing)));
        };
        expect_in_short(1);
        expect_in_short(12);
    };
    const std::string type = "ElementType = MET_UCHAR\n";
    expect_needs_its_end("image.mha", meta(type, bytes()));
    const std::string zlib = packed(bytes(), false);
    expect_in("bytes of data, but there are",
              error_of("packed.mha",
                       meta(type + "CompressedData = True\nCompressedDataSize = " + std::to_string(zlib.size()) + "\n",
                            zlib.substr(0, zlib.size() / 2))));
    expect_bytes(
        read_image(write("length.mha", meta(type + "CompressedData = True\n", zlib))));  // though its size is not said

    expect_needs_its_end("image.nii", nifti(bytes()));
    const std::string gzip = packed(nifti(bytes()), true);
    expect_bytes(read_image(write("image.nii.gz", gzip)));
    expect_in("bytes of data, but there are", error_of("short.nii.gz", gzip.substr(0, gzip.size() - 20)));

    expect_needs_its_end("image.vtk", vtk("BINARY") + bytes());
    std::string text = vtk("ASCII");
    for (int i = 1; i <= 24; ++i) {
        text += std::to_string(i) + '\n';
    }
    expect_bytes(read_image(write("ascii.vtk", text)));
    expect_in("24 values, but there are 23", error_of("short.vtk", text.substr(0, text.size() - 3)));
}

TEST_F(ImageIo, AnyFormatMayBePackedByGzip) {
    const std::string stl =
        "solid s\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
        "endloop\nendfacet\nendsolid\n";
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (const auto& [name, content] : {std::pair(std::string("a.stl.gz"), stl), {"a.obj.gz", obj}, {"a", obj}}) {
        SCOPED_TRACE(name);
        const fs::path file = write(name, packed(content, true));
        EXPECT_EQ(file_kind(file), FileKind::kMesh);
        const TriangleMesh mesh = read_mesh(file);
        EXPECT_EQ(mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
        EXPECT_EQ(mesh.triangles.size(), 1u);
    }
    const std::string gzip = packed(obj, true);
    EXPECT_EQ(read_mesh(FileBytes{std::as_bytes(std::span(gzip)), "stdin"}).triangles.size(), 1u);
    EXPECT_EQ(read_points(write("a.xyz.gz", packed("1 2 3\n4 5 6\n", true))).points.size(), 2u);
    expect_bytes(read_image(write("a.vtk.gz", packed(vtk("BINARY") + bytes(), true))));
    expect_bytes(read_image(write("a.tif.gz", packed(tiff(bytes()), true))));
    expect_bytes(read_image(write("a.nii.gz", packed(nifti(bytes()), true))));
    expect_in("compressed data end before", error_of("short.vtk.gz", gzip.substr(0, gzip.size() - 9)));
    expect_in("the file is empty", error_of("empty.vtk.gz", packed("", true)));
}

// Ten thousand voxels along each axis, and next to none of them there.
TEST_F(ImageIo, NoMemoryIsTakenForWhatAHeadPromises) {
    const std::string nrrd = "NRRD0004\ntype: float\nendian: little\ndimension: 3\nsizes: 10000 10000 10000\n";
    for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
             {"raw.nrrd", nrrd + "encoding: raw\n\n" + bytes()},
             {"gzip.nrrd", nrrd + "encoding: gzip\n\n" + packed(bytes(), true)},
             {"apart.nhdr", nrrd + "encoding: raw\ndata file: raw.nrrd\n"},
             {"image.nii", nifti(bytes(), {10000, 10000, 10000})},
             {"image.nii.gz", packed(nifti(bytes(), {10000, 10000, 10000}), true)},
             {"image.vtk", vtk("BINARY", "10000 10000 10000") + bytes()},
             {"ascii.vtk", vtk("ASCII", "10000 10000 10000") + "1 2 3"},
             {"image.tif", tiff(bytes(), 40000000)},
             {"image.npy", npy("|u1", false, "10000, 10000, 10000", bytes())},
             {"bzip2.nrrd", nrrd + "encoding: bzip2\n\n" + packed_by_bzip2(bytes())},
             {"hex.nrrd", nrrd + "encoding: hex\n\n0102"}}) {
        expect_in("its head says", error_of(name, content));
    }
}

/// `content` with `from` replaced by `to`.
std::string changed(std::string content, const std::string& from, const std::string& to) {
    EXPECT_NE(content.find(from), std::string::npos) << from;
    return content.replace(content.find(from), from.size(), to);
}

const std::string kNrrd =
    "NRRD0004\ntype: uchar\ndimension: 3\nspace dimension: 3\nsizes: 2 3 4\n"
    "space directions: (1,0,0) (0,1,0) (0,0,2)\nkinds: domain domain domain\nencoding: raw\n"
    "space origin: (0,0,0)\n\n";

TEST_F(ImageIo, FaultsOfHeadsOfNrrd) {
    expect_bytes(read_image(write("image.nrrd", kNrrd + bytes())));
    const std::string long_comment = "# " + std::string(5000, 'c') + "\nkey:=" + std::string(5000, 'v') + "\nsizes:";
    expect_bytes(read_image(write("comment.nrrd", changed(kNrrd, "sizes:", long_comment) + bytes())));

    const auto expect_error = [&](const std::string& from, const std::string& to, const std::string& part) {
        expect_in(part, error_of("bad.nrrd", changed(kNrrd, from, to) + bytes()));
    };
    expect_error("domain\n", "domain\n" + std::string(1066, '0') + "\n", "line 8");
    expect_bytes(
        read_image(write("zeros.nrrd", changed(kNrrd, "origin: (", "origin: (" + std::string(1066, '0')) + bytes())));
    expect_error("space origin: (", "space origin: (" + std::string(1066, '1'), "line 9: '1111");
    expect_error("kinds: domain", "kinds: " + std::string(1000, 'x'), "2 values a voxel");
    expect_error("kinds: domain", "kinds: domain domain", "line 7: 'kinds' needs 3 words, not 4");
    expect_error("dimension: 3\nspace", "dimension: 1000000000\nspace", "line 3");
    expect_error("2 3 4", "2 3 -4", "line 5: '-4' cannot be the value of 'sizes'");
    expect_error("2 3 4", "2 3 0", "line 5");
    expect_error("2 3 4", "2 3", "line 5: 'sizes' needs 3 words, not 2");
    expect_error("2 3 4", "2 3 4 5", "line 5: 'sizes' needs 3 words, not 4");
    expect_error("2 3 4", "2000000000 2000000000 2000000000", "a size that no image has");
    expect_error("(0,0,2)", "(0,0,1e309)", "line 6: '1e309' cannot be a number of 'spacedirections'");
    expect_error("(0,0,0)\n", "(0,0,1e300)\n", "line 9");
    expect_error("(0,0,2)", "(0,0,0)", "spacing");
    expect_error("(0,0,2)", "(0,0)", "line 6: '(0,0)' needs three numbers in parentheses");
    expect_error("(0,0,2)", "(0,0,2", "line 6");
    expect_error("(0,1,0) (0,0,2)", "(0,1,0)", "needs 3 vectors, not 2");
    expect_error("uchar", "short", "no line 'endian'");
    expect_error("uchar", "block", "values of type 'block'");
    expect_error("raw", "zrl", "encoding 'zrl'");
    expect_error("raw\n", "raw\nbyte skip: -2\n", "line 9");
    expect_error("raw\n", "raw\nbyte skip: 1\n", "24 bytes of data, but there are 23");
    expect_error("raw\n", "raw\ndata file: %099999d 0 9 1\n", "several files");
    expect_error("raw\n", "raw\nencoding: raw\n", "there twice");
}

/// The bytes that `Number` has for 1, 2, 3…
template <class Number>
std::string numbers(std::endian order) {
    return bytes_of(counted<Number>(), order);
}

/// Calls `check(name, bytes)` with the numbers 1, 2, 3… of each type; the names are those of NumPy.
template <class Check>
void for_all_types(std::endian order, const Check& check) {
    check("i1", numbers<std::int8_t>(order));
    check("u1", numbers<std::uint8_t>(order));
    check("i2", numbers<std::int16_t>(order));
    check("u2", numbers<std::uint16_t>(order));
    check("i4", numbers<std::int32_t>(order));
    check("u4", numbers<std::uint32_t>(order));
    check("i8", numbers<std::int64_t>(order));
    check("u8", numbers<std::uint64_t>(order));
    check("f4", numbers<float>(order));
    check("f8", numbers<double>(order));
}

/// The value that a map has for this type; empty if it has none.
std::string in(const std::vector<std::pair<std::string, std::string>>& map, const std::string& type) {
    const auto found = std::ranges::find(map, type, &std::pair<std::string, std::string>::first);
    return found == map.end() ? std::string() : found->second;
}

TEST_F(ImageIo, TypesAndEncodingsOfNrrd) {
    const std::vector<std::pair<std::string, std::string>> names{
        {"i1", "signed char"}, {"u1", "uint8_t"}, {"i2", "short int"},     {"u2", "unsigned short int"},
        {"i4", "signed int"},  {"u4", "uint"},    {"i8", "long long int"}, {"u8", "ulonglong"},
        {"f4", "float"},       {"f8", "double"}};
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        for_all_types(order, [&](const std::string& type, const std::string& data) {
            SCOPED_TRACE(type);
            std::string hex;
            for (const char c : data) {
                constexpr std::string_view kDigits = "0123456789abcDEF";
                hex +=
                    {kDigits[static_cast<unsigned char>(c) >> 4], kDigits[c & 15], hex.size() % 30 == 0 ? '\n' : ' '};
            }
            for (const auto& [encoding, packed_data] : std::vector<std::pair<std::string, std::string>>{
                     {"raw", data},
                     {"gzip", packed(data, true)},
                     {"gz", packed(data.substr(0, 13), true) + packed(data.substr(13), true)},
                     {"bzip2", packed_by_bzip2(data)},
                     {"bz2", packed_by_bzip2(data.substr(0, 13)) + packed_by_bzip2(data.substr(13))},
                     {"hex", hex}}) {
                SCOPED_TRACE(encoding);
                std::string head = changed(kNrrd, "uchar", in(names, type));
                head = changed(head, "raw\n",
                               encoding + (order == std::endian::big ? "\nendian: big\n" : "\nendian: little\n"));
                expect_bytes(read_image(write("image.nrrd", head + packed_data)));
                if (encoding != "gz" && encoding != "bz2") {
                    expect_in("bytes of data, but there are",
                              error_of("short.nrrd", head + packed_data.substr(0, packed_data.size() - 15)));
                }
                // In a file of its own, after two lines and, once it is unpacked, nothing more or what is counted from
                // its end.
                write("image.data", "a line\nand another\n" + packed_data);
                for (const std::string skip : {"line skip: 2\n", "lineskip: 2\nbyteskip: -1\n"}) {
                    expect_bytes(
                        read_image(write("image.nhdr", changed(head, "kinds", skip + "data file: image.data\nkinds"))));
                }
            }
        });
    }
    expect_in("is no hexadecimal digit", error_of("bad.nrrd", changed(kNrrd, "raw", "hex") + "01 02 0g"));
    const std::string data = packed(bytes(), true);
    std::string damaged = data;
    damaged[damaged.size() - 8] ^= 1;  // the sum at the end
    const std::string head = changed(kNrrd, "raw", "gzip");
    expect_in("the compressed data are damaged", error_of("sum.nrrd", head + damaged));
    expect_bytes(read_image(write("longer.nrrd", head + packed(bytes() + "more", true))));
    write("skipped.data", packed("skip me " + bytes(), true));
    expect_bytes(
        read_image(write("skipped.nhdr", changed(head, "kinds", "byte skip: 8\ndata file: skipped.data\nkinds"))));
    std::string bad = packed_by_bzip2(bytes());
    bad[20] ^= 1;
    expect_in("the compressed data are damaged", error_of("bad.nrrd", changed(kNrrd, "raw", "bzip2") + bad));
}

TEST_F(ImageIo, NumbersInText) {
    std::string text;
    for (int i = 1; i <= 24; ++i) {
        text += std::to_string(i) + (i % 3 == 0 ? "\n" : i % 3 == 1 ? ", " : "\t");
    }
    const std::string head = changed(kNrrd, "raw", "ascii");
    expect_bytes(read_image(write("text.nrrd", head + text)));
    expect_bytes(read_image(write("text.nrrd", head + text.substr(0, text.size() - 1))));
    expect_in("24 values, but there are 23", error_of("short.nrrd", head + text.substr(0, text.size() - 3)));
    for (const std::string& bad :
         std::vector<std::string>{"x", "1.5", "256", "-1", "nan", "1e9", std::string(1040, '1')}) {
        expect_in("its value 2 of 24 is", error_of("bad.nrrd", head + changed(text, ", 2\t", ", " + bad + '\t')));
    }
    const std::string real = changed(head, "uchar", "float");
    EXPECT_EQ(read_image(write("real.nrrd", real + changed(text, ", 2\t", ", -2.5e3\t"))).values[1], -2500.0F);
    expect_in("is not a number", error_of("nan.nrrd", real + changed(text, ", 2\t", ", nan\t")));
    std::string meta_text = meta("ElementType = MET_UCHAR\n", text);
    expect_bytes(read_image(write("text.mha", changed(meta_text, "BinaryData = True", "BinaryData = False"))));
}

// In single precision 2^24 + 1 is 2^24: of two labels one must not be made.
TEST_F(ImageIo, LabelsBeyond24BitsAreNotTakenForOthers) {
    constexpr std::int64_t kMost = 1 << 24;
    std::vector<std::int64_t> labels(24, kMost - 1);
    std::copy_n(std::array{kMost, kMost + 1, kMost + 2, kMost + 3}.begin(), 4, labels.begin());
    const auto expect = [&](const fs::path& file) {
        SCOPED_TRACE(file.extension());
        const Image image = read_image(file);
        for (std::size_t i = 0; i < labels.size(); ++i) {
            EXPECT_EQ(image.values[i] == float{kMost}, labels[i] == kMost) << labels[i];
            EXPECT_EQ(image.values[i] > float{kMost}, labels[i] > kMost) << labels[i];
        }
        EXPECT_TRUE(scaleaxis::labels(image).empty());
        LoadOptions options;
        options.labels = {float{kMost + 2}};
        try {
            load_solid(image, options);
            ADD_FAILURE() << "labels beyond 2^24 are taken";
        } catch (const UnusableInput& error) {
            expect_in("labels beyond 2^24 cannot be told apart", error.what());
        }
    };
    const auto expect_of = [&](const std::string& type, auto zero) {
        SCOPED_TRACE(type);
        const std::vector<decltype(zero)> values(labels.begin(), labels.end());
        expect(write("a.npy", npy('<' + type, true, "2, 3, 4", bytes_of(values, std::endian::little))));
    };
    expect_of("i4", std::int32_t{});
    expect_of("u4", std::uint32_t{});
    expect_of("i8", std::int64_t{});
    expect_of("u8", std::uint64_t{});
    expect_of("f8", double{});
    std::string text;
    for (const std::int64_t label : labels) {
        text += std::to_string(label) + ' ';
    }
    expect(write("a.nrrd", changed(changed(kNrrd, "raw", "ascii"), "uchar", "uint") + text));
    expect(write("a.pgm3d", "P2-3D\n2 3 4\n16777219\n" + text));
    const std::vector<std::uint32_t> unsigned_labels(labels.begin(), labels.end());
    std::string nii = nifti(bytes_of(unsigned_labels, std::endian::little));
    nii.replace(70, 2, little(std::int16_t{768}));
    expect(write("a.nii", nii));
    std::ranges::replace_if(
        labels, [](std::int64_t label) { return label > kMost; }, kMost);
    EXPECT_EQ(scaleaxis::labels(
                  read_image(write("most.npy", npy("<i8", true, "2, 3, 4", bytes_of(labels, std::endian::little)))))
                  .size(),
              2u);
}

// Without directions, by spacings or by the ends of the axes, as cells or as points between which they lie.
TEST_F(ImageIo, PlacesOfNrrd) {
    const auto place = [&](const std::string& fields) {
        return read_image(write(
            "a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n" + fields + "\n" + bytes()));
    };
    const auto steps = [](double x, double y, double z) {
        return std::array{Point{x, 0, 0}, Point{0, y, 0}, Point{0, 0, z}};
    };
    EXPECT_EQ(place("").steps, steps(1, 1, 1));
    EXPECT_EQ(place("space: RAS\n").steps, steps(1, 1, 1));
    EXPECT_EQ(place("spacings: 2 nan 4\n").steps, steps(2, 1, 4));
    EXPECT_EQ(place("spacings: 2 -3 4\n").steps, steps(2, -3, 4));
    const Image cells = place("axis mins: 1 1 1\naxismaxs: 2 7 13\n");
    EXPECT_EQ(cells.steps, steps(0.5, 2, 3));
    EXPECT_EQ(cells.origin, (Point{1.25, 2, 2.5}));
    const Image nodes = place("axis mins: 1 1 1\naxis maxs: 2 5 13\ncenters: node node node\n");
    EXPECT_EQ(nodes.steps, steps(1, 2, 4));
    EXPECT_EQ(nodes.origin, (Point{1, 1, 1}));
    EXPECT_EQ(place("axis mins: 1 1 1\nspacings: 2 4 6\n").origin, (Point{2, 3, 4}));

    // An axis of one value that is none of space, first or last.
    const auto four = [&](const std::string& fields) {
        return read_image(
            write("a.nrrd", "NRRD0004\ntype: uchar\ndimension: 4\nencoding: raw\n" + fields + "\n" + bytes()));
    };
    const Image first = four("sizes: 1 2 3 4\nspace directions: none (2,0,0) (0,3,0) (0,0,4)\n");
    expect_bytes(first);
    EXPECT_EQ(first.steps, steps(2, 3, 4));
    const Image last = four("sizes: 2 3 4 1\nkinds: domain domain domain list\nspacings: 2 3 4 nan\n");
    expect_bytes(last);
    EXPECT_EQ(last.steps, steps(2, 3, 4));
    expect_in("2 values a voxel", error_of("list.nrrd",
                                           "NRRD0004\ntype: uchar\ndimension: 4\nencoding: raw\n"
                                           "kinds: list domain domain domain\nsizes: 2 2 3 2\n\n" +
                                               bytes()));
}

// Spaces with a time, of which an image is one volume.
TEST_F(ImageIo, NrrdKeepsTheSpaceOfSpacesWithATime) {
    const std::vector<std::pair<std::string, std::string>> spaces{
        {"RAS", "right-anterior-superior"}, {"LAS", "left-anterior-superior"}, {"lps", "left-posterior-superior"}};
    for (const auto& [short_name, name] : spaces) {
        SCOPED_TRACE(name);
        const auto read = [&](const std::string& space) {
            return read_image(
                write("a.nrrd", "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 2 3 4 1\nencoding: raw\nspace: " + space +
                                    "\nkinds: space space space time\n"
                                    "space directions: (2,0,0,0) (0,3,0,0) (0,0,4,0) (0,0,0,1)\n\n" +
                                    bytes()));
        };
        const Image image = read(name + "-time");
        expect_bytes(image);
        EXPECT_EQ(image.space, name + "-time");
        for (const std::string time : {"T", "t"}) {
            EXPECT_EQ(read(short_name + time).space, image.space);
        }
        write_image(path("written.nrrd"), image);
        EXPECT_EQ(read_image(path("written.nrrd")).space, name);
        EXPECT_EQ(content("written.nrrd").find("space dimension"), std::string::npos);
    }
    EXPECT_EQ(read_image(write("a.nrrd", changed(kNrrd, "space dimension: 3", "space: lpsx") + bytes())).space, "lpsx");
}

TEST_F(ImageIo, SegmentsOfSlicerHaveNames) {
    const std::string segments =
        "Segment0_ID:=Segment_1\nSegment0_LabelValue:=3\nSegment0_Layer:=0\nSegment0_Name:=left part\n"
        "Segment1_LabelValue:=7\nSegment1_Layer:=1\nSegment1_Name:=a: b\n";
    const Image image =
        read_image(write("a.seg.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: raw\n" + segments +
                                           "\n" + bytes()));
    ASSERT_EQ(image.label_names.size(), 2u);
    EXPECT_EQ(image.label_names[1].label, 7.0F);
    EXPECT_EQ(image.label_names[1].name, "a: b");
    const ImageReport report = report_of(image);
    EXPECT_EQ(report.labels.at(2).name, "left part");
    EXPECT_EQ(report.labels.at(3).name, "");
    LoadOptions by_number;
    by_number.mask_smoothing = 0.0;
    LoadOptions by_name = by_number;
    by_number.labels = {3.0F};
    by_name.label_names = {"left part"};
    EXPECT_EQ(load_solid(image, by_name).solid->bounds().min, load_solid(image, by_number).solid->bounds().min);
    by_name.label_names = {"right part"};
    try {
        load_solid(image, by_name);
        ADD_FAILURE() << "nothing was thrown";
    } catch (const UnusableInput& error) {
        expect_in("no label is called 'right part'", error.what());
        expect_in("3 'left part'", error.what());
    }
}

TEST_F(ImageIo, LayersOfSlicerAreJoinedUnlessSegmentsOverlap) {
    const auto layered = [&](const std::vector<std::uint8_t>& values) {
        return write("layers.seg.nrrd",
                     "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 2 2 1 2\nkinds: list domain domain domain\n"
                     "space directions: none (1,0,0) (0,1,0) (0,0,2)\nencoding: raw\n"
                     "Segment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Name:=a\n"
                     "Segment1_LabelValue:=2\nSegment1_Layer:=0\nSegment1_Name:=b\n"
                     "Segment2_LabelValue:=1\nSegment2_Layer:=1\nSegment2_Name:=c\n\n" +
                         std::string(values.begin(), values.end()));
    };
    const Image image = read_image(layered({0, 1, 1, 0, 2, 0, 0, 0}));
    EXPECT_EQ(image.sizes, (std::array<Index, 3>{2, 1, 2}));
    EXPECT_EQ(image.values, (std::vector<float>{3, 1, 2, 0}));
    ASSERT_EQ(image.label_names.size(), 3u);
    EXPECT_EQ(image.label_names[2].label, 3.0F);
    EXPECT_EQ(image.label_names[2].name, "c");
    EXPECT_EQ(image.steps[2], (Point{0, 0, 2}));
    try {
        read_image(layered({0, 1, 1, 0, 2, 1, 0, 0}));
        ADD_FAILURE() << "nothing was thrown";
    } catch (const FileError& error) {
        expect_in("'b' and 'c' (1 voxel in all)", error.what());
    }
}

TEST_F(ImageIo, TypesOfMetaImages) {
    const std::vector<std::pair<std::string, std::string>> names{
        {"i1", "MET_CHAR"},  {"u1", "MET_UCHAR"}, {"i2", "MET_SHORT"},     {"u2", "MET_USHORT"},
        {"i4", "MET_LONG"},  {"u4", "MET_UINT"},  {"i8", "MET_LONG_LONG"}, {"u8", "MET_ULONG_LONG"},
        {"f4", "MET_FLOAT"}, {"f8", "MET_DOUBLE"}};
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        for_all_types(order, [&](const std::string& type, const std::string& data) {
            SCOPED_TRACE(type);
            const std::string head = "ElementType = " + in(names, type) + '\n';
            const auto meta_of = [&](const std::string& fields, const std::string& content) {
                const std::string text = meta(head + fields, content);
                return order == std::endian::big ? changed(text, "MSB = False", "MSB = True") : text;
            };
            expect_bytes(read_image(write("a.mha", meta_of("", data))));
            expect_bytes(read_image(write("a.mha", meta_of("HeaderSize = 3\n", "abc" + data))));
            expect_bytes(read_image(write("a.mha", meta_of("HeaderSize = -1\n", "abcdef" + data))));
            const std::string zlib = packed(data, false);
            // What is said of the size of packed data may be wrong.
            expect_bytes(read_image(write("a.mha", meta_of("CompressedData = True\nCompressedDataSize = 7\n", zlib))));
            write("my data.zraw", zlib);
            expect_bytes(
                read_image(write("a.mhd", changed(meta_of("CompressedData = True\n", ""), "LOCAL", "my data.zraw"))));
        });
    }
    const std::string size = changed(meta("ElementType = MET_UCHAR\n", bytes()), "ElementSpacing", "ElementSize");
    EXPECT_EQ(read_image(write("a.mha", size)).steps[2], (Point{0, 0, 2}));
}

TEST_F(ImageIo, TypesOfVtk) {
    const std::vector<std::pair<std::string, std::string>> names{
        {"i1", "char"},  {"u1", "unsigned_char"}, {"i2", "short"}, {"u2", "unsigned_short"},
        {"i4", "int"},   {"u4", "unsigned_int"},  {"i8", "long"},  {"u8", "unsigned_long"},
        {"f4", "float"}, {"f8", "double"}};
    for_all_types(std::endian::big, [&](const std::string& type, const std::string& data) {
        SCOPED_TRACE(type);
        const std::string head = changed(vtk("BINARY"), "unsigned_char 1", in(names, type));
        expect_bytes(read_image(write("a.vtk", head + data)));
        expect_bytes(read_image(write("a.vtk", changed(head, "LOOKUP_TABLE default\n", "") + data)));
    });
    const Image image = read_image(write("a.vtk", changed(changed(vtk("BINARY"), "SPACING 1 1 1", "ORIGIN 1 2 3"),
                                                          "ORIGIN 0 0 0", "aspect_ratio 2 3 4") +
                                                      bytes()));
    EXPECT_EQ(image.origin, (Point{1, 2, 3}));
    EXPECT_EQ(image.steps[1], (Point{0, 3, 0}));
}

TEST_F(ImageIo, TypesOfNumpy) {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const std::string sign = order == std::endian::big ? ">" : "<";
        for_all_types(order, [&](const std::string& type, const std::string& data) {
            SCOPED_TRACE(sign + type);
            expect_bytes(read_image(write("a.npy", npy(sign + type, true, "2, 3, 4", data))));
            const Image image = read_image(write("a.npy", npy(sign + type, false, "4, 3, 2", data)));
            EXPECT_EQ(image.sizes, (std::array<Index, 3>{4, 3, 2}));
            for (int n = 0; n < 24; ++n) {
                const int i = n / 6;
                const int j = n / 2 % 3;
                const int k = n % 2;
                EXPECT_EQ(image.values[(k * 3 + j) * 4 + i], static_cast<float>(n + 1));
            }
            expect_in("bytes of data, but there are",
                      error_of("a.npy", npy(sign + type, false, "2, 3, 4", data.substr(1))));
        });
    }
    EXPECT_EQ(file_kind(write("array", npy("|b1", true, "2, 3, 4", bytes()))), FileKind::kImage);
    expect_bytes(read_image(write("a.npy", npy("|b1", true, "2, 3, 4, 1", bytes()))));
    // One, a half, -2, the least number above 0, and the largest one.
    std::string halves =
        bytes_of(std::vector<std::uint16_t>{0x3c00, 0x3800, 0xc000, 0x0001, 0x7bff}, std::endian::little);
    halves += std::string(38, '\0');
    const Image image = read_image(write("a.npy", npy("<f2", true, "2, 3, 4", halves)));
    EXPECT_EQ(std::vector(image.values.begin(), image.values.begin() + 6),
              (std::vector<float>{1.0F, 0.5F, -2.0F, 0x1p-24F, 65504.0F, 0.0F}));
    expect_in("several values an element",
              error_of("a.npy", changed(npy("|u1", true, "2, 3, 4", bytes()), "'|u1'", "[('a', '|u1')]")));
    expect_in("type '<c8'", error_of("a.npy", npy("<c8", true, "2, 3, 4", bytes())));
    expect_in("2 dimensions", error_of("a.npy", npy("|u1", true, "4, 6", bytes())));
    expect_in("head is none", error_of("a.npy", npy("|u1", true, "2, 3, x", bytes())));
    expect_in("no image has", error_of("a.npy", npy("|u1", true, "-2, -3, 4", bytes())));
    expect_in("head does not end", error_of("a.npy", npy("|u1", true, "2, 3, 4", "").substr(0, 60)));
    expect_in("head does not end", error_of("a.npy", "\x93NUMPY"));
}

/// An archive of files that are stored, or deflated.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files, bool is_packed) {
    std::string content;
    std::string directory;
    for (const auto& [name, data] : files) {
        const std::string gzip = packed(data, true);
        const std::string stored = is_packed ? gzip.substr(10, gzip.size() - 18) : data;
        const auto sum = crc32(0, reinterpret_cast<const Bytef*>(data.data()), static_cast<uInt>(data.size()));
        const std::string common = little(std::uint16_t{0}) + little(static_cast<std::uint16_t>(is_packed ? 8 : 0)) +
                                   little(std::uint32_t{0}) + little(static_cast<std::uint32_t>(sum)) +
                                   little(static_cast<std::uint32_t>(stored.size())) +
                                   little(static_cast<std::uint32_t>(data.size())) +
                                   little(static_cast<std::uint16_t>(name.size())) + little(std::uint16_t{0});
        directory += "PK\1\2" + little(std::uint16_t{20}) + little(std::uint16_t{20}) + common + std::string(10, '\0') +
                     little(static_cast<std::uint32_t>(content.size())) + name;
        content += "PK\3\4" + little(std::uint16_t{20}) + common + name + stored;
    }
    const auto count = static_cast<std::uint16_t>(files.size());
    return content + directory + "PK\5\6" + little(std::uint32_t{0}) + little(count) + little(count) +
           little(static_cast<std::uint32_t>(directory.size())) + little(static_cast<std::uint32_t>(content.size())) +
           little(std::uint16_t{0});
}

TEST_F(ImageIo, ArchivesOfNumpy) {
    const std::string array = npy("|u1", true, "2, 3, 4", bytes());
    const std::string spacing = npy("<f8", false, "3,", std::string(24, '\0'));
    for (const bool is_packed : {false, true}) {
        const fs::path file = write("a.npz", zip({{"spacing.npy", spacing}, {"mask.npy", array}}, is_packed));
        EXPECT_EQ(file_kind(file), FileKind::kImage);
        expect_bytes(read_image(file));
        expect_in("2 arrays of three dimensions, 'mask' and 'image'",
                  error_of("two.npz", zip({{"mask.npy", array}, {"image.npy", array}}, is_packed)));
        expect_in("0 arrays of three dimensions: save",
                  error_of("none.npz", zip({{"spacing.npy", spacing}}, is_packed)));
    }
}

TEST_F(ImageIo, NiftiInTwoFiles) {
    std::string head = nifti("").substr(0, 352);
    head.replace(344, 3, "ni1");
    head.replace(108, 4, little(8.0F));
    write("a.img", "--------" + bytes());
    expect_bytes(read_image(write("a.hdr", head)));
    expect_bytes(read_image(write("a.hdr.gz", packed(head, true))));
    fs::remove(path("a.img"));
    expect_in("a.img", error_of("a.hdr", head));
    write("a.img.gz", packed("--------" + bytes(), true));
    expect_bytes(read_image(write("a.hdr", head)));
}

TEST_F(ImageIo, ValuesOfNifti) {
    const auto with = [](std::string content, std::size_t at, const std::string& field) {
        return content.replace(at, field.size(), field);
    };
    const std::vector<std::pair<std::string, std::string>> codes{
        {"u1", "2"},   {"i2", "4"},   {"i4", "8"},   {"f4", "16"},   {"f8", "64"},
        {"i1", "256"}, {"u2", "512"}, {"u4", "768"}, {"i8", "1024"}, {"u8", "1280"}};
    for_all_types(std::endian::little, [&](const std::string& type, const std::string& data) {
        SCOPED_TRACE(type);
        const std::string content =
            with(nifti(data), 70, little(static_cast<std::int16_t>(std::stoi(in(codes, type)))));
        expect_bytes(read_image(write("a.nii", content)));
        const Image scaled = read_image(write("a.nii", with(with(content, 112, little(0.5F)), 116, little(-3.0F))));
        EXPECT_EQ(scaled.values[23], 9.0F);
        // No scale, and none that is a number.
        expect_bytes(read_image(write("a.nii", with(with(content, 112, little(0.0F)), 116, little(-3.0F)))));
        expect_bytes(read_image(write("a.nii", with(content, 112, little(static_cast<float>(NAN))))));
        if (type == "f4") {
            std::string nan = content;
            nan.replace(nan.size() - 4, 4, little(static_cast<float>(NAN)));
            EXPECT_EQ(read_image(write("a.nii", nan)).values[23], 0.0F);
        }
    });
    expect_in("type 128 of NIfTI cannot be read",
              error_of("rgb.nii", with(nifti(bytes()), 70, little(std::int16_t{128}))));
    expect_bytes(read_image(
        write("zero.nii", with(with(nifti(bytes()), 40, little(std::int16_t{4})), 48, little(std::int16_t{0})))));
    expect_in(
        "sizes up to 2 beyond the third",
        error_of("time.nii", with(with(nifti(bytes()), 40, little(std::int16_t{4})), 48, little(std::int16_t{2}))));
}

// By a rotation: a third of a turn about (1, 1, 1), with z turned around.
TEST_F(ImageIo, RotationOfNifti) {
    std::string content = nifti(bytes());
    const auto put = [&](std::size_t at, auto value) {
        const std::string field = little(value);
        content.replace(at, field.size(), field);
    };
    put(252, std::int16_t{1});
    put(254, std::int16_t{0});
    for (const int axis : {0, 1, 2}) {
        put(80 + 4 * axis, 2.0F + static_cast<float>(axis));
        put(256 + 4 * axis, 0.5F);
        put(268 + 4 * axis, 5.0F + static_cast<float>(axis));
    }
    put(76, -1.0F);
    const Image image = read_image(write("a.nii", content));
    EXPECT_EQ(image.steps, (std::array{Point{0, 2, 0}, Point{0, 0, 3}, Point{-4, 0, 0}}));
    EXPECT_EQ(image.origin, (Point{5, 6, 7}));
    // Half a turn, about z.
    put(256, 0.0F);
    put(260, 0.0F);
    put(264, 1.0F);
    put(76, 1.0F);
    EXPECT_EQ(read_image(write("a.nii", content)).steps,
              (std::array{Point{-2, 0, 0}, Point{0, -3, 0}, Point{0, 0, 4}}));
}

TEST_F(ImageIo, FaultsOfHeadsOfMetaImages) {
    const std::string good = meta("ElementType = MET_UCHAR\n", bytes());
    const auto expect_error = [&](const std::string& from, const std::string& to, const std::string& part) {
        expect_in(part, error_of("bad.mha", changed(good, from, to)));
    };
    expect_error("NDims = 3", "NDims = 1e9", "line 2: '1e9' cannot be the value of 'NDims'");
    expect_error("NDims = 3", "NDims = -3", "line 2");
    expect_error("NDims = 3", "NDims = 1000000000", "line 2");
    expect_error("NDims = 3", "NDims = 4", "'DimSize' needs 4 words, not 3");
    expect_error("DimSize = 2 3 4", "DimSize = 2 3", "'DimSize' needs 3 words, not 2");
    expect_error("DimSize = 2 3 4", "DimSize = 2 3 -4", "line 7: '-4'");
    expect_error("DimSize = 2 3 4", "DimSize = 2000000000 2000000000 2000000000", "a size that no image has");
    expect_error("ElementSpacing = 0.5 1 2", "ElementSpacing = 0.5 1 1e309", "line 6: '1e309'");
    expect_error("ElementSpacing = 0.5 1 2", "ElementSpacing = 0.5 1 0", "its spacing");
    expect_error("Offset = 1 2 3", "Offset = 1 2 nan", "line 5: 'nan'");
    expect_error("MET_UCHAR", "MET_STRING", "line 8: values of type 'MET_STRING' cannot be read");
    expect_error("ElementType", "NDims = 3\nElementType", "there twice");
    expect_error("ElementDataFile", "ElementDataPile", "line 10");
    expect_in("neither its name nor its content",
              error_of("bad.image", changed(changed(good, "DimSize", "imSize"), "NDims = 3", "NDims = -1")));
    const std::string matrix = "TransformMatrix = 0 0 0 0 0 0 0 0 0\nElementType";
    EXPECT_NE(error_of("bad.mha", changed(good, "ElementType", matrix)), "nothing was thrown");
}

TEST_F(ImageIo, FaultsOfHeadsOfVtk) {
    const std::string good = vtk("BINARY") + bytes();
    expect_bytes(read_image(write("good.vtk", good)));
    const auto expect_error = [&](const std::string& from, const std::string& to, const std::string& part) {
        expect_in(part, error_of("bad.vtk", changed(good, from, to)));
    };
    expect_error("SPACING 1 1 1", "SPACING 1 1 1e309", "line 6");
    expect_error("SPACING 1 1 1", "SPACING 1 1 nan", "line 6");
    expect_error("SPACING 1 1 1", "SPACING 1 1 0", "its spacing");
    expect_error("SPACING 1 1 1", "SPACING 1 1", "line 6");
    expect_error("ORIGIN 0 0 0", "ORIGIN 0 0 -1e300", "line 7");
    expect_error("DIMENSIONS 2 3 4", "DIMENSIONS 2 3 -4", "line 5");
    expect_error("DIMENSIONS 2 3 4", "DIMENSIONS 2 3", "line 5");
    expect_error("unsigned_char 1", "bit 1", "line 9: values of type 'bit' cannot be read");
    expect_error("unsigned_char 1", "unsigned_char 3", "3 values a voxel");
    expect_error("POINT_DATA 24", "VECTORS v float", "line 8: 'vectors' cannot be read");
    expect_error("POINT_DATA 24", "FIELD f 1\nx 1 1000000 double", "end within a field");
    expect_error("BINARY", "BASE64", "line 3: 'base64' stands where `ASCII` or `BINARY` should");
    expect_in("head does not end", error_of("bad.vtk", good.substr(0, good.find("SCALARS"))));
}

TEST_F(ImageIo, ValuesOfCellsOfVtkLieInTheirMiddles) {
    for (const bool is_text : {false, true}) {
        const std::string data = is_text ? as_text(bytes()) : bytes();
        const std::string cells =
            changed(changed(vtk(is_text ? "ASCII" : "BINARY", "3 4 5"), "POINT_DATA", "CELL_DATA"),
                    "SPACING 1 1 1\nORIGIN 0 0 0", "SPACING 2 4 6\nORIGIN 10 0 0");
        const Image image = read_image(write("cells.vtk", cells + data));
        expect_bytes(image);
        EXPECT_EQ(image.origin, (Point{11, 2, 3}));
        EXPECT_EQ(image.steps[2], (Point{0, 0, 6}));
    }
}

// VTK writes arrays of bytes as colours, those that are not active as fields, and fields of its own before all.
TEST_F(ImageIo, ArraysOfVtkThatAreNotCalledScalars) {
    const std::string scalars = "SCALARS values unsigned_char 1\nLOOKUP_TABLE default\n";
    const std::string field = "FIELD FieldData 2\nvalues 1 24 unsigned_char\n";
    const std::string time = std::string(8, '\x0a') + "\nMETADATA\nINFORMATION 0\n\n";
    expect_bytes(read_image(write("a.vtk", changed(vtk("BINARY"), scalars, "COLOR_SCALARS values 1\n") + bytes())));
    expect_bytes(read_image(write("a.vtk", changed(vtk("BINARY"), scalars, field) + bytes())));
    expect_bytes(read_image(write("a.vtk", changed(vtk("ASCII"), scalars, field) + as_text(bytes()))));
    expect_bytes(read_image(write(
        "a.vtk",
        changed(vtk("BINARY"), "DIMENSIONS", "FIELD FieldData 1\nTIME 1 1 double\n" + time + "DIMENSIONS") + bytes())));
    expect_bytes(read_image(
        write("a.vtk", changed(vtk("ASCII"), "DIMENSIONS", "FIELD FieldData 1\nTIME 1 2 double\n1.5\n2.5\nDIMENSIONS") +
                           as_text(bytes()))));
    // Text has shares of 255, rounded.
    std::ostringstream shares;
    for (const char c : bytes()) {
        shares << static_cast<unsigned char>(c) / 255.0 << ' ';
    }
    expect_bytes(read_image(write("a.vtk", changed(vtk("ASCII"), scalars, "COLOR_SCALARS values 1\n") + shares.str())));
    expect_in("3 values a voxel",
              error_of("a.vtk", changed(vtk("BINARY"), scalars, "COLOR_SCALARS values 3\n") + bytes()));
}

TEST_F(ImageIo, NiftiWithImpossibleSizes) {
    expect_in("a size that no image has", error_of("bad.nii", nifti(bytes(), {-2, -3, 4})));
    expect_in("a size that no image has", error_of("bad.nii", nifti(bytes(), {2, 0, 4})));
    std::string distant = nifti(bytes());
    distant.replace(280, 4, little(3e38F));
    expect_in("no finite numbers that an image can have", error_of("far.nii", distant));
}

/// `content` with the last field of this number replaced by one that means nothing.
std::string without_last_field(std::string content, std::uint16_t tag) {
    const std::size_t at = content.rfind(little(tag) + little(std::uint16_t{3}));
    return content.replace(at, 2, little(std::uint16_t{65000}));
}

TEST_F(ImageIo, PagesOfTiffHaveValuesOfOneKind) {
    // Absent bits are 1.
    expect_in("page 4 has values of another kind", error_of("bits.tif", without_last_field(tiff(bytes()), 258)));
    // The second page becomes a preview.
    std::string preview = tiff(bytes());
    const auto second_unit = [&] {
        const std::string unit = little(std::uint16_t{296}) + little(std::uint16_t{3});
        return preview.find(unit, preview.find(unit) + 1);
    }();
    preview.replace(second_unit, 2, little(std::uint16_t{254}));
    preview.replace(second_unit + 8, 4, little(std::uint32_t{1}));
    const Image image = read_image(write("preview.tif", preview));
    EXPECT_EQ(image.sizes, (std::array<Index, 3>{2, 3, 3}));
    EXPECT_EQ(image.values[6], 13);
    preview.replace(second_unit + 8, 4, little(std::uint32_t{0}));
    expect_bytes(read_image(write("marked.tif", preview)));
}

TEST_F(ImageIo, ImagesFromBytes) {
    const auto of = [](const std::string& content, const std::string& name) {
        return read_image(FileBytes{std::as_bytes(std::span(content)), name});
    };
    const std::vector<std::string> contents{kNrrd + bytes(),         meta("ElementType = MET_UCHAR\n", bytes()),
                                            nifti(bytes()),          packed(nifti(bytes()), true),
                                            vtk("BINARY") + bytes(), tiff(bytes()),
                                            inr(kInrBytes, bytes()), vol("2", bytes())};
    for (const std::string& content : contents) {
        SCOPED_TRACE(content.substr(0, 12));
        expect_bytes(of(content, "upload"));
    }
    write("image.raw", bytes());
    const std::string apart = changed(kNrrd, "raw\n", "raw\ndata file: image.raw\n");
    expect_bytes(read_image(write("apart.nhdr", apart)));
    try {
        of(apart, "upload");
        FAIL();
    } catch (const FileError& error) {
        expect_in("upload: its data are in a file of their own, 'image.raw'", error.what());
        EXPECT_EQ(error.diagnostic().code, "file.unsupported");
    }
}

// More than the beginning that is read for the head.
TEST_F(ImageIo, WhatFollowsTheBeginningIsReadFromTheFile) {
    std::string data(std::size_t{257} * 257 * 257, '\0');
    std::minstd_rand random(1);
    for (char& byte : data) {
        byte = static_cast<char>(random() >> 8U);
    }
    const std::string fields = "ElementType = MET_UCHAR\n";
    std::string inr_file = inr(kInrBytes, data);
    std::string vol_file = vol("2", data);
    for (const char axis : {'X', 'Y', 'Z'}) {
        const std::string size = std::to_string(axis - 'X' + 2);
        inr_file = changed(inr_file, std::string{axis} + "DIM=" + size + '\n', std::string{axis} + "DIM=257\n");
        vol_file = changed(vol_file, std::string{axis} + ": " + size, std::string{axis} + ": 257");
    }
    inr_file.erase(inr_file.find("\n\n"), 6);  // the head keeps its length
    const std::string nrrd = changed(kNrrd, "2 3 4", "257 257 257");
    const std::vector<std::pair<std::string, std::string>> files{
        {"a.nrrd", nrrd + data},
        {"gzip.nrrd", changed(nrrd, "raw", "gzip") + packed(data, true)},
        {"a.mha", changed(meta(fields, data), "2 3 4", "257 257 257")},
        {"a.nii", nifti(data, {257, 257, 257})},
        {"a.nii.gz", packed(nifti(data, {257, 257, 257}), true)},
        {"a.vtk", vtk("BINARY", "257 257 257") + data},
        {"a.npy", npy("|u1", true, "257, 257, 257", data)},
        {"c.npy", npy("|u1", false, "257, 257, 257", data)},
        {"a.inr", inr_file},
        {"a.vol", vol_file}};
    for (const auto& [name, content] : files) {
        SCOPED_TRACE(name);
        const fs::path file = write(name, content);
        EXPECT_EQ(file_kind(file), FileKind::kImage);
        EXPECT_TRUE(read_image(file).values == read_image(FileBytes{std::as_bytes(std::span(content)), name}).values);
        expect_in("bytes of data, but there are", error_of(name, content.substr(0, content.size() - 100)));
    }
    const std::string long_head = changed(nrrd, "\n\n", '\n' + std::string(data.size(), '#') + "\n\n");
    expect_in("its head does not end in its first 16777216 bytes", error_of("long.nrrd", long_head + data));
}

TEST_F(ImageIo, PlacesOfNifti) {
    // A matrix, a rotation, which here is none, or both.
    for (const auto& [rotation, matrix] : {std::array{0, 1}, {1, 0}, {1, 1}, {1, 2}, {2, 1}}) {
        for (const char unit : {'\0', '\1', '\2', '\3'}) {
            SCOPED_TRACE(testing::Message() << rotation << ' ' << matrix << ' ' << int{unit});
            std::string content = nifti(bytes());
            const auto put = [&](std::size_t at, const std::string& field) {
                content.replace(at, field.size(), field);
            };
            content[123] = unit;
            put(252, little(static_cast<std::int16_t>(rotation)));
            put(254, little(static_cast<std::int16_t>(matrix)));
            for (const int axis : {0, 1, 2}) {
                put(80 + 4 * axis, little(2.0F));
                put(280 + 20 * axis, little(2.0F));
                put(268 + 4 * axis, little(5.0F + static_cast<float>(axis)));
                put(292 + 16 * axis, little(10.0F + static_cast<float>(axis)));
            }
            const Image image = read_image(write("a.nii", content));
            const double first = matrix > 0 ? 10.0 : 5.0;
            EXPECT_EQ(image.origin, (Point{first, first + 1.0, first + 2.0}));
            EXPECT_EQ(image.steps[1], (Point{0, 2, 0}));
        }
    }
}

TEST_F(ImageIo, NiftiWithoutPlace) {
    std::string content = nifti(bytes());
    const float bad = NAN;
    std::memcpy(content.data() + 280, &bad, 4);
    expect_in("no finite numbers", error_of("image.nii", content));
}

TEST_F(ImageIo, MetaImageInSeveralFiles) {
    for (int k = 0; k < 4; ++k) {
        write(std::to_string(k) + ".raw", bytes().substr(6 * k, 6));
    }
    std::string list = meta("ElementType = MET_UCHAR\n", "0.raw\n1.raw\n2.raw\n3.raw\n");
    list.replace(list.find("LOCAL"), 5, "LIST");
    expect_bytes(read_image(write("list.mhd", list)));
    write("2.raw", "short");
    expect_in("but there are 23", error_of("list.mhd", list));
    fs::remove(path("2.raw"));
    expect_in("2.raw", error_of("list.mhd", list));
    write("2.raw", bytes().substr(12, 6));
    write("4.raw", bytes().substr(0, 6));
    list.replace(list.find("LIST"), 4, "%d.raw 0 3 1");
    expect_bytes(read_image(write("pattern.mhd", list)));
    expect_bytes(read_image(write("pattern.nhdr", changed(kNrrd, "raw\n", "raw\ndata file: %1d.raw 0 3 1 2\n"))));
    expect_bytes(read_image(write("pattern.nhdr", changed(kNrrd, "raw\n", "raw\ndata file: %d.raw 0 3\n"))));
    expect_bytes(read_image(write("list.nhdr", changed(kNrrd, "raw\nspace origin: (0,0,0)\n\n",
                                                       "raw\ndata file: LIST\n0.raw\n1.raw\n2.raw\n3.raw\n"))));
    for (const std::string pattern : {"%d%d.raw 0 3 1", "%x.raw 0 3 1", "%d.raw 0", "%d.raw 0 3 0", "%d.raw 3 0 1",
                                      "%d.raw 0 99999999 1", "%-3d.raw 0 3 1", "%d.raw -1 2 1"}) {
        expect_in("several files", error_of("list.mhd", changed(list, "%d.raw 0 3 1", pattern)));
    }
    expect_in("24 voxels cannot be in 5 files", error_of("list.mhd", changed(list, "0 3 1", "0 4 1")));
}

/// Pages of 20 x 18 numbers; \param mode "w", or "w8" for the form of large files
void write_tiff(const fs::path& file, const std::string& type, const std::string& data, const char* mode, int packing,
                bool is_tiled, std::uint16_t orientation) {
    constexpr int kWidth = 20;
    constexpr int kHeight = 18;
    const int bits = type == "bit" ? 1 : 8 * (type[1] - '0');
    const int row_bytes = (kWidth * bits + 7) / 8;
    TIFF* tiff = TIFFOpen(file.string().c_str(), mode);
    for (std::size_t page = 0; page < data.size(); page += static_cast<std::size_t>(row_bytes) * kHeight) {
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kWidth);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kHeight);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
        TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, type[0] == 'i' ? 2 : type[0] == 'f' ? 3 : 1);
        TIFFSetField(tiff, TIFFTAG_COMPRESSION, packing);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, page == 0 ? PHOTOMETRIC_MINISWHITE : PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff, TIFFTAG_ORIENTATION, orientation);
        if (is_tiled) {
            TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
            TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
            const int tile_bytes = 16 * bits / 8;
            for (int y = 0; y < kHeight; y += 16) {
                for (int x = 0; x < row_bytes; x += tile_bytes) {
                    std::string tile(16 * static_cast<std::size_t>(tile_bytes), '\0');
                    for (int row = 0; row < std::min(16, kHeight - y); ++row) {
                        data.copy(tile.data() + row * tile_bytes, std::min(tile_bytes, row_bytes - x),
                                  page + (y + row) * row_bytes + x);
                    }
                    TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(8 * x / bits), y, 0, 0);
                }
            }
        } else {
            TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 7);
            for (int row = 0; row < kHeight; ++row) {
                std::string line = data.substr(page + static_cast<std::size_t>(row) * row_bytes, row_bytes);
                TIFFWriteScanline(tiff, line.data(), row, 0);
            }
        }
        TIFFWriteDirectory(tiff);
    }
    TIFFClose(tiff);
}

template <class Number>
std::string counted_bytes(std::size_t count) {
    std::vector<Number> values;
    for (std::size_t i = 0; i < count; ++i) {
        values.push_back(static_cast<Number>(i % 125));
    }
    return bytes_of(values, std::endian::native);
}

TEST_F(ImageIo, TypesOfTiff) {
    constexpr std::size_t kCount = 20 * 18 * 3;
    const auto check = [&](const std::string& type, const std::string& data, const auto& value) {
        for (const int packing : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS}) {
            for (const char* mode : {"wl", "wb", "wl8", "wb8"}) {
                for (const bool is_tiled : {false, true}) {
                    SCOPED_TRACE(testing::Message() << type << ' ' << packing << ' ' << mode << ' ' << is_tiled);
                    write_tiff(path("a.tif"), type, data, mode, packing, is_tiled, ORIENTATION_TOPLEFT);
                    const Image image = read_image(path("a.tif"));
                    EXPECT_EQ(image.sizes, (std::array<Index, 3>{20, 18, 3}));
                    for (std::size_t i = 0; i < kCount; ++i) {
                        ASSERT_EQ(image.values[i], value(i)) << i;
                    }
                }
            }
        }
    };
    const auto counted_value = [](std::size_t i) { return static_cast<float>(i % 125); };
    check("i1", counted_bytes<std::int8_t>(kCount), counted_value);
    check("u1", counted_bytes<std::uint8_t>(kCount), counted_value);
    check("i2", counted_bytes<std::int16_t>(kCount), counted_value);
    check("u2", counted_bytes<std::uint16_t>(kCount), counted_value);
    check("i4", counted_bytes<std::int32_t>(kCount), counted_value);
    check("u4", counted_bytes<std::uint32_t>(kCount), counted_value);
    check("f4", counted_bytes<float>(kCount), counted_value);
    check("f8", counted_bytes<double>(kCount), counted_value);
    // One bit a voxel, the first one in the highest; rows begin with a byte.
    std::string bits;
    for (std::size_t row = 0; row < kCount / 20; ++row) {
        bits += std::string("\xa5\x0f", 2) + (row % 2 == 0 ? '\xf0' : '\0');
    }
    check("bit", bits, [&](std::size_t i) {
        return static_cast<float>(static_cast<unsigned char>(bits[i / 20 * 3 + i % 20 / 8]) >> (7 - i % 20 % 8) & 1);
    });

    const std::string data = counted_bytes<std::uint8_t>(kCount);
    write_tiff(path("down.tif"), "u1", data, "w", COMPRESSION_NONE, false, ORIENTATION_BOTLEFT);
    EXPECT_EQ(read_image(path("down.tif")).values[0], static_cast<float>(17 * 20 % 125));
    write_tiff(path("left.tif"), "u1", data, "w", COMPRESSION_NONE, false, ORIENTATION_LEFTTOP);
    expect_in("turned", error_of("left.tif", content("left.tif")));
    // What is damaged within a page.
    write_tiff(path("lzw.tif"), "u1", data, "w", COMPRESSION_ADOBE_DEFLATE, false, ORIENTATION_TOPLEFT);
    std::string damaged = content("lzw.tif");
    damaged[40] ^= 0x55;
    expect_in("its page 1 is damaged", error_of("damaged.tif", damaged));
}

TEST_F(ImageIo, CalibrationOfTiff) {
    const auto expect = [&](const std::string& description, const Point& spacing, const std::string& unit,
                            std::uint32_t tag = 1) {
        SCOPED_TRACE(description);
        const Image image = read_image(write("a.tif", tiff(bytes(), 2, description, tag)));
        expect_bytes(image);
        EXPECT_LT(distance({image.steps[0].x, image.steps[1].y, image.steps[2].z}, spacing), 1e-6);
        EXPECT_EQ(image.unit, unit);
        EXPECT_EQ(image.origin, Point());
    };
    // Nothing says how far pages are apart.
    expect("", {1, 1, 1}, "");
    expect("a stack", {0.2, 0.5, 1}, "", 3);
    expect("a stack", {25.4 / 50, 25.4 / 20, 1}, "", 2);
    // Millimetres and micrometres, which libtiff does not know.
    expect("a stack", {0.02, 0.05, 1}, "", 4);
    expect("a stack", {0.02e-3, 0.05e-3, 1}, "", 5);
    expect("ImageJ=1.53t\nimages=4\nslices=4\n", {0.02, 0.05, 1}, "mm", 4);
    expect(R"({"shape": [4, 3, 2], "spacing": 0.3, "unit": "um"})", {20, 50, 0.3}, "um", 4);
    expect(R"({"shape": [4, 3, 2], "spacing": 0.3, "unit": "um"})", {0.02, 0.05, 0.3}, "um", 5);
    expect_in("its page 1 is damaged", error_of("unit.tif", tiff(bytes(), 2, "a stack", 77)));
    // ImageJ: resolutions in its unit.
    expect("ImageJ=1.53t\nimages=4\nslices=4\nunit=micron\nspacing=0.3\nloop=false\n", {0.02, 0.05, 0.3}, "um");
    expect("ImageJ=1.53t\nimages=4\nslices=4\nunit=\\u00B5m\nspacing=0.3\n", {0.02, 0.05, 0.3}, "um");
    expect("ImageJ=1.53t\nimages=4\nslices=4\nunit=mm\n", {0.02, 0.05, 1}, "mm");
    expect("ImageJ=1.53t\nimages=4\nslices=4\nunit=cm\nspacing=-0.3\n", {0.02, 0.05, 0.3}, "cm", 3);
    expect("ImageJ=1.53t\nimages=4\nslices=4\n", {0.02, 0.05, 1}, "inch", 2);
    expect("ImageJ=1.53t\nimages=4\nunit=pixel\n", {0.02, 0.05, 1}, "");
    // OME: what is not said is in micrometres.
    const auto ome = [](const std::string& attributes) {
        return "<?xml version=\"1.0\"?><OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\"><Image "
               "ID=\"0\">"
               "<Pixels ID=\"0\" SizeX=\"2\" SizeY=\"3\" SizeZ=\"4\" SizeT=\"1\" SizeC=\"1\" " +
               attributes + "><TiffData/></Pixels></Image></OME>";
    };
    const std::string sizes = "PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.25\" PhysicalSizeZ=\"1.5\" ";
    expect(ome(sizes), {0.5, 0.25, 1.5}, "um");
    expect(ome(sizes + "PhysicalSizeXUnit=\"\xC2\xB5m\" PhysicalSizeZUnit=\"nm\""), {0.5, 0.25, 1.5e-3}, "um");
    expect(ome(sizes + "PhysicalSizeXUnit=\"mm\" PhysicalSizeYUnit=\"mm\" PhysicalSizeZUnit=\"mm\""), {0.5, 0.25, 1.5},
           "mm");
    expect(ome("PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.25\""), {0.5, 0.25, 1}, "");
    expect(changed(changed(ome(sizes), "<Pixels", "<o:Pixels"), "</Pixels", "</o:Pixels"), {0.5, 0.25, 1.5}, "um");
    expect(ome("PhysicalSizeX=\"-1\" PhysicalSizeY=\"x\" PhysicalSizeZ=\"inf\""), {1, 1, 1}, "");
    expect("<xml that ends", {0.2, 0.5, 1}, "", 3);
    // tifffile: ImageJ's words; inches are what it writes where nothing is said.
    expect(R"({"shape": [4, 3, 2]})", {1, 1, 1}, "");
    expect(R"({"shape": [1, 4, 1, 3, 2], "axes": "TZCYX"})", {0.2, 0.5, 1}, "", 3);
    expect(R"({"shape": [3, 2]})", {0.2, 0.5, 1}, "", 3);  // each page by itself
    expect(R"({"shape": [4, 3, 2], "axes": "ZYX", "spacing": 0.3, "unit": "micron"})", {0.02, 0.05, 0.3}, "um", 2);
    expect(R"({"shape": [4, 3, 2], "spacing": 0.3, "unit": "um"})", {200, 500, 0.3}, "um", 3);
    expect(R"({"shape": [4, 3, 2], "spacing": 0.3})", {0.2, 0.5, 0.3}, "", 3);
    expect(R"({"shape": 4, "spacing": "x"})", {0.2, 0.5, 1}, "", 3);
    expect("{no JSON", {0.2, 0.5, 1}, "", 3);

    const auto error = [&](const std::string& description) {
        return error_of("bad.tif", tiff(bytes(), 2, description));
    };
    expect_in("several channels", error("ImageJ=1.53t\nimages=4\nchannels=2\nslices=2\n"));
    expect_in("several frames", error("ImageJ=1.53t\nimages=4\nframes=2\nslices=2\n"));
    expect_in("9 slices, but has 4 pages", error("ImageJ=1.53t\nimages=9\nslices=9\n"));
    expect_in("9 slices, but has 4 pages", error(R"({"shape": [9, 3, 2]})"));
    expect_in("several volumes", error(R"({"shape": [2, 2, 3, 2]})"));
    expect_in("several volumes", error(R"({"shape": [2, 3, 2]})"));
    expect_in("several channels", error(R"({"shape": [4, 1, 3, 2], "axes": "CZYX"})"));
    expect_in("several times", error(R"({"shape": [1, 4, 3, 2], "axes": "CTYX"})"));
    expect_in("several channels", error(changed(ome(sizes), "SizeC=\"1\"", "SizeC=\"2\"")));
    expect_in("several times", error(changed(ome(sizes), "SizeT=\"1\"", "SizeT=\"2\"")));
    expect_in("8 slices, but has 4 pages", error(changed(ome(sizes), "SizeZ=\"4\"", "SizeZ=\"8\"")));
}

// ImageJ writes stacks beyond 4 GB so, and tifffile if it is told to.
TEST_F(ImageIo, TiffWhoseOnlyPageHasAllSlices) {
    for (const std::string description :
         {R"({"shape": [4, 3, 2], "truncated": true})", "ImageJ=1.53t\nimages=4\nslices=4\n"}) {
        std::string one = tiff(bytes().substr(0, 6), 2, description, 1);
        const std::string place = little(std::uint16_t{273}) + little(std::uint16_t{4}) + little(1);
        const std::size_t at = one.find(place);
        ASSERT_NE(at, std::string::npos);
        one.replace(at + place.size(), 4, little(static_cast<std::uint32_t>(one.size())));
        expect_bytes(read_image(write("one.tif", one + bytes())));
        expect_in("4 slices, but has 1 pages", error_of("short.tif", one + bytes().substr(1)));
    }
}

TEST_F(ImageIo, TiffWithSeveralPages) {
    const std::string content = tiff(bytes());
    const fs::path file = write("image.tif", content);
    EXPECT_EQ(file_kind(file), FileKind::kImage);
    const Image image = read_image(file);
    expect_bytes(image);
    // 50 and 20 points a centimetre, in millimetres; nothing says how far the pages are apart.
    EXPECT_LT(distance(image.steps[0], {0.2, 0, 0}), 1e-6);
    EXPECT_LT(distance(image.steps[1], {0, 0.5, 0}), 1e-6);
    EXPECT_EQ(image.steps[2], (Point{0, 0, 1}));
    EXPECT_EQ(image.origin, Point());

    expect_in("page 4 is damaged, or the file ends before it does",
              error_of("short.tif", content.substr(0, content.size() - 10)));
    std::string circle = content;
    std::memcpy(circle.data() + circle.size() - 4, circle.data() + 4, 4);
    expect_in("page 5 is damaged", error_of("circle.tif", circle));
    std::string wider = content;
    wider[wider.rfind(little(std::uint16_t{256}) + little(std::uint16_t{4})) + 8] = 1;
    expect_in("page 4 has another size", error_of("wider.tif", wider));
    expect_in("2 dimensions", error_of("flat.tif", tiff(bytes().substr(0, 6))));
}

TEST_F(ImageIo, SaysHowToConvertDicom) {
    expect_in("it is a folder; name a file in it", error_of_folder());
    for (const std::string& message : {error_of("series/a.dcm", kSlice + little(1)), error_of_folder()}) {
        expect_in("dcm2niix", message);
        expect_in("SimpleITK", message);
    }
}

}  // namespace
}  // namespace scaleaxis
