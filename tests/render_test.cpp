// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>
#include <string>

#include "render_canvas.hpp"
#include "render_draw.hpp"
#include "render_png.hpp"
#include "render_scene.hpp"
#include "render_text.hpp"
#include "scaleaxis/errors.hpp"

namespace scaleaxis::render {
namespace {

constexpr Color kRed{1, 0, 0};
constexpr Color kGreen{0, 1, 0};

const Pixel& pixel(const Image& image, int x, int y) {
    return image.pixels[static_cast<std::size_t>(y) * image.width + x];
}

bool is_white(const Pixel& p) { return p.r == 255 && p.g == 255 && p.b == 255; }

bool is_ink(const Pixel& p) { return p.r < 60 && p.g < 60 && p.b < 60; }

template <typename Predicate>
std::ptrdiff_t count(const Image& image, Predicate predicate) {
    return std::ranges::count_if(image.pixels, predicate);
}

/// A file that disappears with the test.
class TemporaryFile {
   public:
    explicit TemporaryFile(const std::string& ending, const std::string& content = {})
        : path_(std::filesystem::temp_directory_path() /
                (std::to_string(std::random_device{}()) + "-render-test" + ending)) {
        std::ofstream(path_, std::ios::binary) << content;
    }
    ~TemporaryFile() { std::filesystem::remove(path_); }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

   private:
    std::filesystem::path path_;
};

TEST(Canvas, TriangleCoversThePixelsWhoseCentresItHolds) {
    Canvas canvas(10, 10);
    fill_triangle(canvas, {1, 1, 0, kRed}, {9, 1, 0, kRed}, {1, 9, 0, kRed});
    for (int y = 0; y < 10; ++y) {
        for (int x = 0; x < 10; ++x) {
            const bool is_covered = x >= 1 && y >= 1 && (x + 0.5) + (y + 0.5) <= 10.0;
            EXPECT_EQ(!is_white(pixel(canvas.image, x, y)), is_covered) << x << ' ' << y;
        }
    }
}

TEST(Canvas, NearerTriangleWinsInEitherOrder) {
    for (const bool near_first : {true, false}) {
        Canvas canvas(8, 8);
        const auto draw = [&](double z, const Color& color) {
            fill_triangle(canvas, {-20, -20, z, color}, {40, -20, z, color}, {-20, 40, z, color});
        };
        if (near_first) draw(5, kRed);
        draw(1, kGreen);
        if (!near_first) draw(5, kRed);
        EXPECT_EQ(count(canvas.image, [](const Pixel& p) { return p.r == 255 && p.g == 0; }), 64);
    }
}

TEST(Canvas, NeighbouringTrianglesLeaveNoGap) {
    constexpr int kSize = 64;
    for (std::uint32_t seed = 1; seed <= 50; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> inner(0.0, kSize);
        // Half of the centres lie on those of pixels, where rounding decides.
        double x = inner(random);
        double y = inner(random);
        if (seed % 2 == 0) x = std::floor(x) + 0.5, y = std::floor(y) + 0.5;
        Canvas canvas(kSize, kSize);
        const std::array<std::array<double, 2>, 4> square{{{-1, -1}, {65, -1}, {65, 65}, {-1, 65}}};
        for (std::size_t k = 0; k < 4; ++k) {
            const auto& [ax, ay] = square[k];
            const auto& [bx, by] = square[(k + 1) % 4];
            fill_triangle(canvas, {x, y, 0, kRed}, {ax, ay, 0, kRed}, {bx, by, 0, kRed});
        }
        EXPECT_EQ(count(canvas.image, is_white), 0);
    }
}

TEST(Canvas, SegmentHasItsWidthAndRoundEnds) {
    for (const double angle : {0.0, 0.3, 1.0, std::numbers::pi / 2, 2.5}) {
        Canvas canvas(400, 400);
        const double dx = 100 * std::cos(angle);
        const double dy = 100 * std::sin(angle);
        fill_segment(canvas, {200 - dx, 200 - dy, 0, kRed}, {200 + dx, 200 + dy, 0, kRed}, 15.0);
        const double area = 200.0 * 30.0 + std::numbers::pi * 15.0 * 15.0;
        const auto covered = 400 * 400 - count(canvas.image, is_white);
        EXPECT_NEAR(static_cast<double>(covered), area, 0.01 * area) << "angle " << angle;
    }
}

TEST(Canvas, SphereIsARoundHeight) {
    Canvas canvas(300, 300);
    fill_spheres(canvas, {{{150, 150, 7, kRed}, 100.0}});
    const double area = std::numbers::pi * 100.0 * 100.0;
    EXPECT_NEAR(static_cast<double>(300 * 300 - count(canvas.image, is_white)), area, 0.005 * area);
    for (int x = 0; x < 300; ++x) {
        const double dx = x + 0.5 - 150.0;
        const double squared = 100.0 * 100.0 - dx * dx - 0.25;
        if (squared < 0.0) continue;
        EXPECT_NEAR(canvas.depth[150 * 300 + static_cast<std::size_t>(x)], 7.0 + std::sqrt(squared), 1e-3);
    }
}

/// The blocks that spare work must not change the picture: compared with the highest sphere at each pixel.
TEST(Canvas, ManySpheresAreTheirUpperEnvelope) {
    constexpr int kSize = 101;
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> position(-10.0, kSize + 10.0);
        std::uniform_real_distribution<double> size(1.0, 30.0);
        std::vector<Sphere> spheres;
        for (int i = 0; i < 200; ++i) {
            const double x = position(random);
            const double y = position(random);
            const double z = position(random);
            spheres.push_back({{x, y, z, kRed}, size(random)});
        }
        Canvas canvas(kSize, kSize);
        fill_spheres(canvas, spheres);
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                double highest = -std::numeric_limits<double>::infinity();
                for (const Sphere& s : spheres) {
                    const double dx = x + 0.5 - s.center.x;
                    const double dy = y + 0.5 - s.center.y;
                    const double squared = s.radius * s.radius - dx * dx - dy * dy;
                    if (squared >= 0.0) highest = std::max(highest, s.center.z + std::sqrt(squared));
                }
                ASSERT_FLOAT_EQ(canvas.depth[static_cast<std::size_t>(y) * kSize + x], static_cast<float>(highest));
            }
        }
    }
}

