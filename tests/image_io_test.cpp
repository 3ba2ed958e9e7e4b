// SPDX-License-Identifier: Apache-2.0
// Readers of images: what is in a file, and what is wrong with it.
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "folder.hpp"
#include "images.hpp"
#include "io/bytes.hpp"
#include "scaleaxis/errors.hpp"
#include "scaleaxis/io.hpp"

namespace scaleaxis {
namespace {

using namespace test;
namespace fs = std::filesystem;

class ImageIo : public test::FolderTest {
   protected:
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
    std::string result(content.size() + 1000, '\0');
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

/// 2 x 3 x 4 bytes 1, 2, 3…
std::string bytes() {
    std::string result;
    for (int i = 0; i < 24; ++i) {
        result += static_cast<char>(i + 1);
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

    expect_in("that is 24 bytes, but there are 23", error_of("a.inr", inr(kInrBytes, bytes().substr(1))));
    expect_in("but there are 25", error_of("a.inr", inr(kInrBytes, bytes() + "x")));
    expect_in("no TYPE", error_of("a.inr", inr("", bytes())));
    expect_in("cannot be read", error_of("a.inr", inr("TYPE=packed\nPIXSIZE=12 bits\nCPU=pc\n", bytes())));
    const std::string gz = packed(inr(kInrBytes, bytes()), true);
    expect_in("the compressed data end before their end", error_of("a.inr.gz", gz.substr(0, gz.size() - 12)));
    expect_in("head does not end", error_of("a.inr", "#INRIMAGE-4#{\nXDIM=2\n"));
    std::string huge = inr(kInrBytes, bytes());
    huge.replace(huge.find("XDIM=2\n"), 7, "XDIM=9e");
    expect_in("no positive number", error_of("a.inr", huge));
    // The end of the head lies beyond the end of the file.
    std::string shifted = inr(kInrBytes, "0123456789");
    shifted.erase(252, 4);
    shifted += "##}\n";
    expect_in("there are 0", error_of("a.inr", shifted));
    expect_in("a size that no image has",
              error_of("a.inr", "#INRIMAGE-4#{\nXDIM=3000000000\n" + std::string(222, '\n') + "##}\n"));
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
    expect_in("but there are 25", error_of("a.vol", vol("3", packed(bytes() + "xyz", false))));
    expect_in("end before their end", error_of("a.vol", vol("3", packed(bytes(), false).substr(0, 12))));
    expect_in("damaged", error_of("a.vol", vol("3", bytes())));
    expect_in("has no Z", error_of("a.vol", "X: 2\nY: 3\n.\n"));
    expect_in("no positive number", error_of("a.vol", "X: 2\nY: 3\nZ: -4\n.\n"));
    expect_in("a size that no image has", error_of("a.vol", "X: 2000000\nY: 3000\nZ: 4\n.\n"));
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
        const auto part = io::to_bytes(number, order);
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
    EXPECT_EQ(count, 6);
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
    expect_in("more values", error("24", "24 25"));
    expect_in("fewer values", error("24", ""));
    expect_in("is no number", error("24", "2x4"));
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
    expect_in("too short", error_of("a.vti", huge));
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

#if SCALEAXIS_READS_ITK

std::string nifti2(std::endian order, const std::string& magic, std::int64_t offset) {
    std::string head(544, '\0');
    const auto put = [&](std::size_t at, auto value) {
        std::ranges::copy(io::to_bytes(value, order), head.begin() + static_cast<std::ptrdiff_t>(at));
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
        expect_in("there are 591", error_of("a.nii", file.substr(0, file.size() - 1)));
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
        std::ranges::copy(io::to_bytes(std::int64_t{1} << 40, order), large.begin() + 24);
        expect_in("up to 32767 voxels", error_of("a.nii", large));
        std::string elsewhere = file;
        std::ranges::copy(io::to_bytes(std::int64_t{1} << 40, order), elsewhere.begin() + 168);
        expect_in("a place where they cannot be", error_of("a.nii", elsewhere));
    }
}

TEST_F(ImageIo, NrrdPackedByBzip2) {
    expect_in("unu save",
              error_of("a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 3 4\nencoding: bzip2\n\nBZh9"));
}

#endif

#if SCALEAXIS_READS_ITK

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
        const double sign = image.space.starts_with("left") ? -1.0 : 1.0;
        const auto turned = [&](const Point& p) { return Point{sign * p.x, sign * p.y, p.z}; };
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

TEST_F(ImageIo, FolderWithoutDicom) {
    fs::create_directories(folder() / "series");
    try {
        read_image(folder() / "series");
        FAIL();
    } catch (const FileError& error) {
        expect_in("no DICOM image", error.what());
    }
}

/// A number as files have it, the least significant byte first.
template <class T>
std::string little(T value) {
    const auto data = io::to_bytes(value, std::endian::little);
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

/// A page for each six bytes, of `width` x 3.
std::string tiff(const std::string& data, std::uint32_t width = 2) {
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
        file.replace(link, 4, little(static_cast<std::uint32_t>(file.size())));
        struct Field {
            std::uint16_t tag, type;
            std::uint32_t value;
        };
        const std::vector<Field> fields{
            {256, 4, width},           {257, 4, 3}, {258, 3, 8}, {259, 3, 1},     {262, 3, 1},
            {273, 4, strip},           {277, 3, 1}, {278, 4, 3}, {279, 4, kPage}, {282, 5, resolutions},
            {283, 5, resolutions + 8}, {296, 3, 3}};
        file += little(static_cast<std::uint16_t>(fields.size()));
        for (const auto& [tag, type, value] : fields) {
            file += little(tag) + little(type) + little(std::uint32_t{1}) + little(value);
        }
        link = file.size();
        file += little(std::uint32_t{0});
    }
    return file;
}

/// One of a DICOM series, of 2 x 3 voxels.
struct Slice {
    int number = 0;
    std::string series = "1";
    Point place = {};
    int first_value = 1;
    std::uint16_t rows = 3;
    std::string spacing = "0.5\\0.25";  ///< between rows, between columns
    std::array<std::string, 2> rescale{"1", "0"};
};

std::string dicom(const Slice& slice) {
    const auto element = [](std::uint16_t group, std::uint16_t number, const std::string& kind, std::string value) {
        if (value.size() % 2 != 0) {
            value += kind == "UI" ? '\0' : ' ';
        }
        const std::string head = little(group) + little(number) + kind;
        return kind.starts_with('O')
                   ? head + little(std::uint16_t{0}) + little(static_cast<std::uint32_t>(value.size())) + value
                   : head + little(static_cast<std::uint16_t>(value.size())) + value;
    };
    const auto small = [&](std::uint16_t number, std::uint16_t value) {
        return element(0x28, number, "US", little(value));
    };
    const std::string series = "1.2.3.4." + slice.series;
    const std::string name = series + "." + std::to_string(slice.number);
    const std::string kind = "1.2.840.10008.5.1.4.1.1.2";
    const std::string meta = element(2, 1, "OB", std::string("\0\1", 2)) + element(2, 2, "UI", kind) +
                             element(2, 3, "UI", name) + element(2, 0x10, "UI", "1.2.840.10008.1.2.1");
    std::string values;
    for (int i = 0; i < 6; ++i) {
        values += little(static_cast<std::int16_t>(slice.first_value + i));
    }
    std::ostringstream place;
    place << slice.place.x << '\\' << slice.place.y << '\\' << slice.place.z;
    return std::string(128, '\0') + "DICM" + element(2, 0, "UL", little(static_cast<std::uint32_t>(meta.size()))) +
           meta + element(8, 0x16, "UI", kind) + element(8, 0x18, "UI", name) + element(8, 0x60, "CS", "CT") +
           element(0x20, 0xd, "UI", "1.2.3.4") + element(0x20, 0xe, "UI", series) + element(0x20, 0x11, "IS", "1") +
           element(0x20, 0x13, "IS", std::to_string(slice.number)) + element(0x20, 0x32, "DS", place.str()) +
           element(0x20, 0x37, "DS", "1\\0\\0\\0\\0.8\\0.6") + small(2, 1) + element(0x28, 4, "CS", "MONOCHROME2") +
           small(0x10, slice.rows) + small(0x11, slice.rows > 3 ? slice.rows : 2) +
           element(0x28, 0x30, "DS", slice.spacing) + small(0x100, 16) + small(0x101, 16) + small(0x102, 15) +
           small(0x103, 1) + element(0x28, 0x1052, "DS", slice.rescale[1]) +
           element(0x28, 0x1053, "DS", slice.rescale[0]) + element(0x7fe0, 0x10, "OW", values);
}

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
    expect_in("no CompressedDataSize", error_of("length.mha", meta(type + "CompressedData = True\n", zlib)));

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
             {"image.dcm", dicom({.rows = 60000})}}) {
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

// Heads over which the toolkit stops the program, writes beyond its memory, or never ends.
TEST_F(ImageIo, HeadsOfNrrdAreCheckedBeforeTheToolkitReadsThem) {
    expect_bytes(read_image(write("image.nrrd", kNrrd + bytes())));
    const std::string long_comment = "# " + std::string(5000, 'c') + "\nkey:=" + std::string(5000, 'v') + "\nsizes:";
    expect_bytes(read_image(write("comment.nrrd", changed(kNrrd, "sizes:", long_comment) + bytes())));

    const auto expect_error = [&](const std::string& from, const std::string& to, const std::string& part) {
        expect_in(part, error_of("bad.nrrd", changed(kNrrd, from, to) + bytes()));
    };
    expect_error("domain\n", "domain\n" + std::string(1066, '0') + "\n", "line 8");
    expect_error("space origin: (", "space origin: (" + std::string(1066, '0'), "line 9");
    expect_error("kinds: domain", "kinds: " + std::string(1000, 'x'), "line 7");
    expect_error("dimension: 3\nspace", "dimension: 1000000000\nspace", "line 3");
    expect_error("2 3 4", "2 3 -4", "line 5: '-4' cannot be the sizes");
    expect_error("2 3 4", "2 3 0", "line 5");
    expect_error("2 3 4", "2 3", "2 sizes in place of 3");
    expect_error("2 3 4", "2 3 4 5", "4 sizes in place of 3");
    expect_error("2 3 4", "2000000000 2000000000 2000000000", "sizes that no image has");
    expect_error("(0,0,2)", "(0,0,1e309)", "line 6: '1e309' cannot be a number of the space directions");
    expect_error("(0,0,0)\n", "(0,0,1e300)\n", "line 9");
    expect_error("(0,0,2)", "(0,0,0)", "spacing");
    expect_error("uchar", "block", "values of type 'block'");
    expect_error("raw", "zrl", "encoding 'zrl'");
    expect_error("raw\n", "raw\nbyte skip: -2\n", "line 9");
    expect_error("raw\n", "raw\nbyte skip: 1\n", "24 bytes of data, but there are 23");
    expect_error("raw\n", "raw\ndata file: %099999d 0 9 1\n", "several files");
    expect_error("raw\n", "raw\nencoding: raw\n", "there twice");
}

TEST_F(ImageIo, HeadsOfMetaImagesAreCheckedBeforeTheToolkitReadsThem) {
    const std::string good = meta("ElementType = MET_UCHAR\n", bytes());
    const auto expect_error = [&](const std::string& from, const std::string& to, const std::string& part) {
        expect_in(part, error_of("bad.mha", changed(good, from, to)));
    };
    expect_error("NDims = 3", "NDims = 1e9", "line 2: '1e9' cannot be the NDims");
    expect_error("NDims = 3", "NDims = -3", "line 2");
    expect_error("NDims = 3", "NDims = 1000000000", "line 2");
    expect_error("NDims = 3", "NDims = 4", "needs 4 numbers, not 3");
    expect_error("DimSize = 2 3 4", "DimSize = 2 3", "DimSize needs 3 numbers, not 2");
    expect_error("DimSize = 2 3 4", "DimSize = 2 3 -4", "cannot have the sizes");
    expect_error("DimSize = 2 3 4", "DimSize = 2000000000 2000000000 2000000000", "cannot have the sizes");
    expect_error("ElementSpacing = 0.5 1 2", "ElementSpacing = 0.5 1 1e309", "line 6: '1e309'");
    expect_error("ElementSpacing = 0.5 1 2", "ElementSpacing = 0.5 1 0", "cannot have the spacing");
    expect_error("Offset = 1 2 3", "Offset = 1 2 nan", "line 5: 'nan'");
    expect_error("Offset = 1 2 3", "Comment = " + std::string(300, 'c'), "too long");
    expect_error("ObjectType = Image\n", "DimSize = 2 3 4\n", "stands before NDims");
    expect_error("ElementType", "NDims = 3\nElementType", "there twice");
    expect_error("ElementDataFile", "ElementDataPile", "line 10");
    expect_in("no reader of images takes it",
              error_of("bad.mha", changed(changed(good, "DimSize", "imSize"), "NDims = 3", "NDims = -1")));
    const std::string matrix = "TransformMatrix = 0 0 0 0 0 0 0 0 0\nElementType";
    EXPECT_NE(error_of("bad.mha", changed(good, "ElementType", matrix)), "nothing was thrown");
}

TEST_F(ImageIo, HeadsOfVtkAreCheckedBeforeTheToolkitReadsThem) {
    const std::string good = vtk("BINARY") + bytes();
    expect_bytes(read_image(write("good.vtk", good)));
    const auto expect_error = [&](const std::string& from, const std::string& to, const std::string& part) {
        expect_in(part, error_of("bad.vtk", changed(good, from, to)));
    };
    expect_error("SPACING 1 1 1", "SPACING 1 1 1e309", "line 6");
    expect_error("SPACING 1 1 1", "SPACING 1 1 nan", "line 6");
    expect_error("SPACING 1 1 1", "SPACING 1 1 0", "cannot have");
    expect_error("SPACING 1 1 1", "SPACING 1 1", "line 6");
    expect_error("ORIGIN 0 0 0", "ORIGIN 0 0 -1e300", "line 7");
    expect_error("DIMENSIONS 2 3 4", "DIMENSIONS 2 3 -4", "line 5");
    expect_error("DIMENSIONS 2 3 4", "DIMENSIONS 2 3", "line 5");
    expect_error("SCALARS values", "SCALARS originals", "'origin'");
    expect_error("an image", std::string(600, 'x'), "line 2");
}

TEST_F(ImageIo, NiftiWithImpossibleSizes) {
    expect_in("a size that no image has", error_of("bad.nii", nifti(bytes(), {-2, -3, 4})));
    expect_in("a size that no image has", error_of("bad.nii", nifti(bytes(), {2, 0, 4})));
    std::string far = nifti(bytes());
    far.replace(280, 4, little(3e38F));
    expect_in("no finite numbers that an image can have", error_of("far.nii", far));
}

/// `content` with the last field of this number replaced by one that means nothing.
std::string without_last_field(std::string content, std::uint16_t tag) {
    const std::size_t at = content.rfind(little(tag) + little(std::uint16_t{3}));
    return content.replace(at, 2, little(std::uint16_t{65000}));
}

TEST_F(ImageIo, PagesOfTiffHaveValuesOfOneKind) {
    // Absent bits are 1: rows of such a page are shorter than the others, and would be read beyond their end.
    expect_in("page 4 has values of another kind", error_of("bits.tif", without_last_field(tiff(bytes()), 258)));
    // All pages are as long; the second one is a preview, so the volume would be written beyond its end.
    std::string preview = tiff(bytes());
    const auto second_unit = [&] {
        const std::string unit = little(std::uint16_t{296}) + little(std::uint16_t{3});
        return preview.find(unit, preview.find(unit) + 1);
    }();
    preview.replace(second_unit, 2, little(std::uint16_t{254}));
    preview.replace(second_unit + 8, 4, little(std::uint32_t{1}));
    expect_in("page 3 follows a preview", error_of("preview.tif", preview));
    preview.replace(second_unit + 8, 4, little(std::uint32_t{0}));
    expect_in("only some of its pages are marked", error_of("marked.tif", preview));
}

TEST_F(ImageIo, ImagesFromBytes) {
    const auto of = [](const std::string& content, const std::string& name) {
        return read_image(FileBytes{std::as_bytes(std::span(content)), name});
    };
    const std::vector<std::string> contents{kNrrd + bytes(),         meta("ElementType = MET_UCHAR\n", bytes()),
                                            nifti(bytes()),          packed(nifti(bytes()), true),
                                            vtk("BINARY") + bytes(), tiff(bytes()),
                                            inr(kInrBytes, bytes()), vol("2", bytes())};
    const auto temporary_files = [] {
        std::set<std::string> result;
        for (const auto& entry : fs::directory_iterator(fs::temp_directory_path())) {
            const std::string name = entry.path().filename().string();
            if (name.starts_with("scaleaxis-")) {
                result.insert(name);
            }
        }
        return result;
    };
    const std::set<std::string> before = temporary_files();
    for (const std::string& content : contents) {
        SCOPED_TRACE(content.substr(0, 12));
        expect_bytes(of(content, "upload"));
    }
    EXPECT_EQ(temporary_files(), before);

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
    list.replace(list.find("LIST"), 4, "%d.raw 0 3 1");
    expect_in("several files", error_of("list.mhd", list));
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

    expect_in("ends before its page 4", error_of("short.tif", content.substr(0, content.size() - 10)));
    std::string circle = content;
    std::memcpy(circle.data() + circle.size() - 4, circle.data() + 4, 4);
    expect_in("page 4 refers to an earlier one", error_of("circle.tif", circle));
    std::string wider = content;
    wider[wider.rfind(little(std::uint16_t{256}) + little(std::uint16_t{4})) + 8] = 1;
    expect_in("page 4 has another size", error_of("wider.tif", wider));
    expect_in("2 dimensions", error_of("flat.tif", tiff(bytes().substr(0, 6))));
}

// The toolkit's reader of DICOM stops the program over what it does not expect.
TEST_F(ImageIo, ElementsOfDicomAreCheckedBeforeTheToolkitReadsThem) {
    const std::string good = dicom({});
    const auto expect_error = [&](const std::string& from, const std::string& to, const std::string& part) {
        expect_in(part, error_of("bad.dcm", changed(good, from, to)));
    };
    expect_error("CS", "Cs", "unknown kind 'Cs'");
    expect_error("1.2.840.10008.1.2.1", "1.2.840.10008.1.2.2", "DICOM");
    expect_error("0.5\\0.25", "0.5\\ inf", "pixel spacing");
    expect_error(std::string("US\2\0\3\0", 6), std::string("US\2\0\0\0", 6), "a size that no image has");
    expect_error(std::string("US\2\0\x10\0", 6), std::string("US\2\0\x0c\0", 6), "12 bits");
    expect_error("OW", "SQ", "no valid DICOM file: at byte");
    for (std::size_t size = 133; size < good.size(); ++size) {
        EXPECT_NE(error_of("short.dcm", good.substr(0, size)), "nothing was thrown") << size;
    }
}

TEST_F(ImageIo, DicomSeries) {
    // Names, numbers and places are in three different orders. The slices are oblique.
    const std::array<std::string, 4> names{"c", "a.dcm", "d.dcm", "b"};
    const Point step{0, -1.2, 1.6};
    const auto write_slices = [&](const std::function<void(int, Slice&)>& change = [](int, Slice&) {}) {
        for (int k = 0; k < 4; ++k) {
            Slice slice{.number = (k * 3) % 4, .place = Point{10, 20, 30} + k * step, .first_value = 6 * k + 1};
            change(k, slice);
            write(names[k], dicom(slice));
        }
    };
    const auto error = [&] {
        try {
            read_image(folder());
        } catch (const FileError& fault) {
            return std::string(fault.what());
        }
        return std::string("nothing was thrown");
    };
    write_slices();
    EXPECT_EQ(file_kind(folder()), FileKind::kImage);
    const Image image = read_image(folder());
    expect_bytes(image);
    EXPECT_LT(distance(image.origin, {10, 20, 30}), 1e-6);
    EXPECT_LT(distance(image.steps[0], {0.25, 0, 0}), 1e-6);
    EXPECT_LT(distance(image.steps[1], {0, 0.4, 0.3}), 1e-6);
    EXPECT_LT(distance(image.steps[2], step), 1e-6);

    write_slices([](int, Slice& slice) { slice.rescale = {"2", "-1024"}; });
    EXPECT_EQ(read_image(folder()).values[23], 2 * 24 - 1024);
    // A tilted gantry: slices are not above each other.
    const Point tilt{0, 0.3, 2};
    write_slices([&](int k, Slice& slice) { slice.place = Point{10, 20, 30} + k * tilt; });
    EXPECT_LT(distance(read_image(folder()).steps[2], tilt), 1e-6);

    write_slices([&](int k, Slice& slice) { slice.place = slice.place + (k == 3 ? 1.0 : 0.0) * step; });
    expect_in("not evenly apart", error());
    write_slices([&](int k, Slice& slice) { slice.place = slice.place - (k == 2 ? 1.0 : 0.0) * step; });
    expect_in("not evenly apart", error());
    write_slices([&](int, Slice& slice) { slice.place = {}; });
    expect_in("not evenly apart", error());
    write_slices([](int k, Slice& slice) { slice.spacing = k == 2 ? "0.5\\0.3" : slice.spacing; });
    expect_in("same directions and spacing", error());
    write_slices([](int k, Slice& slice) { slice.series = k < 2 ? "1" : "2"; });
    expect_in("2 DICOM series", error());
    write_slices();
    const std::string whole = content("b");
    write("b", whole.substr(0, whole.size() - 3));
    expect_in("b: the DICOM file ends too early", error());
    write("b", whole.substr(0, 200));
    expect_in("b: the DICOM file ends too early", error());
}

#else

TEST_F(ImageIo, SaysThatTheToolkitIsMissing) { expect_in("built without it", error_of("a.nrrd", "NRRD0004\n")); }

#endif

}  // namespace
}  // namespace scaleaxis
