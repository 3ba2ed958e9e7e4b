// SPDX-License-Identifier: GPL-3.0-or-later
// Readers of images: what is in a file, and what is wrong with it.
#include <gtest/gtest.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "folder.hpp"
#include "images.hpp"
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

#else

TEST_F(ImageIo, SaysThatTheToolkitIsMissing) { expect_in("built without it", error_of("a.nrrd", "NRRD0004\n")); }

#endif

}  // namespace
}  // namespace scaleaxis