TEST(Canvas, ReductionIsTheMean) {
    Image image{4, 2, std::vector<Pixel>(8)};
    image.pixels[0] = {0, 3, 255};
    const Image half = reduced(image, 2);
    ASSERT_EQ(half.width, 2);
    ASSERT_EQ(half.height, 1);
    EXPECT_EQ(half.pixels[0].r, 191);
    EXPECT_EQ(half.pixels[0].g, 192);
    EXPECT_EQ(half.pixels[0].b, 255);
    EXPECT_TRUE(is_white(half.pixels[1]));
}

TEST(Color, ScaleEndsAndSheetsAreApart) {
    const auto near = [](const Color& c, double r, double g, double b) {
        return std::abs(255 * c.r - r) + std::abs(255 * c.g - g) + std::abs(255 * c.b - b) < 2.0;
    };
    EXPECT_TRUE(near(viridis(0.0), 68, 1, 84));
    EXPECT_TRUE(near(viridis(0.5), 33, 145, 140));
    EXPECT_TRUE(near(viridis(1.0), 253, 231, 37));
    EXPECT_EQ(on_scale(0.0, 0.0), 0.0);
    EXPECT_EQ(on_scale(3.0, 2.0), 1.0);
    EXPECT_EQ(on_scale(std::nan(""), 2.0), 0.0);
    for (Index a = 0; a < 8; ++a) {
        for (Index b = 0; b < a; ++b) {
            const Color difference = sheet_color(a) - sheet_color(b);
            EXPECT_GT(std::abs(difference.r) + std::abs(difference.g) + std::abs(difference.b), 0.1F) << a << ' ' << b;
        }
    }
}

TEST(Text, EveryCharacterIsInsideItsWidth) {
    for (int c = '!'; c <= '~'; ++c) {
        const std::string text(1, static_cast<char>(c));
        Canvas canvas(200, 200);
        draw_text(canvas, text, {50, 100, 0, kRed}, 60.0);
        const double width = text_width(text, 60.0);
        bool has_ink = false;
        for (int y = 0; y < 200; ++y) {
            for (int x = 0; x < 200; ++x) {
                if (is_white(pixel(canvas.image, x, y))) continue;
                has_ink = true;
                ASSERT_TRUE(x > 40 && x < 50 + width + 10 && y > 20 && y < 130) << text << ' ' << x << ' ' << y;
            }
        }
        EXPECT_TRUE(has_ink) << text;
    }
}

constexpr int kTile = 400;
constexpr int kMiddle = kTile / 2;

/// The square [0, 1]² at z = 0, and what the caller adds.
Scene square() {
    Scene scene;
    scene.kind = Kind::Axis;
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    scene.radii = {1, 1, 1, 1};
    scene.faces.push_back(std::vector<Index>{0, 1, 2, 3});
    scene.face_sheets = {0};
    scene.face_angles = {45.0};
    return scene;
}

Image front_picture(Scene scene, Coloring coloring, const std::optional<Scene>& shape = {}) {
    const Camera camera = camera_from({0, 0, 1}, {0, 1, 0});
    Tile tile{std::move(scene), shape, "", {}, 1.0};
    tile.extent = extent_of(tile.scene, camera);
    Style style;
    style.width = style.height = kTile;
    style.coloring = coloring;
    style.has_labels = false;
    return draw_tile(tile, camera, style);
}

void expect_color(const Pixel& p, const Color& color) {
    EXPECT_NEAR(p.r, 255 * color.r, 1.5);
    EXPECT_NEAR(p.g, 255 * color.g, 1.5);
    EXPECT_NEAR(p.b, 255 * color.b, 1.5);
}

TEST(DrawTile, SquareFillsTheTileInTheColourAskedFor) {
    const float light = brightness({0, 0, 1});
    const Image sheet = front_picture(square(), Coloring::Sheet);
    expect_color(pixel(sheet, kMiddle, kMiddle), light * sheet_color(0));
    // 12 pixels of margin at each side.
    EXPECT_TRUE(is_white(pixel(sheet, 9, kMiddle)));
    EXPECT_TRUE(is_white(pixel(sheet, kMiddle, 390)));
    EXPECT_FALSE(is_white(pixel(sheet, 13, kMiddle)));
    EXPECT_FALSE(is_white(pixel(sheet, kMiddle, 386)));
    expect_color(pixel(front_picture(square(), Coloring::Angle), kMiddle, kMiddle), light * viridis(0.5));
    expect_color(pixel(front_picture(square(), Coloring::Radius), kMiddle, kMiddle), light * viridis(1.0));
}

TEST(DrawTile, BothSidesOfAFaceAreLit) {
    Scene turned = square();
    turned.faces = {};
    turned.faces.push_back(std::vector<Index>{3, 2, 1, 0});
    expect_color(pixel(front_picture(turned, Coloring::Sheet), kMiddle, kMiddle),
                 brightness({0, 0, 1}) * sheet_color(0));
}

TEST(DrawTile, CurveIsThickDarkAndHiddenBehindFaces) {
    for (const double z : {1.0, -1.0}) {
        Scene scene = square();
        scene.vertices.push_back({0.5, -0.5, z});
        scene.vertices.push_back({0.5, 1.5, z});
        scene.radii.insert(scene.radii.end(), 2, 1.0);
        scene.edges.push_back({4, 5});
        const Image image = front_picture(scene, Coloring::Sheet);
        const auto ink_of_row = [&](int y) {
            int ink = 0;
            for (int x = 0; x < image.width; ++x) ink += is_ink(pixel(image, x, y));
            return ink;
        };
        EXPECT_NEAR(ink_of_row(50), 2, 1);
        EXPECT_EQ(ink_of_row(kMiddle) > 0, z > 0.0);
    }
}

TEST(DrawTile, IsolatedVertexIsADot) {
    Scene scene = square();
    scene.vertices.push_back({2, 0.5, 0});
    scene.radii.push_back(1);
    const Image image = front_picture(scene, Coloring::Sheet);
    EXPECT_FALSE(is_white(pixel(image, 387, kMiddle)));
    EXPECT_TRUE(is_white(pixel(image, 378, kMiddle)));
}

TEST(DrawTile, NarrowStripIsUnbroken) {
    Scene scene = square();
    for (Point& p : scene.vertices) p.x *= 1e-6;
    const Image image = front_picture(scene, Coloring::Sheet);
    for (int y = 13; y < 387; ++y) {
        int covered = 0;
        for (int x = 0; x < image.width; ++x) covered += !is_white(pixel(image, x, y));
        ASSERT_GE(covered, 1) << "row " << y;
    }
}

TEST(DrawTile, SheetsHaveTheirColours) {
    // Two squares side by side.
    Scene scene;
    scene.kind = Kind::Axis;
    scene.vertices = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}};
    scene.radii.assign(6, 1.0);
    scene.faces.push_back(std::vector<Index>{0, 1, 3, 2});
    scene.faces.push_back(std::vector<Index>{0, 1, 5, 4});
    const auto colors_differ = [](const Image& image) {
        const Pixel& left = pixel(image, kTile / 4, kMiddle);
        const Pixel& right = pixel(image, 3 * kTile / 4, kMiddle);
        return std::abs(left.r - right.r) + std::abs(left.g - right.g) + std::abs(left.b - right.b) > 10;
    };
    scene.face_sheets = {0, 0};
    EXPECT_FALSE(colors_differ(front_picture(scene, Coloring::Sheet)));
    scene.face_sheets = {0, 1};
    EXPECT_TRUE(colors_differ(front_picture(scene, Coloring::Sheet)));
}

TEST(DrawTile, GlassTintsWithoutHiding) {
    Scene glass = square();
    glass.kind = Kind::Mesh;
    for (Point& p : glass.vertices) p.z = 5.0;
    const Pixel bare = pixel(front_picture(square(), Coloring::Sheet), kMiddle, kMiddle);
    const Pixel tinted = pixel(front_picture(square(), Coloring::Sheet, glass), kMiddle, kMiddle);
    EXPECT_LT(tinted.r, bare.r);
    EXPECT_GT(tinted.r, 0.8 * bare.r);
}

TEST(DrawTile, MissingAnglesAreAnError) {
    Scene scene = square();
    scene.face_angles.clear();
    EXPECT_THROW(front_picture(scene, Coloring::Angle), InvalidOption);
}

TEST(DrawTile, LabelsHaveHuesOfTheirOwn) {
    Scene scene = square();
    EXPECT_THROW(front_picture(scene, Coloring::Label), InvalidOption);
    scene.labels.assign(4, 7);
    expect_color(pixel(front_picture(scene, Coloring::Label), kMiddle, kMiddle),
                 brightness({0, 0, 1}) * sheet_color(7));
}

TEST(DrawTile, OnePointHasNoSizeAndIsDrawn) {
    Scene scene;
    scene.kind = Kind::Axis;
    scene.vertices = {{1e6, 0, 0}};
    scene.radii = {0.0};
    EXPECT_TRUE(is_ink(pixel(front_picture(scene, Coloring::Sheet), kMiddle, kMiddle)));
}

TEST(Png, ReadsBackAsWritten) {
    Image image{3, 2, std::vector<Pixel>(6)};
    for (std::size_t i = 0; i < 6; ++i) image.pixels[i] = {static_cast<std::uint8_t>(i), 100, 200};
    const TemporaryFile file(".png");
    write_png(file.path(), image);
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_TRUE(png_image_begin_read_from_file(&png, file.path().c_str()));
    png.format = PNG_FORMAT_RGB;
    ASSERT_EQ(png.width, 3U);
    ASSERT_EQ(png.height, 2U);
    std::vector<std::uint8_t> bytes(PNG_IMAGE_SIZE(png));
    ASSERT_TRUE(png_image_finish_read(&png, nullptr, bytes.data(), 0, nullptr));
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(bytes[3 * i], i);
        EXPECT_EQ(bytes[3 * i + 1], 100);
        EXPECT_EQ(bytes[3 * i + 2], 200);
    }
    EXPECT_THROW(write_png(file.path() / "no-folder.png", image), FileError);
}

constexpr const char* kAsciiAxis =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 5\nproperty double x\nproperty double y\n"
    "property double z\nproperty double radius\nproperty int ball\nelement face 1\n"
    "property list uchar int vertex_indices\nproperty int sheet\nproperty double angle\nelement edge 1\n"
    "property int vertex1\nproperty int vertex2\nend_header\n"
    "0 0 0 0.1 -1\n1 0 0 0.2 -1\n1 1 0 0.3 -1\n0 1 0 0.4 7\n0 2 0 0.5 -1\n4 0 1 2 3 0 62.5\n3 4\n";

void expect_axis(const Scene& scene) {
    EXPECT_EQ(scene.kind, Kind::Axis);
    ASSERT_EQ(scene.vertices.size(), 5U);
    EXPECT_EQ(scene.vertices[2], (Point{1, 1, 0}));
    EXPECT_EQ(scene.radii, (std::vector<double>{0.1, 0.2, 0.3, 0.4, 0.5}));
    ASSERT_EQ(scene.faces.size(), 1U);
    EXPECT_EQ(scene.faces.items, (std::vector<Index>{0, 1, 2, 3}));
    EXPECT_EQ(scene.face_sheets, std::vector<Index>{0});
    EXPECT_EQ(scene.face_angles, std::vector<double>{62.5});
    EXPECT_EQ(scene.edges, (std::vector<std::array<Index, 2>>{{0, 1}, {0, 3}, {1, 2}, {2, 3}, {3, 4}}));
}

/// The axis of `kAsciiAxis` in binary.
std::string binary_axis(std::endian order) {
    std::string text(kAsciiAxis);
    text.replace(text.find("ascii"), 5, order == std::endian::little ? "binary_little_endian" : "binary_big_endian");
    text.erase(text.find("end_header\n") + 11);
    const auto put = [&](auto value) {
        auto bytes = std::bit_cast<std::array<char, sizeof(value)>>(value);
        if (order != std::endian::native) std::ranges::reverse(bytes);
        text.append(bytes.begin(), bytes.end());
    };
    const std::array<Point, 5> points{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 2, 0}}};
    const std::array<double, 5> radii{0.1, 0.2, 0.3, 0.4, 0.5};
    for (std::size_t v = 0; v < 5; ++v) {
        for (const double value : {points[v].x, points[v].y, points[v].z, radii[v]}) put(value);
        put(std::int32_t{-1});
    }
    put(std::uint8_t{4});
    for (const std::int32_t v : {0, 1, 2, 3, 0}) put(v);
    put(62.5);
    for (const std::int32_t v : {3, 4}) put(v);
    return text;
}

TEST(ReadScene, PlyInAllEncodings) {
    expect_axis(read_scene(TemporaryFile(".ply", kAsciiAxis).path()));
    expect_axis(read_scene(TemporaryFile(".ply", binary_axis(std::endian::little)).path()));
    expect_axis(read_scene(TemporaryFile(".PLY", binary_axis(std::endian::big)).path()));
}

TEST(ReadScene, MedialAxisText) {
    const TemporaryFile file(".ma",
                             "4 4 1\nv 0 0 0 1\nv 1 0 0 2\nv 0 1 0 3\nv 5 5 5 4\n"
                             "e 0 1\ne 1 2\ne 0 2\ne 2 3\nf 0 1 2\n");
    const Scene scene = read_scene(file.path());
    EXPECT_EQ(scene.kind, Kind::Axis);
    EXPECT_EQ(scene.radii, (std::vector<double>{1, 2, 3, 4}));
    EXPECT_EQ(scene.edges.size(), 4U);
    EXPECT_EQ(scene.faces.items, (std::vector<Index>{0, 1, 2}));
    EXPECT_EQ(scene.face_sheets, std::vector<Index>{0});
    EXPECT_TRUE(scene.face_angles.empty()) << "the file names none";
}

TEST(ReadScene, RadiiAloneAreBallsAndFacesAloneAMesh) {
    const std::string vertices =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const TemporaryFile balls(".ply", vertices + "property float radius\nend_header\n0 0 0 1\n1 0 0 1\n0 1 0 1\n");
    EXPECT_EQ(read_scene(balls.path()).kind, Kind::Balls);
    const TemporaryFile mesh(".ply", vertices +
                                         "element face 1\nproperty list uchar uint vertex_index\nend_header\n"
                                         "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_EQ(read_scene(mesh.path()).kind, Kind::Mesh);
}

TEST(ReadScene, BadFilesAreErrors) {
    // Cut anywhere, a file is an error, never a crash. (Without the last newline nothing is missing.)
    const std::string whole = binary_axis(std::endian::little);
    for (std::size_t length = 0; length < whole.size(); length += 7) {
        EXPECT_THROW(read_scene(TemporaryFile(".ply", whole.substr(0, length)).path()), FileError) << length;
    }
    const auto expect_bad = [](const char* ending, const std::string& content) {
        EXPECT_THROW(read_scene(TemporaryFile(ending, content).path()), FileError) << content;
    };
    expect_bad(".ma", "");
    expect_bad(".ma", "0 0 0\n");
    expect_bad(".ma", "1000000000000 0 0\nv 0 0 0 1\n");
    expect_bad(".ma", "1 0 0\nv 0 0 nan 1\n");
    expect_bad(".ma", "1 0 0\nv 0 0 1e300 1\n");
    expect_bad(".ma", "1 1 0\nv 0 0 0 1\ne 0 1\n");
    expect_bad(".ma", "1 1 0\nv 0 0 0 1\ne 0 -1\n");
    expect_bad(".ma", "1 0 0\nx 0 0 0 1\n");
    EXPECT_THROW(read_scene("no-such-file.ply"), FileError);
    EXPECT_THROW(read_scene(std::filesystem::temp_directory_path() / "."), FileError);
}

}  // namespace
}  // namespace scaleaxis::render
